"""Outputs: events, trajectories, MCAP files."""

import json
from pathlib import Path

import numpy as np

from placecell.core.segments import Segments
from placecell.trajectories.reading import read_trajectory
from robot.core.map_to_odom import MapToOdom
from robot.core.status import AgentStatus, Fix
from robot.outputs.events import EventLog
from robot.outputs.mcap_output import McapOutput
from robot.outputs.output import AgentOutput, NoOutput, OutputGroup
from robot.outputs.trajectory import TrajectoryFile
from tests.robot.agent_fakes import at

POINTS = np.array([[1, 2, 3], [4, 5, 6]], np.float32)
FOUND = MapToOdom(at(10.0, 0.0, 0.5), np.eye(6), "yard", 1.0)


def report(output: AgentOutput) -> None:
    """Report a short run to an output."""
    output.status(AgentStatus(time=0.5, reason="no fix yet"))
    output.scan(0.5, POINTS, at(0.0), None)
    segments = Segments.of([POINTS, POINTS + 1], np.zeros((2, 3)))
    output.segments(1.0, segments, np.array([3, 8]))
    fix = Fix(1.0, "yard", at(11.0), np.eye(6), 0.99, "service", 4.0, True)
    output.fix(fix)
    output.scan(1.0, POINTS, at(1.0), FOUND)
    output.scan(1.1, POINTS, at(2.0), FOUND)
    output.close()


def test_events_are_json_lines(tmp_path: Path) -> None:
    report(EventLog(tmp_path / "new" / "run.jsonl"))
    lines = (tmp_path / "new" / "run.jsonl").read_text().splitlines()
    events = [json.loads(each) for each in lines]
    assert [each["event"] for each in events] == ["state", "keyframe", "fix"]
    assert events[2]["position"] == [11.0, 0.0, 0.0]
    assert events[2]["accepted"]
    assert events[1]["segments"] == 2


def test_trajectory_has_the_poses_that_are_known(tmp_path: Path) -> None:
    report(TrajectoryFile(tmp_path / "run.tum"))
    found = read_trajectory(tmp_path / "run.tum")
    assert found.stamps is not None
    np.testing.assert_allclose(found.stamps, [1.0, 1.1])
    np.testing.assert_allclose(found.poses[0], FOUND.pose(at(1.0)), atol=1e-6)


def test_trajectory_in_kitti_format_has_twelve_numbers(tmp_path: Path) -> None:
    report(TrajectoryFile(tmp_path / "run.kitti"))
    rows = np.loadtxt(tmp_path / "run.kitti")
    np.testing.assert_allclose(rows[1].reshape(3, 4), FOUND.pose(at(2.0))[:3], atol=1e-6)


def test_mcap_has_clouds_poses_and_the_transform(tmp_path: Path) -> None:
    from mcap.reader import make_reader
    from rosbags.typesys import Stores, get_typestore

    report(McapOutput(tmp_path / "run.mcap"))
    store = get_typestore(Stores.ROS2_HUMBLE)
    found: dict[str, list[object]] = {}
    with (tmp_path / "run.mcap").open("rb") as stream:
        for schema, channel, message in make_reader(stream).iter_messages():
            assert schema is not None
            decoded = store.deserialize_cdr(message.data, schema.name)
            found.setdefault(channel.topic, []).append(decoded)
    counts = {topic: len(each) for topic, each in found.items()}
    assert counts == {"/scan": 1, "/segments": 1, "/pose": 3, "/fixes": 1, "/tf": 2}
    transform = found["/tf"][0].transforms[0]  # type: ignore[attr-defined]
    assert (transform.header.frame_id, transform.child_frame_id) == ("map", "odom")
    assert transform.transform.translation.x == 10.0
    assert found["/segments"][0].width == 4  # type: ignore[attr-defined]
    scan = np.frombuffer(found["/scan"][0].data, "<f4").reshape(2, -1)  # type: ignore[attr-defined]
    np.testing.assert_allclose(scan[:, :3], POINTS + [1, 0, 0])


def test_group_passes_everything_on() -> None:
    calls: list[str] = []

    class Counter(NoOutput):
        def scan(self, *_: object) -> None:
            calls.append("scan")

        def segments(self, *_: object) -> None:
            calls.append("segments")

        def fix(self, fix: Fix) -> None:
            calls.append("fix")

        def status(self, status: AgentStatus) -> None:
            calls.append("status")

        def close(self) -> None:
            calls.append("close")

    report(OutputGroup([Counter(), NoOutput()]))
    assert calls == ["status", "scan", "segments", "fix", "scan", "scan", "close"]
