"""Correspondences: pairs of a query segment and a place of the map, with weights."""

from dataclasses import dataclass, replace

import numpy as np

from placecell.core.cancellation import current, is_cancelled
from placecell.core.grid_cells import neighboring
from placecell.core.jit import compiled
from placecell.core.types import Float64, Int32, Int64
from placecell.localization.candidates import Candidates
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.viewpoint import view_shifts


@dataclass(frozen=True, slots=True, eq=False)
class Correspondences:
    """The m pairs of a query and a place. A place is a group of map segments at one position.

    Attributes:
        queries: int64 (m,), indices of the candidates' queries.
        places: int64 (m,), numbers of places.
        rows: int64 (m,), the place's map row that is most similar to the query.
        source: float64 (m, 3), meters, the query's centroid in the robot's frame.
        target: float64 (m, 3), meters, the row's centroid in the map's frame.
        weights: float64 (m,), more than 0.
        usable: number of queries that have candidates.
        sensor: float64 (3,), meters, sensor position in the robot's frame; None if it is not known.
        captures: float64 (m, 3), meters, sensor position in the map's frame from which the row was
            seen; None if it is not known.
    """

    queries: Int64
    places: Int64
    rows: Int64
    source: Float64
    target: Float64
    weights: Float64
    usable: int
    sensor: Float64 | None = None
    captures: Float64 | None = None

    def __len__(self) -> int:
        return len(self.queries)

    def take(self, indices: Int64) -> "Correspondences":
        """Return the correspondences at these indices, in this order."""
        return Correspondences(
            self.queries[indices],
            self.places[indices],
            self.rows[indices],
            self.source[indices],
            self.target[indices],
            self.weights[indices],
            self.usable,
            self.sensor,
            None if self.captures is None else self.captures[indices],
        )

    def seen_at(self, pose: Pose) -> "Correspondences":
        """Return them with the targets that the robot would see at a pose (see `view_shifts`)."""
        if self.sensor is None or self.captures is None:
            return self
        shifts = view_shifts(self.target, self.captures, pose.apply(self.sensor))
        return replace(self, target=self.target + shifts)


def correspond(candidates: Candidates, parameters: LocalizationParameters) -> Correspondences:
    """Return weighted pairs of queries and places, in an order independent of the queries' order.

    A map holds several views of a segment. A query's candidates at one place form one
    correspondence with the sum of their match probabilities. The weight is the log-likelihood ratio
    of "this is the right place" against chance:

        weight = log(1 + share / (unlikely * claims))

    `share` is the place's part of the query's total probability: a query with many similar
    candidates has a low weight. `claims` is the sum of all queries' shares of the place, at least
    1: a place that resembles many queries (repetitive segments) has a low weight, as in inverse
    document frequency.
    """
    beliefs = candidates.beliefs
    queries, columns = np.nonzero(beliefs)
    rows = candidates.rows[queries, columns]
    targets = candidates.places[queries, columns]
    captured = targets if candidates.captures is None else candidates.captures[queries, columns]
    belief = beliefs[queries, columns]
    if len(belief) > parameters.most_candidates:
        likeliest = np.lexsort((rows, -belief))[: parameters.most_candidates]
        queries, rows = queries[likeliest], rows[likeliest]
        targets, belief = targets[likeliest], belief[likeliest]
        captured = captured[likeliest]
    places = number_places(rows, targets, parameters.same_place)
    # The best row first within each pair of query and place; ties by row.
    order = np.lexsort((rows, -belief, places, queries))
    queries, places, rows = queries[order], places[order], rows[order]
    starts = np.flatnonzero(np.diff(queries, prepend=-1) | np.diff(places, prepend=-1))
    summed = np.add.reduceat(belief[order], starts) if len(starts) else np.zeros(0)
    queries, places, rows = queries[starts], places[starts], rows[starts]
    total = np.bincount(queries, summed, minlength=len(candidates))
    share = summed / total[queries]
    claims = np.bincount(places, share)[places]
    found = Correspondences(
        queries,
        places,
        rows,
        candidates.centroids[queries],
        targets[order][starts],
        np.log1p(share / (parameters.unlikely * np.maximum(claims, 1.0))),
        int(np.count_nonzero(total)),
        candidates.sensor,
        None if candidates.captures is None else captured[order][starts],
    )
    # Queries by position, not by number; each query's correspondences together, heaviest first.
    order = np.lexsort((found.rows, *found.source.T))
    rank = np.empty(len(candidates), dtype=np.int64)
    rank[found.queries[order][::-1]] = np.arange(len(order))[::-1]
    return found.take(np.lexsort((found.rows, -found.weights, rank[found.queries])))


def number_places(rows: Int64, centroids: Float64, radius: float) -> Int64:
    """Return the number of each row's place, int64 (m,).

    Rows are visited in the order of their coordinates. A row begins a new place unless it is within
    the radius of the first row of another place.

    Args:
        rows: int64 (m,), rows of the map, with repetitions.
        centroids: float64 (m, 3), meters, centroid of each row.
        radius: radius of a place, meters.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    _, first, inverse = np.unique(rows, return_index=True, return_inverse=True)
    points = centroids[first]
    order = np.lexsort(points.T[::-1])
    numbers = np.empty(len(points), dtype=np.int64)
    token = current()
    _lead(points[order], *neighboring(points[order], radius), radius, token.flag, numbers)
    token.check()
    places = np.empty(len(points), dtype=np.int64)
    places[order] = numbers
    return places[inverse]


@compiled
def _lead(
    points: Float64, cells: Int64, around: Int64, radius: float, flag: Int32, numbers: Int64
) -> None:
    """Fill `numbers` with the first leader within the radius of each point, in order.

    Leaders are at least the radius apart, so a cell holds few, and each point is compared with few.
    """
    heads = np.full(len(around), -1, dtype=np.int64)
    following = np.empty(len(points), dtype=np.int64)
    leaders = np.empty(len(points), dtype=np.int64)
    count = 0
    for point in range(len(points)):
        if is_cancelled(flag):
            return
        numbers[point] = -1
        for cell in around[cells[point]]:
            if cell < 0:
                break
            place = heads[cell]
            while place >= 0:
                squared = 0.0
                for axis in range(3):
                    squared += (points[point, axis] - points[leaders[place], axis]) ** 2
                if squared < radius * radius and not 0 <= numbers[point] < place:
                    numbers[point] = place
                place = following[place]
        if numbers[point] < 0:
            leaders[count] = point
            numbers[point] = count
            if np.isfinite(points[point]).all():  # else nothing is near it
                following[count] = heads[cells[point]]
                heads[cells[point]] = count
            count += 1
