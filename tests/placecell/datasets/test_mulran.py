"""MulRan: poses of the vehicle at 100 Hz become poses of the sensor at each scan."""

from pathlib import Path

import numpy as np
import pytest

from placecell.datasets import DriveError, MulRan, ScanOptions, open_drive, use_scan_options
from placecell.datasets.mulran import base_to_ouster
from tests.placecell.datasets.dataset_builders import POSE_NS, START_NS, write_mulran
from tests.placecell.segment_builders import pose

UTM = (353_100.5, 4_026_030.25, 21.0)
"""Position of the first scan, UTM zone 52."""

SCAN = np.array([[5.0, 1.0, -1.0], [0.0, 8.0, 0.5]])


def poses(count: int = 3) -> list[np.ndarray]:
    return [pose(UTM[0] + 2 * step, UTM[1] + step, UTM[2], 0.4) for step in range(count)]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_mulran(tmp_path / "KAIST01", [SCAN] * 3, poses())


def refused(folder: Path) -> str:
    with pytest.raises(DriveError) as caught:
        open_drive(folder)
    return str(caught.value)


def test_drive_is_recognized_and_read(folder: Path) -> None:
    drive = open_drive(folder)
    assert isinstance(drive, MulRan)
    assert len(drive) == 3
    np.testing.assert_allclose(drive.scan(0), SCAN)  # Without the beams that have no echo.
    np.testing.assert_allclose(drive.times, [0, 0.1, 0.2], atol=1e-6)


def test_poses_are_the_sensors_in_utm_from_the_first_scan(folder: Path) -> None:
    drive = open_drive(folder)
    assert drive.georeferenced
    np.testing.assert_allclose(drive.origin, UTM, atol=1e-5)
    from_first = np.stack(poses())
    from_first[:, :3, 3] -= UTM
    np.testing.assert_allclose(drive.poses, from_first, atol=1e-5)


def test_sensor_looks_backward_on_the_vehicle() -> None:
    """The Ouster's x axis points to the rear: its yaw is 179.67 degrees."""
    np.testing.assert_allclose(base_to_ouster()[:3, 0], [-1, 0.006, 0], atol=1e-3)
    np.testing.assert_allclose(base_to_ouster()[:3, 3], [1.7042, -0.021, 1.8047])


def test_scans_without_a_pose_are_left_out_and_told(folder: Path) -> None:
    lines = (folder / "global_pose.csv").read_text().splitlines()
    (folder / "global_pose.csv").write_text("\n".join(lines[:4]) + "\n")
    said: list[str] = []
    with use_scan_options(ScanOptions(tell=said.append)):
        drive = open_drive(folder)
    assert len(drive) == 2
    assert any("1 of 3 scans have no pose in global_pose.csv" in line for line in said)


def test_scan_in_a_gap_of_the_poses_is_left_out(folder: Path) -> None:
    """Between poses far apart in time, interpolation would invent a pose."""
    lines = (folder / "global_pose.csv").read_text().splitlines()
    kept = [lines[0], lines[1], lines[5]]
    moved = lines[4].replace(str(START_NS + 200_000_000), str(START_NS + 230_000_000), 1)
    (folder / "global_pose.csv").write_text("\n".join([*kept[:2], moved]) + "\n")
    assert len(open_drive(folder)) == 1


def test_poses_of_another_sequence_are_refused(folder: Path) -> None:
    lines = (folder / "global_pose.csv").read_text().replace(str(START_NS)[:6], "171000")
    (folder / "global_pose.csv").write_text(lines)
    assert "no scan of" in refused(folder)
    assert "another sequence" in refused(folder)


@pytest.mark.parametrize("content", ["", "1,2,3\n", "a,b\n", ",".join(["1"] * 12 + ["nan"]) + "\n"])
def test_unreadable_poses_are_refused(folder: Path, content: str) -> None:
    (folder / "global_pose.csv").write_text(content)
    assert "global_pose.csv" in refused(folder)
    assert "13 numbers" in refused(folder)


def test_scan_that_is_cut_short_is_skipped(folder: Path) -> None:
    file = folder / "Ouster" / f"{START_NS + POSE_NS // 2}.bin"
    file.write_bytes(file.read_bytes()[:-3])
    drive = open_drive(folder)
    assert list(drive.dropouts.skipped) == [0]
