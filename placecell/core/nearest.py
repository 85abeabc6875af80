"""Nearest points of each of some places, within a radius."""

import numpy as np

from placecell.core.jit import compiled
from placecell.core.types import Float64, Int64

FARTHEST = 2.0**40
"""Largest number of a cell along an axis; farther points share the last cell."""


def nearest_within(
    places: Float64, points: Float64, radius: float, most: int
) -> tuple[Int64, Int64, Float64]:
    """Return the nearest points of each place, at most `most` of them.

    The time is linear in the number of points, as long as few places are near each other.

    Args:
        places: float64 (n, 3), meters, finite.
        points: float64 (m, 3), meters, finite.
        radius: distance below which a point is near, meters.
        most: largest number of points of a place.

    Returns:
        Indices into places, ascending, and into points, int64 (p,) each, and the distances,
        float64 (p,), meters, ascending for each place; the first point first among equal ones.
    """
    numbers = np.zeros((len(places), most), dtype=np.int64)
    squared = np.zeros((len(places), most))
    counts = np.zeros(len(places), dtype=np.int64)
    if len(places) and len(points):
        of_places, of_points = (
            np.floor(each[:, :2] / radius).clip(-FARTHEST, FARTHEST).astype(np.int64)
            for each in (places, points)
        )
        _collect(places, points, of_places, of_points, radius**2, numbers, squared, counts)
    kept = np.arange(most) < counts[:, None]
    return np.repeat(np.arange(len(places)), counts), numbers[kept], np.sqrt(squared[kept])


@compiled
def _collect(
    places: Float64,
    points: Float64,
    of_places: Int64,
    of_points: Int64,
    limit: float,
    numbers: Int64,
    squared: Float64,
    counts: Int64,
) -> None:
    """Fill the nearest points of each place, their squared distances and their number.

    The horizontal cells of the places are in a hash table. Each point looks at nine cells.
    """
    slots = 64
    while slots < 4 * len(places):
        slots *= 2
    heads = np.full(slots, -1, dtype=np.int64)
    following = np.empty(len(places), dtype=np.int64)
    for place in range(len(places)):
        slot = (31 * of_places[place, 0] + of_places[place, 1]) & (slots - 1)
        following[place] = heads[slot]
        heads[slot] = place
    most = numbers.shape[1]
    for point in range(len(points)):
        for around in range(9):
            x = of_points[point, 0] + around // 3 - 1
            y = of_points[point, 1] + around % 3 - 1
            place = heads[(31 * x + y) & (slots - 1)]
            while place >= 0:
                if of_places[place, 0] == x and of_places[place, 1] == y:
                    distance = 0.0
                    for axis in range(3):
                        distance += (places[place, axis] - points[point, axis]) ** 2
                    at = counts[place]
                    if distance < limit and (at < most or distance < squared[place, most - 1]):
                        if at < most:
                            counts[place] += 1
                        else:
                            at -= 1
                        while at > 0 and squared[place, at - 1] > distance:
                            squared[place, at] = squared[place, at - 1]
                            numbers[place, at] = numbers[place, at - 1]
                            at -= 1
                        squared[place, at] = distance
                        numbers[place, at] = point
                place = following[place]
