"""Consistency of loops: what drift explains, what other loops support, and which fit together.

Source: pairwise consistency of Mangelson et al. 2018, *Pairwise consistent measurement set
maximization for robust multi-robot map merging*, with the clique search of localization.
"""

import numpy as np

from placecell.core.bits import packed
from placecell.core.types import Bool, Float64, Int64
from placecell.localization.clique import heaviest_clique
from placecell.pose_graph.frames import GraphFrames, Links, composed, relative, wrapped
from placecell.pose_graph.parameters import PoseGraphParameters

EFFORT = 200_000_000
"""Number of elementary steps of the clique search: about a second."""

BLOCK = 256
"""Number of loops that are compared with all others at once."""


def is_explained_by_drift(
    frames: GraphFrames, loops: Links, parameters: PoseGraphParameters
) -> Bool:
    """Return whether the drift between its two captures explains each loop, bool (n,).

    Loops between tracks have no odometry to compare with: all are explained.
    """
    odometry = frames.odometry
    tracks = odometry.tracks
    same = (tracks[loops.one] == tracks[loops.other]) & (tracks[loops.one] != 0)
    positions, yaws = relative(
        odometry.positions[loops.one],
        odometry.yaws[loops.one],
        odometry.positions[loops.other],
        odometry.yaws[loops.other],
    )
    way = np.abs(frames.ways[loops.one] - frames.ways[loops.other])
    meters = np.linalg.norm(positions - loops.positions, axis=1)
    angle = np.abs(wrapped(yaws - loops.yaws))
    near = meters <= parameters.slack + parameters.slack_per_meter * way
    turned = angle <= np.radians(parameters.slack_yaw + parameters.slack_yaw_growth * np.sqrt(way))
    return np.asarray(~same | (near & turned))


def in_one_order(frames: GraphFrames, loops: Links) -> Links:
    """Return the loops with the capture of the smaller track, or of the shorter way, first."""
    tracks, ways = frames.odometry.tracks, frames.ways
    one, other = loops.one, loops.other
    flip = (tracks[other] < tracks[one]) | (
        (tracks[other] == tracks[one]) & (ways[other] < ways[one])
    )
    nothing = np.zeros((len(loops), 3))
    back, turned = relative(loops.positions, loops.yaws, nothing, np.zeros(len(loops)))
    return Links(
        np.where(flip, loops.other, loops.one),
        np.where(flip, loops.one, loops.other),
        np.where(flip[:, None], back, loops.positions),
        np.where(flip, turned, loops.yaws),
        loops.deviations,
    )


def supporters_of(frames: GraphFrames, loops: Links, parameters: PoseGraphParameters) -> Int64:
    """Return how many other loops support each loop, int64 (n,).

    A supporter lies beside the loop at both ends, is the loop of another capture, and agrees with
    it: over a few meters, drift is small. So single wrong loops have no support.
    """
    ordered = in_one_order(frames, loops)
    counts = np.zeros(len(loops), dtype=np.int64)
    for begin in range(0, len(loops), BLOCK):
        rows = np.arange(begin, min(begin + BLOCK, len(loops)))
        compared = _Compared.of(frames, ordered, rows)
        beside = (compared.ways <= parameters.beside).all(axis=0) & compared.same_tracks
        beside &= loops.other[rows][:, None] != loops.other
        near = compared.meters <= parameters.same + parameters.same_per_meter * compared.ways.sum(
            axis=0
        )
        turned = compared.angles <= np.radians(parameters.same_yaw)
        counts[rows] = (beside & near & turned).sum(axis=1)
    return counts


def consistent_loops(frames: GraphFrames, loops: Links, parameters: PoseGraphParameters) -> Int64:
    """Return the largest set of loops in which drift explains each pair, int64 (m,), ascending.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    if len(loops) < 2:
        return np.arange(len(loops))
    ordered = in_one_order(frames, loops)
    words = []
    for begin in range(0, len(loops), BLOCK):
        rows = np.arange(begin, min(begin + BLOCK, len(loops)))
        compared = _Compared.of(frames, ordered, rows)
        way = compared.ways.sum(axis=0)
        near = compared.meters <= parameters.slack + parameters.slack_per_meter * way
        turned = compared.angles <= np.radians(
            parameters.slack_yaw + parameters.slack_yaw_growth * np.sqrt(way)
        )
        fits = (near & turned) | ~compared.same_tracks
        fits[np.arange(len(rows)), rows] = False
        words += [packed(row) for row in fits]
    count = len(loops)
    clique, _ = heaviest_clique(
        np.stack(words), np.ones(count), np.arange(count), np.ones(count, dtype=bool), EFFORT
    )
    return clique if len(clique) else np.arange(1)


class _Compared:
    """Differences between some loops and all loops, along the odometry between them.

    Attributes:
        same_tracks: bool (r, n), whether the two loops connect the same tracks.
        ways: float64 (2, r, n), meters, way between the two loops at each end.
        meters: float64 (r, n), distance between the two poses of the second loop's other capture.
        angles: float64 (r, n), angle between them, radians.
    """

    def __init__(self, same_tracks: Bool, ways: Float64, meters: Float64, angles: Float64) -> None:
        self.same_tracks = same_tracks
        self.ways = ways
        self.meters = meters
        self.angles = angles

    @classmethod
    def of(cls, frames: GraphFrames, loops: Links, rows: Int64) -> "_Compared":
        """Compare the loops of these rows with all loops; all are in one order."""
        odometry, tracks, ways = frames.odometry, frames.odometry.tracks, frames.ways
        same_tracks = np.ones((len(rows), len(loops)), dtype=bool)
        apart = []
        for ends in (loops.one, loops.other):
            same_tracks &= tracks[ends[rows]][:, None] == tracks[ends]
            apart.append(np.abs(ways[ends[rows]][:, None] - ways[ends]))
        # Each loop as a correction: the pose of the one track's frame in the other's.
        spot, turn = composed(
            odometry.positions[loops.one],
            odometry.yaws[loops.one],
            loops.positions,
            loops.yaws,
        )
        turns = turn - odometry.yaws[loops.other]
        # Where the row's loop puts the other capture of each loop, against where that loop puts it.
        moved = odometry.positions[loops.other] - odometry.positions[loops.other[rows]][:, None]
        cos, sin = np.cos(turns[rows])[:, None], np.sin(turns[rows])[:, None]
        x = spot[rows, 0, None] + cos * moved[..., 0] - sin * moved[..., 1]
        y = spot[rows, 1, None] + sin * moved[..., 0] + cos * moved[..., 1]
        z = spot[rows, 2, None] + moved[..., 2]
        meters = np.sqrt((x - spot[:, 0]) ** 2 + (y - spot[:, 1]) ** 2 + (z - spot[:, 2]) ** 2)
        angles = np.abs(wrapped(turns[rows][:, None] - turns))
        return cls(same_tracks, np.stack(apart), meters, angles)
