"""Region growing on Euclidean distance (paper III-A).

Points are sorted into cells so small that all points of a cell are linked. Then only cells are
joined: two cells near each other are compared, point by point, only if they are not yet in one
region.
"""

from dataclasses import dataclass

import numpy as np

from placecell.core.jit import compiled, compiled_part
from placecell.core.parameters import Parameters
from placecell.core.radix_sort import stable_order
from placecell.core.types import Float32, Int64

CELL_SHARE = 0.56
"""Edge length of a cell, relative to the radius. The diagonal of a cell is shorter than the radius
(0.56 sqrt(3) < 1), and linked points are at most two cells apart along each axis (1 < 2 * 0.56)."""


def grow_regions(points: Float32, radius: float) -> Int64:
    """Label the connected regions of points. Points within the radius of each other are connected.

    Args:
        points: float32 (n, 3), meters.
        radius: largest distance of connected points, meters.

    Returns:
        int64 (n,), labels from 0, in the order of each region's first point.
    """
    if not len(points):
        return np.zeros(0, dtype=np.int64)
    points = np.ascontiguousarray(points)
    keys, rows, layers = _cell_keys(points, CELL_SHARE * radius)
    return _label(points, keys, stable_order(keys), rows, layers, radius * radius)


@compiled
def _cell_keys(points: Float32, size: float) -> tuple[Int64, int, int]:
    """Return the key of each point's cell, and the number of rows and layers of the cells."""
    count = len(points)
    cells = np.empty((3, count), np.int64)
    for axis in range(3):
        for point in range(count):
            cells[axis, point] = np.int64(np.floor(points[point, axis] / size))
        # Two empty layers around, so that a neighbor's key never wraps into another column.
        cells[axis] -= cells[axis].min() - 2
    rows, layers = cells[1].max() + 3, cells[2].max() + 3
    return (cells[0] * rows + cells[1]) * layers + cells[2], rows, layers


@compiled_part
def _find(parent: Int64, index: int) -> int:
    while parent[index] != index:
        parent[index] = parent[parent[index]]
        index = parent[index]
    return index


@compiled
def _label(
    points: Float32, keys: Int64, order: Int64, rows: int, layers: int, squared_radius: float
) -> Int64:
    """Return the label of each point's region: union-find over cells in the order of their keys."""
    count = len(order)
    ordered = np.empty((count, 3), np.float32)
    starts = np.empty(count + 1, np.int64)
    cells = np.empty(count, np.int64)
    cell_of = np.empty(count, np.int32)
    filled = 0
    for place in range(count):
        row = order[place]
        ordered[place, 0] = points[row, 0]
        ordered[place, 1] = points[row, 1]
        ordered[place, 2] = points[row, 2]
        if filled == 0 or keys[row] != cells[filled - 1]:
            cells[filled] = keys[row]
            starts[filled] = place
            filled += 1
        cell_of[row] = filled - 1
    starts[filled] = count
    parent = _join(ordered, starts, cells[:filled], rows, layers, squared_radius)
    # Cells are not in the order of the points: label each region by its first point.
    label_of = np.full(filled, -1, np.int64)
    labels = np.empty(count, np.int64)
    found = 0
    for row in range(count):
        root = _find(parent, cell_of[row])
        if label_of[root] < 0:
            label_of[root] = found
            found += 1
        labels[row] = label_of[root]
    return labels


@compiled_part
def _join(
    points: Float32, starts: Int64, cells: Int64, rows: int, layers: int, squared_radius: float
) -> Int64:
    """Return the parent of each cell in its region; roots are their own parents.

    Args:
        points: float32 (n, 3), in the order of their cells, meters.
        starts: int64 (cells + 1,), first point of each cell.
        cells: int64 (cells,), ascending keys.
        rows: number of rows of the cells.
        layers: number of layers of the cells.
        squared_radius: squared radius, square meters.
    """
    parent, root = np.arange(len(cells)), np.empty(len(cells), np.int64)
    columns, firsts = np.empty(len(cells), np.int64), np.empty(len(cells) + 1, np.int64)
    count = 0
    for cell in range(len(cells)):
        if count == 0 or cells[cell] // layers != columns[count - 1]:
            columns[count], firsts[count] = cells[cell] // layers, cell
            count += 1
    firsts[count] = len(cells)
    common = np.empty(count, np.int64)
    # The columns next to a cell first. They join nearly all that belongs together, so that most
    # columns farther apart, and most pairs of the others, are skipped by comparing known roots.
    for reach in range(3):
        _find_roots(parent, firsts, root, common)
        for row_step in range(-reach, 1):
            for column_step in range(-reach, reach + 1):
                step = row_step * rows + column_step
                if step > 0 or max(abs(row_step), abs(column_step)) < reach:
                    continue  # each pair of columns is visited once
                if reach == 1:  # these steps join most
                    _find_roots(parent, firsts, root, common)
                near = 0
                for column in range(count):
                    while columns[near] < columns[column] + step:
                        near += 1
                    is_joined = common[column] >= 0 and common[column] == common[near]
                    if columns[near] == columns[column] + step and not is_joined:
                        _unite_columns(
                            points, starts, cells, firsts, column, near, step * layers, root,
                            parent, squared_radius,
                        )  # fmt: skip
    return parent


@compiled_part
def _find_roots(parent: Int64, firsts: Int64, root: Int64, common: Int64) -> None:
    """Fill the root of each cell, and of all cells of a column; -1 if these have several."""
    for column in range(len(common)):
        common[column] = _find(parent, firsts[column])
        for cell in range(firsts[column], firsts[column + 1]):
            root[cell] = _find(parent, cell)
            if root[cell] != common[column]:
                common[column] = -1


@compiled_part
def _unite_columns(
    points: Float32,
    starts: Int64,
    cells: Int64,
    firsts: Int64,
    column: int,
    near: int,
    step: int,
    root: Int64,
    parent: Int64,
    squared_radius: float,
) -> None:
    """Join the regions of the cells of two columns that are two layers apart at most."""
    low, end = firsts[near], firsts[near + 1]
    for cell in range(firsts[column], firsts[column + 1]):
        lowest = cells[cell] + step - 2
        while low < end and cells[low] < lowest:
            low += 1
        other = low
        while other < end and other < cell and cells[other] <= lowest + 4:
            if root[cell] != root[other]:
                _unite(points, starts, cell, other, parent, squared_radius)
            other += 1


@compiled_part
def _unite(
    points: Float32, starts: Int64, cell: int, other: int, parent: Int64, squared_radius: float
) -> None:
    """Join the regions of two cells if they are not one yet and the cells are linked."""
    a, b = _find(parent, cell), _find(parent, other)
    if a == b:
        return
    for i in range(starts[cell], starts[cell + 1]):
        for j in range(starts[other], starts[other + 1]):
            dx = points[i, 0] - points[j, 0]
            dy = points[i, 1] - points[j, 1]
            dz = points[i, 2] - points[j, 2]
            if dx * dx + dy * dy + dz * dz <= squared_radius:
                parent[max(a, b)] = min(a, b)
                return


@dataclass(frozen=True, slots=True, eq=False)
class Regions:
    """Connected regions of points, in the order of their first points.

    Attributes:
        members: int64 (n,), indices of the points, region by region, ascending in each.
        counts: int64 (regions,), number of points of each region.
    """

    members: Int64
    counts: Int64

    def take(self, regions: Int64) -> Int64:
        """Return the points of some regions, region by region, int64 (m,).

        Args:
            regions: int64 (k,), ascending.
        """
        is_taken = np.zeros(len(self.counts), dtype=bool)
        is_taken[regions] = True
        return np.asarray(self.members[np.repeat(is_taken, self.counts)])


def find_regions(points: Float32, radius: float) -> Regions:
    """Return the connected regions of points (see `grow_regions`)."""
    labels = grow_regions(points, radius)
    counts = np.bincount(labels)
    return Regions(_members(labels, counts), counts)


@compiled
def _members(labels: Int64, counts: Int64) -> Int64:
    """Return the points in the order of their labels: a counting sort."""
    places = np.empty(len(counts), np.int64)
    total = 0
    for label in range(len(counts)):
        places[label] = total
        total += counts[label]
    members = np.empty(len(labels), np.int64)
    for row in range(len(labels)):
        members[places[labels[row]]] = row
        places[labels[row]] += 1
    return members


def segment_indices(points: Float32, parameters: Parameters) -> list[Int64]:
    """Return the point indices of each region within the size limits, ordered by first point."""
    regions = find_regions(points, parameters.growing_radius)
    counts = regions.counts
    wanted = np.flatnonzero((counts >= parameters.min_points) & (counts <= parameters.max_points))
    return list(np.split(regions.take(wanted), np.cumsum(counts[wanted]))[:-1])
