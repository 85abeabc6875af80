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

CELLS = SMALL, LARGE = 0.5, 1.0
"""Edge lengths of the cells of local surfaces, meters: powers of two, one twice the other."""

REACH = 512.0
"""Number of cells from the centroid to either side. Farther points share the last cell."""

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
    surfaces = np.zeros((len(segments), len(CELLS), len(SURFACES) + 2))
    _surfaces(points, ends, centroids, SEED, surfaces)
    parts.append(surfaces.reshape(len(segments), -1))
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
            for height in heights:  # without a branch: successive points are at many heights
                layer += int(above >= height)
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
    points: Float32, ends: Int64, centroids: Float64, seed: UInt64, found: Float64
) -> None:
    """Fill the mean local surfaces of each segment, (segments, cell sizes, SURFACES + 2).

    The last two values are the logarithm of the number of cells, and cells per column of cells.
    Cells are kept in a hash table, as in `placecell.descriptors.neighborhood`, and numbered in the
    order of their first points, so that the seed does not change the result. Eight small cells are
    a large one: the points are read once.
    """
    longest, start = 1, 0
    for end in ends:
        longest, start = max(longest, end - start), end
    most = 1
    while most < 2 * longest:
        most *= 2
    memory = (np.empty(most, np.int64), np.empty(most, np.int64), np.empty(most, np.int64))
    small, large = np.empty((longest, 10)), np.empty((longest, 10))
    small_keys, large_keys = np.empty(longest, np.int64), np.empty(longest, np.int64)
    start = 0
    for segment in range(len(ends)):
        some, centroid = points[start : ends[segment]], centroids[segment]
        cells, held, inside = _gather(some, centroid, SMALL, seed, memory, small_keys, small)
        _average(small[:cells], held, SMALL, len(some), found[segment, 0])
        if inside:
            cells, held = _merge(small_keys[:cells], small, seed, memory, large_keys, large)
        else:
            cells, held, _ = _gather(some, centroid, LARGE, seed, memory, large_keys, large)
        _average(large[:cells], held, LARGE, len(some), found[segment, 1])
        start = ends[segment]


@compiled_part
def _gather(
    points: Float32,
    centroid: Float64,
    cell: float,
    seed: UInt64,
    memory: tuple[Int64, Int64, Int64],
    keys: Int64,
    sums: Float64,
) -> tuple[int, int, bool]:
    """Sum the points of each cell of a segment.

    Args:
        points: points of the segment.
        centroid: float64 (3,).
        cell: edge length of the cells, a power of two, meters.
        seed: seed of the hash tables.
        memory: memory of the hash tables (see `_number`).
        keys: key of each cell, filled by this function.
        sums: number of points of each cell, sums of x, y, z, and sums of their products, relative
            to the middle of the cell so that no digits are lost; filled by this function.

    Returns:
        Number of cells, number of columns, and whether all cells are within reach of the keys.
    """
    slots = _cleared(len(points), memory)
    cells = held = number = 0
    last, inside, inverse = -1, True, 1 / cell
    for point in range(len(points)):
        x = points[point, 0] - centroid[0]
        y = points[point, 1] - centroid[1]
        z = points[point, 2] - centroid[2]
        column, row, layer = np.floor(x * inverse), np.floor(y * inverse), np.floor(z * inverse)
        if not (abs(column) < REACH and abs(row) < REACH and abs(layer) < REACH):
            inside = False
            column = min(max(column, -REACH), REACH - 1.0)
            row = min(max(row, -REACH), REACH - 1.0)
            layer = min(max(layer, -REACH), REACH - 1.0)
        x -= (column + 0.5) * cell
        y -= (row + 0.5) * cell
        z -= (layer + 0.5) * cell
        key = (((int(column) + 512) << 10 | (int(row) + 512)) << 10) | (int(layer) + 512)
        if key != last:
            number, new_column = _number(key, cells, seed, slots, memory)
            if number == cells:
                keys[cells], sums[cells] = key, 0
                cells += 1
                held += new_column
            last = key
        into = sums[number]
        into[0] += 1
        into[1] += x
        into[2] += y
        into[3] += z
        into[4] += x * x
        into[5] += x * y
        into[6] += x * z
        into[7] += y * y
        into[8] += y * z
        into[9] += z * z
    return cells, held, inside


@compiled_part
def _merge(
    small_keys: Int64,
    small: Float64,
    seed: UInt64,
    memory: tuple[Int64, Int64, Int64],
    keys: Int64,
    sums: Float64,
) -> tuple[int, int]:
    """Sum the small cells of each large one (see `_gather`); return the numbers as there."""
    slots = _cleared(len(small_keys), memory)
    cells = held = 0
    for cell in range(len(small_keys)):
        column, row = small_keys[cell] >> 20, (small_keys[cell] >> 10) & 1023
        layer = small_keys[cell] & 1023
        # Keys count from -512, so that halves are rounded down.
        key = ((((column >> 1) + 256) << 10 | ((row >> 1) + 256)) << 10) | ((layer >> 1) + 256)
        number, new_column = _number(key, cells, seed, slots, memory)
        if number == cells:
            keys[cells], sums[cells] = key, 0
            cells += 1
            held += new_column
        # From the middle of the small cell to that of the large one.
        x, y, z = (
            ((column & 1) - 0.5) * SMALL,
            ((row & 1) - 0.5) * SMALL,
            ((layer & 1) - 0.5) * SMALL,
        )
        count, of_x, of_y, of_z = small[cell, 0], small[cell, 1], small[cell, 2], small[cell, 3]
        into = sums[number]
        into[0] += count
        into[1] += of_x + count * x
        into[2] += of_y + count * y
        into[3] += of_z + count * z
        into[4] += small[cell, 4] + 2 * x * of_x + count * x * x
        into[5] += small[cell, 5] + x * of_y + y * of_x + count * x * y
        into[6] += small[cell, 6] + x * of_z + z * of_x + count * x * z
        into[7] += small[cell, 7] + 2 * y * of_y + count * y * y
        into[8] += small[cell, 8] + y * of_z + z * of_y + count * y * z
        into[9] += small[cell, 9] + 2 * z * of_z + count * z * z
    return cells, held


@compiled_part
def _cleared(count: int, memory: tuple[Int64, Int64, Int64]) -> int:
    """Clear the hash tables for a number of keys; return their number of slots."""
    slots = 1
    while slots < 2 * count:
        slots *= 2
    memory[1][:slots] = -1
    memory[2][:slots] = -1
    return slots


@compiled_part
def _number(
    key: int, unused: int, seed: UInt64, slots: int, memory: tuple[Int64, Int64, Int64]
) -> tuple[int, bool]:
    """Return the number of a cell, and whether its column is new.

    Args:
        key: key of the cell.
        unused: number for a cell that is new.
        seed: seed of the hash tables.
        slots: number of slots.
        memory: keys and numbers of cells, and keys of columns, by slot.
    """
    keys, numbers, columns = memory
    slot = slot_of(key, seed, slots)
    while numbers[slot] >= 0 and keys[slot] != key:
        slot = (slot + 1) & (slots - 1)
    if numbers[slot] >= 0:
        return numbers[slot], False
    numbers[slot], keys[slot] = unused, key
    column = key >> 10
    slot = slot_of(column, seed, slots)
    while columns[slot] >= 0 and columns[slot] != column:
        slot = (slot + 1) & (slots - 1)
    is_new = columns[slot] < 0
    columns[slot] = column
    return unused, is_new


@compiled_part
def _average(sums: Float64, held: int, cell: float, points: int, found: Float64) -> None:
    """Fill the mean local surface of a segment, (SURFACES + 2,).

    Args:
        sums: sums of each cell (see `_gather`).
        held: number of columns.
        cell: edge length of the cells, meters.
        points: number of points of the segment.
        found: mean surface, filled by this function.
    """
    moments = np.empty((3, 3))
    for number in range(len(sums)):
        count = sums[number, 0]
        if count < FEWEST:
            continue
        mean = sums[number, 1:4] / count
        place = 4
        for row in range(3):
            for column in range(row, 3):
                moments[row, column] = sums[number, place] / count - mean[row] * mean[column]
                place += 1
        _judge(moments, cell, count / points, found)
    found[len(SURFACES)] = np.log(len(sums))
    found[len(SURFACES) + 1] = len(sums) / held


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
