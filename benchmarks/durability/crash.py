"""The service killed again and again while robots write: what was lost, if anything."""

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
    """Run it; the report as `placecell bench crash` writes it.

    Args:
        plan: what is done.
        seed: of everything that is drawn; what threads and disks do is not.
        options: further ones of `placecell serve`.
        progress: wraps the loop.
    """
    with tempfile.TemporaryDirectory(prefix="placecell-crash-") as folder:
        crasher = Crasher(Path(folder), options, plan, random.Random(seed))
        for number in progress(range(plan.kills), plan.kills, "kills"):
            crasher.crash(MOMENTS[number % len(MOMENTS)])
        crasher.finish()
    tally, journals = crasher.tally, [writer.journal for writer in crasher.writers]
    acknowledged = sum((journal.acknowledged for journal in journals), Counter[str]())
    return {
        "kills": plan.kills,
        "killed_during": dict(sorted(tally.killed.items())),
        "writes_acknowledged": acknowledged.total(),
        "operations_acknowledged": dict(sorted(acknowledged.items())),
        "in_flight_that_landed": sum(journal.landed for journal in journals),
        "versions_compared": tally.versions,
        "reads": crasher.reader.reads,
        "losses": tally.lost,
        "half_seen": tally.half + len(crasher.reader.half),
        "wrong": tally.told + crasher.reader.half,
        "restart_seconds": {
            "p50": round(float(np.median(tally.starts)), 3),
            "max": round(max(tally.starts), 3),
        },
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }
