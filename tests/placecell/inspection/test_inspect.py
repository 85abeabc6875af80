"""The doctor, on sources with one fault each."""

import json
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from placecell.inspection.clocks import read_clock
from placecell.inspection.inspect import Inspection, inspect_source
from placecell.inspection.problem import SourceProblem
from placecell.sources.errors import DriveError
from placecell.sources.scan_options import ScanOptions, use_scan_options
from tests.placecell.inspection.scan_builders import (
    cloud_messages,
    mount_message,
    odometry_messages,
    way,
    write_clouds,
    yard,
    yards,
)
from tests.placecell.sources.bags.bag_builders import PERIOD_NS, START_NS, write_ros1

KEYS = {
    "format",
    "scans",
    "points_mean",
    "fields",
    "per_point_time",
    "nan_share",
    "zero_share",
    "poses",
    "frame",
    "sensor_height_m",
    "tilt_deg",
    "rate_hz",
    "gaps",
    "topics",
    "problems",
}


def told(found: Inspection, severity: str | None = None) -> str:
    """Return all problems, or those of a severity, as text."""
    return "\n".join(
        f"{problem.what} -> {problem.cure}"
        for problem in found.problems
        if severity in (None, problem.severity)
    )


def folder(tmp_path: Path, clouds: Sequence[NDArray[np.generic]]) -> Inspection:
    """Inspect a folder of these clouds."""
    return inspect_source(write_clouds(tmp_path / "scans", clouds))


def test_folder_of_clouds_is_told_with_height_and_missing_poses(tmp_path: Path) -> None:
    found = folder(tmp_path, yards())
    facts = found.as_dict()
    assert set(facts) >= KEYS
    assert json.loads(json.dumps(facts)) == facts
    assert facts["scans"] == facts["scans_looked_at"] == 4
    assert facts["points_mean"] == len(yard())
    assert facts["sensor_height_m"] == pytest.approx(1.5, abs=0.03)
    assert facts["tilt_deg"] < 0.5
    assert facts["poses"] == 0
    assert facts["nan_share"] == facts["zero_share"] == 0
    assert not facts["per_point_time"]
    assert found.usable
    assert "no poses -> Give a trajectory with --poses" in told(found, "warning")
    assert "have no time" in told(found)
    assert told(found, "error") == ""


def test_bag_tells_topics_frame_rate_poses_and_mount(tmp_path: Path) -> None:
    mount = np.eye(4)
    mount[:3, 3] = 0.2, 0, 0.9
    bag = write_ros1(
        tmp_path / "run.bag",
        [mount_message(mount), *cloud_messages(yards()), *odometry_messages(way(4))],
    )
    found = inspect_source(bag)
    facts = found.as_dict()
    assert facts["format"] == "ROS 1 bag"
    assert facts["frame"] == "lidar"
    assert facts["rate_hz"] == pytest.approx(10)
    assert facts["poses"] == 4
    assert facts["trajectory"]["length_m"] == pytest.approx(3)
    assert facts["tf"].startswith("base_link -> lidar")
    assert {topic["name"] for topic in facts["topics"]} == {"/points", "/odom", "/tf_static"}
    assert facts["cloud_topic"] == "/points"
    assert told(found, "warning") == told(found, "error") == ""


def test_missing_transform_is_a_warning(tmp_path: Path) -> None:
    messages = [*cloud_messages(yards()), *odometry_messages(way(4))]
    found = inspect_source(write_ros1(tmp_path / "run.bag", messages))
    assert "pose of the sensor 'lidar' on the robot is not known" in told(found, "warning")
    assert "--extrinsic" in told(found, "warning")


def test_second_topic_of_clouds_is_told(tmp_path: Path) -> None:
    rear = [cloud[::3] for cloud in yards()]
    messages = [*cloud_messages(yards()), *cloud_messages(rear, topic="/rear")]
    found = inspect_source(write_ros1(tmp_path / "run.bag", messages))
    assert found.as_dict()["cloud_topics"] == 2
    assert "Clouds are read from /points -> State another one with --topic: /rear" in told(found)


def test_bag_without_clouds_tells_its_poses_and_is_not_usable(tmp_path: Path) -> None:
    found = inspect_source(write_ros1(tmp_path / "run.bag", odometry_messages(way(5))))
    facts = found.as_dict()
    assert (facts["scans"], facts["poses"], facts["format"]) == (0, 5, "ROS 1 bag")
    assert not found.usable
    assert "no topic has clouds" in told(found, "error")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n2 2 0 0 0 0 0 1\n", "holds 3 poses and no scans"),
        ("hello\n", "file.dat"),
    ],
)
def test_trajectory_and_garbage_are_not_usable(tmp_path: Path, text: str, said: str) -> None:
    (tmp_path / "file.dat").write_text(text)
    found = inspect_source(tmp_path / "file.dat")
    assert said in told(found, "error")
    assert not found.usable
    assert found.as_dict()["poses"] == (3 if "poses" in said else 0)


def test_missing_path_is_refused(tmp_path: Path) -> None:
    with pytest.raises(DriveError, match="does not exist"):
        inspect_source(tmp_path / "none")


def test_nan_and_zero_points_are_counted(tmp_path: Path) -> None:
    clouds = yards()
    for cloud in clouds:
        cloud[::4] = np.nan
        cloud[1::4] = 0
    found = folder(tmp_path, clouds)
    assert found.as_dict()["nan_share"] == pytest.approx(0.25, abs=1e-3)
    assert found.as_dict()["zero_share"] == pytest.approx(0.25, abs=1e-3)
    assert "25.0% of the points are NaN" in told(found, "info")
    assert found.usable


def test_mostly_lost_points_are_a_warning(tmp_path: Path) -> None:
    clouds = [np.concatenate([cloud, np.full((30_000, 3), np.nan)]) for cloud in yards()]
    assert "NaN or infinite" in told(folder(tmp_path, clouds), "warning")


def test_scans_without_points_are_an_error(tmp_path: Path) -> None:
    found = folder(tmp_path, [np.full((500, 3), np.nan, np.float32)] * 3)
    assert "3 of 3 scans have no usable point" in told(found, "error")


@pytest.mark.parametrize(("scale", "unit"), [(1000, "mm"), (100, "cm")])
def test_wrong_unit_names_the_option(tmp_path: Path, scale: float, unit: str) -> None:
    found = folder(tmp_path, [cloud * np.float32(scale) for cloud in yards()])
    assert f"--unit {unit}" in told(found)
    assert not found.usable
    with use_scan_options(ScanOptions(unit="mm" if unit == "mm" else "cm")):
        assert inspect_source(tmp_path / "scans").usable


def test_cloud_of_a_map_is_an_error(tmp_path: Path) -> None:
    found = folder(tmp_path, [yard().astype(np.float64) + [500_000, 5_400_000, 100]])
    assert "map" in told(found, "error")
    moved = folder(tmp_path / "moved", [yard() + np.array([900, 700, 0], np.float32)] * 2)
    assert "they are in the frame of a map" in told(moved, "error")


def test_camera_frame_is_a_warning(tmp_path: Path) -> None:
    clouds = [np.column_stack([-c[:, 1], -c[:, 2], c[:, 0]]) for c in yards()]
    found = folder(tmp_path, clouds)
    assert "The axis -y of the scans' frame points up as in a camera's frame" in told(found)
    assert found.as_dict()["up_axis"] == "-y"
    assert found.as_dict()["sensor_height_m"] == pytest.approx(1.5, abs=0.05)


def test_tilt_is_a_warning_without_poses(tmp_path: Path) -> None:
    angle = np.radians(20)
    turn = np.array(
        [[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]]
    )
    found = folder(tmp_path, [(cloud @ turn.T).astype(np.float32) for cloud in yards()])
    assert "tilted by 20." in told(found, "warning")
    assert found.as_dict()["tilt_deg"] == pytest.approx(20, abs=0.5)


def test_high_sensor_and_missing_ground_are_warnings(tmp_path: Path) -> None:
    high = folder(tmp_path / "high", [yard(height=5.0, seed=seed) for seed in range(3)])
    assert "The sensor is 5.0" in told(high, "warning")
    blind = folder(tmp_path / "blind", [cloud[cloud[:, 2] > -1] for cloud in yards()])
    assert "No ground was found" in told(blind, "warning")
    assert blind.as_dict()["sensor_height_m"] is None
    assert blind.as_dict()["ground"]


def test_few_points_and_narrow_view_are_told(tmp_path: Path) -> None:
    few = folder(tmp_path / "few", [cloud[::200] for cloud in yards()])
    assert "fewer than the 100 of one segment" in told(few, "error")
    some = folder(tmp_path / "some", [cloud[::20] for cloud in yards()])
    assert "few segments will be found" in told(some, "warning")
    ahead = folder(
        tmp_path / "ahead", [cloud[cloud[:, 0] > np.abs(cloud[:, 1])] for cloud in yards()]
    )
    assert "a narrow view" in told(ahead)


def test_repeated_scans_are_a_warning(tmp_path: Path) -> None:
    found = folder(tmp_path, [yard(), yard(), *yards()[1:]])
    assert "1 of 5 scans repeat the points of another" in told(found, "warning")


def test_truncated_scan_is_a_warning_and_many_are_an_error(tmp_path: Path) -> None:
    path = write_clouds(tmp_path / "scans", yards())
    (path / "000002.npy").write_bytes((path / "000002.npy").read_bytes()[:3000])
    found = inspect_source(path)
    assert "1 of 4 scans cannot be read" in told(found, "warning")
    for name in ("000001.npy", "000003.npy"):
        (path / name).write_bytes((path / name).read_bytes()[:3000])
    assert "3 of 4 scans cannot be read" in told(inspect_source(path), "error")


def test_few_scans_are_looked_at_if_so_wished(tmp_path: Path) -> None:
    path = write_clouds(tmp_path / "scans", yards(9))
    facts = inspect_source(path, scans=3).as_dict()
    assert facts["scans"] == 9
    assert facts["scans_looked_at"] == 4


def test_standing_and_jumping_poses_are_warnings(tmp_path: Path) -> None:
    poses = way(4)
    poses[2:, 0, 3] += 100
    messages = [mount_message(np.eye(4)), *cloud_messages(yards()), *odometry_messages(poses)]
    found = inspect_source(write_ros1(tmp_path / "jump.bag", messages))
    assert "1 steps between poses are jumps" in told(found, "warning")
    messages = [*cloud_messages(yards()), *odometry_messages(way(4, step=0.0))]
    found = inspect_source(write_ros1(tmp_path / "still.bag", messages))
    assert "never move" in told(found)


def test_poses_for_a_part_of_the_scans_are_a_warning(tmp_path: Path) -> None:
    messages = [
        mount_message(np.eye(4)),
        *cloud_messages(yards(12)),
        *odometry_messages(way(5)),
    ]
    found = inspect_source(write_ros1(tmp_path / "run.bag", messages))
    assert "7 of 12 scans have no pose" in told(found, "warning")


def test_poses_of_another_clock_are_an_error(tmp_path: Path) -> None:
    lines = [f"{index * 0.1} {index} 0 0 0 0 0 1" for index in range(30)]
    (tmp_path / "poses.tum").write_text("\n".join(lines))
    bag = write_ros1(tmp_path / "run.bag", cloud_messages(yards()))
    with use_scan_options(ScanOptions(poses=tmp_path / "poses.tum")):
        found = inspect_source(bag)
    assert "do not overlap" in told(found, "error")


def test_world_that_is_not_level_is_a_warning(tmp_path: Path) -> None:
    mount = np.eye(4)
    mount[:3, :3] = [[0, 0, 1], [-1, 0, 0], [0, -1, 0]]
    messages = [mount_message(mount), *cloud_messages(yards()), *odometry_messages(way(4))]
    found = inspect_source(write_ros1(tmp_path / "run.bag", messages))
    assert "up is 90 degrees away from z" in told(found, "warning")


def test_clock_that_jumps_is_a_warning(tmp_path: Path) -> None:
    stamps = [START_NS + PERIOD_NS * index for index in range(6)]
    stamps[3] -= 10 * PERIOD_NS
    found = inspect_source(write_ros1(tmp_path / "run.bag", cloud_messages(yards(6), stamps)))
    assert "The clock jumps backward 1 times" in told(found, "warning")
    assert found.as_dict()["clock_jumps"][0]["seconds"] < 0


def test_read_clock_finds_gaps_jumps_and_repeats() -> None:
    stamps = 0.1 * np.arange(100.0)
    clock = read_clock(stamps)
    assert clock.rate_hz == pytest.approx(10)
    assert (clock.gaps, clock.forward, clock.backward, clock.repeated) == ((), (), (), 0)
    lost = np.delete(stamps, [20, 50, 51])
    clock = read_clock(lost)
    assert [at for at, _ in clock.gaps] == [19, 48]
    assert clock.lost == 3
    assert [at for at, _ in read_clock(np.r_[stamps, stamps + 500]).forward] == [99]
    assert [at for at, _ in read_clock(np.r_[stamps, stamps]).backward] == [99]
    assert read_clock(np.r_[stamps[:5], stamps[4:]]).repeated == 1
    assert read_clock(np.full(3, np.nan)).unknown == 3
    assert read_clock(np.zeros(4)).rate_hz is None
    assert read_clock(np.zeros(0)).lost == 0


@pytest.mark.parametrize("rate", [0.2, 100])
def test_odd_rate_names_the_unit_of_times(tmp_path: Path, rate: float) -> None:
    stamps = [START_NS + int(1e9 / rate) * index for index in range(4)]
    found = inspect_source(write_ros1(tmp_path / "run.bag", cloud_messages(yards(), stamps)))
    assert "Check the unit of the times" in told(found, "warning")


def test_problem_splits_a_message_into_fault_and_cure() -> None:
    problem = SourceProblem.of("error", "a.pcd: has no points. Write the file again")
    assert (problem.what, problem.cure) == ("a.pcd: has no points.", "Write the file again")
    problem = SourceProblem.of("error", "a.pcd: is odd")
    assert problem.cure == "Correct the file, and inspect it again."
