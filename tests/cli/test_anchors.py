"""`placecell maps tag`, `placecell maps anchor` and `placecell robots` against a service."""

import json
from pathlib import Path

import numpy as np
import pytest
from placecell_client import Client, CompactMap
from typer.testing import CliRunner

from cli import app
from placecell.core.geodesy import GeoAnchor, to_geodetic
from tests.cli.maps_command import bad, good


def test_tags_anchor_and_robots(
    address: str, tmp_path: Path, yard: CompactMap, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PLACECELL_URL", address)
    with Client(address) as client:
        client.put_map("tagged", yard)
        assert "outdoor, site-3" in good("tag", "tagged", "site-3", "outdoor")
        assert json.loads(good("tag", "tagged", "--json")) == {
            "map": "tagged",
            "tags": ["outdoor", "site-3"],
        }
        assert "--clear removes all tags" in bad("tag", "tagged", "x", "--clear")
        assert "no tags" in good("tag", "tagged", "--clear")
        assert "no WGS 84 anchor" in bad("anchor", "show", "tagged")
        placed = good("anchor", "set", "tagged", "-33.9", "151.2", "--yaw-deg", "-20")
        assert "is at -33.9000000, 151.2000000" in placed
        assert json.loads(good("anchor", "show", "tagged", "--json"))["yaw_deg"] == -20
        file = tmp_path / "fixes.csv"
        positions = np.column_stack([np.linspace(0, 100, 20), np.zeros(20), np.zeros(20)])
        places = to_geodetic(positions, GeoAnchor(49.0, 8.4, 110.0, 37.0))
        rows = np.column_stack([positions, places, np.ones(20)])
        lines = [",".join(map(repr, row)) for row in rows.tolist()]
        file.write_text("x,y,z,lat,lon,height,accuracy\n" + "\n".join(lines) + "\n")
        assert "Nothing was written" in good("anchor", "fit", "tagged", file, "--dry-run")
        assert client.anchor("tagged").yaw_deg == -20
        told = json.loads(good("anchor", "fit", "tagged", file, "--json"))
        assert told["inliers"] == 20
        assert told["anchor"]["yaw_deg"] == pytest.approx(37.0, abs=0.01)
        file.write_text("1,2,3\n")
        assert "line 1 is '1,2,3'; expected seven numbers" in bad("anchor", "fit", "tagged", file)
        assert "no place on the Earth" in good("anchor", "delete", "tagged")
        empty = CliRunner().invoke(app, ["robots"])
        assert "No robot reported" in empty.output
        client.report_pose("ann", "tagged", (1, 2, 3), probability=0.99)
        client.report_pose("bob", state="lost", reason="carried away")
        shown = CliRunner().invoke(app, ["robots"]).output
        assert "1.0, 2.0, 3.0" in shown
        assert "carried away" in shown
        listed = json.loads(CliRunner().invoke(app, ["robots", "--json"]).output)["robots"]
        assert [each["robot"] for each in listed] == ["ann", "bob"]
        client.delete_map("tagged")
