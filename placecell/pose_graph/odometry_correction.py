"""Correction of odometry by segments that a robot sees several times while it passes them.

A map stores a segment again after each 10 m of the way. If the odometry measures distances too
long, the later view lies farther along the way than the first one, and so do all others. So the
views tell the error of the scale, which wanders over some 100 m, and the error of the heading.
Loops cannot: they fix the poses at their ends, but not the shape of the way between them.

The centroid of a segment also moves, because other parts become visible as the robot passes it. It
leans toward the sensor, and so moves across the way, too: without this, a street with more things
on one side would bend. These amounts are estimated along with the errors, by the size of segments
and the change of their direction. Segments at the height of the sensor or above, seen from nearly
the same direction twice, only lean; they give the level.

A view shows the points of about a second. If the odometry turned wrongly in this time, only the
later points moved with it, so each error counts by the share of the points that came after it.
Along each axis, a pair counts by its box: the centroid of a pole stays, that of a long wall slides
along it, and a side that changes moves it.
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

ROUNDS = (1.0, 0.7, 0.7)
"""Largest distance between two views of a segment in each round of the estimation, meters. Each
round pairs the views in the map that the last one corrected."""

RIGHT = 0.3
"""Standard deviation of the distance between two views of right pairs, meters, in Welsch's
function: pairs farther apart show two different segments."""

TAILS = 3.0
"""Degrees of freedom of Student's distribution, by which a pair counts less if it is farther off
than its box explains."""

ITERATIONS = 6
"""Number of times that the weights of the pairs are renewed in each round."""

BETWEEN = (6.0, 16.0)
"""Way between two views, meters: those before the next one, which follows after 10 m."""

DEVIATION = 0.02
"""Smallest standard deviation of the distance between two views, along each axis, meters."""

BY_SIDE = 0.06
"""Standard deviation of the distance between two views along an axis, as a share of the side of the
box there: the centroid slides along a long wall, and that of a pole stays."""

BY_CHANGE = 0.16
"""The same, as a share of the change of this side."""

UNKNOWN = 0.15
"""The same for a segment whose box the map does not state, meters."""

SIZES = (0.65, 1.2, 3.0)
"""Longest horizontal sides, meters, that separate segments whose centroids lean toward the sensor
by different amounts."""

GATHERED = 1.0
"""Time in which the points of a view were seen, seconds: ten turns of a sensor. If the robot turns
or drives with an error in this time, only the later points move with it."""

MOST_GATHERED = 30.0
"""Largest way on which the points of a view were seen, meters: times may be wrong."""

HEADING = 0.1
"""Standard deviation of the heading after one meter in the first round, degrees. The later rounds
take the one that the first round found."""

HEADINGS = (0.03, 0.3)
"""Smallest and largest such deviation, degrees."""

HEADING_WAY = 50.0
"""Way after which the found errors of the heading tell its deviation, meters."""

PASSED = (0.4, 0.8, 1.2)
"""Changes of the direction to a segment, as the length of the difference of the unit vectors, that
separate segments whose centroids move by different amounts."""

AMOUNTS = (len(SIZES) + 1) * (len(PASSED) + 2)
"""Number of amounts by which centroids move: for each size, one lean and one for each change."""

BELOW = 0.3
"""Height below the sensor from which a centroid counts as low, meters: the segment may be hidden
behind others."""

LEVEL = 0.01
"""Amount by which the centroids of high segments move ahead that are seen from nearly the same
direction twice, meters: 1 cm in a simulated town (seed 104), 2 cm on a real drive in a city."""

AMOUNT = 1.0
"""Standard deviation of the amount by which other centroids move in addition, meters: hardly a
limit."""

LEAST_PAIRS = 10
"""Smallest number of pairs of views in the map; with fewer, nothing is corrected."""


def with_corrected_odometry(graph: GraphMap, parameters: PoseGraphParameters) -> GraphMap:
    """Return a map whose odometry is corrected, with its captures at the corrected poses.

    A track stays as it is if its odometry is stated to be better than the correction makes it
    (`PoseGraphParameters.drift_corrected`). Other stated variances of the height stay, and those of
    the heading that are smaller than after the correction.

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
    moves = np.zeros(AMOUNTS)
    heading = HEADING
    now = graph
    for number, apart in enumerate(ROUNDS):
        current().check()
        pairs = repeated_views(now, tracks, apart)
        if len(pairs) < LEAST_PAIRS:
            return graph
        errors, moves = _estimated(now, pairs, errors, moves, heading, parameters)
        errors[~np.isin(odometry.tracks[one], tracks)] = 0.0
        now = _corrected(graph, errors)
        if number == 0:
            heading = _found_heading(frames, errors[:, 1], tracks)
    variances = _corrected_variances(frames, tracks, parameters)
    odometry = replace(now.frames.odometry, variances=variances)
    return replace(now, frames=replace(now.frames, odometry=odometry))


def _corrected_variances(
    frames: GraphFrames, tracks: Int64, parameters: PoseGraphParameters
) -> Float64:
    """Return the accumulated variances of the odometry after the correction, float64 (f, 3).

    Args:
        frames: the captures.
        tracks: tracks that were corrected.
        parameters: constants of the pose graph.
    """
    one, other = frames.links.T
    odometry = frames.odometry
    way = (frames.ways[other] - frames.ways[one])[:, None]
    growth = np.array([parameters.drift_height, np.radians(parameters.drift_yaw)]) ** 2
    is_stated = _are_stated(frames)[:, None]
    stated = odometry.variances[other] - odometry.variances[one]
    step = np.empty((len(one), 3))
    step[:, :1] = parameters.drift_corrected**2 * way
    step[:, 1:] = np.where(is_stated, stated[:, 1:], growth * way)
    yaw = np.radians(parameters.drift_yaw_corrected) ** 2 * way[:, 0]
    step[:, 2] = np.minimum(step[:, 2], yaw)
    steps = np.zeros((len(frames), 3))
    steps[other] = step
    order = frames.order
    variances = np.empty_like(steps)
    variances[order] = _summed(steps[order], _begins(frames))
    corrected = np.isin(odometry.tracks, tracks)
    return np.where(corrected[:, None], variances, odometry.variances)


def _begins(frames: GraphFrames) -> Bool:
    """Return whether a track begins at each capture, in the order of `GraphFrames.order`."""
    tracks = frames.odometry.tracks[frames.order]
    return np.concatenate([[True], (tracks[1:] != tracks[:-1]) | (tracks[1:] == NO_TRACK)])


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
    heading: float,
    parameters: PoseGraphParameters,
) -> tuple[Float64, Float64]:
    """Estimate the errors of the odometry from pairs of views.

    Args:
        graph: the map, corrected by the present errors.
        pairs: int64 (p, 2), pairs of views.
        errors: float64 (links, 2), present scale errors, and heading errors, radians.
        moves: float64 (groups,), present amounts by which centroids move, meters.
        heading: standard deviation of the heading after one meter, degrees.
        parameters: constants of the pose graph.

    Returns:
        The estimated errors and amounts.
    """
    frames = graph.frames
    ahead = _ahead(graph, pairs)
    by_moves = _movements(graph, pairs, ahead)
    effects = hstack([_effects(graph, pairs, _gathered(frames)), by_moves]).tocsr()
    prior = _prior(frames, len(moves), heading, parameters)
    variances = _variances(graph, pairs)
    unknown = np.concatenate([errors.T.ravel(), moves])
    apart = np.diff(graph.centroids[pairs], axis=1)[:, 0, :2].T.ravel()
    # Without the present correction, which moves each view with its capture:
    moved = _effects(graph, pairs, np.zeros(len(frames))) @ unknown[: errors.size]
    seen = apart - LEVEL * ahead.T.ravel() + moved
    for _ in range(ITERATIONS):
        current().check()
        off = (seen - effects @ unknown).reshape(2, -1)
        kept = np.exp(-(off**2).sum(axis=0) / (2 * RIGHT**2))
        tails = (TAILS + 1) / (TAILS + off**2 / variances)
        weights = (kept * tails / variances).ravel()
        normal = effects.T @ effects.multiply(weights[:, None]) + prior
        unknown = spsolve(normal.tocsc(), effects.T @ (weights * seen))
    return unknown[: errors.size].reshape(2, -1).T.copy(), unknown[errors.size :]


def _effects(graph: GraphMap, pairs: Int64, gathered: Float64) -> csr_matrix:
    """Return how the errors of links move the later view of each pair, (2 p, 2 links).

    Rows are the x of all pairs, then the y; columns are the scale errors of all links, then the
    heading errors. The error of a scale moves a view along the step of its link. The error of a
    heading turns it about the end of its link. Both move a view by the share of its points that
    were seen after the link, and so the earlier view, too.

    Args:
        graph: the map.
        pairs: int64 (p, 2), pairs of views, the earlier one first.
        gathered: float64 (f,), way on which the points of each capture were seen, meters.
    """
    frames = graph.frames
    links = frames.links
    places = np.empty(len(frames), dtype=np.int64)
    places[frames.order] = np.arange(len(frames))
    link_at = np.zeros(len(frames), dtype=np.int64)
    link_at[places[links[:, 0]]] = np.arange(len(links))
    # From the link on which the first point of the earlier view was seen to the later view:
    ways = frames.ways[frames.order]
    _, numbers = np.unique(frames.odometry.tracks[frames.order], return_inverse=True)
    along = ways + numbers.ravel() * (ways.max(initial=0.0) + 1.0)
    views = graph.captures[pairs]
    one, last = places[views].T
    begins = np.searchsorted(numbers.ravel(), numbers.ravel()[one])
    first = np.searchsorted(along, along[one] - gathered[views[:, 0]], side="right") - 1
    first = np.clip(first, begins, one)
    counts = last - first
    pair = np.repeat(np.arange(len(pairs)), counts)
    place = first[pair] + np.arange(len(pair)) - np.repeat(np.cumsum(counts) - counts, counts)
    middle = (ways[place] + ways[place + 1]) / 2
    shares = []
    for view, at in ((views[pair, 0], one[pair]), (views[pair, 1], last[pair])):
        after = (frames.ways[view] - middle) / np.maximum(gathered[view], LEAST_WAY)
        at_once = np.where(place < at, 1.0, 0.0)
        shares.append(np.where(gathered[view] > LEAST_WAY, after.clip(0.0, 1.0), at_once))
    share = (shares[1] - shares[0])[:, None]
    link = link_at[place]
    spots = frames.positions[:, :2]
    step = share * (spots[links[:, 1]] - spots[links[:, 0]])[link]
    arm = share * (graph.centroids[pairs[pair, 1], :2] - spots[links[link, 1]])
    size = (2 * len(pairs), 2 * len(links))
    rows = [pair, pair + len(pairs), pair, pair + len(pairs)]
    columns = [link, link, link + len(links), link + len(links)]
    values = [step[:, 0], step[:, 1], -arm[:, 1], arm[:, 0]]
    return csr_matrix(
        (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=size
    )


def _gathered(frames: GraphFrames) -> Float64:
    """Return the way on which the points of each capture were seen, meters, float64 (f,)."""
    one, other = frames.links.T
    seconds = frames.times[other] - frames.times[one]
    meters = frames.ways[other] - frames.ways[one]
    speed = np.divide(meters, seconds, out=np.zeros(len(one)), where=seconds > 0)
    speeds = np.zeros(len(frames))
    speeds[one] = speed  # the first capture of a track has no link before it
    speeds[other] = speed
    return np.asarray(np.minimum(GATHERED * speeds, MOST_GATHERED))


def _variances(graph: GraphMap, pairs: Int64) -> Float64:
    """Return the variance of the distance between the views of each pair, m^2, float64 (2, p).

    Rows are the x and the y axis. If a part of a segment becomes visible or hidden, its box and its
    centroid change.
    """
    variances = np.full((2, len(pairs)), UNKNOWN**2)
    if graph.sides is not None:
        sides = graph.sides[pairs]
        known = (sides > 0).all(axis=(1, 2))
        change, side = sides[known, 1] - sides[known, 0], sides[known].max(axis=1)
        by_box = (BY_CHANGE * change) ** 2 + (BY_SIDE * side) ** 2
        variances[:, known] = by_box.T
    return DEVIATION**2 + variances


def _found_heading(frames: GraphFrames, turns: Float64, tracks: Int64) -> float:
    """Return the standard deviation of the heading after one meter, degrees.

    Args:
        frames: the captures.
        turns: float64 (links,), errors of the heading that were found, radians.
        tracks: tracks that were corrected.
    """
    squares, meters = 0.0, 0.0
    ends = frames.links[:, 1]
    for track in tracks:
        rows = frames.odometry.tracks[ends] == track
        ways, sums = frames.ways[ends[rows]], np.cumsum(turns[rows])
        later = np.searchsorted(ways, ways + HEADING_WAY)
        first = np.flatnonzero(later < len(ways))
        squares += float(((sums[later[first]] - sums[first]) ** 2).sum())
        meters += float((ways[later[first]] - ways[first]).sum())
    found = np.degrees(np.sqrt(squares / meters)) if meters > 0 else HEADING
    return float(np.clip(found, *HEADINGS))


def _ahead(graph: GraphMap, pairs: Int64) -> Float64:
    """Return the direction of the way between the captures of each pair, float64 (p, 2)."""
    spots = graph.frames.positions[graph.captures[pairs], :2]
    way = spots[:, 1] - spots[:, 0]
    return np.asarray(way / np.maximum(np.linalg.norm(way, axis=1), LEAST_WAY)[:, None])


def _movements(graph: GraphMap, pairs: Int64, ahead: Float64) -> csr_matrix:
    """Return how the movement of centroids moves the later view of each pair, (2 p, amounts).

    A centroid leans toward the sensor, by an amount for each size of segments. It also moves ahead
    with the robot, by an amount for each size and each range of the change of direction. High
    segments that are seen from nearly the same direction only lean.
    """
    arms = graph.frames.positions[graph.captures[pairs]] - graph.centroids[pairs]
    flat = arms[..., :2]
    directions = flat / np.maximum(np.linalg.norm(flat, axis=2), 1.0)[..., None]
    leans = directions[:, 1] - directions[:, 0]
    longest = np.zeros(len(pairs)) if graph.sides is None else graph.sides[pairs].max(axis=(1, 2))
    size = np.searchsorted(SIZES, longest)
    group = np.searchsorted(PASSED, np.linalg.norm(leans, axis=1))
    moving = np.flatnonzero((group > 0) | (arms[:, 0, 2] > BELOW))
    every = np.arange(2 * len(pairs))
    rows = np.concatenate([every, moving, moving + len(pairs)])
    ahead_of = (1 + group) * (len(SIZES) + 1) + size
    columns = np.concatenate([np.tile(size, 2), np.tile(ahead_of[moving], 2)])
    values = np.concatenate([leans.T.ravel(), ahead[moving].T.ravel()])
    return csr_matrix((values, (rows, columns)), shape=(2 * len(pairs), AMOUNTS))


def _prior(
    frames: GraphFrames, groups: int, heading: float, parameters: PoseGraphParameters
) -> csr_matrix:
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
    turn = 1 / (np.radians(heading) * np.sqrt(way))
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
    order, begins = frames.order, _begins(frames)
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
    return replace(moved_map, frames=replace(moved_map.frames, odometry=corrected))


def _summed(values: Float64, begins: Bool) -> Float64:
    """Return the running sums of rows, begun anew where stated, float64 (n, c)."""
    sums = np.cumsum(values, axis=0)
    starts = np.flatnonzero(begins)
    before = np.concatenate([np.zeros((1, values.shape[1])), sums[starts[1:] - 1]])
    return np.asarray(sums - before[np.cumsum(begins) - 1])
