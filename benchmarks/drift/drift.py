"""Drift: trajectory errors of maps before and after the optimization of their pose graph."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.union import union

from benchmarks.drift.kiss_slam import kiss_slam_row
from benchmarks.drift.merging import EVERY, merge_row
from benchmarks.drift.town_maps import DriftCase, TrueMap, robot_maps
from benchmarks.drift.views import shared_things, within
from evaluation.machine import machine
from evaluation.trajectory import absolute_error
from placecell.core.types import Float64, Int64
from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
from placecell.pose_graph import BentMap, FoundLoop, judged
from placecell.pose_graph.bend import PARAMETERS
from placecell.pose_graph.frames import headings, relative, wrapped
from service.engine import Engine
from service.merging.bending import bend_content, graph_of

WRONG = (1.0, 3.0)
"""Error from which a loop is wrong, meters and degrees: that of a right pose of a localization."""


@dataclass(frozen=True, slots=True)
class DriftPlan:
    """Plan of a measurement.

    Attributes:
        cases: towns and drives.
        percents: drifts of the odometry, percent.
        cache: folder where simulated maps are kept.
        merges: also merge the maps of several robots, and localize in the merged map.
        every: way between two captures that are localized in a merged map, meters.
        kiss_slam: Python interpreter with the package `kiss-slam`, which then maps the same drives
            of single robots; None: it is not compared.
    """

    cases: Sequence[DriftCase]
    percents: Sequence[float]
    cache: Path
    merges: bool = True
    every: float = EVERY
    kiss_slam: Path | None = None


def run_drift(
    plan: DriftPlan,
    tell: Callable[[str], None] = lambda _: None,
    keep: Callable[[dict[str, Any]], None] = lambda _: None,
) -> dict[str, Any]:
    """Run the measurement; return its report.

    Args:
        plan: what to measure.
        tell: takes a line about the progress.
        keep: takes the report so far after each row, because all rows take hours.
    """
    with Engine.temporary(model_folder(DEFAULT_MODEL)) as engine:
        report: dict[str, Any] = {
            "model_id": engine.model.id,
            "machine": machine(),
            "rows_planned": len(plan.cases) * len(plan.percents),
            "rows": [],
        }
        for case in plan.cases:
            maps = robot_maps(case, plan.percents, plan.cache, tell)
            for percent in plan.percents:
                row = measured(case, percent, maps[percent], engine)
                if plan.merges and case.robots > 1:
                    row |= merge_row(maps[percent], engine, plan.every)
                if plan.kiss_slam is not None and case.robots == 1:
                    row |= kiss_slam_row(case, maps[percent], plan.kiss_slam, plan.cache, tell)
                tell(
                    f"{row['case']}: {row['ate_before_m']} m before, {row['ate_after_m']} m after, "
                    f"{row['loops_accepted']} loops, {row['loops_wrong']} wrong"
                )
                report["rows"].append(row)
                keep(report)
    return report


def measured(
    case: DriftCase, percent: float, maps: Sequence[TrueMap], engine: Engine
) -> dict[str, Any]:
    """Optimize the map of one or several robots; return its row of the report."""
    content, true = joined(maps)
    begun, begun_cpu = perf_counter(), process_time()
    bent, after = bend_content(content, engine.model, PARAMETERS)
    seconds, cpu_seconds = perf_counter() - begun, process_time() - begun_cpu
    wrong = wrong_loops(bent, true)
    accepted = np.array([each.verdict == "accepted" for each in bent.loops], dtype=bool)
    before, now = (
        ate_of(positions, bent, content, true)
        for positions in (bent.frames.positions, bent.positions)
    )
    row = {
        "case": f"{case.name}-{percent:g}percent",
        "meters": round(sum(each.meters for each in maps), 1),
        "robots": case.robots,
        "drift_percent": percent,
        "captures": len(content.frame_times),
        "segments": len(content),
        "loops_found": len(bent.loops),
        "loops_accepted": bent.accepted,
        "loops_wrong": int((wrong & accepted).sum()),
        "loops_wrong_rejected": int((wrong & ~accepted).sum()),
        "parts": int(bent.parts.max()) + 1,
        "ate_before_m": round(before, 3),
        "ate_after_m": round(now, 3),
        "ate_after_scaled_m": round(ate_of(bent.positions, bent, content, true, scale=True), 3),
        "seconds": round(seconds, 1),
        "cpu_seconds": round(cpu_seconds, 1),
    }
    row |= with_outliers(bent, case.seed)
    if case.robots > 1:
        graph = graph_of(content)
        shared = shared_things(graph, true)
        moved = graph if after is None else graph.moved(bent.positions, bent.yaws)
        row["within_0_3_m"] = round(within(moved, shared), 4)
    return row


def with_outliers(bent: BentMap, seed: int) -> dict[str, Any]:
    """Judge the loops again with as many random ones; return the keys that the report has for it.

    `outliers_change` is the distance between the two results, as a share of the distance by which
    the optimization moves captures, both root mean square.
    """
    loops = [each.loop for each in bent.loops]
    rng = np.random.default_rng([seed, 100])
    again = judged(bent.frames, [*loops, *outliers(len(loops), len(bent.frames), rng)], PARAMETERS)
    accepted = sum(each.verdict == "accepted" for each in again.loops[len(loops) :])
    change = np.sqrt(((again.positions - bent.positions) ** 2).sum(axis=1).mean())
    moved = np.sqrt((bent.moved**2).mean())
    return {
        "outliers": len(loops),
        "outliers_accepted": accepted,
        "outliers_change": round(float(change / moved), 5) if moved > 0 else 0.0,
    }


def outliers(count: int, frames: int, rng: np.random.Generator) -> list[FoundLoop]:
    """Return random loops between random captures, at most 30 m apart along each axis."""
    found = []
    for _ in range(count):
        one, other = rng.choice(frames, 2, replace=False).tolist()
        place = np.append(rng.uniform(-30.0, 30.0, 2), 0.0)
        yaw = float(rng.uniform(-np.pi, np.pi))
        covariance = np.diag([0.01, 0.01, 0.01, 1e-4])
        found.append(FoundLoop(one, other, place, yaw, covariance, 0.99, 20))
    return found


def joined(maps: Sequence[TrueMap]) -> tuple[CompactMap, Float64]:
    """Return one map of all robots, each in the frame of its odometry, and the true poses."""
    contents, first = [], 0
    for number, each in enumerate(maps, start=1):
        frames = each.content
        yaws = headings(_rotations(frames))
        zeros = np.zeros((len(yaws), 3))
        contents.append(
            replace(
                frames,
                frame="town",
                ids=frames.ids + np.uint32(first),
                frame_tracks=np.full(len(yaws), number, np.uint32),
                frame_odometry=np.column_stack([frames.frame_positions, yaws, zeros]),
            )
        )
        first += int(frames.ids.max()) + 1
    content = union(contents)
    true = np.empty((len(content.frame_times), 4, 4))
    assert content.frame_tracks is not None
    for number, each in enumerate(maps, start=1):
        rows = np.flatnonzero(content.frame_tracks == number)
        order = np.argsort(each.content.frame_times)
        true[rows[np.argsort(content.frame_times[rows])]] = each.poses[order]
    return content, true


def _rotations(content: CompactMap) -> Float64:
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_quat(content.frame_orientations).as_matrix())


def wrong_loops(bent: BentMap, true: Float64) -> np.ndarray:
    """Return which loops are wrong, bool (loops,)."""
    if not bent.loops:
        return np.zeros(0, dtype=bool)
    loops = [each.loop for each in bent.loops]
    one, other = (np.array([getattr(each, name) for each in loops]) for name in ("one", "other"))
    positions, yaws = true[:, :3, 3], headings(true[:, :3, :3])
    there, turned = relative(positions[one], yaws[one], positions[other], yaws[other])
    meters = np.linalg.norm(there - np.array([each.position for each in loops]), axis=1)
    angles = np.degrees(np.abs(wrapped(turned - np.array([each.yaw for each in loops]))))
    return np.asarray((meters > WRONG[0]) | (angles > WRONG[1]))


def ate_of(
    positions: Float64, bent: BentMap, content: CompactMap, true: Float64, scale: bool = False
) -> float:
    """Return the absolute trajectory error, meters, root mean square over all captures.

    Each connected part is aligned with the truth as one; before the optimization, each robot is.
    With `scale`, the error of the scale is left out: loops do not see it.
    """
    if positions is bent.frames.positions:
        assert content.frame_tracks is not None
        groups: Int64 = content.frame_tracks.astype(np.int64)
    else:
        groups = bent.parts
    squares, errors = 0.0, []
    for group in np.unique(groups):
        rows = np.flatnonzero(groups == group)
        errors.append(absolute_error(positions[rows], true[rows, :3, 3], scale=scale).rmse)
        squares += len(rows) * errors[-1] ** 2
    return float(np.sqrt(squares / len(positions)))
