"""Correction of odometry by segments that a robot sees several times while it passes them.

A map stores a segment again after each 10 m of the way. If the odometry measures distances too
long, the later view lies farther along the way than the first one, and so do all others. So the
views tell the error of the scale, which wanders over some 100 m, and the error of the heading.
Loops cannot: they fix the poses at their ends, but not the shape of the way between them.

The centroid of a segment also moves as the robot passes it, because other parts become visible. It
moves by a similar amount for segments that are passed at a similar angle, so that amount is
estimated along with the errors. Segments at the height of the sensor or above, seen from nearly the
same direction twice, hardly move; they give the level.
"""

from dataclasses import replace

import numpy as np
from scipy.sparse import csr_matrix, eye_array, hstack
from scipy.sparse.linalg import spsolve
from scipy.spatial import cKDTree

from placecell.core.cancellation import current
from placecell.core.types import Bool, Float64, Int64
from placecell.pose_graph.frames import (
    LEAST_WAY,
    NO_TRACK,
    CaptureOdometry,
    GraphFrames,
    relative,
    rotated,
)
from placecell.pose_graph.loops import GraphMap
from placecell.pose_graph.parameters import PoseGraphParameters

ROUNDS = ((1.0, 0.3), (0.7, 0.15), (0.5, 0.1))
"""Rounds of the estimation: largest distance between two views of a segment, and the standard
deviation of their distance, meters. Each round pairs the views in the map that the last one
corrected."""

ITERATIONS = 6
"""Number of times that the weights of the pairs are renewed in each round (Welsch's function)."""

BETWEEN = (6.0, 16.0)
"""Way between two views, meters: those before the next one, which follows after 10 m."""

DEVIATION = 0.1
"""Standard deviation of the distance between two views, by which they count against the prior of
the odometry, meters."""

PASSED = (0.4, 0.8, 1.2)
"""Changes of the direction to a segment, as the length of the difference of the unit vectors, that
separate segments whose centroids move by different amounts."""

BELOW = 0.3
"""Height below the sensor from which a centroid counts as low, meters: the segment may be hidden
behind others."""

LEVEL = 0.02
"""Amount by which the centroids of high segments move that are seen from nearly the same direction
twice, meters: 1 cm in a simulated town (seed 104), 3 cm on a real drive in a city."""

AMOUNT = 1.0
"""Standard deviation of the amount by which other centroids move in addition, meters: hardly a
limit."""

LEAST_PAIRS = 10
"""Smallest number of pairs of views in the map; with fewer, nothing is corrected."""


def with_corrected_odometry(graph: GraphMap, parameters: PoseGraphParameters) -> GraphMap:
    """Return a map whose odometry is corrected, with its captures at the corrected poses.

    A track stays as it is if its odometry is stated to be better than the correction makes it
    (`PoseGraphParameters.drift_corrected`). Other stated variances of height and heading stay.

    Args:
        graph: the map, with its captures at the poses of their odometry.
        parameters: constants of the pose graph.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    frames = graph.frames
    one = frames.links[:, 0]
    odometry = frames.odometry
    tracks = _tracks_to_correct(frames, parameters)
    if not len(tracks):
        return graph
    errors = np.zeros((len(one), 2))
    moves = np.zeros(len(PASSED) + 1)
    now = graph
    for apart, deviation in ROUNDS:
        current().check()
        pairs = repeated_views(now, tracks, apart)
        if len(pairs) < LEAST_PAIRS:
            return graph
        errors, moves = _estimated(now, pairs, errors, moves, deviation, parameters)
        errors[~np.isin(odometry.tracks[one], tracks)] = 0.0
        now = _corrected(graph, errors)
    corrected = np.isin(odometry.tracks, tracks)
    growth = [
        parameters.drift_corrected**2,
        parameters.drift_height**2,
        np.radians(parameters.drift_yaw) ** 2,
    ]
    variances = np.where(
        corrected[:, None], frames.ways[:, None] * np.array(growth), odometry.variances
    )
    kept = corrected & ~np.isin(odometry.tracks, odometry.tracks[one[~_are_stated(frames)]])
    variances[kept, 1:] = odometry.variances[kept, 1:]
    odometry = replace(now.frames.odometry, variances=variances)
    return GraphMap(replace(now.frames, odometry=odometry), now.centroids, now.captures)


def _are_stated(frames: GraphFrames) -> Bool:
    """Return whether the map states the covariance of each link, bool (links,).

    A robot that stands still adds nothing to it.
    """
    one, other = frames.links.T
    variances = frames.odometry.variances
    grows = (variances[other] > variances[one]).all(axis=1)
    stands = (variances[other] == variances[one]).all(axis=1) & (variances[other] > 0).all(axis=1)
    return np.asarray(grows | stands)


def _tracks_to_correct(frames: GraphFrames, parameters: PoseGraphParameters) -> Int64:
    """Return the tracks whose odometry is not stated to be better than the correction makes it."""
    one, other = frames.links.T
    odometry = frames.odometry
    stated = _are_stated(frames)
    way = np.linalg.norm(odometry.positions[other] - odometry.positions[one], axis=1)
    grown = odometry.variances[other, 0] - odometry.variances[one, 0]
    tracks = np.unique(odometry.tracks[one])
    good = [
        track
        for track in tracks.tolist()
        if (rows := stated & (odometry.tracks[one] == track)).any()
        and grown[rows].sum() < parameters.drift_corrected**2 * way[rows].sum()
    ]
    return np.setdiff1d(tracks, good)


def repeated_views(graph: GraphMap, tracks: Int64, apart: float) -> Int64:
    """Return pairs of views of the same segment, the earlier one first, int64 (p, 2).

    They are the nearest ones of each other among the views that are 6 to 16 m of way apart.

    Args:
        graph: the map.
        tracks: tracks to look at.
        apart: largest distance between the centroids, meters.
    """
    numbers = graph.frames.odometry.tracks[graph.captures]
    ways = graph.frames.ways[graph.captures]
    found = [np.zeros((0, 2), dtype=np.int64)]
    for track in tracks:
        rows = np.flatnonzero(numbers == track)
        near = cKDTree(graph.centroids[rows]).query_pairs(apart, output_type="ndarray")
        pairs = rows[near.astype(np.int64).reshape(-1, 2)]
        later = ways[pairs[:, 0]] > ways[pairs[:, 1]]
        pairs[later] = pairs[later][:, ::-1]
        way = ways[pairs[:, 1]] - ways[pairs[:, 0]]
        pairs = pairs[(way > BETWEEN[0]) & (way < BETWEEN[1])]
        meters = np.linalg.norm(np.diff(graph.centroids[pairs], axis=1)[:, 0], axis=1)
        nearest = _is_first(pairs[:, 0], meters) & _is_first(pairs[:, 1], meters)
        found.append(pairs[nearest])
    return np.concatenate(found)


def _is_first(keys: Int64, values: Float64) -> Bool:
    """Return whether each row has the smallest value of those with its key, bool (n,)."""
    order = np.lexsort((values, keys))
    first = np.zeros(len(keys), dtype=bool)
    first[order[np.unique(keys[order], return_index=True)[1]]] = True
    return first


def _estimated(
    graph: GraphMap,
    pairs: Int64,
    errors: Float64,
    moves: Float64,
    deviation: float,
    parameters: PoseGraphParameters,
) -> tuple[Float64, Float64]:
    """Estimate the errors of the odometry from pairs of views.

    Args:
        graph: the map, corrected by the present errors.
        pairs: int64 (p, 2), pairs of views.
        errors: float64 (links, 2), present scale errors, and heading errors, radians.
        moves: float64 (groups,), present amounts by which centroids move, meters.
        deviation: standard deviation of right pairs, meters.
        parameters: constants of the pose graph.

    Returns:
        The estimated errors and amounts.
    """
    by_errors = _effects(graph, pairs)
    ahead = _ahead(graph, pairs)
    by_moves = _movements(graph, pairs, ahead)
    effects = hstack([by_errors, by_moves]).tocsr()
    prior = _prior(graph.frames, len(moves), parameters)
    unknown = np.concatenate([errors.T.ravel(), moves])
    apart = np.diff(graph.centroids[pairs], axis=1)[:, 0, :2].T.ravel()
    # Without the present correction:
    seen = apart - LEVEL * ahead.T.ravel() + by_errors @ unknown[: errors.size]
    for _ in range(ITERATIONS):
        current().check()
        off = (seen - effects @ unknown).reshape(2, -1)
        kept = np.exp(-(off**2).sum(axis=0) / (2 * deviation**2))
        weights = np.tile(kept / DEVIATION**2, 2)
        normal = effects.T @ effects.multiply(weights[:, None]) + prior
        unknown = spsolve(normal.tocsc(), effects.T @ (weights * seen))
    return unknown[: errors.size].reshape(2, -1).T.copy(), unknown[errors.size :]


def _effects(graph: GraphMap, pairs: Int64) -> csr_matrix:
    """Return how the errors of links move the later view of each pair, (2 p, 2 links).

    Rows are the x of all pairs, then the y; columns are the scale errors of all links, then the
    heading errors. The error of a scale moves the view along the step of its link. The error of a
    heading turns it about the end of its link.
    """
    frames = graph.frames
    links = frames.links
    places = np.empty(len(frames), dtype=np.int64)
    places[frames.order] = np.arange(len(frames))
    link_at = np.zeros(len(frames), dtype=np.int64)
    link_at[places[links[:, 0]]] = np.arange(len(links))
    first, last = places[graph.captures[pairs]].T
    counts = last - first
    pair = np.repeat(np.arange(len(pairs)), counts)
    offsets = np.arange(len(pair)) - np.repeat(np.cumsum(counts) - counts, counts)
    link = link_at[first[pair] + offsets]
    spots = frames.positions[:, :2]
    step = (spots[links[:, 1]] - spots[links[:, 0]])[link]
    arm = graph.centroids[pairs[pair, 1], :2] - spots[links[link, 1]]
    size = (2 * len(pairs), 2 * len(links))
    rows = [pair, pair + len(pairs), pair, pair + len(pairs)]
    columns = [link, link, link + len(links), link + len(links)]
    values = [step[:, 0], step[:, 1], -arm[:, 1], arm[:, 0]]
    return csr_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=size
    )


def _ahead(graph: GraphMap, pairs: Int64) -> Float64:
    """Return the direction of the way between the captures of each pair, float64 (p, 2)."""
    spots = graph.frames.positions[graph.captures[pairs], :2]
    way = spots[:, 1] - spots[:, 0]
    return np.asarray(way / np.maximum(np.linalg.norm(way, axis=1), LEAST_WAY)[:, None])


def _movements(graph: GraphMap, pairs: Int64, ahead: Float64) -> csr_matrix:
    """Return how the movement of centroids moves the later view of each pair, (2 p, groups).

    A centroid moves with the robot, by an amount for each group of segments: the low ones that are
    seen from nearly the same direction, and those of each range of the change of direction.
    """
    arms = graph.frames.positions[graph.captures[pairs]] - graph.centroids[pairs]
    flat = arms[..., :2]
    directions = flat / np.maximum(np.linalg.norm(flat, axis=2), 1.0)[..., None]
    change = np.linalg.norm(directions[:, 1] - directions[:, 0], axis=1)
    group = np.searchsorted(PASSED, change)
    moving = np.flatnonzero((group > 0) | (arms[:, 0, 2] > BELOW))
    rows = np.concatenate([moving, moving + len(pairs)])
    size = (2 * len(pairs), len(PASSED) + 1)
    return csr_matrix((ahead[moving].T.ravel(), (rows, np.tile(group[moving], 2))), shape=size)


def _prior(frames: GraphFrames, groups: int, parameters: PoseGraphParameters) -> csr_matrix:
    """Return the information of the prior of all unknowns.

    The scale error is a Gauss-Markov process along each track, and the heading a random walk.
    """
    one, other = frames.links.T
    count = len(one)
    way = np.linalg.norm(frames.positions[other] - frames.positions[one], axis=1)
    way = np.maximum(way, LEAST_WAY)
    tracks = frames.odometry.tracks[one]
    follows = np.concatenate([[False], tracks[1:] == tracks[:-1]])
    keeps = np.where(follows, np.exp(-way / parameters.scale_length), 0.0)
    scale = 1 / (parameters.scale * np.sqrt(1 - keeps**2))
    every, later = np.arange(count), np.flatnonzero(follows)
    turn = 1 / (np.radians(parameters.drift_yaw) * np.sqrt(way))
    values = [scale, -(keeps * scale)[later], turn]
    rows, columns = [every, later, count + every], [every, later - 1, count + every]
    total = 2 * count + groups
    factor = csr_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))),
        shape=(2 * count, total),
    )
    amounts = np.concatenate([np.zeros(2 * count), np.full(groups, 1 / AMOUNT**2)])
    return csr_matrix(factor.T @ factor + eye_array(total).multiply(amounts))


def _corrected(graph: GraphMap, errors: Float64) -> GraphMap:
    """Return the map with the steps of its odometry corrected, and captures at these poses.

    Args:
        graph: the map, with its captures at the poses of their odometry.
        errors: float64 (links, 2), scale errors, and heading errors, radians.
    """
    frames, odometry = graph.frames, graph.frames.odometry
    one, other = frames.links.T
    steps, turns = relative(
        odometry.positions[one], odometry.yaws[one], odometry.positions[other], odometry.yaws[other]
    )
    order, tracks = frames.order, odometry.tracks[frames.order]
    begins = np.concatenate([[True], (tracks[1:] != tracks[:-1]) | (tracks[1:] == NO_TRACK)])
    added = odometry.yaws.copy()
    added[other] = turns - errors[:, 1]
    yaws = np.empty(len(frames))
    yaws[order] = _summed(added[order][:, None], begins)[:, 0]
    moved = odometry.positions.copy()
    moved[other] = rotated(steps / (1 + errors[:, :1]), yaws[one])
    positions = np.empty_like(moved)
    positions[order] = _summed(moved[order], begins)
    moved_map = graph.moved(
        np.where((odometry.tracks == NO_TRACK)[:, None], frames.positions, positions),
        np.where(odometry.tracks == NO_TRACK, frames.yaws, yaws),
    )
    corrected = CaptureOdometry(odometry.tracks, positions, yaws, odometry.variances)
    return GraphMap(
        replace(moved_map.frames, odometry=corrected), moved_map.centroids, moved_map.captures
    )


def _summed(values: Float64, begins: Bool) -> Float64:
    """Return the running sums of rows, begun anew where stated, float64 (n, c)."""
    sums = np.cumsum(values, axis=0)
    starts = np.flatnonzero(begins)
    before = np.concatenate([np.zeros((1, values.shape[1])), sums[starts[1:] - 1]])
    return np.asarray(sums - before[np.cumsum(begins) - 1])
