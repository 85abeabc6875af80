"""Tests of the times of the faults."""

import random
from collections import Counter

from benchmarks.replicas.fault_schedule import FleetCrashPlan, scheduled


def test_twenty_minutes_hold_a_hundred_kills_and_ten_crashes() -> None:
    plan = FleetCrashPlan.of(1200.0)
    faults = scheduled(plan, random.Random(1))
    counts = Counter(each.cause for each in faults)
    assert counts == {
        "replica": 100,
        "primary": 10,
        "cut_commit": 5,
        "paused": 5,
        "full_disk": 2,
    }
    times = [each.seconds for each in faults]
    assert times == sorted(times)
    assert times[0] >= 0
    assert times[-1] < 1200
    # Every kind is spread: one crash in each tenth of the faults.
    places = [place for place, each in enumerate(faults) if each.cause == "primary"]
    assert [place * 10 // len(faults) for place in places] == list(range(10))


def test_short_runs_have_each_kind_once() -> None:
    plan = FleetCrashPlan.of(12.0)
    assert (plan.kills, plan.crashes, plan.cuts, plan.pauses, plan.full_disks) == (1, 1, 1, 1, 1)
    assert FleetCrashPlan.of(120.0).kills == 10
    plan = FleetCrashPlan.of(60.0, kills=7, crashes=3)
    assert (plan.kills, plan.crashes) == (7, 3)


def test_equal_seeds_have_equal_times() -> None:
    plan = FleetCrashPlan.of(120.0)
    assert scheduled(plan, random.Random(4)) == scheduled(plan, random.Random(4))
    assert scheduled(plan, random.Random(4)) != scheduled(plan, random.Random(5))
