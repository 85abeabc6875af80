"""Options of drives on the command line: topic, poses, odometry, mount, deskewing."""

import shutil
from importlib import metadata
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

from cli import app
from placecell.datasets import ScanOptions, SourceDrive, open_drive, use_scan_options
from placecell.odometry.cache import FOLDER_VARIABLE
from placecell.segmentation.recording import Recording
from tests.benchmarks.drive_builders import BOXES
from tests.placecell.segment_builders import pose, write_odometry
from tests.placecell.sources.bags import bag_builders
from town import sensor, two_robots

SCANS = 12
START = 1_700_000_000.0


def run(*words: str | Path | int, status: int = 0) -> Result:
    result = CliRunner().invoke(app, [str(word) for word in words])
    assert result.exit_code == status, result.output
    return result


def seen(index: int) -> np.ndarray:
    return np.concatenate(BOXES) - np.array([index, 0, 0], np.float32)


@pytest.fixture(scope="module")
def kitti(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a drive of 1 m a scan in KITTI's layout."""
    folder = tmp_path_factory.mktemp("kitti") / "drive"
    poses = [pose(float(index)) for index in range(SCANS)]
    return write_odometry(folder, [seen(index) for index in range(SCANS)], poses)


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the same drive as an MCAP bag with odometry of a base 1 m behind the sensor."""
    return write_bag(tmp_path_factory.mktemp("bag") / "run")


def write_bag(path: Path) -> Path:
    messages: list[bag_builders.Message] = []
    for index in range(SCANS):
        stamp = int(START * 1e9) + index * 100_000_000
        cloud = bag_builders.cloud_of(bag_builders.xyz(seen(index)), stamp_ns=stamp, frame="lidar")
        messages += [
            ("/points", stamp, bag_builders.cloud_message(cloud, "cdr")),
            ("/odom", stamp, bag_builders.odometry_message(pose(index - 1.0), stamp, "cdr")),
        ]
    bag_builders.write_ros2(path, messages, "mcap")
    return path


def prepared(folder: Path, *words: str | Path) -> tuple[Recording, str]:
    """Prepare a drive; return the recording and the output."""
    result = run("prepare", *words, "--output", folder)
    (file,) = folder.glob("*.safetensors")
    recording = Recording.load(file)
    file.unlink()
    return recording, " ".join(result.output.split())


def test_same_scans_and_poses_give_the_same_segments_bit_for_bit(
    kitti: Path, tmp_path: Path
) -> None:
    expected, _ = prepared(tmp_path / "out", kitti)
    poses = ("--poses", kitti / "poses.txt", "--extrinsic", kitti / "calib.txt")
    shutil.copytree(kitti / "velodyne", tmp_path / "scans")
    for path in (kitti, tmp_path / "scans"):
        found, said = prepared(tmp_path / "out", path, *poses)
        assert len(found.segments) > 5
        np.testing.assert_array_equal(found.segments.points, expected.segments.points)
        np.testing.assert_array_equal(found.segments.ends, expected.segments.ends)
        np.testing.assert_array_equal(found.segments.sensors, expected.segments.sensors)
        np.testing.assert_array_equal(found.groups, expected.groups)
        assert found.scan_hashes == expected.scan_hashes
        assert f"{SCANS} of {SCANS} scans have a pose, from {kitti / 'poses.txt'}" in said


@pytest.mark.slow
def test_town_drive_as_a_folder_of_scans_gives_the_same_segments(tmp_path: Path) -> None:
    town, _ = two_robots(tmp_path, seed=3, scans=12, columns=500)
    expected, _ = prepared(tmp_path / "out", town)
    shutil.copytree(town / "velodyne", tmp_path / "scans")
    poses = ("--poses", town / "poses.txt", "--extrinsic", town / "calib.txt")
    found, _ = prepared(tmp_path / "out", tmp_path / "scans", *poses)
    assert len(found.segments) > 50
    np.testing.assert_array_equal(found.segments.points, expected.segments.points)
    np.testing.assert_array_equal(found.groups, expected.groups)


def test_bag_has_its_own_poses_and_the_mount_is_stated(bag: Path, tmp_path: Path) -> None:
    recording, said = prepared(tmp_path / "out", bag, "--extrinsic", "1 0 0 0 0 0")
    assert len(recording.segments) > 5
    assert recording.path_length == pytest.approx(SCANS - 1)
    assert "the sensor is mounted at 1.00 0.00 0.00 m, 0.0 0.0 0.0 deg" in said
    with use_scan_options(ScanOptions(extrinsic="1 0 0 0 0 0")):
        drive = open_drive(bag)
    assert isinstance(drive, SourceDrive)
    assert drive.origin == pytest.approx(np.zeros(3), abs=1e-9)
    assert drive.times[0] == pytest.approx(START)


def test_bag_is_a_source_of_training_and_of_the_demo(bag: Path) -> None:
    from cli.sources import source
    from evaluation.poses.robots import robots_of_drive

    whole, part = source(str(bag)), source(f"{bag}@0:{SCANS - 2}")
    assert (whole.first, whole.last) == (0, SCANS - 1)
    assert (part.first, part.last) == (0, SCANS - 2)
    assert len(whole.recording.segments)
    mapper, asker = robots_of_drive(bag, lambda items, *_: items)
    assert len(mapper.drive) == len(asker.drive) == SCANS


def test_topics_are_stated(bag: Path, tmp_path: Path) -> None:
    words = ("--topic", "/points", "--odometry", "/odom")
    recording, said = prepared(tmp_path / "out", bag, *words)
    assert len(recording.segments) > 5
    assert "topic /odom" in said
    result = run("prepare", bag, "--topic", "/scan", status=1)
    assert "has no topic '/scan'" in " ".join(result.output.split())
    result = run("prepare", bag, "--odometry", "/gps", status=1)
    assert "'/gps' is not in the bag" in " ".join(result.output.split())


def test_poses_of_another_clock_need_the_offset(bag: Path, tmp_path: Path) -> None:
    lines = [f"{index * 0.1 + 5} {index} 0 0 0 0 0 1\n" for index in range(2 * SCANS)]
    (tmp_path / "poses.tum").write_text("".join(lines))
    words = ("--poses", tmp_path / "poses.tum")
    result = run("prepare", bag, *words, "--output", tmp_path, status=1)
    assert "do not overlap" in " ".join(result.output.split())
    offset = f"{START - 5:.1f}"
    recording, said = prepared(tmp_path / "out", bag, *words, "--pose-offset", offset)
    assert recording.scans == SCANS
    assert "were added to its times, as stated" in said


def test_poses_of_another_bag(bag: Path, kitti: Path, tmp_path: Path) -> None:
    recording, _ = prepared(tmp_path / "out", bag, "--poses", bag)
    assert recording.path_length == pytest.approx(SCANS - 1)


def test_odometry_none_refuses_a_drive_without_poses(kitti: Path, tmp_path: Path) -> None:
    shutil.copytree(kitti / "velodyne", tmp_path / "scans")
    result = run("prepare", tmp_path / "scans", "--odometry", "none", status=1)
    assert "uses neither those in a bag nor kiss-icp. Give poses" in " ".join(result.output.split())


def test_odometry_none_takes_poses_only_from_the_file(
    bag: Path, kitti: Path, tmp_path: Path
) -> None:
    result = run("prepare", bag, "--odometry", "none", status=1)
    assert "uses neither those in a bag nor kiss-icp. Give poses" in " ".join(result.output.split())
    poses = kitti / "poses.txt"
    recording, said = prepared(tmp_path / "out", bag, "--odometry", "none", "--poses", poses)
    assert recording.scans == SCANS
    assert "poses.txt" in said
    assert "/odom" not in said


def test_missing_kiss_icp_is_named_with_the_command_that_installs_it(
    kitti: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def missing(name: str) -> str:
        raise metadata.PackageNotFoundError(name)

    monkeypatch.setattr(metadata, "version", missing)
    result = run("prepare", kitti, "--odometry", "kiss-icp", status=1)
    assert 'pip install "placecell[odometry]"' in " ".join(result.output.split())


@pytest.mark.slow
def test_distorted_town_drive_is_deskewed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A drive in the KITTI layout, whose scans have the times of their points."""
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "cache"))
    lidar = sensor("os1-32", columns=256)
    words = {"seed": 3, "scans": 14, "lidar": lidar, "spacing": 1.0}
    still, _ = two_robots(tmp_path / "still", **words)  # type: ignore[arg-type]
    raw, _ = two_robots(tmp_path / "raw", **words, distortion=True)  # type: ignore[arg-type]
    said: list[str] = []
    with use_scan_options(ScanOptions(tell=said.append)):
        deskewed = open_drive(raw)
    assert any("the scans are deskewed by the poses" in line for line in said)
    with use_scan_options(ScanOptions(deskew=False)):
        skewed = open_drive(raw)
    true = open_drive(still)
    for index in (3, 8):
        expected = true.scan(index)
        off = np.linalg.norm(deskewed.scan(index) - expected, axis=1)
        before = np.linalg.norm(skewed.scan(index) - expected, axis=1)
        assert np.median(off) < 0.02
        assert np.median(before) > 0.1
    with use_scan_options(ScanOptions(odometry="kiss-icp")):
        by_odometry = open_drive(raw)
    off = np.linalg.norm(by_odometry.scan(8) - true.scan(8), axis=1)
    assert np.median(off) < 0.1
    assert by_odometry.path_length() == pytest.approx(true.path_length(), rel=0.05)
    assert by_odometry.scan_hash(3) == skewed.scan_hash(3)
