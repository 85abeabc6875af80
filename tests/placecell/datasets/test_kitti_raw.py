import math
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.datasets import DriveError, KittiRaw, open_drive
from tests.placecell.segment_builders import IMU_TO_VELO, pose, write_raw, yaw_matrix

LATITUDE, LONGITUDE, ALTITUDE = 49.0, 8.4, 115.0
# Any sphere of this radius: meters a degree, here without any map projection.
METERS_A_DEGREE = math.pi / 180 * 6_378_137.0
Record = tuple[float, float, float, float, float, float]


def record(
    east: float = 0.0, north: float = 0.0, up: float = 0.0, yaw: float = 0.0, roll: float = 0.0,
    pitch: float = 0.0,
) -> Record:  # fmt: skip
    """Return an oxts record at a distance from the start, meters."""
    longitude = LONGITUDE + east / (METERS_A_DEGREE * math.cos(math.radians(LATITUDE)))
    return LATITUDE + north / METERS_A_DEGREE, longitude, ALTITUDE + up, roll, pitch, yaw


def unit_at_the_sensor(folder: Path) -> None:
    """Write a calibration without a lever arm."""
    (folder / "calib_imu_to_velo.txt").write_text("R: 1 0 0 0 1 0 0 0 1\nT: 0 0 0\n")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    records = [record(0.8 * step, 0.6 * step) for step in range(6)]
    return write_raw(tmp_path / "2011_09_30" / "2011_09_30_drive_0018_sync", records)


def refused(folder: Path, file: Path | str) -> str:
    with pytest.raises(DriveError) as caught:
        open_drive(folder)
    assert str(folder / file) in str(caught.value)
    return str(caught.value)


def test_drive_is_recognized_and_read(folder: Path) -> None:
    drive = open_drive(folder)
    assert isinstance(drive, KittiRaw)
    assert len(drive) == 6
    assert drive.scan(0).tolist() == [[5, 0, 0]]
    assert drive.folder.name == "2011_09_30_drive_0018_sync"


def test_poses_as_constructed(tmp_path: Path) -> None:
    # x east, y north; yaw 0 is east, counter-clockwise. The first is the world's origin.
    true = [(0, 0, 0, 0), (10, 0, 0, 0), (20, 5, 0.5, 0.4), (25, 60, -1.0, 1.5), (0, 80, 0, 3.0)]
    folder = write_raw(tmp_path / "drive", [record(*each) for each in true])
    unit_at_the_sensor(folder)
    # Within 80 m the Mercator map is off by 80^2 tan(49) / 2R = 0.6 mm and some 1 mm of scale.
    by_hand = np.stack([pose(*each) for each in true])
    assert open_drive(folder).poses == pytest.approx(by_hand, abs=2e-3)


@pytest.mark.parametrize("heading", [0.0, 0.7, math.pi / 2, -2.0])
def test_world_is_the_sensors_frame_at_the_first_scan(tmp_path: Path, heading: float) -> None:
    """Driving ahead is +x for any heading."""
    records = [
        record(s * math.cos(heading), s * math.sin(heading), yaw=heading) for s in (0.0, 5.0, 9.0)
    ]
    drive = open_drive(write_raw(tmp_path / "drive", records))
    assert drive.poses == pytest.approx(np.stack([pose(), pose(5), pose(9)]), abs=1e-3)


def test_lever_arm_between_unit_and_sensor_counts(tmp_path: Path) -> None:
    """A rotation by 90 degrees moves the sensor, 0.81 m ahead of the unit, around it."""
    drive = open_drive(write_raw(tmp_path / "drive", [record(), record(yaw=math.pi / 2)]))
    sensor = np.array([0.8086759, -0.3195559, 0.7997231])  # minus T: seen from the unit
    x, y, z = yaw_matrix(math.pi / 2) @ sensor - sensor
    assert drive.poses[1] == pytest.approx(pose(x, y, z, math.pi / 2), abs=1e-6)


def test_sensor_mounted_turned(tmp_path: Path) -> None:
    """The sensor's x is the unit's left, so driving ahead is the sensor's -y."""
    folder = write_raw(tmp_path / "drive", [record(), record(4.0)])
    (folder / "calib_imu_to_velo.txt").write_text("R: 0 1 0 -1 0 0 0 0 1\nT: 0 0 0\n")
    assert open_drive(folder).poses[1] == pytest.approx(pose(0, -4), abs=1e-3)


def test_roll_pitch_and_yaw(tmp_path: Path) -> None:
    folder = write_raw(tmp_path / "drive", [record(), record(yaw=0.5, pitch=0.2, roll=-0.3)])
    unit_at_the_sensor(folder)
    # About the fixed axes: roll about x first, then pitch about y, then yaw about z.
    by_hand = Rotation.from_euler("xyz", [-0.3, 0.2, 0.5]).as_matrix()
    assert open_drive(folder).poses[1, :3, :3] == pytest.approx(by_hand, abs=1e-9)


def test_gap_in_the_scans_as_in_drive_0009(tmp_path: Path) -> None:
    # Scans 2 and 3 are missing; their oxts records and time stamps are there.
    records = [record(float(step)) for step in range(6)]
    folder = write_raw(tmp_path / "drive", records, numbers=[0, 1, 4, 5])
    drive = open_drive(folder)
    assert len(drive) == 4
    assert drive.poses[:, 0, 3] == pytest.approx([0, 1, 4, 5], abs=1e-3)
    assert drive.times == pytest.approx([0, 0.1, 0.4, 0.5])


def test_drive_that_does_not_begin_at_0(tmp_path: Path) -> None:
    folder = write_raw(tmp_path / "drive", [record(float(s)) for s in range(4)], numbers=[2, 3])
    drive = open_drive(folder)
    assert drive.poses == pytest.approx(np.stack([pose(), pose(1)]), abs=1e-3)
    assert drive.times == pytest.approx([0, 0.1])


def test_times_with_nanoseconds_across_a_minute(folder: Path) -> None:
    stamps = [f"2011-09-30 12:40:59.{n}00000999" for n in (7, 8, 9)]
    stamps += [f"2011-09-30 12:41:00.{n}00000999" for n in (0, 1, 2)]
    (folder / "velodyne_points" / "timestamps.txt").write_text("\n".join(stamps) + "\n")
    assert open_drive(folder).times == pytest.approx([0, 0.1, 0.2, 0.3, 0.4, 0.5], abs=1e-6)


def test_calibration_of_the_date(folder: Path) -> None:
    file = folder / "calib_imu_to_velo.txt"
    file.rename(folder.parent / file.name)
    assert len(open_drive(folder)) == 6


def test_missing_calibration_error_names_its_source(folder: Path) -> None:
    (folder / "calib_imu_to_velo.txt").unlink()
    message = refused(folder, "calib_imu_to_velo.txt")
    assert str(folder.parent) in message
    assert "calibration archive" in message


@pytest.mark.parametrize(
    "text",
    [
        "",
        "R: 1 0 0 0 1 0 0 0 1\n",
        "T: 0 0 0\n",
        "R: 1 0 0\nT: 0 0 0\n",
        IMU_TO_VELO.replace("3.19", "x"),
        "R: 1 0 0 0 1 0 0 0 1\nT: 0 nan 0\n",
        "R: nan 0 0 0 1 0 0 0 1\nT: 0 0 0\n",
        "R: 2 0 0 0 1 0 0 0 1\nT: 0 0 0\n",
        "R: 1 0 0 0 1 0 0 0 -1\nT: 0 0 0\n",
    ],
)
def test_malformed_calibration(folder: Path, text: str) -> None:
    (folder / "calib_imu_to_velo.txt").write_text(text)
    refused(folder, "calib_imu_to_velo.txt")


def test_calibration_of_bytes(folder: Path) -> None:
    (folder / "calib_imu_to_velo.txt").write_bytes(b"\xff\xfe\xfd")
    refused(folder, "calib_imu_to_velo.txt")


OXTS = Path("oxts/data/0000000003.txt")


def test_missing_oxts_record(folder: Path) -> None:
    (folder / OXTS).unlink()
    assert "missing" in refused(folder, OXTS)


@pytest.mark.parametrize("text", ["", "1 2 3\n", "x " * 30, "nan " * 30, ("0 " * 30 + "\n") * 2])
def test_malformed_oxts_record(folder: Path, text: str) -> None:
    (folder / OXTS).write_text(text)
    refused(folder, OXTS)


STAMPS = Path("velodyne_points/timestamps.txt")


def test_missing_time_stamps(folder: Path) -> None:
    (folder / STAMPS).unlink()
    assert "missing" in refused(folder, STAMPS)


@pytest.mark.parametrize("text", ["", "2011-09-30 12:40:59.5\n" * 5, "noon\n" * 6, "\n" * 6])
def test_malformed_time_stamps(folder: Path, text: str) -> None:
    (folder / STAMPS).write_text(text)
    refused(folder, STAMPS)


def test_time_stamps_of_bytes(folder: Path) -> None:
    (folder / STAMPS).write_bytes(b"\xff\xfe\xfd")
    refused(folder, STAMPS)


def test_no_scans(folder: Path) -> None:
    for file in (folder / "velodyne_points" / "data").iterdir():
        file.unlink()
    assert "no scans" in refused(folder, Path("velodyne_points/data"))
