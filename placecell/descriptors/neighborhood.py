"""Neighborhood of a segment: a histogram of the other segments around it (beyond the paper).

One segment often resembles a hundred others; its neighborhood does not. The other segments of the
same capture are counted in rings around its centroid and in layers of height. Directions are
averaged, so robots need neither a common north nor the same direction of travel.
"""

import secrets

import numpy as np

from placecell.core.cancellation import current, is_cancelled
from placecell.core.jit import compiled
from placecell.core.parameters import NEIGHBORHOOD_V1, NeighborhoodParameters
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int32, Int64, UInt64

SECTORS = 16

TAN_22_5 = np.tan(np.pi / 8)

CELLS = 1 << 13
"""Largest number of voxels along an edge of a segment's bounding box."""

SEED: UInt64 = np.array([secrets.randbits(64), secrets.randbits(64) | 1], dtype=np.uint64)
"""Seed of the voxel hash tables, new in each process: nobody can choose points that collide."""

STRIP = 5.0
"""Edge length of the cells in which near voxels are found, meters."""

STRIPS = 1 << 20
"""Largest number of cells from the origin to either side. Farther voxels share the last cell."""

BLOCK = 1024
"""Voxels counted together, so that intermediate values stay in the nearest cache."""


def describe_neighborhood(
    segments: Segments,
    captures: Int64 | None = None,
    parameters: NeighborhoodParameters = NEIGHBORHOOD_V1,
) -> Float32:
    """Return the neighborhood histogram of each segment.

    Args:
        segments: segments in one z-up frame.
        captures: int64 (segments,), capture of each segment; None: all belong to one capture.
        parameters: voxel size, rings and layers.

    Returns:
        float32 (segments, rings x layers): log(1 + voxels) in each ring and layer, averaged over
        the directions. A segment without neighbors has zeros.
    """
    found = np.zeros((len(segments), *parameters.shape), dtype=np.float32)
    members = [np.arange(len(segments))]
    if captures is not None:
        order = np.argsort(captures, kind="stable")
        members = np.split(order, np.flatnonzero(np.diff(captures[order])) + 1)
    for together in members:
        some = segments if captures is None else segments.take(together)
        voxels, owners = voxels_by_owner(some, parameters.voxel)
        counted = np.zeros((len(some), *parameters.shape), dtype=np.float32)
        count_voxels(voxels, owners, some.centroids(), parameters, counted)
        found[together] = counted
    return found.reshape(len(segments), parameters.size)


@compiled
def slot_of(key: int, seed: UInt64, slots: int) -> np.int64:
    """Return a key's slot in a hash table whose size is a power of two, at most 2**31.

    It is the finalizer of MurmurHash3 (Appleby) after a secret affine step.
    """
    mixed = (np.uint64(key) + seed[0]) * seed[1]
    mixed = (mixed ^ (mixed >> np.uint64(33))) * np.uint64(0xFF51AFD7ED558CCD)
    mixed = (mixed ^ (mixed >> np.uint64(33))) * np.uint64(0xC4CEB9FE1A85EC53)
    return np.int64(mixed >> np.uint64(33)) & (slots - 1)


def voxels_by_owner(segments: Segments, voxel: float) -> tuple[Float64, Int64]:
    """Return the mean point of each voxel that a segment occupies.

    A segment's voxels begin at its lowest corner, so the result depends neither on the frame's
    origin nor on the other segments.

    Args:
        segments: segments in one frame.
        voxel: edge length, meters.

    Returns:
        Points, float64 (n, 3), and the index of each point's segment, int64 (n,).

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    segments.check_ends()
    points = np.ascontiguousarray(segments.points)
    means = np.zeros((len(points), 3))
    owners = np.zeros(len(points), dtype=np.int64)
    sizes = np.zeros(1, dtype=np.int64)
    token = current()
    _merge(points, segments.ends, np.float32(voxel), SEED, token.flag, means, owners, sizes)
    token.check()
    return means[: sizes[0]], owners[: sizes[0]]


@compiled
def _merge(
    points: Float32,
    ends: Int64,
    voxel: np.float32,
    seed: UInt64,
    flag: Int32,
    means: Float64,
    owners: Int64,
    sizes: Int64,
) -> None:
    """Fill `means` and `owners`, and `sizes` with their number.

    Each segment has a hash table of voxels (linear probing; Knuth, *The Art of Computer
    Programming*, 6.4). Sorting all points takes twice the time. Voxels are numbered in the order of
    their first points, so the seed of the hash does not change the result.
    """
    longest, start = 1, 0
    for end in ends:
        longest, start = max(longest, end - start), end
    slots = 1
    while slots < 2 * longest:
        slots *= 2
    keys = np.empty(slots, dtype=np.int64)
    table = np.empty(slots, dtype=np.int64)
    counts = np.zeros(len(points), dtype=np.int64)
    found = start = 0
    for segment in range(len(ends)):
        if is_cancelled(flag):
            return
        slots = 1
        while slots < 2 * (ends[segment] - start):
            slots *= 2
        table[:slots] = -1
        low_x, low_y, low_z = points[start, 0], points[start, 1], points[start, 2]
        for point in range(start + 1, ends[segment]):
            low_x = min(low_x, points[point, 0])
            low_y = min(low_y, points[point, 1])
            low_z = min(low_z, points[point, 2])
        for point in range(start, ends[segment]):
            key = 0
            for cell in (
                (points[point, 0] - low_x) / voxel,
                (points[point, 1] - low_y) / voxel,
                (points[point, 2] - low_z) / voxel,
            ):
                # No segment is thousands of meters long; points beyond share the last cell.
                # Written so that a NaN coordinate is in the first cell.
                key = key * CELLS + (min(int(min(cell, CELLS)), CELLS - 1) if cell > 0 else 0)
            slot = slot_of(key, seed, slots)
            while table[slot] >= 0 and keys[slot] != key:
                slot = (slot + 1) & (slots - 1)
            if table[slot] < 0:
                table[slot], keys[slot] = found, key
                owners[found] = segment
                found += 1
            place = table[slot]
            counts[place] += 1
            for axis in range(3):
                means[place, axis] += points[point, axis]
        start = ends[segment]
    for place in range(found):
        means[place] /= counts[place]
    sizes[0] = found


def count_voxels(
    voxels: Float64,
    owners: Int64,
    centroids: Float64,
    parameters: NeighborhoodParameters,
    found: Float32,
) -> None:
    """Fill `found`, (segments, rings, layers), from the voxels near each segment.

    Args:
        voxels: float64 (n, 3), meters, ordered by segment.
        owners: int64 (n,), ascending, segment of each voxel.
        centroids: float64 (segments, 3), meters.
        parameters: rings and layers.
        found: float32 (segments, rings, layers), filled by this function.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    rings = parameters.ring_of_meter()
    reach = len(rings)
    # A last ring, which is not read, takes the voxels out of reach.
    rings = np.append(rings, len(parameters.rings))
    bounds = np.searchsorted(owners, np.arange(len(centroids) + 1))
    # A NaN coordinate is out of reach.
    usable = np.flatnonzero(np.isfinite(voxels[:, :2]).all(axis=1))
    keys = _cell_of(voxels[usable, 1]) * (4 * STRIPS) + _cell_of(voxels[usable, 0])
    order = np.argsort(keys, kind="stable")
    near_x, near_y, near_z = (np.ascontiguousarray(column) for column in voxels[usable[order]].T)
    own_x, own_y, own_z = (np.ascontiguousarray(column) for column in voxels.T)
    lows, highs = _cell_of(centroids[:, :2] - reach), _cell_of(centroids[:, :2] + reach)
    logarithms = np.log1p(np.arange(len(voxels) + 1))
    limits = np.array(parameters.heights, dtype=np.float64)
    token = current()
    _count(
        near_x, near_y, near_z, keys[order], own_x, own_y, own_z, bounds, lows, highs, centroids,
        rings, limits, logarithms, token.flag, found,
    )  # fmt: skip
    token.check()


def _cell_of(coordinates: Float64) -> Int64:
    """Return the number of the cell along an axis, 0 or more. NaN is in cell 0."""
    cells = np.nan_to_num(np.floor(coordinates / STRIP), nan=-np.inf)
    return cells.clip(-STRIPS, STRIPS).astype(np.int64) + STRIPS


@compiled
def _count(
    xs: Float64,
    ys: Float64,
    zs: Float64,
    keys: Int64,
    own_xs: Float64,
    own_ys: Float64,
    own_zs: Float64,
    bounds: Int64,
    lows: Int64,
    highs: Int64,
    centroids: Float64,
    rings: Int64,
    limits: Float64,
    logarithms: Float64,
    flag: Int32,
    found: Float32,
) -> None:
    """Fill `found`. Voxels are given in the order of cells and in the order of owners.

    A segment's own voxels are first counted with the others and then subtracted. Counts are
    integers, so the subtraction is exact.
    """
    row = 4 * STRIPS
    counts = np.zeros((found.shape[1] + 1, found.shape[2], SECTORS), dtype=np.int64)
    flat = counts.reshape(-1)
    meters = np.empty(BLOCK, dtype=np.int64)
    layers = np.empty(BLOCK, dtype=np.int64)
    sectors = np.empty(BLOCK, dtype=np.int64)
    for segment in range(len(centroids)):
        x, y, z = centroids[segment, 0], centroids[segment, 1], centroids[segment, 2]
        if not (np.isfinite(x) and np.isfinite(y)):
            continue
        counts[:] = 0
        for strip in range(lows[segment, 1], highs[segment, 1] + 1):
            begin = np.searchsorted(keys, strip * row + lows[segment, 0])
            end = np.searchsorted(keys, strip * row + highs[segment, 0], side="right")
            for first in range(begin, end, BLOCK):
                if is_cancelled(flag):
                    return
                last = min(first + BLOCK, end)
                _place(
                    xs[first:last], ys[first:last], zs[first:last], x, y, z,
                    len(rings) - 1, limits, meters, layers, sectors,
                )  # fmt: skip
                for place in range(last - first):
                    ring = rings[meters[place]]
                    flat[(ring * found.shape[2] + layers[place]) * SECTORS + sectors[place]] += 1
        for first in range(bounds[segment], bounds[segment + 1], BLOCK):
            last = min(first + BLOCK, bounds[segment + 1])
            _place(
                own_xs[first:last], own_ys[first:last], own_zs[first:last], x, y, z,
                len(rings) - 1, limits, meters, layers, sectors,
            )  # fmt: skip
            for place in range(last - first):
                ring = rings[meters[place]]
                flat[(ring * found.shape[2] + layers[place]) * SECTORS + sectors[place]] -= 1
        for ring in range(found.shape[1]):
            for layer in range(found.shape[2]):
                total = 0.0
                for sector in range(SECTORS):
                    total += logarithms[counts[ring, layer, sector]]
                found[segment, ring, layer] = total / SECTORS


@compiled
def _place(
    xs: Float64,
    ys: Float64,
    zs: Float64,
    x: float,
    y: float,
    z: float,
    reach: int,
    limits: Float64,
    meters: Int64,
    layers: Int64,
    sectors: Int64,
) -> None:
    """Fill distance in whole meters (reach: too far), layer and sector of a block of voxels.

    Each loop has one operation and no branch, so that the compiler vectorizes it.
    """
    squared_reach = float(reach * reach)
    for place in range(len(xs)):
        dx = abs(xs[place] - x)
        dy = abs(ys[place] - y)
        squared = dx * dx + dy * dy
        # Written so that a NaN coordinate is out of reach.
        is_near = squared < squared_reach
        # The root of a value just below the reach may round up to it.
        meter = min(int(np.sqrt(squared if is_near else 0.0)), reach - 1)
        meters[place] = meter if is_near else reach
    for place in range(len(xs)):
        dx = abs(xs[place] - x)
        dy = abs(ys[place] - y)
        # A quarter of the compass, and which quarter of that.
        quarter = int(dy > TAN_22_5 * dx) + int(dy > dx) + int(dx < TAN_22_5 * dy)
        sectors[place] = quarter + 4 * int(xs[place] < x) + 8 * int(ys[place] < y)
    for place in range(len(xs)):
        layers[place] = 0
    for limit in limits:
        for place in range(len(xs)):
            layers[place] += int(zs[place] - z >= limit)
