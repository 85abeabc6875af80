"""Voxel map: the points of the last scans near the sensor, one mean in each voxel.

It is updated scan by scan. The voxels are in ascending order, and so are the points of each scan.
So a scan's points are added, and those of the oldest scan removed, in one pass over the voxels.
Points also leave when the sensor moves away from them, and come back when it returns.

The sums are float64 and the coordinates float32. So sums are exact, whatever was added and removed,
unless one coordinate is far smaller than another one of its voxel. Such a voxel is summed anew from
its points. So the means are those of a map that is built anew.
"""

from collections import deque
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from placecell.core.jit import compiled, compiled_part
from placecell.core.radix_sort import stable_order
from placecell.core.types import Bool, Float32, Float64, Int32, Int64

BLOCK = 64
"""Number of successive points of a scan that share one lower and upper bound of their distance."""

LAST = np.iinfo(np.int64).max
"""Key behind all others."""

BITS = 21
"""Bits of a key for each axis: the cells within 100 km of the origin, if a voxel is 0.1 m."""

JUMP = 1000.0
"""Distance between two sensor positions, meters, from which the map begins anew."""


Stream = tuple[Int64, Float32, Bool]
"""Ascending keys of points, int64 (n,), the points, float32 (n, 3), and their flags, bool (n,)."""


class Voxels(NamedTuple):
    """Columns of voxels, in ascending order of their keys.

    Attributes:
        keys: int64 (n,), number of each voxel in the order of x, then y, then z.
        sums: float64 (n, 4), sums of x, y, z of the points, and the number of points.
        means: float32 (n, 3), mean point, meters.
        labels: int32 (n,), number that a user of the map gave to the voxel; -1 for a new voxel.
        is_rounded: bool (n,), whether the sums of x, y, z are not exact.
    """

    keys: Int64
    sums: Float64
    means: Float32
    labels: Int32
    is_rounded: Bool

    @classmethod
    def empty(cls, count: int) -> "Voxels":
        """Return columns for some voxels, with any values."""
        return cls(
            np.empty(count, np.int64),
            np.empty((count, 4)),
            np.empty((count, 3), np.float32),
            np.empty(count, np.int32),
            np.empty(count, np.bool_),
        )


@dataclass(frozen=True, slots=True, eq=False)
class SortedScan:
    """Points of a scan in the order of their voxels.

    Attributes:
        points: float32 (n, 3), meters, world frame.
        keys: int64 (n,), ascending number of each point's voxel.
        is_inside: bool (n,), whether each point is in the map.
        bounds: float32 (blocks, 2), smallest and largest horizontal distance of the points of each
            block from `sensor`, meters.
        sensor: float64 (3,), sensor position of the scan, meters.
    """

    points: Float32
    keys: Int64
    is_inside: Bool
    bounds: Float32
    sensor: Float64


class VoxelMap:
    """Voxels that hold the points of the last scans within a horizontal radius of the sensor.

    Attributes:
        voxel: edge length of a voxel, meters. The grid is aligned with the world frame.
        radius: horizontal radius around the sensor, meters.
        limit: number of scans in the map.
    """

    def __init__(self, voxel: float, radius: float, limit: int) -> None:
        self.voxel = voxel
        self.radius = radius
        self.limit = limit
        self.clear()

    def __len__(self) -> int:
        return self._count

    def clear(self) -> None:
        """Remove all scans."""
        self._scans = deque[SortedScan]()
        self._count = 0
        self._voxels, self._spare = Voxels.empty(0), Voxels.empty(0)
        self._origin = self._cell = np.zeros(3, dtype=np.int64)

    @property
    def means(self) -> Float32:
        """Mean point of each voxel, float32 (voxels, 3), in the order of x, then y, then z.

        The array changes with the next scan.
        """
        return self._voxels.means[: self._count]

    @property
    def labels(self) -> Int32:
        """Number that the user of the map gave to each voxel, int32 (voxels,); -1 if none."""
        return self._voxels.labels[: self._count]

    @property
    def nbytes(self) -> int:
        """Memory of the map, bytes."""
        arrays: list[NDArray[Any]] = [*self._voxels, *self._spare]
        for scan in self._scans:
            arrays += [scan.points, scan.keys, scan.is_inside, scan.bounds]
        return sum(array.nbytes for array in arrays)

    def add(self, points: Float32, sensor: Float64) -> None:
        """Add a scan, move the map to its sensor position, and remove the scan that is too old.

        Args:
            points: float32 (n, 3), meters, world frame.
            sensor: float64 (3,), position, meters, world frame.
        """
        sensor = np.array(sensor, dtype=np.float64)
        self._prepare(np.floor(sensor / self.voxel).astype(np.int64))
        center = sensor[:2].astype(np.float32)
        squared_radius = np.float32(self.radius**2)
        flipped = self._flip(center, squared_radius)
        new = self._sorted(points, sensor, squared_radius)
        self._scans.append(new)
        is_full = len(self._scans) > self.limit
        old = self._scans.popleft() if is_full else self._sorted(points[:0], sensor, squared_radius)
        largest = self._count + len(new.points) + len(flipped[0])
        if largest > len(self._spare.keys):
            self._spare = Voxels.empty(largest + largest // 4)
        self._count = _merge(
            self._voxels,
            self._count,
            (new.keys, new.points, new.is_inside),
            (old.keys, old.points, old.is_inside),
            flipped,
            self._spare,
        )
        self._voxels, self._spare = self._spare, self._voxels
        self._sum_anew(np.flatnonzero(self._voxels.is_rounded[: self._count]))

    def _sum_anew(self, rows: Int64) -> None:
        """Sum some voxels from their points, in the order of the scans."""
        if not len(rows):
            return
        keys, totals = self._voxels.keys[rows], np.zeros((len(rows), 5))
        for scan in self._scans:
            _sum_voxels(scan.keys, scan.points, scan.is_inside, keys, totals)
        self._voxels.sums[rows] = totals[:, :4]
        self._voxels.means[rows] = totals[:, :3] / totals[:, 3:4]
        self._voxels.is_rounded[rows] = totals[:, 4] > 0

    def _prepare(self, cell: Int64) -> None:
        """Begin anew after a jump, and keep the origin of the keys near the sensor's cell."""
        if not self._scans or np.abs(cell - self._cell).max() * self.voxel > JUMP:
            self.clear()
            self._origin = cell
        self._cell = cell
        shift = cell - self._origin
        if np.abs(shift).max() * self.voxel > JUMP:
            for keys in (self._voxels.keys[: self._count], *(scan.keys for scan in self._scans)):
                np.subtract(keys, (((shift[0] << BITS) + shift[1]) << BITS) + shift[2], out=keys)
            self._origin = cell

    def __getstate__(self) -> dict[str, Any]:
        """Return what the map is made of; the rest is computed anew."""
        return {
            "arguments": (self.voxel, self.radius, self.limit),
            "scans": [(scan.points, scan.sensor) for scan in self._scans],
            "labels": self.labels.copy(),
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Add the scans again."""
        self.__init__(*state["arguments"])  # type: ignore[misc]
        for points, sensor in state["scans"]:
            self.add(points, sensor)
        self.labels[:] = state["labels"]

    def _sorted(self, points: Float32, sensor: Float64, squared_radius: np.float32) -> SortedScan:
        points = np.ascontiguousarray(points)
        keys, compact = _keys(points, np.float32(self.voxel), self._origin)
        order = stable_order(compact)
        center = sensor[:2].astype(np.float32)
        return SortedScan(*_sort(points, keys, order, center, squared_radius), sensor)

    def _flip(self, center: Float32, squared_radius: np.float32) -> Stream:
        """Find the points that come near the sensor or leave, as it moves, and flip their flags.

        Returns:
            Keys int64 (n,), ascending, points float32 (n, 3), and whether each comes, bool (n,).
        """
        parts = [
            (scan.keys[rows], scan.points[rows], scan.is_inside[rows])
            for scan in self._scans
            if len(
                rows := _flipped(
                    scan.points,
                    scan.is_inside,
                    scan.bounds,
                    scan.sensor[:2].astype(np.float32),
                    center,
                    squared_radius,
                )
            )
        ]
        if not parts:
            return np.empty(0, np.int64), np.empty((0, 3), np.float32), np.empty(0, np.bool_)
        keys, points, come = (np.concatenate(column) for column in zip(*parts, strict=True))
        order = stable_order(keys)
        return keys[order], points[order], come[order]


@compiled
def _keys(points: Float32, voxel: np.float32, origin: Int64) -> tuple[Int64, Int64]:
    """Return the key of each point's voxel, and smaller numbers in the same order.

    A key has `BITS` bits for each axis. Points too far from the origin may have the key of another
    voxel. They are not in the map.
    """
    count, half, mask = len(points), np.int64(1 << (BITS - 1)), np.int64((1 << BITS) - 1)
    keys, compact = np.empty(count, np.int64), np.empty(count, np.int64)
    low_x = low_y = low_z = mask
    high_y = high_z = np.int64(0)
    for row in range(count):
        x = (np.int64(np.floor(points[row, 0] / voxel)) - origin[0] + half) & mask
        y = (np.int64(np.floor(points[row, 1] / voxel)) - origin[1] + half) & mask
        z = (np.int64(np.floor(points[row, 2] / voxel)) - origin[2] + half) & mask
        low_x, low_y, low_z = min(low_x, x), min(low_y, y), min(low_z, z)
        high_y, high_z = max(high_y, y), max(high_z, z)
        keys[row] = (((x << BITS) | y) << BITS) | z
    columns, layers = high_y - low_y + 1, high_z - low_z + 1
    for row in range(count):
        x, y, z = keys[row] >> (2 * BITS), (keys[row] >> BITS) & mask, keys[row] & mask
        compact[row] = ((x - low_x) * columns + y - low_y) * layers + z - low_z
    return keys, compact


@compiled
def _sort(
    points: Float32, keys: Int64, order: Int64, center: Float32, squared_radius: np.float32
) -> tuple[Float32, Int64, Bool, Float32]:
    """Return points, keys, and whether a point is inside, in order, and the bounds of blocks."""
    count = len(order)
    sorted_points, sorted_keys = np.empty((count, 3), np.float32), np.empty(count, np.int64)
    is_inside = np.empty(count, np.bool_)
    bounds = np.empty(((count + BLOCK - 1) // BLOCK, 2), np.float32)
    bounds[:, 0], bounds[:, 1] = np.inf, 0
    for place in range(count):
        row = order[place]
        sorted_keys[place] = keys[row]
        for axis in range(3):
            sorted_points[place, axis] = points[row, axis]
        x, y = points[row, 0] - center[0], points[row, 1] - center[1]
        squared = x * x + y * y
        is_inside[place] = squared <= squared_radius
        block = place // BLOCK
        bounds[block, 0] = min(bounds[block, 0], squared)
        bounds[block, 1] = max(bounds[block, 1], squared)
    return sorted_points, sorted_keys, is_inside, np.sqrt(bounds)


@compiled
def _flipped(
    points: Float32,
    is_inside: Bool,
    bounds: Float32,
    before: Float32,
    center: Float32,
    squared_radius: np.float32,
) -> Int64:
    """Flip the flags of the points that come or leave; return their rows."""
    radius = np.sqrt(squared_radius)
    # A little more than the way of the sensor, for the rounding of coordinates.
    far = max(abs(center[0]), abs(center[1])) + radius
    moved = np.hypot(center[0] - before[0], center[1] - before[1]) + np.float32(1e-6) * far
    rows = np.empty(len(points), np.int64)
    count = 0
    for block in range(len(bounds)):
        first, end = block * BLOCK, min((block + 1) * BLOCK, len(points))
        inside = 0
        for row in range(first, end):
            inside += is_inside[row]
        if (inside == end - first and bounds[block, 1] + moved < radius) or (
            inside == 0 and bounds[block, 0] - moved > radius
        ):
            continue
        for row in range(first, end):
            x, y = points[row, 0] - center[0], points[row, 1] - center[1]
            if (x * x + y * y <= squared_radius) != is_inside[row]:
                is_inside[row] = not is_inside[row]
                rows[count] = row
                count += 1
    return rows[:count]


@compiled
def _merge(
    voxels: Voxels, count: int, new: Stream, old: Stream, flipped: Stream, merged: Voxels
) -> int:
    """Write the voxels with new points and without old points; return their number.

    Args:
        voxels: voxels so far.
        count: number of voxels so far.
        new: points of the new scan; those inside come.
        old: points of the oldest scan; those inside leave.
        flipped: points that come or, if not inside, leave.
        merged: columns to write to.
    """
    new_keys, new_points, new_inside = new
    old_keys, old_points, old_inside = old
    flipped_keys, flipped_points, flipped_come = flipped
    keys = voxels.keys
    total = np.empty(5)  # sums of x, y, z, number of points, number of inexact sums
    voxel = filled = a = b = c = 0
    while True:
        a, b = _next_inside(new_inside, a), _next_inside(old_inside, b)
        key = min(_key_at(new_keys, a), _key_at(old_keys, b), _key_at(flipped_keys, c))
        behind = voxel
        while behind < count and keys[behind] < key:
            behind += 1
        _copy(voxels, voxel, behind, merged, filled)
        filled += behind - voxel
        voxel = behind
        if key == LAST:
            return filled
        is_known = voxel < count and keys[voxel] == key
        for column in range(4):
            total[column] = voxels.sums[voxel, column] if is_known else 0.0
        total[4] = is_known and voxels.is_rounded[voxel]
        label = voxels.labels[voxel] if is_known else np.int32(-1)
        voxel += is_known
        a = _add_points(new_keys, new_points, new_inside, a, key, True, 1.0, total)
        b = _add_points(old_keys, old_points, old_inside, b, key, True, -1.0, total)
        _add_points(flipped_keys, flipped_points, flipped_come, c, key, True, 1.0, total)
        c = _add_points(flipped_keys, flipped_points, flipped_come, c, key, False, -1.0, total)
        if total[3] > 0:
            merged.keys[filled] = key
            merged.labels[filled] = label
            merged.is_rounded[filled] = total[4] > 0
            for column in range(4):
                merged.sums[filled, column] = total[column]
            for axis in range(3):
                merged.means[filled, axis] = total[axis] / total[3]
            filled += 1


@compiled_part
def _next_inside(is_inside: Bool, place: int) -> int:
    while place < len(is_inside) and not is_inside[place]:
        place += 1
    return place


@compiled_part
def _key_at(keys: Int64, place: int) -> int:
    return keys[place] if place < len(keys) else LAST


@compiled_part
def _add_points(
    keys: Int64,
    points: Float32,
    flags: Bool,
    place: int,
    key: int,
    wanted: bool,
    sign: float,
    total: Float64,
) -> int:
    """Add the points of a voxel whose flag is as wanted; return the place behind the voxel."""
    while place < len(keys) and keys[place] == key:
        if flags[place] == wanted:
            _add_point(points, place, sign, total)
        place += 1
    return place


@compiled_part
def _add_point(points: Float32, place: int, sign: float, total: Float64) -> None:
    """Add a point, and count the coordinates whose sum is not exact (Knuth's TwoSum)."""
    for axis in range(3):
        old, more = total[axis], sign * points[place, axis]
        new = old + more
        part = new - old
        total[4] += (old - (new - part)) + (more - part) != 0
        total[axis] = new
    total[3] += sign


@compiled
def _sum_voxels(
    keys: Int64, points: Float32, is_inside: Bool, wanted: Int64, totals: Float64
) -> None:
    """Add the points of a scan to the totals of the voxels with the wanted keys."""
    for row in range(len(wanted)):
        place = np.searchsorted(keys, wanted[row])
        while place < len(keys) and keys[place] == wanted[row]:
            if is_inside[place]:
                _add_point(points, place, 1.0, totals[row])
            place += 1


@compiled_part
def _copy(voxels: Voxels, first: int, end: int, merged: Voxels, place: int) -> None:
    """Copy voxels that do not change."""
    for voxel in range(first, end):
        merged.keys[place] = voxels.keys[voxel]
        merged.labels[place] = voxels.labels[voxel]
        merged.is_rounded[place] = voxels.is_rounded[voxel]
        for column in range(4):
            merged.sums[place, column] = voxels.sums[voxel, column]
        for axis in range(3):
            merged.means[place, axis] = voxels.means[voxel, axis]
        place += 1
