import shutil
from pathlib import Path

import numpy as np
import pytest

from placecell.datasets import DriveError, KittiOdometry, ScanOptions, open_drive, use_scan_options
from tests.placecell.segment_builders import KITTI_TR, pose, write_odometry, write_scan

# Straight ahead, then a bend to the left, uphill.
POSES = [pose(), pose(1.0), pose(2.0, 0.1, 0.05, 0.1), pose(2.9, 0.4, 0.1, 0.4)]
SCANS = [[[5, index, 0], [6, index, 1]] for index in range(4)]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return write_odometry(tmp_path / "sequences" / "00", SCANS, POSES)


def refused(folder: Path, file: str, path: Path | None = None) -> str:
    with pytest.raises(DriveError) as caught:
        open_drive(path or folder)
    assert str(folder / file) in str(caught.value)
    return str(caught.value)


def replace_line(file: Path, number: int, line: str | None) -> None:
    """Replace a line; None removes it."""
    lines = file.read_text().splitlines()
    lines[number : number + 1] = [] if line is None else [line]
    file.write_text("\n".join(lines) + "\n")


def test_drive_is_recognized_and_read(folder: Path) -> None:
    drive = open_drive(folder)
    assert isinstance(drive, KittiOdometry)
    assert len(drive) == 4
    assert drive.scan(2).tolist() == SCANS[2]
    assert drive.times == pytest.approx([0, 0.1, 0.2, 0.3])
    assert drive.folder.name == "00"


def test_poses_are_the_sensors_not_the_cameras(folder: Path) -> None:
    # poses.txt holds the camera's: ahead is z there.
    rows = np.loadtxt(folder / "poses.txt")
    assert rows[1, 11] == pytest.approx(1.0, abs=1e-3)
    assert open_drive(folder).poses == pytest.approx(np.stack(POSES), abs=1e-6)


def test_camera_poses_by_hand(tmp_path: Path) -> None:
    """Camera and sensor are at one place; the camera looks along the sensor's x."""
    folder = write_odometry(tmp_path / "07", SCANS[:2], POSES[:2])
    (folder / "calib.txt").write_text("Tr: 0 -1 0 0 0 0 -1 0 1 0 0 0\n")
    # 5 m ahead, 2 m to the right, 1 m up, and turned to the left by 90 degrees:
    # the camera's x (right) is now the old z (ahead), its z (ahead) the old -x.
    (folder / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n0 0 -1 2 0 1 0 -1 1 0 0 5\n")
    by_hand = pose(5, -2, 1, yaw=np.pi / 2)
    assert open_drive(folder).poses == pytest.approx(np.stack([np.eye(4), by_hand]), abs=1e-9)


def test_lever_arm_between_camera_and_sensor_counts(tmp_path: Path) -> None:
    """The sensor is 0.3 m behind the camera: when the camera turns in place, the sensor moves."""
    folder = write_odometry(tmp_path / "07", SCANS[:2], POSES[:2])
    (folder / "calib.txt").write_text("Tr: 0 -1 0 0 0 0 -1 0 1 0 0 -0.3\n")
    (folder / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n0 0 -1 0 0 1 0 0 1 0 0 0\n")
    # Turned left by 90 degrees about a point 0.3 m ahead of the sensor: from (0, 0) to (0.3, -0.3).
    assert open_drive(folder).poses[1] == pytest.approx(pose(0.3, -0.3, 0, np.pi / 2), abs=1e-9)


def test_tr_of_identity_leaves_the_poses_alone(folder: Path) -> None:
    (folder / "calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")
    rows = np.loadtxt(folder / "poses.txt").reshape(-1, 3, 4)
    assert open_drive(folder).poses[:, :3] == pytest.approx(rows)


def test_missing_tr_is_refused_with_advice(folder: Path) -> None:
    replace_line(folder / "calib.txt", 1, None)
    message = refused(folder, "calib.txt")
    assert "has no 'Tr'" in message
    assert "add a line 'Tr: '" in message
    assert "Tr: 1 0 0 0 0 1 0 0 0 0 1 0" in message


def test_tr_under_a_longer_name_is_not_tr(folder: Path) -> None:
    replace_line(folder / "calib.txt", 1, f"Tr_velo_cam: {KITTI_TR}")
    assert "has no 'Tr'" in refused(folder, "calib.txt")


@pytest.mark.parametrize(
    "values", ["", "1 2 3", f"{KITTI_TR} 1", KITTI_TR.replace("4.27", "x"), "nan " + KITTI_TR[19:]]
)
def test_malformed_tr(folder: Path, values: str) -> None:
    replace_line(folder / "calib.txt", 1, f"Tr: {values}")
    assert "Tr" in refused(folder, "calib.txt")


def test_tr_that_is_no_rotation(folder: Path) -> None:
    replace_line(folder / "calib.txt", 1, "Tr: 1 0 0 0 0 2 0 0 0 0 1 0")
    assert "no rotation" in refused(folder, "calib.txt")


@pytest.mark.parametrize("file", ["calib.txt", "times.txt"])
def test_missing_file(folder: Path, file: str) -> None:
    (folder / file).unlink()
    assert "missing" in refused(folder, file)


@pytest.mark.parametrize("file", ["poses.txt", "times.txt"])
@pytest.mark.parametrize("change", [-1, 1])
def test_wrong_count(folder: Path, file: str, change: int) -> None:
    lines = (folder / file).read_text().splitlines()
    lines = lines[:-1] if change < 0 else [*lines, lines[-1]]
    (folder / file).write_text("\n".join(lines) + "\n")
    message = refused(folder, file)
    assert f"{4 + change} " in message
    assert "4 scans" in message


@pytest.mark.parametrize("file", ["poses.txt", "times.txt"])
@pytest.mark.parametrize("line", ["zero", "1 2", "nan " * 12])
def test_malformed_line(folder: Path, file: str, line: str) -> None:
    replace_line(folder / file, 2, line)
    refused(folder, file)


@pytest.mark.parametrize("file", ["poses.txt", "times.txt"])
def test_empty_file(folder: Path, file: str) -> None:
    (folder / file).write_text("")
    assert ": 0 " in refused(folder, file)


def test_pose_that_is_no_rotation(folder: Path) -> None:
    # A quaternion file with enough columns, say.
    replace_line(folder / "poses.txt", 2, "1 2 3 4 5 6 7 8 9 10 11 12")
    assert "pose 2" in refused(folder, "poses.txt")


def test_poses_beside_the_sequences(folder: Path) -> None:
    beside = folder.parent.parent / "poses" / "00.txt"
    beside.parent.mkdir()
    shutil.move(folder / "poses.txt", beside)
    assert open_drive(folder).poses == pytest.approx(np.stack(POSES), abs=1e-6)

    beside.write_text("1 0 0\n")
    with pytest.raises(DriveError) as caught:
        open_drive(folder)
    assert str(beside) in str(caught.value)


def test_poses_in_the_folder_take_precedence(folder: Path) -> None:
    beside = folder.parent.parent / "poses" / "00.txt"
    beside.parent.mkdir()
    beside.write_text("nonsense\n")
    assert len(open_drive(folder)) == 4


@pytest.mark.parametrize(("content", "what"), [(b"", "no points"), (b"x" * 40, "no whole number")])
def test_broken_scan_is_skipped_and_refused_if_strict(
    folder: Path, content: bytes, what: str
) -> None:
    file = folder / "velodyne" / "000001.bin"
    file.write_bytes(content)
    with (
        pytest.raises(DriveError, match=what) as caught,
        use_scan_options(ScanOptions(strict=True)),
    ):
        open_drive(folder)
    assert str(file) in str(caught.value)
    drive = open_drive(folder)
    assert len(drive.scan(1)) == 0
    assert list(drive.dropouts.skipped) == [1]
    assert len(drive.scan(2)) == 2


def test_scan_of_nan_is_skipped_and_refused_if_strict(folder: Path) -> None:
    write_scan(folder / "velodyne" / "000003.bin", [[np.nan, 0, 0]])
    drive = open_drive(folder)
    assert len(drive.scan(3)) == 0
    assert "not finite" in drive.dropouts.skipped[3]
    with use_scan_options(ScanOptions(strict=True)):
        strict = open_drive(folder)
    with pytest.raises(DriveError, match=r"000003\.bin: .*not finite"):
        strict.scan(3)


def test_no_scans(folder: Path) -> None:
    shutil.rmtree(folder / "velodyne")
    (folder / "velodyne").mkdir()
    assert "no scans" in refused(folder, "velodyne")


def test_missing_folder(tmp_path: Path) -> None:
    assert "no such file or folder" in refused(tmp_path / "none", "")


def test_file_that_is_no_drive(folder: Path) -> None:
    (folder / "photo.png").write_bytes(b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR")
    assert "known layout" in refused(folder, "photo.png", folder / "photo.png")


def test_unknown_folder_error_lists_the_layouts(tmp_path: Path) -> None:
    message = refused(tmp_path, "")
    for layout in ("KITTI odometry", "velodyne/*.bin", "KITTI raw", "oxts/data/*.txt"):
        assert layout in message


def test_from_inside_the_folder(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(folder)
    assert open_drive(Path()).folder.name == "00"


def test_poses_far_away_are_moved_to_the_first_and_the_offset_is_kept(folder: Path) -> None:
    near = open_drive(folder)
    rows = np.loadtxt(folder / "poses.txt").reshape(-1, 3, 4)
    (folder / "calib.txt").write_text("Tr: 1 0 0 0 0 1 0 0 0 0 1 0\n")
    straight = open_drive(folder)
    rows[:, :, 3] += [450_000.0, 5_430_000.0, 120.0]
    np.savetxt(folder / "poses.txt", rows.reshape(-1, 12), fmt="%.9f")
    far = open_drive(folder)
    assert far.poses == pytest.approx(straight.poses, abs=1e-6)
    assert far.origin - straight.origin == pytest.approx([450_000.0, 5_430_000.0, 120.0])
    assert near.origin == pytest.approx(near.poses[0, :3, 3])


@pytest.mark.parametrize(
    ("times", "words"),
    [
        ([5.0, 5.0, 5.0, 5.0], "3 of 4 scans have the time of the scan before (5)"),
        ([0.0, 0.0, 0.0, 0.1], "2 of 4 scans have the time of the scan before (0)"),
        ([1e18, 1e18 + 1, 1e18 + 2, 1e18 + 3], "likely nanoseconds"),
        ([1.7e15, 1.7e15 + 1, 1.7e15 + 2, 1.7e15 + 3], "likely microseconds"),
        ([1.7e12, 1.7e12 + 100, 1.7e12 + 200, 1.7e12 + 300], "likely milliseconds"),
    ],
)
def test_times_that_are_equal_or_huge_are_refused(
    folder: Path, times: list[float], words: str
) -> None:
    (folder / "times.txt").write_text("".join(f"{each:.1f}\n" for each in times))
    assert words in refused(folder, "times.txt")
