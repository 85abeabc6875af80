"""Optimization: the poses that fit odometry and loops best, robust against wrong loops.

Gravity is known, so the graph has four unknowns a capture. Position and heading in the plane are
solved by GTSAM, with graduated non-convexity against wrong loops (Yang et al. 2020). Heights do not
depend on them, and are a sparse linear system. So roll and pitch stay exactly as they are.
"""

from dataclasses import dataclass, replace
from types import ModuleType

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import spsolve

from placecell.core.types import Bool, Float64, Int64
from placecell.pose_graph.frames import GraphFrames, Links, odometry_links, relative
from placecell.pose_graph.parameters import PoseGraphParameters

MISSING = (
    "The optimization of a pose graph needs the package gtsam. Install it with: "
    'pip install "placecell[pose-graph]".'
)

ANCHOR = 1e-3
"""Standard deviation of the pose of the first capture of each part, meters and radians."""


class PoseGraphUnavailableError(ImportError):
    """Error: the extra `pose-graph` is not installed."""


@dataclass(frozen=True, slots=True, eq=False)
class Solution:
    """Optimized poses.

    Attributes:
        positions: float64 (f, 3), meters.
        yaws: float64 (f,), radians.
        kept: bool (loops,), loops that the optimization kept.
    """

    positions: Float64
    yaws: Float64
    kept: Bool


def solver() -> ModuleType:
    """Return the module gtsam.

    Raises:
        PoseGraphUnavailableError: It is not installed.
    """
    try:
        import gtsam
    except ImportError as error:
        raise PoseGraphUnavailableError(MISSING) from error
    module: ModuleType = gtsam
    return module


def parts_of(frames: GraphFrames, loops: Links) -> Int64:
    """Return the part of the graph that each capture is in, int64 (f,), from 0.

    Two captures are in one part if odometry and loops connect them.
    """
    one = np.concatenate([frames.links[:, 0], loops.one])
    other = np.concatenate([frames.links[:, 1], loops.other])
    graph = csr_matrix((np.ones(len(one)), (one, other)), shape=(len(frames), len(frames)))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def anchors_of(frames: GraphFrames, parts: Int64) -> Int64:
    """Return the capture of each part that stays where it is: its earliest one."""
    order = np.lexsort((*frames.positions.T, frames.times, parts))
    return order[np.unique(parts[order], return_index=True)[1]]


def optimize(
    frames: GraphFrames, loops: Links, parameters: PoseGraphParameters, distrust: float = 1.0
) -> Solution:
    """Return the poses that fit odometry and loops best.

    The earliest capture of each part keeps its pose. Captures without odometry and loops stay where
    they are.

    Args:
        frames: the captures; their poses are where the optimization begins.
        loops: relative poses by loops; some may be wrong.
        parameters: constants of the pose graph.
        distrust: factor of the deviations of the odometry.

    Raises:
        PoseGraphUnavailableError: The extra `pose-graph` is not installed.
    """
    odometry = odometry_links(frames, parameters)
    odometry = replace(odometry, deviations=distrust * odometry.deviations)
    anchors = anchors_of(frames, parts_of(frames, loops))
    plan, yaws, kept = _in_plan(frames, odometry, loops, anchors, parameters)
    heights = _heights(frames, odometry, loops.take(np.flatnonzero(kept)), anchors)
    return Solution(np.column_stack([plan, heights]), yaws, kept)


def residuals(positions: Float64, yaws: Float64, links: Links) -> tuple[Float64, Float64]:
    """Return how far links are from poses: float64 (n, 3), meters, and float64 (n,), radians."""
    there, turned = relative(
        positions[links.one], yaws[links.one], positions[links.other], yaws[links.other]
    )
    angle = (turned - links.yaws + np.pi) % (2 * np.pi) - np.pi
    return there - links.positions, angle


def _in_plan(
    frames: GraphFrames,
    odometry: Links,
    loops: Links,
    anchors: Int64,
    parameters: PoseGraphParameters,
) -> tuple[Float64, Float64, Bool]:
    """Return positions (f, 2) and headings (f,), and which loops are kept."""
    gtsam = solver()
    # Near the origin, so that nothing is lost to rounding.
    middle = frames.positions[:, :2].mean(axis=0) if len(frames) else np.zeros(2)
    graph, initial = gtsam.NonlinearFactorGraph(), gtsam.Values()
    noises: dict[tuple[float, float], object] = {}
    start = np.column_stack([frames.positions[:, :2], frames.yaws])
    for number, (x, y, yaw) in enumerate(start.tolist()):
        initial.insert(number, gtsam.Pose2(x - middle[0], y - middle[1], yaw))
    firm = gtsam.noiseModel.Isotropic.Sigma(3, ANCHOR)
    for anchor in anchors.tolist():
        graph.add(gtsam.PriorFactorPose2(anchor, initial.atPose2(anchor), firm))
    for links in (odometry, loops):
        rows = zip(
            links.one.tolist(),
            links.other.tolist(),
            links.positions[:, :2].tolist(),
            links.yaws.tolist(),
            links.deviations[:, [0, 2]].tolist(),
            strict=True,
        )
        for one, other, (x, y), yaw, (meters, radians) in rows:
            noise = noises.get((meters, radians))
            if noise is None:
                noise = gtsam.noiseModel.Diagonal.Sigmas(np.array([meters, meters, radians]))
                noises[meters, radians] = noise
            graph.add(gtsam.BetweenFactorPose2(one, other, gtsam.Pose2(x, y, yaw), noise))
    known = len(anchors) + len(odometry)
    values, kept = initial, np.zeros(0, dtype=bool)
    if len(loops):
        settings = gtsam.GncLMParams(gtsam.LevenbergMarquardtParams())
        settings.setLossType(gtsam.GncLossType.TLS)
        settings.setKnownInliers(list(range(known)))
        robust = gtsam.GncLMOptimizer(graph, initial, settings)
        robust.setInlierCostThresholdsAtProbability(parameters.probability)
        values = robust.optimize()
        kept = np.asarray(robust.getWeights())[known:] > 0.5
        for loop in np.flatnonzero(~kept).tolist():
            graph.remove(known + loop)
    # The robust optimization ends early: the least squares of the kept loops follow exactly.
    exact = gtsam.LevenbergMarquardtParams()
    exact.setRelativeErrorTol(1e-10)
    exact.setAbsoluteErrorTol(1e-10)
    values = gtsam.LevenbergMarquardtOptimizer(graph, values, exact).optimize()
    poses = [values.atPose2(number) for number in range(len(frames))]
    found = np.array([(each.x(), each.y(), each.theta()) for each in poses]).reshape(-1, 3)
    return found[:, :2] + middle, found[:, 2], kept


def _heights(frames: GraphFrames, odometry: Links, loops: Links, anchors: Int64) -> Float64:
    """Return the heights that fit odometry and loops best, float64 (f,)."""
    one = np.concatenate([odometry.one, loops.one])
    other = np.concatenate([odometry.other, loops.other])
    rises = np.concatenate([odometry.positions[:, 2], loops.positions[:, 2]])
    weights = 1 / np.concatenate([odometry.deviations[:, 1], loops.deviations[:, 1]]) ** 2
    # Relative to the present heights: a capture without links then keeps its own.
    missing = rises - (frames.positions[other, 2] - frames.positions[one, 2])
    count = len(frames)
    firm = np.zeros(count)
    firm[anchors] = 1 / ANCHOR**2
    diagonal = firm + np.bincount(one, weights, count) + np.bincount(other, weights, count)
    every = np.arange(count)
    matrix = csr_matrix(
        (
            np.concatenate([diagonal, -weights, -weights]),
            (np.concatenate([every, one, other]), np.concatenate([every, other, one])),
        ),
        shape=(count, count),
    )
    right = np.bincount(other, weights * missing, count) - np.bincount(
        one, weights * missing, count
    )
    change = spsolve(matrix.tocsc(), right) if count else np.zeros(0)
    return np.asarray(frames.positions[:, 2] + np.atleast_1d(change))
