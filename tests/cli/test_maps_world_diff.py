"""`placecell maps diff --world`: what changed in the world between two map files."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from placecell_client import CompactMap, encode
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import take

from tests.cli.maps_command import bad, good

CAR, OTHER, WALL, POST = 0, 1, 2, 3


@pytest.fixture
def street() -> CompactMap:
    """Two parked cars before a wall, and a post, seen by one capture."""
    centers = [[8.0, -3.0, 0.8], [8.0, 3.0, 0.8], [15.0, 0.0, 2.0], [4.0, 9.0, 1.0]]
    sides = [[40, 20, 15], [40, 20, 15], [5, 240, 40], [3, 3, 20]]
    return canonical(
        CompactMap(
            model_id="m", preprocessing="1", frame="street",
            codes=np.zeros((4, 2), np.int8),
            centroids=np.array(centers),
            ids=np.arange(4, dtype=np.uint32),
            robots=("ann",), robot=np.zeros(4, np.uint16),
            frame_index=np.zeros(4, np.uint32),
            frame_times=np.array([100.0]),
            frame_positions=np.array([[0.0, 0.0, 1.8]]),
            frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
            extents=np.array(sides, np.uint8),
        )
    )  # fmt: skip


def test_car_that_left_is_gone_and_another_one_appeared(tmp_path: Path, street: CompactMap) -> None:
    files = []
    for name, rows in (("monday", [CAR, WALL, POST]), ("friday", [OTHER, WALL, POST])):
        files.append(tmp_path / f"{name}.map")
        files[-1].write_bytes(encode(canonical(take(street, np.array(rows)))))
    plot = tmp_path / "changes.png"
    counts = json.loads(good("diff", *files, "--world", "--plot", plot, "--json"))
    assert counts == {
        "kept": 2, "changed": 0, "gone": 1, "unseen": 0, "appeared": 1, "new_place": 0,
    }  # fmt: skip
    assert plot.read_bytes().startswith(b"\x89PNG")
    assert "2 kept, 0 changed, 1 gone, 0 not in sight" in good("diff", *files, "--world")
    same = json.loads(good("diff", files[0], files[0], "--world", "--json"))
    assert same["kept"] == 3


def test_maps_in_different_frames_are_refused(tmp_path: Path, street: CompactMap) -> None:
    files = [tmp_path / "one.map", tmp_path / "other.map"]
    files[0].write_bytes(encode(street))
    files[1].write_bytes(encode(replace(street, frame="elsewhere")))
    assert "Merge them" in bad("diff", *files, "--world")
