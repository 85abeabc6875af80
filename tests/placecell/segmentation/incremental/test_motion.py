"""Segments that move while the robot sees them are marked."""

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float32
from placecell.segmentation.incremental import IncrementalSegmentation
from placecell.segmentation.incremental.motion import Sight, directions
from tests.placecell.segment_builders import pose

PARAMETERS = PROTOCOL_V1.for_drive(14)


def patch(distance: float, width: float = 4.0, step: float = 0.1, y: float = 0.0) -> Float32:
    """Return a wall across the x axis, from 1 m below the sensor to 1 m above it."""
    across, up = np.meshgrid(np.arange(-width / 2, width / 2, step) + y, np.arange(-1, 1, step))
    return np.column_stack([np.full(across.size, distance), across.ravel(), up.ravel()]).astype(
        np.float32
    )


def moved(scan: Float32, *segments: Float32) -> list[bool]:
    ends = np.cumsum([len(each) for each in segments])
    return list(Sight.of(scan).moved(np.concatenate(segments), ends))


def test_directions_by_hand() -> None:
    points = np.array(
        [[2, 0, 0], [0, 3, 0], [0, -1, 0], [0, 0, 5], [0, 0, -5], [1, 0, 1], [0, 0, 0]], np.float32
    )
    columns, rows, distances = directions(points)
    assert columns.tolist()[:3] == [0, 90, 270]
    assert rows.tolist()[:6] == [45, 45, 45, 89, 0, 67]
    assert distances.tolist() == pytest.approx([2, 3, 1, 5, 5, 2**0.5, 0])


def test_segment_that_the_scan_looks_through_has_moved() -> None:
    wall, gone = patch(20, width=12), patch(10)
    assert moved(wall, gone) == [True]
    # It is still there, it is hidden, it is off by less than the margin, or nothing is behind it.
    assert moved(np.concatenate([wall, gone]), gone) == [False]
    assert moved(np.concatenate([wall, patch(5, width=6)]), gone) == [False]
    assert moved(patch(10.4), gone) == [False]
    assert moved(patch(20, width=4, y=30), gone) == [False]


def test_each_segment_is_judged_by_its_own_points() -> None:
    wall, gone, left = patch(20, width=40), patch(10), patch(10, y=8)
    assert moved(np.concatenate([wall, left]), gone, left) == [True, False]
    # More than half of the trail is gone, or less.
    half = patch(10, width=1.2, y=-1.4)
    assert moved(np.concatenate([wall, half]), gone) == [True]
    most = patch(10, width=3, y=-0.5)
    assert moved(np.concatenate([wall, most]), gone) == [False]


def test_a_part_that_is_too_small_decides_nothing() -> None:
    gone = patch(10)
    # The wall covers an eighth of the segment.
    assert moved(patch(20, width=1.0, y=-3.4), gone) == [False]
    assert moved(patch(20, width=12), gone[:9]) == [False]
    assert Sight.of(gone).moved(gone[:0], np.zeros(0, np.int64)).tolist() == []


def test_directions_wrap_around_behind_the_sensor() -> None:
    wall, gone = patch(20, width=12), patch(10)
    assert moved(-wall, -gone) == [True]
    assert moved(np.concatenate([-wall, -gone]), -gone) == [False]


def yard(car_at: float | None) -> Float32:
    """Return a scan of a wall and a post, and of a car of 4 m before the wall."""
    things = [patch(18, width=40, step=0.15), patch(8, width=0.8, y=-12, step=0.05)]
    if car_at is not None:
        things.append(patch(10, width=4.0, y=car_at))
    return np.concatenate(things)


def test_car_that_drives_is_marked_and_what_stands_is_not() -> None:
    segmentation = IncrementalSegmentation(PARAMETERS)
    for scan in range(12):
        segmentation.add(yard(car_at=-6.0 + scan), pose())  # 10 m/s
    live = segmentation.segments()
    y = np.array([live.segments.cloud(index)[:, 1].mean() for index in range(len(live))])
    x = np.array([live.segments.cloud(index)[:, 0].mean() for index in range(len(live))])
    assert live.moved.tolist() == (np.abs(x - 10) < 0.5).tolist()
    assert live.moved.sum() == 1
    assert np.abs(y - -12).min() < 0.1
    car = live.ids[live.moved]
    # It stops: its trail ends, and it stays marked while it keeps its id.
    for _ in range(12):
        segmentation.add(yard(car_at=5.0), pose())
    live = segmentation.segments()
    assert live.ids[live.moved].tolist() == car.tolist()
    # It drives away. Its id ends, and its best view is marked.
    for _ in range(12):
        segmentation.add(yard(car_at=None), pose())
    assert not segmentation.segments().moved.any()
    views = segmentation.take_final_views(at_end=True)
    assert views.ids[views.moved].tolist() == car.tolist()


def test_car_that_is_parked_is_not_marked() -> None:
    segmentation = IncrementalSegmentation(PARAMETERS)
    for _ in range(12):
        segmentation.add(yard(car_at=0.0), pose())
    live = segmentation.segments()
    assert len(live) >= 2
    assert not live.moved.any()
    assert not live.take(np.array([0])).moved.any()


def test_mark_ends_with_a_reset() -> None:
    segmentation = IncrementalSegmentation(PARAMETERS)
    for scan in range(12):
        segmentation.add(yard(car_at=-6.0 + scan), pose())
    assert segmentation.segments().moved.any()
    segmentation.reset()
    for _ in range(12):
        segmentation.add(yard(car_at=5.0), pose())
    assert not segmentation.segments().moved.any()
