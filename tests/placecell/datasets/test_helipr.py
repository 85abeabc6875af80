"""HeLiPR: four sensors, each with its own packed points and its own poses."""

from pathlib import Path

import numpy as np
import pytest

from placecell.datasets import DriveError, HeLiPR, ScanOptions, open_drive, use_scan_options
from placecell.datasets.helipr import LAST_EARLY_AEVA, RECORDS, TIME_FIELDS
from tests.placecell.datasets.dataset_builders import SCAN_NS, write_helipr
from tests.placecell.segment_builders import pose

SCAN = np.array([[5.0, 1.0, -1.0], [0.0, 8.0, 0.5], [np.nan, 1.0, 1.0]])
POSES = [pose(1_000.0, 2_000.0, 30.0, 0.5), pose(1_001.0, 2_000.5, 30.0, 0.6)]

BYTES = {"Ouster": 26, "Velodyne": 22, "Avia": 19, "Aeva": 29}
"""Bytes of a point, as the data set's own tools read them."""


@pytest.mark.parametrize("sensor", BYTES)
def test_each_sensor_is_recognized_and_read(tmp_path: Path, sensor: str) -> None:
    folder = write_helipr(tmp_path / "Town01", sensor, [SCAN] * 2, POSES)
    assert next(folder.glob("*.bin")).stat().st_size == 3 * BYTES[sensor]
    drive = open_drive(folder)
    assert isinstance(drive, HeLiPR)
    np.testing.assert_allclose(drive.scan(0), SCAN[:2])
    assert drive.dropouts.dropped == {0: 1}
    np.testing.assert_allclose(drive.times, [0.0, 0.1])
    np.testing.assert_allclose(drive.origin, [1_000.0, 2_000.0, 30.0])
    assert drive.georeferenced
    assert drive.title == f"Town01-{sensor}"
    from_first = np.stack(POSES)
    from_first[:, :3, 3] -= drive.origin
    np.testing.assert_allclose(drive.poses, from_first, atol=1e-6)


def test_early_scans_of_the_aeva_have_no_intensity(tmp_path: Path) -> None:
    first = LAST_EARLY_AEVA - SCAN_NS // 2
    folder = write_helipr(tmp_path / "Town01", "Aeva", [SCAN] * 2, POSES, first_ns=first)
    early, late = sorted(folder.glob("*.bin"))
    assert (early.stat().st_size, late.stat().st_size) == (3 * 25, 3 * 29)
    drive = open_drive(folder)
    for index in range(2):
        np.testing.assert_allclose(drive.scan(index), SCAN[:2])


def test_poses_of_the_sequence_alone_are_not_georeferenced(tmp_path: Path) -> None:
    truth = "{}_gt.txt"
    folder = write_helipr(tmp_path / "Town01", "Ouster", [SCAN] * 2, POSES, truth=truth)
    assert not open_drive(folder).georeferenced


def test_scans_without_a_pose_are_left_out_and_told(tmp_path: Path) -> None:
    folder = write_helipr(tmp_path / "Town01", "Avia", [SCAN] * 2, POSES)
    (folder / f"{LAST_EARLY_AEVA + 5}.bin").write_bytes(b"")
    said: list[str] = []
    with use_scan_options(ScanOptions(tell=said.append)):
        assert len(open_drive(folder)) == 2
    assert any("1 of 3 scans have no pose in global_Avia_gt.txt" in line for line in said)


def test_scan_of_another_sensor_is_refused(tmp_path: Path) -> None:
    folder = write_helipr(tmp_path / "Town01", "Avia", [SCAN] * 2, POSES)
    for file in folder.glob("*.bin"):
        file.write_bytes(b"\0" * 26)
    with pytest.raises(DriveError, match="2 of 2 scans skipped"):
        open_drive(folder)


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("1 2 3", "t x y z qx qy qz qw"),
        ("1 0 0 0 0 0 0 1", "no scan of"),
        (f"{LAST_EARLY_AEVA + SCAN_NS} 0 0 0 0 0 0 0.5", "no length of 1"),
    ],
)
def test_unusable_poses_are_refused(tmp_path: Path, line: str, said: str) -> None:
    folder = write_helipr(tmp_path / "Town01", "Ouster", [SCAN] * 2, POSES)
    (tmp_path / "Town01" / "LiDAR_GT" / "global_Ouster_gt.txt").write_text(line + "\n")
    with pytest.raises(DriveError, match=r"global_Ouster_gt\.txt") as caught:
        open_drive(folder)
    assert said in str(caught.value)


def test_missing_poses_are_named(tmp_path: Path) -> None:
    folder = write_helipr(tmp_path / "Town01", "Ouster", [SCAN] * 2, POSES)
    (tmp_path / "Town01" / "LiDAR_GT" / "global_Ouster_gt.txt").unlink()
    with pytest.raises(DriveError, match=r"Ouster_gt\.txt: missing"):
        open_drive(folder)


def test_other_folder_beside_the_sensors_is_refused(tmp_path: Path) -> None:
    write_helipr(tmp_path / "Town01", "Ouster", [SCAN] * 2, POSES)
    (tmp_path / "Town01" / "LiDAR" / "Pandar").mkdir()
    with pytest.raises(DriveError, match="Expected a folder Ouster, Velodyne, Avia, Aeva"):
        open_drive(tmp_path / "Town01" / "LiDAR" / "Pandar")


@pytest.mark.parametrize("sensor", BYTES)
def test_points_are_moved_to_the_time_of_their_scan(tmp_path: Path, sensor: str) -> None:
    poses = [pose(float(step), 0.0, 0.0, 0.0) for step in range(3)]  # 1 m a scan: 10 m/s
    scan = np.tile([[5.0, 1.0, -1.0]], (11, 1))
    folder = write_helipr(tmp_path / "Town01", sensor, [scan] * 3, poses)
    seconds = np.linspace(0, 0.1, 11)
    for file in sorted(folder.glob("*.bin")):
        records = np.fromfile(file, RECORDS[sensor])
        records[TIME_FIELDS[sensor]] = seconds if sensor == "Velodyne" else seconds * 1e9
        records.tofile(file)
    said: list[str] = []
    with use_scan_options(ScanOptions(tell=said.append)):
        moved = open_drive(folder).scan(1)
    np.testing.assert_allclose(moved - scan, np.outer(10 * seconds, [1, 0, 0]), atol=1e-4)
    assert any("points have times" in line and "deskewed by the poses" in line for line in said)
    with use_scan_options(ScanOptions(deskew=False)):
        np.testing.assert_allclose(open_drive(folder).scan(1), scan)
