"""Exports over HTTP: the files of `placecell export`, and their headers."""

import json
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode
from typer.testing import CliRunner

from cli import app
from placecell.core import geodesy
from placecell.descriptors.manifest import Manifest
from service.clouds import map_export
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

ANCHOR = "49.011,8.424,30"


@pytest.fixture
def yard(service: Any, manifest: Manifest) -> Any:
    """The service with a map in two versions."""
    service.put("/maps/yard", content=encode(map_of(random_codes(20), manifest.model_id)))
    edit = edit_of(random_codes(3, 1), manifest.model_id, first_id=500)
    assert service.post("/maps/yard/segments", content=edit).status_code == 200
    return service


@pytest.mark.parametrize("to", ["ply", "pcd", "mcap", "geojson", "tum", "g2o", "las"])
def test_export_is_the_file_of_the_command(yard: Any, tmp_path: Path, to: str) -> None:
    query = {"to": to, "color": "robot"} | ({"anchor": ANCHOR} if to == "geojson" else {})
    answer = yard.get("/maps/yard/export", params=query)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-disposition"] == f'attachment; filename="yard.{to}"'
    assert answer.headers["x-content-type-options"] == "nosniff"
    kind = answer.headers["content-type"].partition(";")[0]
    assert kind == map_export.MEDIA_TYPES[to]  # type: ignore[index]
    source, file = tmp_path / "yard.map", tmp_path / f"out.{to}"
    source.write_bytes(yard.get("/maps/yard").content)
    arguments = ["export", str(source), "--to", to, "--color", "robot", "--output", str(file)]
    done = CliRunner().invoke(app, arguments + ["--anchor", ANCHOR] * (to == "geojson"))
    assert done.exit_code == 0, done.output
    assert answer.content == file.read_bytes()


def test_known_export_is_not_made_again(yard: Any) -> None:
    first = yard.get("/maps/yard/export?to=ply")
    known = {"If-None-Match": first.headers["etag"]}
    again = yard.get("/maps/yard/export?to=ply", headers=known)
    assert (again.status_code, again.content) == (304, b"")
    other = yard.get("/maps/yard/export?to=ply&color=group", headers=known)
    assert other.status_code == 200
    old = yard.get("/maps/yard/export?to=ply&version=1", headers=known)
    assert old.status_code == 200
    assert b"element vertex 20\n" in old.content
    assert b"element vertex 23\n" in first.content
    assert yard.head("/maps/yard/export?to=ply").headers["content-length"] == str(
        len(first.content)
    )


def test_geojson_takes_the_anchor_of_the_map(yard: Any) -> None:
    refused = yard.get("/maps/yard/export?to=geojson")
    assert_problem(refused, 422, "invalid-request", "PUT /maps/MAP/anchor")
    place = {"lat": 49.011, "lon": 8.424, "yaw_deg": 30.0}
    assert yard.put("/maps/yard/anchor", json=place).status_code in {200, 201}
    features = json.loads(yard.get("/maps/yard/export?to=geojson").content)["features"]
    asked = yard.get("/maps/yard/export", params={"to": "geojson", "anchor": ANCHOR})
    assert json.loads(asked.content)["features"] == features
    moved = yard.get("/maps/yard/export", params={"to": "geojson", "anchor": "48,8"})
    assert json.loads(moved.content)["features"] != features


@pytest.mark.parametrize(
    ("path", "status", "kind"),
    [
        ("/maps/yard/export", 422, "invalid-request"),
        ("/maps/yard/export?to=exe", 422, "invalid-request"),
        ("/maps/yard/export?to=ply&color=blue", 422, "invalid-request"),
        ("/maps/yard/export?to=geojson&anchor=north", 422, "invalid-request"),
        ("/maps/yard/export?to=ply&version=9", 404, "unknown-version"),
        ("/maps/other/export?to=ply", 404, "unknown-map"),
    ],
)
def test_wrong_export_is_refused(yard: Any, path: str, status: int, kind: str) -> None:
    answer = yard.get(path)
    assert_problem(answer, status, kind)
    assert "--anchor" not in answer.text


def test_large_map_and_distant_anchor_are_refused(
    yard: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(map_export.MOST_SEGMENTS, "ply", 22)
    assert_problem(yard.get("/maps/yard/export?to=ply"), 413, "too-many-segments", "as las or ply")
    monkeypatch.setattr(map_export, "MOST_CAPTURES", 0)
    assert_problem(yard.get("/maps/yard/export?to=tum"), 413, "too-many-segments", "captures")
    assert yard.get("/maps/yard/export?to=las").status_code == 200
    monkeypatch.undo()
    monkeypatch.setattr(geodesy, "FARTHEST", 1.0)
    far = yard.get("/maps/yard/export", params={"to": "geojson", "anchor": ANCHOR})
    assert_problem(far, 422, "invalid-request", "from the anchor")


def test_folder_of_the_service_is_left_clean(yard: Any, data_dir: Path) -> None:
    before = {each.name for each in data_dir.iterdir()}
    assert yard.get("/maps/yard/export?to=mcap").status_code == 200
    assert {each.name for each in data_dir.iterdir()} == before
