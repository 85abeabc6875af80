import threading
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from robot.agent import RobotAgent
from robot.core.status import AgentState, LinkState
from robot.node.messages import CertainPose, DiagnosticLevel, StampedTransform
from robot.node.node import NodeAgent, RobotNode
from robot.node.settings import NodeSettings
from tests.robot.node.node_fakes import (
    SECOND,
    FakeAgent,
    FakeClock,
    FakePublisher,
    cloud,
    moved,
    odometry,
)


class Rig:
    """A node with its stand-ins."""

    def __init__(self, settings: NodeSettings | None = None, known_after: int = 1) -> None:
        self.agent = FakeAgent(known_after)
        self.publisher = FakePublisher()
        self.clock = FakeClock()
        self.told: list[str] = []
        used = settings or NodeSettings(mount=moved(0))
        self.node = RobotNode(self.agent, self.publisher, used, self.told.append, self.clock)

    def message(self) -> str:
        """Publish and return the newest diagnostic."""
        self.clock.now += 1.0
        self.node.step(0)
        return self.publisher.diagnostics[-1].message


def test_agent_of_the_robot_fits_the_node() -> None:
    agent: Callable[..., NodeAgent] = RobotAgent  # mypy compares their methods
    assert agent is RobotAgent


def test_scan_gets_the_odometry_between_two_messages() -> None:
    rig = Rig()
    rig.node.on_odometry(odometry(10.0, 2.0))
    rig.node.on_cloud(cloud(10.05))
    assert not rig.node.step(0)
    rig.node.on_odometry(odometry(10.1, 4.0))
    assert rig.node.step(0)
    points, time_s, pose = rig.agent.scans[0]
    assert points.tolist() == [[1, 0, 0], [1, 1, 0], [1, -1, 0]]
    assert time_s == 10.05
    assert pose[:3, 3] == pytest.approx([3, 0, 0])
    assert rig.told == ["scan 1"]
    assert rig.agent.covariances == [None]


def test_scan_gets_the_covariance_of_the_odometry_at_the_sensor() -> None:
    rig = Rig(NodeSettings(mount=moved(2)))
    first, last = np.diag([0.1, 0.1, 0.1, 0, 0, 0.01]), np.diag([0.3, 0.3, 0.3, 0, 0, 0.03])
    rig.node.on_odometry(replace(odometry(10.0, 2.0), covariance=first))
    rig.node.on_odometry(replace(odometry(10.1, 4.0), covariance=last))
    rig.node.on_odometry(odometry(10.2, 6.0))
    for seconds in (10.05, 10.1, 10.15):
        rig.node.on_cloud(cloud(seconds))
        assert rig.node.step(0)
    between, at_last, unknown = rig.agent.covariances
    assert between is not None
    assert at_last is not None
    # 2 m times an error of the heading of 0.02 rad^2: 0.08 m^2 sideways.
    assert np.diag(between) == pytest.approx([0.2, 0.28, 0.2, 0, 0, 0.02])
    assert np.diag(at_last) == pytest.approx([0.3, 0.42, 0.3, 0, 0, 0.03])
    assert unknown is None


def test_scan_at_the_time_of_the_odometry_does_not_wait_for_the_next_message() -> None:
    rig = Rig()
    rig.node.on_odometry(odometry(10.0, 2.0))
    rig.node.on_cloud(cloud(10.0))
    assert rig.node.step(0)


def test_newest_scan_wins_and_older_ones_are_counted() -> None:
    rig = Rig()
    for number in range(5):
        rig.node.on_cloud(cloud(10 + 0.1 * number))
    for number in range(50):
        rig.node.on_odometry(odometry(10 + 0.01 * number, number))
    assert rig.node.step(0)
    assert not rig.node.step(0)
    assert [time_s for _, time_s, _ in rig.agent.scans] == [10.4]
    assert rig.agent.dropped == 4


def test_scan_without_odometry_is_dropped_after_the_wait() -> None:
    rig = Rig()
    rig.node.on_odometry(odometry(10.0, 0.0))
    rig.node.on_cloud(cloud(10.05))
    rig.clock.now = 0.31
    rig.node.step(0)
    rig.node.on_odometry(odometry(10.1, 0.0))
    assert not rig.node.step(0)
    assert rig.agent.scans == []
    rig.message()
    assert ("clouds_without_odometry", "1") in rig.publisher.diagnostics[-1].values


def test_scan_from_before_the_odometry_is_dropped_at_once() -> None:
    rig = Rig()
    rig.node.on_odometry(odometry(10.0, 0.0))
    rig.node.on_cloud(cloud(9.0))
    rig.node.step(0)
    rig.message()
    assert ("clouds_without_odometry", "1") in rig.publisher.diagnostics[-1].values


def test_correction_is_published_with_the_odometry_at_a_bounded_rate() -> None:
    rig = Rig()
    rig.node.on_odometry(odometry(10.0, 2.0))
    assert rig.publisher.transforms == []
    rig.node.on_cloud(cloud(10.0))
    rig.node.step(0)
    for number in range(1, 101):
        rig.node.on_odometry(odometry(10 + 0.01 * number, 2.0))
    assert len(rig.publisher.transforms) == 20  # a second at 20 Hz
    first = rig.publisher.transforms[0]
    assert (first.parent, first.child) == ("map", "odom")
    assert first.stamp_ns == 10_210_000_000  # dated ahead by 0.2 s
    assert first.pose[:3, 3].tolist() == [100, 50, 0]
    rig.node.on_odometry(odometry(5.0, 2.0))  # the clock was restarted
    assert rig.publisher.transforms[-1].stamp_ns == 5_200_000_000


def test_correction_is_not_published_if_another_node_does_it() -> None:
    rig = Rig(NodeSettings(mount=moved(0), publish_transform=False))
    rig.node.on_odometry(odometry(10.0, 2.0))
    rig.node.on_cloud(cloud(10.0))
    rig.node.step(0)
    rig.node.on_odometry(odometry(10.1, 2.0))
    assert rig.publisher.transforms == []
    assert len(rig.publisher.poses) == 1


def test_pose_of_the_base_is_published_and_the_agent_gets_that_of_the_sensor() -> None:
    rig = Rig(NodeSettings(mount=moved(0.5, 0, 1.5)))
    rig.node.on_odometry(odometry(10.0, 2.0))
    rig.node.on_cloud(cloud(10.0))
    rig.node.step(0)
    assert rig.agent.scans[0][2][:3, 3].tolist() == [2.5, 0, 1.5]
    (pose,) = rig.publisher.poses
    assert (pose.frame, pose.stamp_ns) == ("map", 10 * SECOND)
    assert pose.pose[:3, 3].tolist() == [102, 50, 0]
    assert pose.covariance[0, 0] == 0.01


def test_mount_is_found_in_the_static_transforms() -> None:
    rig = Rig(NodeSettings())
    rig.node.on_odometry(odometry(10.0, 2.0))
    rig.node.on_cloud(cloud(10.0))
    assert not rig.node.step(0)
    assert rig.message() == (
        "No transform from 'base_link' to 'lidar' is known. Publish it on /tf_static, or set the "
        "extrinsic."
    )
    rig.node.on_static_transform(StampedTransform(0, "base_link", "mast", moved(0, 0, 1)))
    rig.node.on_static_transform(StampedTransform(0, "mast", "lidar", moved(1, 0, 0.5)))
    rig.node.on_odometry(odometry(10.1, 2.0))
    rig.node.on_cloud(cloud(10.1))
    assert rig.node.step(0)
    assert rig.agent.scans[0][2][:3, 3].tolist() == [3, 0, 1.5]


def test_mount_is_the_identity_if_the_odometry_is_that_of_the_sensor() -> None:
    rig = Rig(NodeSettings())
    rig.node.on_odometry(odometry(10.0, 2.0, child="lidar"))
    rig.node.on_cloud(cloud(10.0))
    assert rig.node.step(0)


def test_points_of_a_sweep_are_moved_to_the_time_of_the_scan() -> None:
    rig = Rig()
    for number in range(6):
        for step in range(11):
            at = 10 + 0.1 * number + 0.01 * step
            rig.node.on_odometry(odometry(at, 10 * (at - 10)))  # 10 m/s
        rig.node.on_cloud(cloud(10 + 0.1 * number, times=[0.0, 0.05, 0.09]))
        rig.node.step(0)
    points, _, _ = rig.agent.scans[-1]
    assert points[:, 0] == pytest.approx([1.0, 1.5, 1.9], abs=1e-4)


def test_deskewing_can_be_switched_off() -> None:
    rig = Rig(NodeSettings(mount=moved(0), deskew=False))
    rig.node.on_odometry(odometry(9.9, 0))
    rig.node.on_odometry(odometry(10.1, 2))
    rig.node.on_cloud(cloud(10.0, times=[0.0, 0.05, 0.09]))
    rig.node.step(0)
    assert rig.agent.scans[0][0][:, 0].tolist() == [1, 1, 1]


def test_initial_pose_is_given_as_that_of_the_sensor() -> None:
    rig = Rig(NodeSettings(mount=moved(0.5)))
    rig.node.on_initial_pose(CertainPose(0, "map", moved(7, 8), np.eye(6)))
    rig.node.step(0)
    ((pose, covariance),) = rig.agent.initial_poses
    assert pose[:3, 3].tolist() == [7.5, 8, 0]
    assert covariance.tolist() == np.eye(6).tolist()


def test_initial_pose_in_another_frame_is_refused() -> None:
    rig = Rig()
    rig.node.on_initial_pose(CertainPose(0, "odom", moved(7, 8), np.eye(6)))
    rig.node.step(0)
    assert rig.agent.initial_poses == []
    assert "is in the frame 'odom', expected 'map'" in rig.message()


def test_request_to_localize_reaches_the_agent() -> None:
    rig = Rig()
    rig.node.on_localize()
    rig.node.step(0)
    assert rig.agent.requests == 1


def test_damaged_cloud_is_told_and_the_next_one_is_used() -> None:
    rig = Rig()
    rig.node.on_odometry(odometry(10.0, 0.0))
    rig.node.on_cloud(replace(cloud(10.0), data=b""))
    assert not rig.node.step(0)
    assert "the data has 0" in rig.message()
    assert ("clouds_damaged", "1") in rig.publisher.diagnostics[-1].values
    assert rig.publisher.diagnostics[-1].level == DiagnosticLevel.ERROR
    rig.node.on_odometry(odometry(10.1, 0.0))
    rig.node.on_cloud(cloud(10.1))
    assert rig.node.step(0)
    assert rig.message() == "tracking"


def test_state_is_published_at_once_and_then_every_second() -> None:
    rig = Rig()
    rig.node.step(0)
    assert [each.message for each in rig.publisher.diagnostics] == ["starting"]
    assert rig.publisher.diagnostics[0].level == DiagnosticLevel.WARN
    rig.node.step(0)
    assert len(rig.publisher.diagnostics) == 1
    rig.node.on_odometry(odometry(10.0, 0.0))
    rig.node.on_cloud(cloud(10.0))
    rig.node.step(0)
    last = rig.publisher.diagnostics[-1]
    assert (last.message, last.level, last.hardware) == ("tracking", DiagnosticLevel.OK, "ann")
    assert last.stamp_ns == 10 * SECOND
    for _ in range(10):
        rig.clock.now += 0.25
        rig.node.step(0)
    assert len(rig.publisher.diagnostics) == 4


def test_silent_topics_are_told() -> None:
    rig = Rig()
    rig.clock.now = 5
    assert rig.message() == "No clouds for 6 s. Check the topic's name and the driver."
    rig.node.on_cloud(cloud(10.0))
    assert rig.message() == "No odometry for 7 s. Check the topic's name and the driver."


def test_clocks_that_differ_are_told() -> None:
    rig = Rig()
    rig.node.on_cloud(cloud(1.7e9))
    rig.node.on_odometry(odometry(10.0, 0.0))
    assert "off the odometry's clock. Check that both drivers use the same clock" in rig.message()


def test_link_and_state_set_the_level() -> None:
    rig = Rig()
    rig.agent.status = replace(
        rig.agent.status, state=AgentState.TRACKING, link=LinkState.OFFLINE, reason="in the yard"
    )
    assert rig.message() == "tracking: in the yard; no link to the service"
    rig.agent.status = replace(rig.agent.status, state=AgentState.KIDNAPPED)
    rig.message()
    levels = [each.level for each in rig.publisher.diagnostics]
    assert levels == [DiagnosticLevel.WARN, DiagnosticLevel.ERROR]


def test_node_runs_until_it_is_stopped() -> None:
    agent, publisher, stop = FakeAgent(), FakePublisher(), threading.Event()
    node = RobotNode(agent, publisher, NodeSettings(mount=moved(0)))
    thread = threading.Thread(target=node.run, args=[stop])
    thread.start()
    node.on_odometry(odometry(10.0, 0.0))
    node.on_cloud(cloud(10.0))
    for _ in range(200):
        if agent.scans:
            break
        threading.Event().wait(0.01)
    stop.set()
    thread.join(5)
    assert not thread.is_alive()
    assert len(agent.scans) == 1


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ({"map_frame": ""}, "Invalid map_frame ''"),
        ({"queue": 0}, "Invalid queue 0: expected 1 or more"),
        ({"transform_hz": 0.0}, "Invalid transform_hz 0.0: expected a positive number"),
        ({"odometry_wait": -1.0}, "Invalid odometry_wait -1.0: expected 0 or more"),
    ],
)
def test_impossible_settings_are_refused(words: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        NodeSettings(**words)  # type: ignore[arg-type]
