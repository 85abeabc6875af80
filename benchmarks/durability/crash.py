"""Crash benchmark: kills the service repeatedly while robots write, and counts lost writes."""

import random
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.durability.crasher import MOMENTS, Crasher, CrashPlan
from evaluation.machine import machine


def run_crashes(
    plan: CrashPlan,
    seed: int = 0,
    options: tuple[str, ...] = (),
    progress: Callable[[Iterable[int], int, str], Iterable[int]] = lambda items, *_: items,
) -> dict[str, Any]:
    """Run the crashes; return the report that `placecell bench crash` writes.

    Args:
        plan: extent of the run.
        seed: random seed of all choices; the timing of threads and disks stays random.
        options: further options of `placecell serve`.
        progress: wraps the loop.
    """
    with tempfile.TemporaryDirectory(prefix="placecell-crash-") as folder:
        crasher = Crasher(Path(folder), options, plan, random.Random(seed))
        for number in progress(range(plan.kills), plan.kills, "kills"):
            crasher.crash(MOMENTS[number % len(MOMENTS)])
        crasher.finish()
    findings, journals = crasher.findings, [writer.journal for writer in crasher.writers]
    acknowledged = sum((journal.acknowledged for journal in journals), Counter[str]())
    return {
        "kills": plan.kills,
        "killed_during": dict(sorted(findings.killed.items())),
        "writes_acknowledged": acknowledged.total(),
        "operations_acknowledged": dict(sorted(acknowledged.items())),
        "in_flight_that_landed": sum(journal.landed for journal in journals),
        "versions_compared": findings.versions,
        "reads": crasher.reader.reads,
        "losses": findings.lost,
        "half_seen": findings.half + len(crasher.reader.half),
        "wrong": findings.faults + crasher.reader.half,
        "restart_seconds": {
            "p50": round(float(np.median(findings.starts)), 3),
            "max": round(max(findings.starts), 3),
        },
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }
