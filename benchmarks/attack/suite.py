"""Attack suite: runs the attack cases and reports which ones the service withstands."""

import resource
import tempfile
import time
import traceback
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.attack.cases import CASES
from benchmarks.attack.stage import AttackCase, Stage
from benchmarks.attack.target import CORES, Target
from evaluation.machine import machine

DESCRIPTORS = 8_192
"""Largest number of files that this process and the services that it starts may open."""


@dataclass(frozen=True, slots=True)
class AttackPlan:
    """Selection and limits of an attack run.

    Attributes:
        cases: ids of the cases; empty: all.
        short: whether to run the short form.
        limit_mb: limit of a service's resident memory, MB.
        victim_seconds: longest allowed wait of another key's small request, seconds.
        seed: random seed of all choices.
    """

    cases: tuple[str, ...] = ()
    short: bool = False
    limit_mb: float = 1_000.0
    victim_seconds: float = 1.0
    seed: int = 0


def select_cases(plan: AttackPlan) -> list[AttackCase]:
    """Return the cases that a plan names.

    Raises:
        ValueError: the plan names an unknown case.
    """
    known = {case.id: case for case in CASES}
    unknown = [name for name in plan.cases if name not in known]
    if unknown:
        raise ValueError(f"Unknown case {unknown[0]!r}. Known cases: {', '.join(known)}.")
    if plan.cases:
        return [case for case in CASES if case.id in plan.cases]
    return [case for case in CASES if case.in_short or not plan.short]


def run_attacks(
    plan: AttackPlan,
    progress: Callable[[Iterable[int], int, str], Iterable[int]] = lambda items, *_: items,
    report_case: Callable[[str, dict[str, Any]], None] = lambda *_: None,
) -> dict[str, Any]:
    """Run the cases and return the report that `placecell bench attack` writes.

    Args:
        plan: selection and limits.
        progress: wraps the loop.
        report_case: called with the id and the result of each case when the case ends.

    Raises:
        ValueError: the plan names an unknown case.
    """
    cases = select_cases(plan)
    _allow_descriptors()
    begun = time.perf_counter()
    results: dict[str, dict[str, Any]] = {}
    with _shared(plan) as shared:
        for number in progress(range(len(cases)), len(cases), "cases"):
            case = cases[number]
            results[case.id] = run_case(case, plan, shared)
            report_case(case.id, results[case.id])
    held = sum(each["held"] for each in results.values())
    return {
        "cases": results,
        "held": held,
        "failed": len(results) - held,
        "short": plan.short,
        "machine": machine(),
        "cores": min(CORES, machine()["cores"]),
        "memory_limit_mb": plan.limit_mb,
        "memory_limit_by": "a watcher that kills the service, and the kernel's peak (VmHWM)",
        "victim_limit_s": plan.victim_seconds,
        "seeds": [plan.seed],
        "seconds": round(time.perf_counter() - begun, 1),
    }


@contextmanager
def _shared(plan: AttackPlan) -> Iterator[Target | None]:
    """Prepare the service that the short form's cases share; the first case starts it."""
    with tempfile.TemporaryDirectory(prefix="placecell-attack-") as folder:
        shared = Target(Path(folder) / "shared", plan.limit_mb) if plan.short else None
        try:
            yield shared
        finally:
            if shared is not None:
                shared.stop()


def run_case(case: AttackCase, plan: AttackPlan, shared: Target | None = None) -> dict[str, Any]:
    """Run one case and return its part of the report.

    Args:
        case: case to run.
        plan: selection and limits of the run.
        shared: service for cases that need none of their own.
    """
    begun = time.perf_counter()
    random = np.random.default_rng([plan.seed, int(case.id[1:])])
    with tempfile.TemporaryDirectory(prefix="placecell-attack-") as folder:
        stage = Stage(Path(folder), plan.limit_mb, plan.short, plan.victim_seconds, random, shared)
        try:
            case.attack(stage)
        except Exception as error:  # a service that dies breaks the case's next request
            last = traceback.extract_tb(error.__traceback__)[-1]
            where = f"{Path(last.filename).name}:{last.lineno}"
            stage.expect(
                False,
                f"The case failed with {type(error).__name__}: {error!s:.300} ({where}).",
            )
    found = stage.found
    return {
        "held": not found.why,
        "peak_mb": found.peak_mb,
        "victim_max_s": found.victim_max_s,
        "victim_idle_max_s": found.victim_idle_max_s,
        "statuses": dict(sorted(found.statuses.items())),
        "lost": found.lost,
        "why": " ".join(found.why),
        "expected": case.expected,
        "notes": found.notes,
        "seconds": round(time.perf_counter() - begun, 1),
    }


def failures(report: dict[str, Any]) -> Sequence[str]:
    """Return one line for each failed case."""
    return [f"{id_}: {case['why']}" for id_, case in report["cases"].items() if not case["held"]]


def _allow_descriptors() -> None:
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = DESCRIPTORS if hard == resource.RLIM_INFINITY else min(DESCRIPTORS, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))
