"""What stands around a segment: the strongest evidence of where it is (beyond the paper).

A segment by itself is often like a hundred others; what stands around it is not. The other
segments of the same scan are counted in rings about its centroid, by height above it. Directions
are averaged out, so that robots need not agree on where north is, nor come from the same side.
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
"""Voxels along an edge of a segment's box, at most."""

SEED: UInt64 = np.array([secrets.randbits(64), secrets.randbits(64) | 1], dtype=np.uint64)
"""Seed of the voxel hash tables, new in each process: nobody can choose points that collide."""

STRIP = 5.0
"""Edge of the cells in which near voxels are looked up, meters."""

STRIPS = 1 << 20
"""Largest number of cells from the middle to either side; farther voxels share the last cell."""

BLOCK = 1024
"""Voxels counted together, so that intermediate values stay in the nearest cache."""


def describe_neighborhood(
    segments: Segments,
    captures: Int64 | None = None,
    parameters: NeighborhoodParameters = NEIGHBORHOOD_V1,
) -> Float32:
    """Histograms of what stands around each segment.

    Args:
        segments: in a common z-up frame.
        captures: int64 (segments,), which were seen together; None: all of them.

    Returns:
        float32 (segments, rings x heights): log(1 + voxels) in each ring and layer, averaged over
        the directions; all zero for a segment that stands alone.
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

    The finalizer of MurmurHash3 (Appleby) behind a secret affine step.
    """
    mixed = (np.uint64(key) + seed[0]) * seed[1]
    mixed = (mixed ^ (mixed >> np.uint64(33))) * np.uint64(0xFF51AFD7ED558CCD)
    mixed = (mixed ^ (mixed >> np.uint64(33))) * np.uint64(0xC4CEB9FE1A85EC53)
    return np.int64(mixed >> np.uint64(33)) & (slots - 1)


def voxels_by_owner(segments: Segments, voxel: float) -> tuple[Float64, Int64]:
    """Return one point for each voxel that a segment fills: the mean of its points there.

    The voxels of a segment begin at its lowest corner: neither the frame's origin nor the other
    segments make a difference.

    Args:
        voxel: edge, meters.

    Raises:
        Cancelled: nobody waits for it any longer.

    Returns:
        points, float64 (n, 3); and of each the segment that it belongs to, int64 (n,).
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
    """Fill `means` and `owners`; return how many there are.

    Voxels are told apart by a hash table of each segment (linear probing; Knuth, The Art of
    Computer Programming, 6.4): sorting all points takes twice the time. The hash is seeded; voxels
    are numbered in the order of their first points, so the seed makes no difference.
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
                # No segment is thousands of meters long; what lies beyond shares the last cell.
                # As it stands, so that a coordinate that is no number is in the first.
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
        voxels: float64 (n, 3), those of a segment one after the other.
        owners: int64 (n,), ascending: the segment that each belongs to.
        centroids: float64 (segments, 3).

    Raises:
        Cancelled: nobody waits for it any longer.
    """
    rings = parameters.ring_of_meter()
    reach = len(rings)
    # A last ring, which nobody reads, takes what is out of reach.
    rings = np.append(rings, len(parameters.rings))
    bounds = np.searchsorted(owners, np.arange(len(centroids) + 1))
    # A coordinate that is no number is out of reach.
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
    """Return the number of the cell along an axis, from 0 on; NaN is in cell 0."""
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
    """Fill `found`; voxels come in the order of cells and again in the order of owners.

    A segment's own voxels are counted with the others and taken out again: counts are whole
    numbers, so nothing is left of them.
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
    """Fill meters from a centroid (reach: too far), layer and sector of a block of voxels.

    Each loop does one thing without a branch, so that several voxels go through at once.
    """
    squared_reach = float(reach * reach)
    for place in range(len(xs)):
        dx = abs(xs[place] - x)
        dy = abs(ys[place] - y)
        squared = dx * dx + dy * dy
        # As it stands, so that a coordinate that is no number is out of reach.
        is_near = squared < squared_reach
        # The root of what is just short of the reach may round up to it.
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
