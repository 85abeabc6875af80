"""Features of a segment's geometry for its class: size, height profile, surfaces and views.

A network of descriptors learns what tells two segments apart. A class follows from coarser facts,
which hold for all sensors: how high a segment reaches, how wide each height is, and whether its
points lie on walls, on poles or scattered like leaves. Local surfaces are judged in cells of
0.5 m and of 1 m by the variances of their points (Weinmann et al. 2014, *Semantic 3D scene
interpretation*).
"""

import numpy as np

from placecell.core.jit import compiled, compiled_part
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64, UInt64
from placecell.descriptors.class_views import VIEWS, views
from placecell.descriptors.neighborhood import SEED, slot_of

HEIGHTS = (0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 6.0)
"""Heights above the lowest point between the layers of the profile, meters."""

CELLS = (0.5, 1.0)
"""Edge lengths of the cells of local surfaces, meters."""

FEWEST = 4
"""Smallest number of points of a cell whose surface is judged."""

SURFACES = (
    "planar",
    "linear",
    "scattered",
    "upright plane",
    "level plane",
    "upright line",
    "thickness",
    "judged",
)
"""Values of a cell, averaged over the points of a segment."""

FEATURES = 17 + 2 * (len(HEIGHTS) + 1) + len(CELLS) * (len(SURFACES) + 2) + VIEWS
"""Number of features of a segment."""

VERSION = 1
"""Version of the features. A head states the version that it was trained with."""


def class_features(segments: Segments) -> Float32:
    """Return the features of each segment, float32 (segments, `FEATURES`).

    They do not depend on the frame's origin or on other segments, and hardly on its heading.
    """
    if not len(segments):
        return np.zeros((0, FEATURES), np.float32)
    points = np.ascontiguousarray(segments.points)
    centroids, ends, counts = segments.centroids(), segments.ends, segments.counts
    low, high = (bounds[:, 2] - centroids[:, 2] for bounds in segments.bounds())
    to_sensor = segments.sensors - centroids
    distance = np.linalg.norm(to_sensor, axis=1)
    covariance = np.zeros((len(segments), 3, 3))
    _second_moments(points, ends, centroids, covariance)
    values, vectors = np.linalg.eigh(covariance)
    deviations = np.sqrt(values.clip(min=0.0))
    level = np.linalg.eigvalsh(covariance[:, :2, :2]).clip(min=0.0) ** 0.5
    whole = np.stack(
        [
            np.log(counts),
            np.log(counts) + 2 * np.log(distance.clip(min=1.0)),
            np.log(distance.clip(min=1.0)),
            high - low,
            np.log(0.1 + high - low),
            low - to_sensor[:, 2],
            high - to_sensor[:, 2],
            np.log(0.05 + level[:, 0]),
            np.log(0.05 + level[:, 1]),
            level[:, 0] / level[:, 1].clip(min=0.05),
            np.log(0.05 + deviations[:, 0]),
            np.log(0.05 + np.sqrt(covariance[:, 2, 2])),
            *shape_of(deviations),
            np.abs(vectors[:, 2, 0]),
            np.abs(vectors[:, 2, 2]),
        ],
        axis=1,
    )
    layers = np.zeros((len(segments), 2, len(HEIGHTS) + 1))
    _profile(points, ends, centroids, np.array(HEIGHTS), layers)
    parts = [whole, layers.reshape(len(segments), -1)]
    for cell in CELLS:
        local = np.zeros((len(segments), len(SURFACES) + 2))
        _surfaces(points, ends, centroids, cell, SEED, local)
        parts.append(local)
    parts.append(views(points, ends, centroids, covariance, to_sensor))
    return np.concatenate(parts, axis=1).astype(np.float32)


def shape_of(deviations: Float64) -> tuple[Float64, Float64, Float64]:
    """Return linearity, planarity and scattering of ascending standard deviations (n, 3)."""
    small, middle, large = deviations.T
    length = large.clip(min=1e-6)
    return (large - middle) / length, (middle - small) / length, small / length


@compiled
def _second_moments(points: Float32, ends: Int64, centroids: Float64, covariance: Float64) -> None:
    """Fill the covariance of each segment's points, (segments, 3, 3), m^2."""
    start = 0
    for segment in range(len(ends)):
        for point in range(start, ends[segment]):
            for row in range(3):
                offset = points[point, row] - centroids[segment, row]
                for column in range(row, 3):
                    other = points[point, column] - centroids[segment, column]
                    covariance[segment, row, column] += offset * other
        for row in range(3):
            for column in range(row, 3):
                covariance[segment, row, column] /= ends[segment] - start
                covariance[segment, column, row] = covariance[segment, row, column]
        start = ends[segment]


@compiled
def _profile(
    points: Float32, ends: Int64, centroids: Float64, heights: Float64, layers: Float64
) -> None:
    """Fill the share of points and the width of each layer of height, (segments, 2, layers)."""
    count = len(heights) + 1
    number, x, y, squares = np.zeros(count), np.zeros(count), np.zeros(count), np.zeros(count)
    start = 0
    for segment in range(len(ends)):
        low = points[start, 2]
        for point in range(start, ends[segment]):
            low = min(low, points[point, 2])
        number[:], x[:], y[:], squares[:] = 0, 0, 0, 0
        for point in range(start, ends[segment]):
            above, layer = points[point, 2] - low, 0
            while layer < len(heights) and above >= heights[layer]:
                layer += 1
            dx = points[point, 0] - centroids[segment, 0]
            dy = points[point, 1] - centroids[segment, 1]
            number[layer] += 1
            x[layer] += dx
            y[layer] += dy
            squares[layer] += dx * dx + dy * dy
        for layer in range(count):
            layers[segment, 0, layer] = number[layer] / (ends[segment] - start)
            if number[layer]:
                mean = (x[layer] ** 2 + y[layer] ** 2) / number[layer] ** 2
                layers[segment, 1, layer] = np.sqrt(max(squares[layer] / number[layer] - mean, 0))
        start = ends[segment]


@compiled
def _surfaces(
    points: Float32,
    ends: Int64,
    centroids: Float64,
    cell: float,
    seed: UInt64,
    found: Float64,
) -> None:
    """Fill the mean local surface of each segment, (segments, SURFACES + 2).

    The last two values are the logarithm of the number of cells, and cells per column of cells.
    Cells are kept in a hash table, as in `placecell.descriptors.neighborhood`, and numbered in the
    order of their first points, so that the seed does not change the result.
    """
    longest, start = 1, 0
    for end in ends:
        longest, start = max(longest, end - start), end
    most = 1
    while most < 2 * longest:
        most *= 2
    keys, table = np.empty(most, np.int64), np.empty(most, np.int64)
    columns = np.empty(most, np.int64)
    sums = np.empty((longest, 10))
    moments = np.empty((3, 3))
    start = 0
    for segment in range(len(ends)):
        some = points[start : ends[segment]]
        cells, held = _gather(some, centroids[segment], cell, seed, keys, table, columns, sums)
        for number in range(cells):
            count = sums[number, 0]
            if count < FEWEST:
                continue
            mean = sums[number, 1:4] / count
            place = 4
            for row in range(3):
                for column in range(row, 3):
                    moments[row, column] = sums[number, place] / count - mean[row] * mean[column]
                    place += 1
            _judge(moments, cell, count / len(some), found[segment])
        found[segment, len(SURFACES)] = np.log(cells)
        found[segment, len(SURFACES) + 1] = cells / held
        start = ends[segment]


@compiled_part
def _gather(
    points: Float32,
    centroid: Float64,
    cell: float,
    seed: UInt64,
    keys: Int64,
    table: Int64,
    columns: Int64,
    sums: Float64,
) -> tuple[int, int]:
    """Sum the points of each cell of a segment; return the number of cells and of columns.

    Args:
        points: points of the segment.
        centroid: float64 (3,).
        cell: edge length of the cells, meters.
        seed: seed of the hash tables.
        keys, table, columns: memory of the hash tables.
        sums: number of points of each cell, sums of x, y, z, and sums of their products.
    """
    slots = 1
    while slots < 2 * len(points):
        slots *= 2
    table[:slots] = -1
    columns[:slots] = -1
    cells = held = 0
    at, index = np.empty(3), np.empty(3)
    for point in points:
        for axis in range(3):
            at[axis] = point[axis] - centroid[axis]
            index[axis] = min(max(np.floor(at[axis] / cell), -512.0), 511.0)
            # Relative to the middle of the cell, so that no digits are lost.
            at[axis] -= (index[axis] + 0.5) * cell
        column = ((int(index[0]) + 512) << 10) | (int(index[1]) + 512)
        key = (column << 10) | (int(index[2]) + 512)
        slot = slot_of(key, seed, slots)
        while table[slot] >= 0 and keys[slot] != key:
            slot = (slot + 1) & (slots - 1)
        if table[slot] < 0:
            table[slot], keys[slot] = cells, key
            sums[cells] = 0
            cells += 1
            tall = slot_of(column, seed, slots)
            while columns[tall] >= 0 and columns[tall] != column:
                tall = (tall + 1) & (slots - 1)
            held += columns[tall] < 0
            columns[tall] = column
        into = sums[table[slot]]
        into[0] += 1
        place = 4
        for row in range(3):
            into[1 + row] += at[row]
            for other in range(row, 3):
                into[place] += at[row] * at[other]
                place += 1
    return cells, held


@compiled_part
def _judge(moments: Float64, cell: float, weight: float, found: Float64) -> None:
    """Add the surface of a cell, of which `moments` has the upper triangle of the covariance."""
    xx, xy, xz = moments[0, 0], moments[0, 1], moments[0, 2]
    yy, yz, zz = moments[1, 1], moments[1, 2], moments[2, 2]
    # The eigenvalues of a symmetric matrix in closed form (Smith 1961).
    middle = (xx + yy + zz) / 3
    a, b, c = xx - middle, yy - middle, zz - middle
    spread = np.sqrt(max((a * a + b * b + c * c + 2 * (xy * xy + xz * xz + yz * yz)) / 6, 0.0))
    first = second = third = middle
    if spread > 0:
        product = a * b * c + 2 * xy * xz * yz - a * yz * yz - b * xz * xz - c * xy * xy
        angle = np.arccos(min(max(product / (2 * spread**3), -1.0), 1.0)) / 3
        third = middle + 2 * spread * np.cos(angle)
        first = middle + 2 * spread * np.cos(angle + 2 * np.pi / 3)
        second = 3 * middle - first - third
    small, large = np.sqrt(max(first, 0.0)), np.sqrt(max(third, 0.0))
    between = np.sqrt(max(second, 0.0))
    length = max(large, 1e-6)
    linear, planar, scattered = (large - between) / length, (between - small) / length, 0.0
    scattered = small / length
    # The vertical parts of the first and the last eigenvector follow from the eigenvalues of the
    # matrix and of its horizontal part (Denton et al. 2022, *Eigenvectors from eigenvalues*).
    trace, determinant = xx + yy, xx * yy - xy * xy
    upright = along = 0.0
    if (second - first) * (third - first) > 0:
        upright = (first * first - trace * first + determinant) / (
            (second - first) * (third - first)
        )
    if (third - second) * (third - first) > 0:
        along = (third * third - trace * third + determinant) / ((third - second) * (third - first))
    upright, along = np.sqrt(min(max(upright, 0.0), 1.0)), np.sqrt(min(max(along, 0.0), 1.0))
    found[0] += weight * planar
    found[1] += weight * linear
    found[2] += weight * scattered
    found[3] += weight * planar * (1 - upright)
    found[4] += weight * planar * upright
    found[5] += weight * linear * along
    found[6] += weight * small / cell
    found[7] += weight
