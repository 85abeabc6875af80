import hashlib
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.types import Float32, Float64
from placecell.datasets import Drive, open_drive
from placecell.descriptors.orientation import orient
from placecell.descriptors.voxels import voxelize
from placecell.segmentation.local_map import transform
from placecell.segmentation.pipeline import packed_grids, record, segment_captures, segment_map
from placecell.segmentation.recording import Recording
from tests.placecell.segment_builders import (
    MemoryDrive,
    many_segments,
    one_segment,
    plane,
    pose,
    write_odometry,
)

SENSOR_HEIGHT = 1.7
BOXES = [((6.0, 5.0), (2.0, 1.6)), ((14.0, -6.0), (1.5, 2.5)), ((22.0, 6.0), (3.0, 1.2))]
STANDS = range(5, 9)
"""Scans at which the sensor does not move; it moves 0.8 m at the others."""
EVERY_SCAN = PROTOCOL_V1.for_drive(14)


def seen_faces(sensor: Float64) -> Float32:
    """Return points on the sides of the boxes that face the sensor, 2 m high, world frame."""
    heights = np.arange(0.05, 2.0, 0.1)
    faces = []
    for (x, y), (a, b) in BOXES:
        for axis, half, other in ((0, a / 2, b / 2), (1, b / 2, a / 2)):
            for side in (-1, 1):
                if side * (sensor[axis] - (x, y)[axis]) <= half:
                    continue
                along, z = np.meshgrid(np.arange(-other, other + 0.01, 0.1), heights)
                face = np.empty((along.size, 3))
                face[:, axis] = (x, y)[axis] + side * half
                face[:, 1 - axis] = (x, y)[1 - axis] + along.ravel()
                face[:, 2] = z.ravel()
                faces.append(face)
    return np.concatenate(faces).astype(np.float32)


def street() -> tuple[list[Float32], list[Float64]]:
    """Return scans in the sensor frame and poses; the world is the first sensor frame."""
    ground = plane(30, step=0.4)
    scans, poses, x = [], [], 0.0
    for index in range(14):
        x += 0.0 if index in STANDS else 0.8
        at = pose(x - 0.8, 0, 0, yaw=0.0 if index == 0 else 0.02)
        world = np.concatenate([ground, seen_faces(at[:3, 3])]) - np.array(
            [0, 0, SENSOR_HEIGHT], np.float32
        )
        scans.append(transform(np.linalg.inv(at).astype(np.float64), world))
        poses.append(at)
    return scans, poses


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return open_drive(write_odometry(tmp_path_factory.mktemp("drive") / "street", *street()))


@pytest.fixture(scope="module")
def recording(drive: Drive) -> Recording:
    return record(drive, EVERY_SCAN)


@pytest.mark.slow
def test_boxes_are_the_segments_of_every_capture(recording: Recording) -> None:
    captures, counts = np.unique(recording.captures, return_counts=True)
    assert captures.tolist() == list(range(14))
    assert counts.tolist() == [len(BOXES)] * 14


def test_segments_lie_where_the_boxes_stand(recording: Recording) -> None:
    lowest, highest = recording.segments.bounds()
    for (x, y), (a, b) in BOXES:
        box_low, box_high = np.array([x - a / 2, y - b / 2]), np.array([x + a / 2, y + b / 2])
        mine = ((lowest[:, :2] > box_low - 0.1) & (highest[:, :2] < box_high + 0.1)).all(axis=1)
        assert mine.sum() == 14
        # The lowest 0.3 m went with the ground; the top is 2 m above it.
        assert lowest[mine, 2] == pytest.approx(0.35 - SENSOR_HEIGHT, abs=0.11)
        assert highest[mine, 2] == pytest.approx(1.95 - SENSOR_HEIGHT, abs=0.06)


def test_groups_persist_over_all_captures(recording: Recording) -> None:
    assert set(recording.groups.tolist()) == {0, 1, 2}
    centroids = recording.segments.centroids()
    for group in range(3):
        members = recording.groups == group
        assert recording.captures[members].tolist() == list(range(14))
        assert np.ptp(centroids[members], axis=0).max() < 1.5


@pytest.mark.slow
def test_group_ends_when_its_box_is_gone(tmp_path: Path) -> None:
    # From one place; the nearest box, the first of each frame, is missing from scans 2 and 3.
    ground = plane(30, step=0.4)
    boxes = seen_faces(np.zeros(3))
    without = boxes[boxes[:, 0] > 8]
    scans = [
        np.concatenate([ground, without if index in (2, 3) else boxes]) - [0, 0, SENSOR_HEIGHT]
        for index in range(5)
    ]
    drive = open_drive(write_odometry(tmp_path / "yard", scans, [pose()] * 5))
    recording = record(drive, replace(EVERY_SCAN, accumulated_scans=1))
    groups = [recording.groups[recording.captures == frame].tolist() for frame in range(5)]
    assert groups == [[0, 1, 2], [0, 1, 2], [1, 2], [1, 2], [3, 1, 2]]
    # The box that came back is no duplicate of the one before: it is in another group.
    distinct = [recording.distinct[recording.captures == frame].tolist() for frame in range(5)]
    assert distinct == [[True] * 3, [False] * 3, [False] * 2, [False] * 2, [True, False, False]]


def test_standing_still_gives_duplicates(recording: Recording) -> None:
    # Nothing new is seen; scans as old as 9 frames are not yet forgotten.
    assert not recording.distinct[np.isin(recording.captures, list(STANDS))].any()
    assert recording.distinct[recording.captures == 0].all()
    assert recording.distinct.sum() > 3


def test_duplicates_against_slow_reference(recording: Recording) -> None:
    grids = voxelize(recording.segments, PROTOCOL_V1)[0].astype(bool)
    kept: list[int] = []
    for index, group in enumerate(recording.groups):
        others = [other for other in kept if recording.groups[other] == group]
        if all((grids[other] != grids[index]).sum() >= 50 for other in others):
            kept.append(index)
    assert np.flatnonzero(recording.distinct).tolist() == kept


def test_sensors_are_where_the_drive_was(recording: Recording, drive: Drive) -> None:
    assert recording.segments.sensors == pytest.approx(drive.poses[recording.captures, :3, 3])


def test_recording_has_name_and_hashes(recording: Recording, drive: Drive) -> None:
    assert recording.name == "street"
    assert recording.parameters == EVERY_SCAN
    assert recording.scans == 14
    assert recording.path_length == pytest.approx(9 * 0.8, abs=1e-4)
    assert recording.scan_hashes == tuple(
        hashlib.sha256(file.read_bytes()).hexdigest()[:16] for file in drive.scan_files
    )


def test_recording_survives_its_file(recording: Recording, tmp_path: Path) -> None:
    recording.save(tmp_path / "street")
    loaded = Recording.load(tmp_path / "street")
    assert np.array_equal(loaded.segments.points, recording.segments.points)
    assert np.array_equal(loaded.distinct, recording.distinct)


@pytest.mark.slow
def test_recording_twice_gives_equal_recordings(recording: Recording, drive: Drive) -> None:
    again = record(drive, EVERY_SCAN)
    assert np.array_equal(again.segments.points, recording.segments.points)
    assert np.array_equal(again.groups, recording.groups)


@pytest.mark.slow
def test_every_second_scan(drive: Drive) -> None:
    captures = [frame for frame, _ in segment_captures(drive, replace(PROTOCOL_V1, frame_step=2))]
    assert captures == [0, 2, 4, 6, 8, 10, 12]


@pytest.mark.slow
def test_no_scan_outside_the_range_given_feeds_it() -> None:
    scans, poses = street()
    nonsense = (np.random.default_rng(0).normal(size=(5000, 3)) * [5, 5, 1]).astype(np.float32)
    ruined = [scan if 3 <= index < 8 else nonsense for index, scan in enumerate(scans)]
    pairs = [
        list(segment_captures(MemoryDrive(some, poses), EVERY_SCAN, range(3, 8)))
        for some in (scans, ruined)
    ]
    assert [frame for frame, _ in pairs[0]] == [3, 4, 5, 6, 7]
    for (_, one), (_, other) in zip(*pairs, strict=True):
        assert len(one) == len(BOXES)
        assert np.array_equal(one.points, other.points)


def test_progress_is_shown_for_every_capture(drive: Drive) -> None:
    told: list[tuple[int, str]] = []

    def progress(items: Iterable[int], total: int, what: str) -> Iterable[int]:
        told.append((total, what))
        return items

    assert len(list(segment_captures(drive, EVERY_SCAN, range(2, 5), progress))) == 3
    assert told == [(3, "segments of street")]


def test_drive_through_nothing_has_no_segments(tmp_path: Path) -> None:
    # One scan too near, one of ground alone, one too far away.
    scans: list[object] = [[[1, 0, 0]], plane(10) - np.array([0, 0, 1.7], np.float32), [[0, 70, 0]]]
    folder = write_odometry(tmp_path / "nothing", scans, [pose()] * 3)
    nothing = record(open_drive(folder), EVERY_SCAN)
    assert len(nothing.segments) == len(nothing.captures) == len(nothing.groups) == 0
    assert nothing.distinct.shape == (0,)


def test_segments_of_an_empty_map() -> None:
    assert segment_map(np.zeros((0, 3), np.float32), PROTOCOL_V1) == []


@pytest.mark.parametrize("batch", [1, 3, 7, 1000])
def test_packed_grids_in_batches(batch: int) -> None:
    segments = many_segments([50] * 7)
    grids = voxelize(segments, PROTOCOL_V1)[0].reshape(7, -1)
    packed = packed_grids(segments, PROTOCOL_V1, batch)
    assert packed.shape == (7, 38 * 38 * 18 // 8)
    assert np.array_equal(np.unpackbits(packed, axis=1, count=grids.shape[1]), grids)


def golden_segment() -> Float32:
    """Return two walls at a corner from integers; 56 of the points are outside the grid."""
    rows = [(i * 7 % 97 / 11, 0.031 * (i % 5), i * 11 % 89 / 23) for i in range(120)]
    rows += [(0.017 * (i % 3), i * 5 % 83 / 19, i * 13 % 71 / 53) for i in range(80)]
    rows += [(0.5, 0.7, -0.037)]
    return np.array(rows, dtype=np.float32) + np.array([12, -7, -1], np.float32)


def test_golden_input_of_the_network() -> None:
    """The network's input never changes without a new preprocessing version.

    If this fails, every model that exists sees another input than it was trained on: change
    PREPROCESSING_VERSIONS with it, or undo what made it fail.
    """
    segment = one_segment(golden_segment(), sensor=(3.0, 4.0, 0.5))

    # No point is so near a voxel's border that rounding on another machine would move it.
    aligned = orient(segment).astype(np.float64)
    middle = (aligned.min(axis=0) + aligned.max(axis=0)) / 2
    cells = (aligned - middle) / 0.2
    assert 0.2 * np.abs(cells - np.rint(cells)).min() > 1e-5

    occupancy, extents = voxelize(segment, PROTOCOL_V1)
    assert occupancy.sum() == 122
    assert hashlib.sha256(np.packbits(occupancy).tobytes()).hexdigest() == (
        "a4174e43260ffcfeac7701a568683b5284e32a5e6dbaffe30610c83f873954c2"
    )
    assert extents[0] == pytest.approx([9.343003, 5.831216, 3.863087], abs=1e-5)

    halves = cells * 2
    assert 0.1 * np.abs(halves - np.rint(halves)).min() > 1e-6
    halved, _ = voxelize(segment, Parameters(voxel_parts=2))
    assert halved.sum() == 135
    assert hashlib.sha256(halved.tobytes()).hexdigest() == (
        "79260794ea54ab18bc86aebb98e949a0636ae89e1405b18e6dfd3c13ae708119"
    )
