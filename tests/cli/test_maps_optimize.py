"""Tests of `placecell maps optimize`: what it prints and draws."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from placecell_client.results.optimization import Optimization, optimization_of

from tests.cli.maps_command import good

ANSWER: dict[str, Any] = {
    "map": "yard", "dry_run": False, "sequence": 5, "etag": "ab-5", "previous": 4, "captures": 3,
    "changed": 40, "loops_found": 2, "loops_accepted": 1, "residual_before_m": 1.5,
    "residual_after_m": 0.05, "moved_median_m": 0.4, "moved_max_m": 2.0,
    "loops": [
        {
            "captures": [0, 2], "times": [1.0, 3.0], "positions": [[0, 0, 0], [1, 0, 0]],
            "verdict": verdict, "probability": 0.99, "inliers": 20, "meters": 0.1, "degrees": 0.2,
        }
        for verdict in ("accepted", "not-explained-by-drift")
    ],
    "parts": [{"robots": ["ann"], "captures": 3, "moved_m": 2.0}],
    "frames": [
        {"robot": "ann", "time": float(n), "before": [n, 0, 0], "after": [n, 1, 0], "yaw": 0.1}
        for n in range(3)
    ],
}  # fmt: skip


class FakeClient:
    """Client that answers with one optimization."""

    def __init__(self, found: Optimization) -> None:
        self.found = found
        self.asked: list[tuple[str, dict[str, Any]]] = []

    def optimize_map(self, name: str, **options: Any) -> Optimization:
        self.asked.append((name, options))
        return self.found


@pytest.fixture
def client(monkeypatch: pytest.MonkeyPatch) -> FakeClient:
    fake = FakeClient(optimization_of(ANSWER))

    @contextmanager
    def service(_: str) -> Iterator[FakeClient]:
        yield fake

    # The package has a function of the module's name.
    monkeypatch.setattr(sys.modules["cli.maps.optimize"], "service", service)
    return fake


def test_optimize_prints_verdicts_and_the_command_that_undoes_it(client: FakeClient) -> None:
    told = good("optimize", "yard")
    assert "not explained by drift" in told
    assert "1.50 m off before and 0.05 m" in told
    assert "placecell maps restore yard 4" in told
    assert client.asked == [("yard", {"dry_run": False, "frames": False, "if_match": None})]


def test_dry_run_and_settled_map_say_that_nothing_was_written(client: FakeClient) -> None:
    client.found = replace(client.found, dry_run=True, sequence=None, etag=None)
    assert "40 segments would move. Nothing was written" in good("optimize", "yard", "--dry-run")
    client.found = replace(client.found, dry_run=False, sequence=4)
    assert "nothing was written" in good("optimize", "yard")


def test_plot_and_json_are_written(client: FakeClient, tmp_path: Path) -> None:
    file = tmp_path / "yard.png"
    found = json.loads(good("optimize", "yard", "--plot", str(file), "--json"))
    assert found["loops"][0]["verdict"] == "accepted"
    assert file.read_bytes().startswith(b"\x89PNG")
    assert client.asked[0][1]["frames"]
