"""Bending: the steps from a map that drifted to corrected poses of its captures."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from placecell.core.progress import Progress, silent
from placecell.core.types import Float64, Int64
from placecell.localization import Confidence
from placecell.pose_graph.consistency import (
    consistent_loops,
    is_explained_by_drift,
    supporters_of,
)
from placecell.pose_graph.frames import GraphFrames, Links
from placecell.pose_graph.known_loops import KnownLoops
from placecell.pose_graph.loops import (
    FoundLoop,
    GraphMap,
    SegmentSearch,
    chosen_captures,
    find_loops,
    links_of,
)
from placecell.pose_graph.odometry_correction import with_corrected_odometry
from placecell.pose_graph.optimize import Solution, optimize, parts_of, residuals, solver
from placecell.pose_graph.parameters import PoseGraphParameters

PARAMETERS = PoseGraphParameters()

Verdict = Literal["accepted", "not-explained-by-drift", "unsupported", "inconsistent", "outlier"]
"""Judgment of a loop: it is part of the graph; or its drift is too large; or too few loops beside
it agree; or it contradicts more loops than it agrees with; or the optimization rejects it."""


@dataclass(frozen=True, slots=True, eq=False)
class JudgedLoop:
    """Loop with its judgment.

    Attributes:
        loop: the loop.
        verdict: whether it is accepted, or why not.
        meters: distance between the loop and the optimized poses.
        degrees: angle between them.
    """

    loop: FoundLoop
    verdict: Verdict
    meters: float
    degrees: float


@dataclass(frozen=True, slots=True, eq=False)
class BentMap:
    """Result of the optimization of a map's pose graph.

    Attributes:
        frames: the captures as they were.
        positions: float64 (f, 3), meters, optimized positions.
        yaws: float64 (f,), radians, optimized headings.
        loops: all loops that were found, with their judgment.
        parts: int64 (f,), part of the graph that each capture is in; parts are not connected.
        before: root mean square of the accepted loops' distances before the optimization, meters.
        after: the same after it.
        known: the loops, for the next optimization of the map; None if none were searched.
    """

    frames: GraphFrames
    positions: Float64
    yaws: Float64
    loops: tuple[JudgedLoop, ...]
    parts: Int64
    before: float
    after: float
    known: KnownLoops | None = None

    @property
    def moved(self) -> Float64:
        """Distance by which each capture moves, meters, float64 (f,)."""
        return np.asarray(np.linalg.norm(self.positions - self.frames.positions, axis=1))

    @property
    def accepted(self) -> int:
        """Number of accepted loops."""
        return self.verdicts["accepted"]

    @property
    def verdicts(self) -> Counter[str]:
        """Number of loops by judgment."""
        return Counter(each.verdict for each in self.loops)


def bend(
    graph: GraphMap,
    search: SegmentSearch,
    parameters: PoseGraphParameters = PARAMETERS,
    confidence: Confidence | None = None,
    progress: Progress = silent,
    known: KnownLoops | None = None,
) -> BentMap:
    """Find the loops of a map, and optimize the poses of its captures.

    Args:
        graph: the map.
        search: search for similar segments in it.
        parameters: constants of the pose graph.
        confidence: model of the loops' probability; None for that of the default model.
        progress: function that shows the progress.
        known: loops of an earlier optimization; only the captures that are new since then are
            localized.

    Raises:
        Cancelled: The request is late, or its client disconnected.
        PoseGraphUnavailableError: The extra `pose-graph` is not installed.
    """
    solver()  # before a search that may take minutes
    # Each track as its odometry gave it: a map that was optimized before has the same loops again.
    raw = with_corrected_odometry(graph.as_driven(), parameters)
    loops: list[FoundLoop] = []
    before, left = np.zeros(0, dtype=np.int64), chosen_captures(raw, parameters)
    if known is not None:
        loops, before, left = known.in_map(raw.frames, left, parameters)
    loops += find_loops(raw, search, parameters, confidence, left, progress)
    frames = replace(graph.frames, odometry=raw.frames.odometry)
    localized = np.concatenate([before, left])
    return replace(
        judged(frames, loops, parameters), known=KnownLoops.of(raw.frames, localized, loops)
    )


def judged(
    frames: GraphFrames, loops: Sequence[FoundLoop], parameters: PoseGraphParameters = PARAMETERS
) -> BentMap:
    """Judge loops, and optimize the poses of captures with those that are right.

    Args:
        frames: the captures.
        loops: loops between them; some may be wrong.
        parameters: constants of the pose graph.

    Raises:
        Cancelled: The work was cancelled.
        PoseGraphUnavailableError: The extra `pose-graph` is not installed.
    """
    links = links_of(loops, parameters)
    verdicts = np.full(len(loops), "accepted", dtype=object)
    left = np.arange(len(loops))

    def reject(rows: Int64, keeps: Int64, verdict: Verdict) -> Int64:
        verdicts[np.setdiff1d(rows, keeps)] = verdict
        return keeps

    explained = is_explained_by_drift(frames, links, parameters)
    left = reject(left, left[explained], "not-explained-by-drift")
    supporters = supporters_of(frames, links.take(left), parameters)
    left = reject(left, left[supporters >= parameters.supporters], "unsupported")
    fitting = consistent_loops(frames, links.take(left), parameters)
    left = reject(left, left[fitting], "inconsistent")
    found, kept = _trusted(frames, links, left, parameters)
    while len(kept) < len(left):
        left = reject(left, kept, "outlier")
        found, kept = _trusted(frames, links, left, parameters)
    # Without loops, there is nothing to optimize: captures stay where they are.
    parts = parts_of(frames, links.take(left))
    looped = np.isin(parts, parts[links.one[left]])
    positions = np.where(looped[:, None], found.positions, frames.positions)
    yaws = np.where(looped, found.yaws, frames.yaws)
    meters, angles = residuals(positions, yaws, links)
    apart, degrees = np.linalg.norm(meters, axis=1), np.degrees(np.abs(angles))
    before, _ = residuals(frames.positions, frames.yaws, links.take(left))
    return BentMap(
        frames=frames,
        positions=positions,
        yaws=yaws,
        loops=tuple(
            JudgedLoop(loop, verdict, float(distance), float(angle))
            for loop, verdict, distance, angle in zip(loops, verdicts, apart, degrees, strict=True)
        ),
        parts=parts,
        before=_mean_square(np.linalg.norm(before, axis=1)),
        after=_mean_square(apart[left]),
    )


def _trusted(
    frames: GraphFrames, links: Links, left: Int64, parameters: PoseGraphParameters
) -> tuple[Solution, Int64]:
    """Optimize with some loops, and return which of them fit the result.

    If many consistent loops do not fit, the odometry is worse than its covariance says. It is then
    trusted less, as long as that makes more loops fit.
    """
    best: tuple[Solution, Int64] | None = None
    for distrust in DISTRUST:
        found = optimize(frames, links.take(left), parameters, distrust)
        meters, angles = residuals(found.positions, found.yaws, links.take(left))
        right = (np.linalg.norm(meters, axis=1) <= parameters.right) & (
            np.degrees(np.abs(angles)) <= parameters.right_yaw
        )
        kept = left[found.kept & right]
        if best is not None and len(kept) <= len(best[1]):
            break
        best = found, kept
        if len(kept) >= FITTING * len(left):
            break
    assert best is not None  # DISTRUST is not empty
    return best


DISTRUST = (1.0, 2.0, 4.0, 8.0)
"""Factors of the odometry's deviations that are tried one after the other."""

FITTING = 0.98
"""Share of the consistent loops that should fit the result."""


def _mean_square(values: Float64) -> float:
    return float(np.sqrt(np.mean(values**2))) if len(values) else 0.0
