"""Incremental segmentation gives the segments of the batch pipeline, with ids that persist."""

import os
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import cast

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64
from placecell.datasets import open_drive
from placecell.segmentation.incremental import IncrementalSegmentation, LiveSegments
from placecell.segmentation.local_map import in_range, transform, voxel_means
from placecell.segmentation.pipeline import segment_captures, segment_map
from tests.placecell.segment_builders import MemoryDrive, box, plane, pose
from town import two_robots

EVERY_SCAN = PROTOCOL_V1.for_drive(14)


def live_segments(
    scans: Sequence[Float32], poses: Sequence[Float64], parameters: Parameters = EVERY_SCAN
) -> list[LiveSegments]:
    """Return the live segments after each scan."""
    segmentation = IncrementalSegmentation(parameters)
    found = []
    for points, at in zip(scans, poses, strict=True):
        segmentation.add(points, at)
        found.append(segmentation.segments())
    return found


def yard(offset: float = 0.0) -> Float32:
    """Return the scan of a yard with two boxes, from `offset` meters along x, sensor frame."""
    things = [box((8, 5, 0), (2, 1, 2)), box((12, -5, 0), (1, 3, 2))]
    world = np.concatenate([plane(15, step=0.4), *things])
    return cast(Float32, (world - np.array([offset, 0, 1.7])).astype(np.float32))


def rebuilt_segments(
    scans: Sequence[Float32], poses: Sequence[Float64], parameters: Parameters = EVERY_SCAN
) -> list[Segments]:
    """Return the segments after each scan, from local maps that are built anew."""
    found = []
    for last in range(len(scans)):
        window = range(max(0, last + 1 - parameters.accumulated_scans), last + 1)
        points = np.concatenate(
            [transform(poses[each], in_range(scans[each], parameters)) for each in window]
        )
        sensor = poses[last][:3, 3]
        offset = points[:, :2] - sensor[:2].astype(np.float32)
        near = (offset**2).sum(axis=1) <= parameters.local_map_radius**2
        clouds = segment_map(voxel_means(points[near], parameters.map_voxel), parameters)
        found.append(Segments.of(clouds, np.tile(sensor, (len(clouds), 1))))
    return found


def check_segments(lives: Sequence[LiveSegments], expected: Sequence[Segments]) -> None:
    """Check that the segments are equal, bit for bit."""
    for live, each in zip(lives, expected, strict=True):
        assert live.segments.points.tobytes() == each.points.tobytes()
        assert live.segments.ends.tolist() == each.ends.tolist()
        assert live.segments.sensors.tobytes() == each.sensors.tobytes()


@pytest.mark.slow
def test_segments_equal_those_of_local_maps_built_anew() -> None:
    steps = np.arange(14) * 0.6
    scans, poses = [yard(step) for step in steps], [pose(step) for step in steps]
    lives = live_segments(scans, poses)
    check_segments(lives, rebuilt_segments(scans, poses))
    batch = segment_captures(MemoryDrive(scans, poses), EVERY_SCAN)
    check_segments(lives, [segments for _, segments in batch])


@pytest.mark.slow
def test_segments_of_a_town_drive_equal_those_of_local_maps_built_anew(tmp_path: Path) -> None:
    folder, _ = two_robots(tmp_path, seed=3, scans=12, columns=400)
    drive = open_drive(folder)
    scans = [drive.scan(index) for index in range(len(drive))]
    lives = live_segments(scans, list(drive.poses))
    assert sum(len(live) for live in lives) > 50
    check_segments(lives, rebuilt_segments(scans, list(drive.poses)))


@pytest.mark.recorded
@pytest.mark.slow
@pytest.mark.parametrize("name", ["city_drive", "muehlburger_tor", "campus_57", "seosan01"])
def test_segments_of_recorded_drives_equal_those_of_local_maps_built_anew(name: str) -> None:
    folder = Path(os.environ.get("PLACECELL_DRIVES", "missing")) / "sequences" / name
    if not folder.is_dir():
        pytest.skip(f"no recorded drives: PLACECELL_DRIVES holds no sequences/{name}")
    drive = open_drive(folder)
    scans = [drive.scan(index) for index in range(min(14, len(drive)))]
    poses = list(drive.poses[: len(scans)])
    lives = live_segments(scans, poses)
    assert sum(len(live) for live in lives) > 50
    check_segments(lives, rebuilt_segments(scans, poses))


def test_calls_in_between_change_nothing() -> None:
    steps = np.arange(12) * 0.6
    each = live_segments([yard(step) for step in steps], [pose(step) for step in steps])
    segmentation = IncrementalSegmentation(EVERY_SCAN)
    for step in steps:
        segmentation.add(yard(step), pose(step))
    live = segmentation.segments()
    assert live.segments.points.tobytes() == each[-1].segments.points.tobytes()
    assert segmentation.segments().ids.tolist() == live.ids.tolist()


def test_ids_persist_while_the_robot_drives() -> None:
    steps = np.arange(14) * 0.6
    found = live_segments([yard(step) for step in steps], [pose(step) for step in steps])
    assert {tuple(live.ids.tolist()) for live in found} == {(0, 1)}


def test_no_scan_gives_no_segments() -> None:
    assert len(IncrementalSegmentation().segments()) == 0


@pytest.mark.parametrize("points", [0, 1])
def test_nearly_empty_scans_give_no_segments(points: int) -> None:
    scan = np.full((points, 3), 5.0, dtype=np.float32)
    assert [len(live) for live in live_segments([scan] * 3, [pose()] * 3)] == [0, 0, 0]


def test_segment_is_complete_once_it_no_longer_grows() -> None:
    found = live_segments([yard()] * 14, [pose()] * 14)
    assert [live.complete.tolist() for live in found] == [[False] * 2] * 10 + [[True] * 2] * 4


def test_final_views_are_returned_once() -> None:
    segmentation = IncrementalSegmentation(EVERY_SCAN)
    taken = []
    for _ in range(14):
        segmentation.add(yard(), pose())
        segmentation.segments()
        taken.append(segmentation.take_final_views())
    assert [view.ids.tolist() for view in taken] == [[]] * 10 + [[0, 1]] + [[]] * 3
    assert taken[10].complete.all()
    assert taken[10].scans.tolist() == [0, 0]


def test_reset_forgets_the_scans_and_no_id_is_used_again() -> None:
    segmentation = IncrementalSegmentation(EVERY_SCAN)
    segmentation.add(yard(), pose())
    assert segmentation.segments().ids.tolist() == [0, 1]
    segmentation.reset()
    assert len(segmentation.segments()) == 0
    segmentation.add(yard(), pose())
    assert segmentation.segments().ids.tolist() == [2, 3]


def wall(first: float, last: float) -> Float32:
    """Return a wall 8 m ahead, 2 m high, that extends along y."""
    y, z = np.meshgrid(np.arange(first + 0.05, last, 0.1), np.arange(-1.15, 0.8, 0.1))
    return np.column_stack([np.full(y.size, 8.05), y.ravel(), z.ravel()]).astype(np.float32)


def in_one_scan(*views: Float32) -> list[LiveSegments]:
    """Return the live segments of successive views, each from one scan, above flat ground."""
    ground = plane(12, step=0.4) - np.array([0, 0, 1.7], np.float32)
    scans = [np.concatenate([ground, view]) for view in views]
    return live_segments(scans, [pose()] * len(views), replace(EVERY_SCAN, accumulated_scans=1))


def test_larger_part_passes_its_id_on_when_segments_merge_and_split() -> None:
    short, long = wall(-2, 0), wall(0.6, 4)
    both = wall(-2, 4)
    found = in_one_scan(np.concatenate([short, long]), both, np.concatenate([short, long]))
    assert [live.ids.tolist() for live in found] == [[0, 1], [1], [2, 1]]


def test_growing_segment_keeps_its_id() -> None:
    found = in_one_scan(*[wall(-1, end) for end in (0.0, 1.0, 2.5, 4.0)])
    assert [live.ids.tolist() for live in found] == [[0]] * 4
    assert [len(live.segments.points) for live in found] == [200, 400, 700, 1000]


def test_segment_that_is_too_small_for_a_moment_keeps_its_id() -> None:
    found = in_one_scan(wall(0, 0.8), wall(0, 0.4), wall(0, 0.8))
    assert [live.ids.tolist() for live in found] == [[0], [], [0]]


def test_segment_at_the_border_is_never_complete() -> None:
    parameters = replace(EVERY_SCAN, local_map_radius=8.6)
    found = live_segments([yard()] * 14, [pose()] * 14, parameters)
    assert [len(live) for live in found] == [1] * 14
    assert not any(live.complete.any() for live in found)


def test_best_view_of_a_segment_that_disappears_is_final() -> None:
    segmentation = IncrementalSegmentation(replace(EVERY_SCAN, accumulated_scans=1))
    lives, views = [], []
    for things in (wall(0, 2), wall(0, 4), wall(0, 1), wall(0, 0.05), wall(0, 0.05)):
        segmentation.add(things, pose())
        lives.append(segmentation.segments())
        views.append(segmentation.take_final_views())
    # With one scan in the local map, the view is complete one scan later.
    assert [view.ids.tolist() for view in views] == [[], [], [0], [], []]
    assert views[2].segments.points.tobytes() == lives[1].segments.points.tobytes()
    assert views[2].scans.tolist() == [1]


def test_every_view_is_final_at_the_end() -> None:
    segmentation = IncrementalSegmentation(EVERY_SCAN)
    segmentation.add(yard(), pose())
    segmentation.segments()
    assert len(segmentation.take_final_views()) == 0
    views = segmentation.take_final_views(at_end=True)
    assert views.ids.tolist() == [0, 1]
    assert not views.complete.any()
    assert len(segmentation.take_final_views(at_end=True)) == 0


def test_pose_jump_gives_new_ids_and_no_mixed_map() -> None:
    segmentation = IncrementalSegmentation(EVERY_SCAN)
    segmentation.add(yard(), pose())
    first = segmentation.segments()
    segmentation.add(yard(), pose(5e6, -2e6, 300))
    second = segmentation.segments()
    assert second.ids.tolist() == [2, 3]
    assert second.segments.counts.tolist() == first.segments.counts.tolist()


def test_coordinates_of_a_million_meters_give_the_same_segments() -> None:
    at = np.array([1e6, -5.3e6, 40.0])
    near, far = (
        live_segments(
            [yard(step) for step in (0, 0.5, 1)],
            [pose(*(start + [step, 0, 0])) for step in (0, 0.5, 1)],
        )
        for start in (np.zeros(3), at)
    )
    for one, other in zip(near, far, strict=True):
        assert other.segments.counts.tolist() == one.segments.counts.tolist()
        # float32 has a resolution of 0.5 m there.
        assert other.segments.points == pytest.approx(one.segments.points + at, abs=0.5)


@pytest.mark.parametrize("bad", [np.eye(3), np.full((4, 4), np.nan)])
def test_invalid_pose_is_refused(bad: Float64) -> None:
    with pytest.raises(ValueError, match=r"^Invalid pose of shape .*: expected a finite 4 x 4 mat"):
        IncrementalSegmentation().add(yard(), bad)


@pytest.mark.slow
def test_memory_is_flat_over_a_long_drive() -> None:
    parameters = replace(EVERY_SCAN, accumulated_scans=3, local_map_radius=10.0)
    segmentation = IncrementalSegmentation(parameters)
    scans = [yard(step) for step in np.arange(0, 20, 1.0)]
    sizes, waiting = set[int](), 0
    for turn in range(12):
        for step, scan in enumerate(scans):
            segmentation.add(scan, pose(step))
            segmentation.segments()
        waiting = len(segmentation.take_final_views()) if turn % 5 == 0 else waiting
        if turn > 2:
            sizes.add(segmentation.nbytes)
    assert len(sizes) == 1
    assert waiting <= 1000
