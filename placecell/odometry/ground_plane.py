"""Ground plane in one scan: the height and the tilt of the sensor.

The ground is the plane below the sensor that many points lie on and few points lie under, and that
is mostly free: a wall's lower edge lies in a plane too, but has the wall above it. Directions of up
are tried in steps of a few degrees, and heights by counting points, so that the result needs no
random numbers and no guess of the mount. The best candidates are refined by least squares.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from placecell.core.types import Bool, Float32, Float64

LARGEST_TILT = 42.0
"""Largest angle between the ground's normal and the expected direction of up, degrees."""
HEIGHTS = (0.1, 6.0)
"""Lowest and highest position of a sensor above the ground, meters."""
RADII = (12.0, 24.0, 48.0)
"""Distances from the sensor in which the ground is sought, one after the other, meters. The
nearest ground counts; a sparse sensor that is mounted high sees none nearby."""
FEWEST_CELLS = 40
"""Smallest number of free ground cells: 3.6 square meters."""
ENOUGH_AREA = 15.0
"""Free ground that ends the search, square meters; with less a larger distance is tried too."""
SEARCHED_CELLS = 3000
"""Largest number of cells that directions are scored on."""
CELL = 0.3
"""Edge length of the cells that count as one point, meters: near rings weigh no more."""
STEP = 4.0
"""Angle between neighboring directions of the search, degrees."""
HEIGHT_BIN = 0.05
"""Step of the heights of the search, meters."""
TOLERANCE = 0.1
"""Largest distance of a ground point from the plane, meters."""
SLOPE_TOLERANCE = float(np.sin(np.radians(STEP * 0.6)))
"""Additional tolerance of the search per meter of distance."""
BELOW = 0.2
"""Depth from which a point is below the ground, beyond the tolerance, meters."""
ABOVE = (0.25, 1.5)
"""Heights above the ground at which a point makes its cell an object's, meters."""
CANDIDATES = 6
LARGEST_BELOW = 0.5
"""Largest number of cells below the ground for each free ground cell."""
NARROWEST = 0.35
"""Smallest standard deviation of the ground's cells across their main direction, meters."""

UP = (0.0, 0.0, 1.0)


class NoGroundError(ValueError):
    """No ground is seen; the message says why."""


@dataclass(frozen=True, slots=True)
class GroundPlane:
    """Ground plane in the sensor's frame.

    Attributes:
        up: direction of up, unit vector, float64 (3,).
        height: height of the sensor above the plane, meters.
        area: area of the free ground that was seen, square meters.
        deviation: standard deviation of the ground's cells of 0.3 m from the plane, meters.
    """

    up: Float64
    height: float
    area: float
    deviation: float

    @property
    def tilt_deg(self) -> float:
        """Angle between the sensor's z axis and up, degrees."""
        return float(np.degrees(np.arccos(np.clip(self.up[2], -1.0, 1.0))))


def find_ground(points: Float32, expected_up: Sequence[float] = UP) -> GroundPlane:
    """Find the ground in one scan.

    Args:
        points: float32 (n, 3), meters, in the sensor's frame; all finite.
        expected_up: direction in the sensor's frame near which up is sought.

    Raises:
        NoGroundError: no plane in the scan can be the ground.
    """
    toward = np.asarray(expected_up, dtype=np.float64)
    turn = rotation_between(toward / np.linalg.norm(toward), np.array(UP))
    with np.errstate(over="ignore"):  # A damaged scan may have points at any distance.
        ranges = np.linalg.norm(points, axis=1)
    best: GroundPlane | None = None
    reason = f"fewer than {FEWEST_CELLS} points within {RADII[-1]:g} m"
    for radius in RADII:
        near = points[(ranges <= radius) & (ranges > HEIGHTS[0])].astype(np.float64) @ turn.T
        if len(near) < FEWEST_CELLS:
            continue
        cells = cell_means(near, CELL)
        for candidate in search(cell_means(cells, 2 * CELL)):
            found = refine(cells, *candidate)
            if isinstance(found, str):
                reason = found
            elif best is None or found.area > best.area:
                best = found
        if best is not None and best.area >= ENOUGH_AREA:
            break
    if best is None:
        raise NoGroundError(f"No ground was found below the sensor: {reason}.")
    return GroundPlane(turn.T @ best.up, best.height, best.area, best.deviation)


def find_common_ground(scans: Sequence[Float32], expected_up: Sequence[float] = UP) -> GroundPlane:
    """Find the ground that most of several scans agree on; the sensor's mount is the same.

    A street's slope tilts single scans; over a drive the slopes even out.

    Args:
        scans: float32 (n, 3) each, meters, in the sensor's frame.
        expected_up: direction in the sensor's frame near which up is sought.

    Raises:
        NoGroundError: a ground is seen in fewer than half of the scans.
    """
    found: list[GroundPlane] = []
    reasons: list[str] = []
    for points in scans:
        try:
            found.append(find_ground(points, expected_up))
        except NoGroundError as error:
            reasons.append(str(error))
    if not found or len(found) < len(reasons):
        reason = max(set(reasons), key=reasons.count) if reasons else "There is no scan."
        raise NoGroundError(f"Ground in {len(found)} of {len(scans)} scans. {reason}")
    ups = np.stack([ground.up for ground in found])
    # The direction that is closest to all others is no outlier; those near it are averaged.
    angles = np.arccos(np.clip(ups @ ups.T, -1.0, 1.0))
    center = int(np.median(angles, axis=1).argmin())
    close = angles[center] <= max(2 * float(np.median(angles[center])), np.radians(1.0))
    up = ups[close].sum(axis=0)
    return GroundPlane(
        up / np.linalg.norm(up),
        float(np.median([ground.height for ground in found])),
        float(np.median([ground.area for ground in found])),
        float(np.median([ground.deviation for ground in found])),
    )


def rotation_between(one: Float64, other: Float64) -> Float64:
    """Return the smallest rotation that turns one unit vector into another, float64 (3, 3)."""
    cosine = float(one @ other)
    if cosine < -1 + 1e-9:  # half a turn, around any axis across
        across = np.cross(one, np.eye(3)[int(np.abs(one).argmin())])
        across /= np.linalg.norm(across)
        return np.asarray(2 * np.outer(across, across) - np.eye(3))
    x, y, z = np.cross(one, other)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + cross + cross @ cross / (1 + cosine))


def cell_means(points: Float64, cell: float) -> Float64:
    """Return the mean of the points in each occupied cubic cell, float64 (cells, 3)."""
    cells = np.floor(points / cell).astype(np.int64)
    cells -= cells.min(axis=0)
    size = cells.max(axis=0) + 1
    keys = (cells[:, 0] * size[1] + cells[:, 1]) * size[2] + cells[:, 2]
    _, inverse, counts = np.unique(keys, return_inverse=True, return_counts=True)
    sums = [np.bincount(inverse, points[:, axis], len(counts)) for axis in range(3)]
    return np.stack(sums, axis=1) / counts[:, None]


@cache
def directions() -> Float64:
    """Return directions of up within the largest tilt, evenly spaced, float64 (n, 3)."""
    rings = [np.array([UP])]
    for tilt in np.radians(np.arange(STEP, LARGEST_TILT + STEP / 2, STEP)):
        count = int(np.ceil(2 * np.pi * np.sin(tilt) / np.radians(STEP)))
        around = 2 * np.pi * np.arange(count) / count
        flat = np.sin(tilt) * np.stack([np.cos(around), np.sin(around)], axis=1)
        rings.append(np.column_stack([flat, np.full(count, np.cos(tilt))]))
    return np.concatenate(rings)


def search(points: Float64) -> list[tuple[Float64, float]]:
    """Return the best directions of up, each with the sensor's height, the best one first.

    A direction and a height score the points near their plane, less the points below it.
    """
    ups = directions()
    points = points[:: -(-len(points) // SEARCHED_CELLS)]
    bins = round((HEIGHTS[1] - HEIGHTS[0]) / HEIGHT_BIN)
    depths = -points @ ups.T
    tolerance = (TOLERANCE + SLOPE_TOLERANCE * np.linalg.norm(points, axis=1))[:, None]
    # Each point counts for the heights from `first` to `last`, against those below `under`.
    first, last, under = (
        np.clip(np.ceil((each - HEIGHTS[0]) / HEIGHT_BIN), 0, bins).astype(np.int64)
        for each in (depths - tolerance, depths + tolerance, depths - tolerance - BELOW)
    )
    rows = (bins + 1) * np.arange(len(ups))
    steps = np.zeros(len(ups) * (bins + 1), dtype=np.int64)
    for edge, change in ((first, 1), (last, -1), (under, 1)):
        steps += change * np.bincount((rows + edge).ravel(), minlength=len(steps))
    scores = steps.reshape(len(ups), bins + 1).cumsum(axis=1)[:, :bins] - len(points)
    best = scores.argmax(axis=1)
    order = np.argsort(-scores[np.arange(len(ups)), best], kind="stable")
    chosen: list[tuple[Float64, float]] = []
    for index in order:
        height = HEIGHTS[0] + HEIGHT_BIN * (int(best[index]) + 0.5)
        similar = any(
            up @ ups[index] > np.cos(np.radians(1.5 * STEP)) and abs(height - other) < 3 * BELOW
            for up, other in chosen
        )
        if not similar:
            chosen.append((ups[index], height))
        if len(chosen) == CANDIDATES:
            break
    return chosen


def refine(cells: Float64, up: Float64, height: float) -> GroundPlane | str:
    """Fit the plane to the cells near it; return why it cannot be the ground otherwise."""
    tolerance = TOLERANCE + SLOPE_TOLERANCE * np.linalg.norm(cells, axis=1)
    for _ in range(10):
        on = np.abs(cells @ up + height) < tolerance
        if np.count_nonzero(on) < FEWEST_CELLS / 2:
            return f"only {np.count_nonzero(on)} cells of {CELL} m lie in one plane below it"
        up, height = fit_plane(cells[on])
        tolerance = np.maximum(tolerance / 1.6, TOLERANCE)
    if up[2] < np.cos(np.radians(LARGEST_TILT)) or not HEIGHTS[0] <= height <= HEIGHTS[1]:
        return "the planes in the scan are walls, or at an odd height"
    above = cells @ up + height
    on = np.abs(above) < TOLERANCE
    free = on & ~beneath(cells, above, on, up)
    count = int(np.count_nonzero(free))
    if count < FEWEST_CELLS:
        return f"only {count} free cells of {CELL} m lie in one plane below it"
    below = np.count_nonzero(above < -TOLERANCE - BELOW)
    if below > LARGEST_BELOW * count:
        return "many points lie below each plane"
    up, height = fit_plane(cells[free])
    spread = np.sqrt(np.maximum(np.linalg.eigvalsh(np.cov(cells[free].T)), 0.0))
    if spread[1] < NARROWEST:
        return "its points lie in one line"
    deviation = float(np.std(cells[free] @ up + height))
    return GroundPlane(up, height, (count - int(below)) * CELL**2, deviation)


def fit_plane(points: Float64) -> tuple[Float64, float]:
    """Fit a plane by least squares; return its normal, z not negative, and the sensor's height."""
    mean = points.mean(axis=0)
    _, vectors = np.linalg.eigh(np.cov((points - mean).T))
    up = vectors[:, 0] if vectors[2, 0] >= 0 else -vectors[:, 0]
    return up, float(-up @ mean)


def beneath(cells: Float64, above: Float64, on: Bool, up: Float64) -> Bool:
    """Return whether each cell has an object right above the ground in it, bool (n,)."""
    level = cells @ rotation_between(up, np.array(UP)).T
    columns = np.floor(level[:, :2] / CELL).astype(np.int64)
    columns -= columns.min(axis=0)
    keys = columns[:, 0] * (columns[:, 1].max() + 1) + columns[:, 1]
    objects = (above > ABOVE[0]) & (above < ABOVE[1])
    return np.asarray(on & np.isin(keys, keys[objects]))
