"""Incremental segmentation gives the segments of the batch pipeline, with ids that persist."""

from collections.abc import Sequence
from typing import cast

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.types import Float32, Float64
from placecell.segmentation.incremental import IncrementalSegmentation, LiveSegments
from placecell.segmentation.pipeline import segment_captures
from tests.placecell.segment_builders import MemoryDrive, box, plane, pose

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
    world = np.concatenate([plane(25), *things])
    return cast(Float32, (world - np.array([offset, 0, 1.7])).astype(np.float32))


def check_equal_to_batch(scans: Sequence[Float32], poses: Sequence[Float64]) -> None:
    drive = MemoryDrive(scans, poses)
    batch = list(segment_captures(drive, EVERY_SCAN))
    for (_, expected), live in zip(batch, live_segments(scans, poses), strict=True):
        assert np.array_equal(live.segments.points, expected.points)
        assert np.array_equal(live.segments.ends, expected.ends)
        assert np.array_equal(live.segments.sensors, expected.sensors)


def test_segments_equal_those_of_the_batch_pipeline() -> None:
    steps = np.arange(14) * 0.6
    check_equal_to_batch([yard(step) for step in steps], [pose(step) for step in steps])


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
