"""Data of the shape decoder: what a map would hold of each segment, and the segment's grid."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from placecell.core.segments import Segments, stored_extents
from placecell.core.types import Float32, Int8, Int64, UInt8
from placecell.descriptors.extractor import Extractor
from placecell.descriptors.orientation import bearings_of, orient
from placecell.descriptors.voxels import voxelize_oriented
from training.data.training_set import Source, check_apart

FRAMES = 6
"""Number of map frames in which the box of each segment is measured; a frame's north is random."""

NOTHING = Segments.of([], np.zeros((0, 3)))
"""No segments."""

CHUNK = 512
"""Number of segments whose grids are in memory at once, one byte a voxel."""


@dataclass(frozen=True, slots=True, eq=False)
class ShapeData:
    """Segments as a map would hold them, with their grids.

    Attributes:
        codes: stored descriptors, int8 (n, code bytes).
        offsets: horizontal distance from the sensor to the centroid, and height of the centroid
            above the sensor, float32 (n, 2), meters.
        counts: number of points, int64 (n,).
        bearings: bearing of the sensor from the centroid in each map frame, float32 (n, frames).
        extents: box along the axes of each map frame, uint8 (n, frames, 3), decimeters.
        grids: occupancy of the oriented grid, eight voxels a byte, uint8 (n, bytes).
        centers: vector from the centroid to the grid's center, float32 (n, 3), meters, with the
            sensor on the positive x axis.
        sizes: edge lengths of the oriented box, float32 (n, 3), meters.
        groups: group of each segment, int64 (n,); sources share none.
    """

    codes: Int8
    offsets: Float32
    counts: Int64
    bearings: Float32
    extents: UInt8
    grids: UInt8
    centers: Float32
    sizes: Float32
    groups: Int64

    def __len__(self) -> int:
        return len(self.codes)

    def take(self, indices: Int64) -> "ShapeData":
        """Return some of the segments."""
        return ShapeData(*(getattr(self, each.name)[indices] for each in fields(self)))

    @classmethod
    def concatenate(cls, parts: "Sequence[ShapeData]") -> "ShapeData":
        """Concatenate the segments of several sources; groups stay apart."""
        columns = {
            each.name: np.concatenate([getattr(part, each.name) for part in parts])
            for each in fields(cls)
        }
        shifts = np.cumsum([0, *(int(part.groups.max(initial=-1)) + 1 for part in parts[:-1])])
        columns["groups"] += np.repeat(shifts, [len(part) for part in parts])
        return cls(**columns)

    def split(self, share: float, seed: int) -> "tuple[ShapeData, ShapeData]":
        """Split into training and validation data; a share of the groups is held out."""
        groups = np.random.default_rng(seed).permutation(int(self.groups.max()) + 1)
        held_out = np.isin(self.groups, groups[: max(1, round(share * len(groups)))])
        return self.take(np.flatnonzero(~held_out)), self.take(np.flatnonzero(held_out))

    def occupied(self, rows: Int64, voxels: int) -> UInt8:
        """Return the grids of some segments, uint8 (rows, voxels), 0 or 1."""
        return np.unpackbits(self.grids[rows], axis=1, count=voxels)

    def reach(self, voxel: float) -> Int64:
        """Return the number of voxels from the grid's center to the sides of the box, (n, 3)."""
        return np.asarray(np.ceil(self.sizes / (2 * voxel)), np.int64)


def shape_data(
    sources: Iterable[Source], extractor: Extractor, seed: int
) -> tuple[ShapeData, list[Source]]:
    """Return the data of several sources, and the sources without their points.

    Args:
        sources: parts of recordings. Only one of them needs to be in memory at a time.
        extractor: model whose codes are decoded.
        seed: random seed of the map frames.

    Raises:
        ValueError: two sources share a scan, or there are no segments.
    """
    parts, described = [], []
    for number, source in enumerate(sources):
        parameters = extractor.manifest.neighborhood
        recording, indices = source.recording, source.indices()
        around = None if parameters is None else recording.neighborhood(parameters)[indices]
        segments = recording.segments.take(indices)
        labels = np.unique(recording.groups[indices], return_inverse=True)[1]
        random = np.random.default_rng([seed, number])
        if len(segments):
            parts.append(extracted(segments, labels, around, extractor, random))
        described.append(replace(source, recording=replace(recording, segments=NOTHING)))
    check_apart(described)
    if not parts:
        raise ValueError("The drives have no segments. Give longer drives or more scans.")
    return ShapeData.concatenate(parts), described


def extracted(
    segments: Segments,
    groups: Int64,
    neighborhood: Float32 | None,
    extractor: Extractor,
    random: np.random.Generator,
) -> ShapeData:
    """Return the data of segments.

    Args:
        segments: segments in one z-up frame, which is the first of the map frames.
        groups: group of each segment, int64 (n,).
        neighborhood: see `Extractor.describe`.
        extractor: model whose codes are decoded.
        random: draws the other map frames.
    """
    count = len(segments)
    relative = segments.centroids() - segments.sensors
    bearings = random.uniform(-np.pi, np.pi, (count, FRAMES))
    bearings[:, 0] = bearings_of(-relative)
    boxes = [boxes_of(orient(segments, bearings[:, frame]), segments) for frame in range(FRAMES)]
    low, high = corners_of(orient(segments), segments)
    descriptors = extractor.describe(segments, neighborhood)
    return ShapeData(
        codes=extractor.manifest.quantizer.encode(descriptors),
        offsets=np.stack([np.hypot(relative[:, 0], relative[:, 1]), relative[:, 2]], axis=1).astype(
            np.float32
        ),
        counts=segments.counts,
        bearings=bearings.astype(np.float32),
        extents=np.stack(boxes, axis=1),
        grids=packed_grids(segments, extractor),
        centers=(low + high) * np.float32(0.5),
        sizes=high - low,
        groups=groups,
    )


def corners_of(points: Float32, segments: Segments) -> tuple[Float32, Float32]:
    """Return lowest and highest corner of each segment's box, float32 (n, 3), of turned points."""
    return Segments(points, segments.ends, segments.sensors).bounds()


def boxes_of(points: Float32, segments: Segments) -> UInt8:
    """Return the box of each segment as a map stores it, uint8 (n, 3); see `stored_extents`."""
    low, high = corners_of(points, segments)
    return stored_extents(high - low)


def packed_grids(segments: Segments, extractor: Extractor) -> UInt8:
    """Return the occupancy of the oriented grids, eight voxels a byte, uint8 (n, bytes)."""
    parts = []
    for first in range(0, len(segments), CHUNK):
        some = segments.take(np.arange(first, min(first + CHUNK, len(segments))))
        grids, _ = voxelize_oriented(orient(some), some.ends, extractor.manifest.parameters)
        parts.append(np.packbits(grids.reshape(len(some), -1) > 0, axis=1))
    return np.concatenate(parts)
