"""What stands around a segment: the strongest evidence of where it is (beyond the paper).

A segment by itself is often like a hundred others; what stands around it is not. The other
segments of the same scan are counted in rings about its centroid, by height above it. Directions
are averaged out, so that robots need not agree on where north is, nor come from the same side.
"""

import numpy as np

from segments.jit import compiled
from segments.parameters import SURROUNDINGS_V1, SurroundingsParameters
from segments.segments import Segments
from segments.types import Float32, Float64, Int64

SECTORS = 16

TAN_22_5 = np.tan(np.pi / 8)

CELLS = 1 << 13
"""Voxels along an edge of a segment's box, at most."""


def describe_surroundings(
    segments: Segments,
    frames: Int64 | None = None,
    parameters: SurroundingsParameters = SURROUNDINGS_V1,
) -> Float32:
    """Histograms of what stands around each segment.

    Args:
        segments: in a common z-up frame.
        frames: int64 (segments,), which were seen together; None: all of them.

    Returns:
        float32 (segments, rings x heights): log(1 + voxels) in each ring and layer, averaged over
        the directions; all zero for a segment that stands alone.
    """
    found = np.zeros((len(segments), *parameters.shape), dtype=np.float32)
    members = [np.arange(len(segments))]
    if frames is not None:
        order = np.argsort(frames, kind="stable")
        members = np.split(order, np.flatnonzero(np.diff(frames[order])) + 1)
    for together in members:
        some = segments.take(together)
        voxels, owners = voxels_by_owner(some, parameters.voxel)
        counted = np.zeros((len(some), *parameters.shape), dtype=np.float32)
        _count(
            *(voxels, owners, some.centroids()),
            *(parameters.ring_of_metre(), np.array(parameters.heights), counted),
        )
        found[together] = counted
    return found.reshape(len(segments), parameters.size)


def voxels_by_owner(segments: Segments, voxel: float) -> tuple[Float64, Int64]:
    """One point for each voxel that a segment fills, the mean of its points there.

    The voxels of a segment begin at its lowest corner: neither the frame's origin nor the other
    segments make a difference.

    Args:
        voxel: edge, metres.

    Returns:
        points, float64 (n, 3); and of each the segment that it belongs to, int64 (n,).
    """
    means = np.zeros((len(segments.points), 3))
    owners = np.zeros(len(segments.points), dtype=np.int64)
    sizes = np.zeros(1, dtype=np.int64)
    _merge(segments.points, segments.ends, np.float32(voxel), means, owners, sizes)
    return means[: sizes[0]], owners[: sizes[0]]


@compiled
def _merge(
    points: Float32, ends: Int64, voxel: np.float32, means: Float64, owners: Int64, sizes: Int64
) -> None:
    """Fill means and owners, and tell how many there are.

    Voxels are told apart by a hash table of each segment (linear probing; Knuth, The Art of
    Computer Programming, 6.4): sorting all points takes twice the time.
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
                # No segment is thousands of metres long; what lies beyond shares the last cell.
                # As it stands, so that a coordinate that is no number is in the first.
                key = key * CELLS + (min(int(min(cell, CELLS)), CELLS - 1) if cell > 0 else 0)
            slot = (key ^ (key >> 13) * 7 ^ (key >> 26) * 31) & (slots - 1)
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
        for axis in range(3):
            means[place, axis] /= counts[place]
    sizes[0] = found


@compiled
def _count(
    voxels: Float64,
    owners: Int64,
    centroids: Float64,
    ring_of_metre: Int64,
    heights: Float64,
    found: Float32,
) -> None:
    """Fill found, (segments, rings, layers): the ring by whole metres, the layer by upper limit."""
    reach = len(ring_of_metre)
    squared_reach = float(reach * reach)
    counts = np.zeros((found.shape[1], found.shape[2], SECTORS), dtype=np.int64)
    logarithms = np.log1p(np.arange(len(voxels) + 1))
    for segment in range(len(centroids)):
        counts[:] = 0
        for voxel in range(len(voxels)):
            if owners[voxel] == segment:
                continue
            x = abs(voxels[voxel, 0] - centroids[segment, 0])
            y = abs(voxels[voxel, 1] - centroids[segment, 1])
            squared = x * x + y * y
            # As it stands, so that a coordinate that is no number is out of reach.
            if not squared < squared_reach:
                continue
            height = voxels[voxel, 2] - centroids[segment, 2]
            layer = 0
            for limit in heights:  # all of them: no branch to be guessed
                layer += int(height >= limit)
            # A quarter of the compass, and which quarter of that.
            sector = int(y > TAN_22_5 * x) + int(y > x) + int(x < TAN_22_5 * y)
            if voxels[voxel, 0] < centroids[segment, 0]:
                sector += 4
            if voxels[voxel, 1] < centroids[segment, 1]:
                sector += 8
            # The root of what is just short of the reach may round up to it.
            metre = min(int(np.sqrt(squared)), reach - 1)
            counts[ring_of_metre[metre], layer, sector] += 1
        for ring in range(counts.shape[0]):
            for layer in range(counts.shape[1]):
                total = 0.0
                for sector in range(SECTORS):
                    total += logarithms[counts[ring, layer, sector]]
                found[segment, ring, layer] = total / SECTORS
