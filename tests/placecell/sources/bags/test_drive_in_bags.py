"""A drive in the layout of KITTI, and the same drive in bags."""

import os
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float32, Float64
from placecell.datasets import Drive, SourceDrive, open_drive
from placecell.segmentation.pipeline import record
from placecell.segmentation.recording import Recording
from placecell.sources.catalog import open_source
from placecell.sources.scan_options import ScanOptions, use_scan_options
from tests.placecell.sources.bags.bag_builders import (
    DRIVES,
    LAYOUTS,
    drive_messages,
)

COUNT = 5
RECORDED_SCANS = 12


def scans() -> list[Float32]:
    """Return random scans."""
    random = np.random.default_rng(3)
    return list(random.normal(0, 25, (COUNT, 400, 3)).astype(np.float32))


def poses() -> list[Float64]:
    """Return the sensor's poses."""
    made = np.tile(np.eye(4), (COUNT, 1, 1))
    for number in range(COUNT):
        turn = 0.1 * number
        made[number, :2, :2] = [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]]
        made[number, :3, 3] = (number, 0.05 * number**2, 0)
    return list(made)


def write_kitti(folder: Path, made: list[Float32], ways: list[Float64]) -> Path:
    """Write a drive in the layout of KITTI odometry, with the camera's frame at the sensor."""
    (folder / "velodyne").mkdir(parents=True)
    for number, points in enumerate(made):
        table = np.column_stack((points, np.full(len(points), 0.5, np.float32)))
        (folder / "velodyne" / f"{number:06}.bin").write_bytes(table.astype("<f4").tobytes())
    lines = [" ".join(map(repr, pose[:3].ravel().tolist())) for pose in ways]
    (folder / "poses.txt").write_text("\n".join(lines) + "\n")
    (folder / "calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")
    (folder / "times.txt").write_text("".join(f"{0.1 * n:.6f}\n" for n in range(len(made))))
    return folder


@pytest.mark.parametrize("layout", LAYOUTS)
@pytest.mark.parametrize("name", DRIVES)
def test_drive_in_a_bag_has_the_points_of_the_kitti_layout_bit_for_bit(
    name: str, layout: str, tmp_path: Path
) -> None:
    drive = open_drive(write_kitti(tmp_path / "kitti", scans(), poses()))
    encoding, write = DRIVES[name]
    messages = drive_messages(scans(), poses(), encoding, LAYOUTS[layout])
    source = open_source(write(tmp_path / name, messages))
    assert len(source) == len(drive) == COUNT
    for index in range(COUNT):
        scan = source.scan(index)
        assert scan.points.tobytes() == drive.scan(index).tobytes()
        assert (scan.not_finite, scan.zeros) == (5, 9)
        assert scan.times is not None
    trajectory = source.trajectory()
    assert trajectory is not None
    assert trajectory.frame == "lidar"
    assert_allclose(trajectory.poses, drive.poses, atol=1e-9)
    assert_array_equal(trajectory.stamps, source.stamps)


def drive_in_bag(path: Path, poses_file: Path | None, extrinsic: Path | None) -> SourceDrive:
    """Open a bag as a drive. The layout of KITTI has no times of points, so no scan is deskewed."""
    options = ScanOptions(
        deskew=False,
        poses=poses_file,
        extrinsic=str(extrinsic) if extrinsic else None,
    )
    with use_scan_options(options):
        drive = open_drive(path)
    assert isinstance(drive, SourceDrive)
    return drive


def same_segments(one: Recording, other: Recording) -> None:
    """Check that two recordings have the same segments, bit for bit."""
    assert len(one.segments) > 0
    assert one.segments.points.tobytes() == other.segments.points.tobytes()
    assert_array_equal(one.segments.ends, other.segments.ends)
    assert one.segments.sensors.tobytes() == other.segments.sensors.tobytes()
    assert_array_equal(one.captures, other.captures)
    assert_array_equal(one.groups, other.groups)
    assert_array_equal(one.distinct, other.distinct)


def scene(count: int) -> tuple[list[Float32], list[Float64]]:
    """Return scans of a street with ten boxes, and the poses of a sensor that drives along."""
    random = np.random.default_rng(7)
    parts = []
    for number in range(10):
        corner = (6.0 * number, 7.0 * (-1) ** number, -1.7)
        parts.append(corner + random.random((1200, 3)) * (2.0, 2.0, 3.0))
    ground = random.uniform((-20, -20, -1.75), (80, 20, -1.7), (12_000, 3))
    world = np.concatenate([*parts, ground])
    ways = np.tile(np.eye(4), (count, 1, 1))
    ways[:, 0, 3] = 2.0 * np.arange(count)
    made = []
    for pose in ways:
        near = world[np.linalg.norm(world - pose[:3, 3], axis=1) < 40]
        made.append((near - pose[:3, 3]).astype(np.float32))
    return made, list(ways)


@pytest.mark.slow
def test_drive_in_a_bag_has_the_segments_of_the_kitti_layout_bit_for_bit(tmp_path: Path) -> None:
    count = 12
    made, ways = scene(count)
    kitti = write_kitti(tmp_path / "kitti", made, ways)
    parameters = PROTOCOL_V1.for_drive(count)
    expected = record(open_drive(kitti), parameters)
    messages = drive_messages(made, ways, "ros1", LAYOUTS["big-endian"])
    bag = DRIVES["drive.bag"][1](tmp_path / "drive.bag", messages)
    same_segments(record(drive_in_bag(bag, kitti / "poses.txt", None), parameters), expected)
    # Quaternions of odometry state the same poses to some 1e-16.
    by_odometry = record(drive_in_bag(bag, None, None), parameters)
    assert len(by_odometry.segments) == len(expected.segments)
    assert_allclose(by_odometry.segments.points, expected.segments.points, atol=1e-5)


@pytest.fixture(scope="module")
def city_drive() -> Drive:
    folder = Path(os.environ.get("PLACECELL_DRIVES", "/nowhere"))
    for path in (folder / "city_drive", folder / "sequences" / "city_drive"):
        if path.is_dir():
            return open_drive(path)
    pytest.skip("PLACECELL_DRIVES names no folder with city_drive")


class FirstScans(Drive):
    """The first scans of a drive."""

    def __init__(self, drive: Drive, count: int) -> None:
        self.folder = drive.folder
        self.drive = drive
        self.poses = drive.poses[:count]
        self.times = drive.times[:count]
        self.origin = drive.origin
        self.scan_files = list(drive.scan_files[:count])

    @classmethod
    def recognizes(cls, folder: Path) -> bool:
        return False

    def scan(self, index: int) -> Float32:
        return self.drive.scan(index)


@pytest.mark.recorded
@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "layout"),
    [
        ("drive.bag", "padded"),
        ("drive_sqlite", "big-endian"),
        ("drive_mcap_split_zstd", "padded"),
    ],
)
def test_city_drive_in_a_bag_has_the_segments_of_the_kitti_layout(
    name: str, layout: str, city_drive: Drive, tmp_path: Path
) -> None:
    """The poses are those of KITTI's file, with its calibration, so they have the same bits."""
    part = FirstScans(city_drive, RECORDED_SCANS)
    parameters = PROTOCOL_V1.for_drive(RECORDED_SCANS)
    scans_of = [part.scan(index) for index in range(RECORDED_SCANS)]
    encoding, write = DRIVES[name]
    messages = drive_messages(scans_of, list(part.poses), encoding, LAYOUTS[layout])
    bag = write(tmp_path / name, messages)
    lines = (city_drive.folder / "poses.txt").read_text().splitlines()[:RECORDED_SCANS]
    (tmp_path / "poses.txt").write_text("\n".join(lines) + "\n")
    drive = drive_in_bag(bag, tmp_path / "poses.txt", city_drive.folder / "calib.txt")
    assert_array_equal(drive.poses, part.poses)
    same_segments(record(drive, parameters), record(part, parameters))
