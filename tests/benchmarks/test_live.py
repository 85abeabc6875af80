"""Live localization and faults, in a small form."""

import json
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from placecell_client import encode
from placecell_client.maps.edit import take

from benchmarks.live.faults import FaultPlan, compared, fixes_in, keyframes_in, run_faults
from benchmarks.live.live import Judge, LivePlan, legs_of, run_live
from benchmarks.live.town_drive import LiveScan
from robot.agent import RobotAgent
from tests.client.map_builders import random_map
from town import two_robots

pytestmark = [pytest.mark.slow, pytest.mark.integration]


def test_robot_is_localized_after_a_kidnap_and_notices_the_edge_of_the_map() -> None:
    told: list[str] = []
    plan = LivePlan(
        meters=360.0, kidnaps=1, gap=120.0, spacing=2.5, columns=400, seed=3, route=420.0
    )
    report = run_live(plan, told.append)
    assert report["wrong_but_sure"] == 0
    assert report["worst_offset_m"] < 0.5
    assert report["worst_angle_deg"] < 2.0
    assert report["left_noticed"]
    assert report["returned_noticed"]
    assert len(report["meters_until_localized"]) == 2
    assert all(each is not None and each <= 25.0 for each in report["meters_until_localized"])
    assert report["scans_dropped"] == 0
    assert told


def test_meters_outside_the_map_are_not_counted_until_localized() -> None:
    judge = Judge()
    lost = SimpleNamespace(map_to_odom=None, status=SimpleNamespace(is_sure=False, state=None))
    found = SimpleNamespace(
        map_to_odom=SimpleNamespace(pose=lambda pose: pose),
        status=SimpleNamespace(is_sure=True, state=None),
    )
    for number, (agent, from_map) in enumerate([(lost, 50), (lost, 40), (lost, 1), (found, 1)]):
        pose = np.eye(4)
        pose[0, 3] = 2.0 * number
        scan = SimpleNamespace(leg=0, true_pose=pose, odom_pose=pose)
        judge.add(cast("LiveScan", scan), cast("RobotAgent", agent), float(from_map))
    figures = judge.figures()
    assert figures["meters_until_localized"] == [4.0]
    assert figures["meters_outside_before"] == [2.0]


def test_legs_follow_from_the_seed() -> None:
    plan = LivePlan(meters=1000.0, kidnaps=4)
    assert legs_of(plan, 3000.0) == legs_of(plan, 3000.0)
    assert len(legs_of(plan, 3000.0)) == 5


def test_faults_do_not_change_the_map(tmp_path: Path) -> None:
    drive, _ = two_robots(tmp_path, seed=2, scans=60, columns=400)
    told: list[str] = []
    report = run_faults(
        FaultPlan(str(drive), kills=3, restarts=1, cut_seconds=5.0, seed=1), told.append
    )
    assert report["equal_bytes"], (report, told)
    assert report["kills"] == 3
    assert report["service_kills"] >= 1
    assert report["segments_missing"] == report["segments_twice"] == 0
    assert report["spool_entries"] == 0
    assert report["maps"] == ["site", "yard"]
    assert report["fixes"]["service"] + report["fixes"]["local"] > 0


def test_missing_and_repeated_segments_are_counted() -> None:
    whole = random_map(20)
    same = encode(whole)
    assert compared(same, same)["equal_bytes"]
    part = encode(take(whole, np.arange(20) > 2))
    found = compared(same, part)
    assert not found["equal_bytes"]
    assert (found["segments_found"], found["segments_missing"]) == (17, 3)


def test_events_with_a_broken_line_are_counted(tmp_path: Path) -> None:
    file = tmp_path / "events.jsonl"
    fix = {"event": "fix", "accepted": True, "source": "local"}
    file.write_text(f'{json.dumps({"event": "keyframe"})}\n{json.dumps(fix)}\n{{"event": "f')
    assert keyframes_in(file) == 1
    assert fixes_in(file) == {"service": 0, "local": 1}
