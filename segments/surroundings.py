"""What stands around a segment: the strongest evidence of where it is (beyond the paper).

A segment by itself is often like a hundred others; what stands around it is not. The other
segments of the same scan are counted in rings about its centroid, by height above it. Directions
are averaged out, so that robots need not agree on where north is, nor come from the same side.
"""

import numpy as np

from segments.parameters import SURROUNDINGS_V1, SurroundingsParameters
from segments.segments import Segments, compiled, means_by_key
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
    if not len(segments):
        return np.zeros((0, 3)), np.zeros(0, dtype=np.int64)
    owners = segments.owners
    # No segment is thousands of metres long; what lies beyond shares the last cell.
    cells = (segments.points - segments.bounds()[0][owners]) / voxel
    cells = np.nan_to_num(cells).clip(0, CELLS - 1).astype(np.int64)
    keys = owners
    for axis in range(3):
        keys = keys * CELLS + cells[:, axis]
    means, first = means_by_key(segments.points, keys)
    return means, owners[first]


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
            while layer < len(heights) and height >= heights[layer]:
                layer += 1
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
                    if counts[ring, layer, sector]:
                        total += np.log1p(counts[ring, layer, sector])
                found[segment, ring, layer] = total / SECTORS
