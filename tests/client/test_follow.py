"""Captures that follow the moved captures of their odometry track."""

from dataclasses import replace

import numpy as np
import pytest
from placecell_client import CompactMap
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import take
from placecell_client.maps.follow import followed, moved_at
from placecell_client.maps.move import moved

TRACK = 9
YAW = 0.3


def line(captures: int = 10) -> CompactMap:
    """Return a map of captures 5 m apart, as the odometry gave them, with two segments each."""
    positions = np.column_stack([5.0 * np.arange(captures), np.zeros(captures), np.ones(captures)])
    rows = np.repeat(np.arange(captures), 2)
    offsets = np.tile([[3.0, 4.0, 0.0], [3.0, -4.0, 0.5]], (captures, 1))
    return canonical(
        CompactMap(
            model_id="m", preprocessing="1", frame="odom",
            codes=np.zeros((len(rows), 2), np.int8),
            centroids=positions[rows] + offsets,
            ids=np.arange(len(rows), dtype=np.uint32),
            robots=("ann",), robot=np.zeros(len(rows), np.uint16),
            frame_index=rows.astype(np.uint32),
            frame_times=100.0 + np.arange(captures, dtype=np.float64),
            frame_positions=positions,
            frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (captures, 1)),
            frame_tracks=np.full(captures, TRACK, np.uint32),
            frame_odometry=np.column_stack([positions, np.zeros((captures, 4))]),
        )
    )  # fmt: skip


def turned(given: CompactMap) -> CompactMap:
    """Return the map after an optimization that turned and shifted it."""
    cos, sin = np.cos(YAW), np.sin(YAW)
    rotation = np.array([[cos, -sin, 0], [sin, cos, 0], [0, 0, 1]])
    return canonical(moved(given, rotation, [2.0, 1.0, 0.0], given.frame))


def test_new_captures_follow_the_last_moved_one() -> None:
    whole = line()
    stored, new = take(whole, whole.frame_index < 6), take(whole, whole.frame_index >= 6)
    placed = followed(new, [turned(canonical(stored))])
    expected = turned(canonical(new))
    np.testing.assert_allclose(placed.frame_positions, expected.frame_positions, atol=1e-4)
    np.testing.assert_allclose(placed.centroids, expected.centroids, atol=0.011)
    np.testing.assert_allclose(placed.frame_orientations, expected.frame_orientations, atol=1e-6)
    np.testing.assert_array_equal(placed.frame_odometry, canonical(new).frame_odometry)
    # Captures that follow already stay as they are.
    assert followed(placed, [turned(canonical(stored))]) is placed


def test_map_that_nobody_moved_is_returned_as_it_is() -> None:
    whole = line()
    assert followed(whole, [whole]) is whole
    assert followed(whole, []) is whole
    plain = replace(whole, frame_tracks=None, frame_odometry=None)
    assert followed(plain, [turned(whole)]) is plain
    assert followed(whole, [plain]) is whole


def test_other_tracks_do_not_matter() -> None:
    whole = line()
    other = replace(turned(whole), frame_tracks=np.full(10, 3, np.uint32))
    assert followed(whole, [other]) is whole


def test_robot_learns_how_its_place_moved() -> None:
    whole = line()
    after = turned(whole)
    found = moved_at(whole, after, [21.0, 1.0, 1.0])
    assert found is not None
    at = found @ [20.0, 0.0, 1.0, 1.0]
    row = int(np.flatnonzero(after.frame_times == 104.0)[0])
    np.testing.assert_allclose(at[:3], after.frame_positions[row], atol=1e-6)
    assert np.arctan2(found[1, 0], found[0, 0]) == pytest.approx(YAW, abs=1e-6)
    plain = replace(whole, frame_tracks=None, frame_odometry=None)
    assert moved_at(whole, plain, [0, 0, 0]) is None
    other = replace(after, frame_tracks=np.full(10, 3, np.uint32))
    assert moved_at(whole, other, [0, 0, 0]) is None
