"""Reconstruction of segments from what a map stores of them, beside a baseline without a decoder.

Both are compared with the grids of the segments themselves. The baseline knows the training
segments: the shape of a code is the mean grid of the nearest training codes.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Float64, Int8, Int64, UInt8
from placecell.descriptors.extractor import Extractor
from placecell.descriptors.orientation import bearings_of, orient
from placecell.descriptors.voxels import voxelize
from placecell.segmentation.recording import Recording
from placecell.shapes.decoder import ShapeDecoder, Shapes, StoredSegments, turned
from placecell.shapes.geometry import points_of

SIZES = (250, 500, 1500)
"""Bounds of the classes of size, points of a segment."""

MEASURED = 2000
"""Largest number of segments that are measured, drawn at random."""

NEAREST = 16
"""Number of training codes whose grids the baseline averages."""

THRESHOLDS = np.linspace(0.05, 0.6, 12)
"""Shares of the nearest training grids from which the baseline's voxel is occupied. The one that is
best on the measured segments is taken, which favors the baseline."""


@dataclass(frozen=True, slots=True, eq=False)
class CodedGrids:
    """Segments with their codes and true grids.

    Attributes:
        segments: the segments.
        codes: stored descriptors, int8 (n, code bytes).
        grids: occupancy of the oriented grids, bool (n, x, y, z).
    """

    segments: Segments
    codes: Int8
    grids: Bool

    @classmethod
    def of(cls, recording: Recording, extractor: Extractor, most: int, seed: int) -> "CodedGrids":
        """Return segments of a recording, at most `most`, drawn at random."""
        parameters = extractor.manifest.neighborhood
        around = None if parameters is None else recording.neighborhood(parameters)
        rows = np.random.default_rng(seed).permutation(len(recording.segments))[:most]
        rows = np.sort(rows)
        segments = recording.segments.take(rows)
        descriptors = extractor.describe(segments, None if around is None else around[rows])
        grids, _ = voxelize(segments, extractor.manifest.parameters)
        return cls(segments, extractor.manifest.quantizer.encode(descriptors), grids > 0)

    def stored(self, *, extents: bool = True) -> StoredSegments:
        """Return what a map holds of the segments, with or without the column `extents`."""
        return StoredSegments(
            codes=self.codes,
            centroids=self.segments.centroids(),
            sensors=self.segments.sensors.astype(np.float64),
            extents=boxes(self.segments) if extents else None,
        )


def boxes(segments: Segments) -> UInt8:
    """Return the box of each segment as a map stores it, uint8 (n, 3): decimeters, rounded up."""
    low, high = segments.bounds()
    return np.asarray(np.ceil((high - low) * 10).clip(1, 255), np.uint8)


def shape_figures(
    recording: Recording,
    extractor: Extractor,
    decoder: ShapeDecoder | None,
    training: Recording | None,
    seed: int = 0,
) -> dict[str, Any]:
    """Return the figures of reconstruction; all are null for a model without a decoder.

    Args:
        recording: segments to reconstruct.
        extractor: model that describes them.
        decoder: decoder of the model.
        training: segments that the model was trained on, for the baseline; None: no baseline.
        seed: random seed of the measured segments.
    """
    keys: tuple[str, ...] = ("iou", "iou_by_size", "iou_without_extents", "chamfer_m")
    nothing: dict[str, Any] = dict.fromkeys(
        (*keys, "baseline_iou", "nearest_code_iou", "baseline_chamfer_m")
    )
    if decoder is None:
        return {"reconstructed": 0, **nothing}
    known = CodedGrids.of(recording, extractor, MEASURED, seed)
    shapes = decoder.decode(known.stored())
    overlaps = overlap(shapes.occupancy, known.grids)
    figures = nothing | {
        "reconstructed": len(overlaps),
        "iou": rounded(overlaps),
        "iou_by_size": by_size(overlaps, known.segments.counts),
        "iou_without_extents": rounded(
            overlap(decoder.decode(known.stored(extents=False)).occupancy, known.grids)
        ),
        "chamfer_m": chamfer(shapes, known.segments),
    }
    if training is not None:
        learned = CodedGrids.of(training, extractor, 10 * MEASURED, seed)
        guessed = nearest_shapes(known.codes, learned, extractor, known.grids)
        figures["baseline_iou"] = rounded(overlap(guessed, known.grids))
        figures["nearest_code_iou"] = rounded(
            overlap(nearest_shapes(known.codes, learned, extractor, known.grids, 1), known.grids)
        )
        placed = Shapes(guessed, true_centers(known.segments), shapes.bearings, shapes.voxel)
        figures["baseline_chamfer_m"] = chamfer(placed, known.segments)
        figures["baseline_training"] = training.name
    return figures


def overlap(guessed: Bool, true: Bool) -> Float64:
    """Return the intersection over union of each pair of grids, float64 (n,)."""
    axes = tuple(range(1, true.ndim))
    common, union = (guessed & true).sum(axis=axes), (guessed | true).sum(axis=axes)
    return np.asarray(common / np.maximum(union, 1))


def by_size(overlaps: Float64, counts: Int64) -> dict[str, dict[str, Any]]:
    """Return the number and the mean overlap of the segments of each class of size."""
    classes = np.digitize(counts, SIZES)
    names = [f"below {SIZES[0]}"]
    names += [f"{low} to {high - 1}" for low, high in pairwise(SIZES)]
    names += [f"from {SIZES[-1]}"]
    return {
        name: {
            "segments": int((classes == index).sum()),
            "iou": rounded(overlaps[classes == index]),
        }
        for index, name in enumerate(names)
    }


def rounded(values: Float64) -> float | None:
    """Return the mean; None of nothing."""
    return round(float(values.mean()), 4) if len(values) else None


def chamfer(shapes: Shapes, segments: Segments) -> float | None:
    """Return the mean distance from each surface to the other, meters, over all segments.

    The distance of a segment is the mean of both directions: from the centers of the decoded voxels
    to the nearest points, and back. A shape without a voxel counts with its size.
    """
    points, owners = points_of(shapes)
    ends = np.searchsorted(owners, np.arange(len(shapes)), side="right")
    low, high = segments.bounds()
    distances, start = [], 0
    for index, end in enumerate(ends.tolist()):
        true = segments.cloud(index)
        if start == end:
            distances.append(float(np.linalg.norm(high[index] - low[index])))
        else:
            decoded = points[start:end]
            there, _ = cKDTree(true).query(decoded)
            back, _ = cKDTree(decoded).query(true)
            distances.append(float(there.mean() + back.mean()) / 2)
        start = end
    return round(float(np.mean(distances)), 4) if distances else None


def true_centers(segments: Segments) -> Float64:
    """Return the center of each segment's oriented box in its frame, float64 (n, 3)."""
    centroids = segments.centroids()
    low, high = Segments(orient(segments), segments.ends, segments.sensors).bounds()
    bearings = bearings_of(segments.sensors.astype(np.float64) - centroids)
    return np.asarray(centroids + turned(((low + high) / 2).astype(np.float64), bearings))


def nearest_shapes(
    codes: Int8, learned: CodedGrids, extractor: Extractor, true: Bool, most: int = NEAREST
) -> Bool:
    """Return the mean grid of the nearest training codes, at the best threshold.

    Args:
        codes: codes of the segments, int8 (n, code bytes).
        learned: training segments.
        extractor: model of the codes.
        true: true grids, which choose the threshold.
        most: number of training codes.
    """
    decode = extractor.manifest.quantizer.decode
    known: Float32 = decode(learned.codes)
    tree = cKDTree(known)
    count = min(most, len(known))
    _, rows = tree.query(decode(codes), k=count)
    likely = np.stack(
        [learned.grids[each].mean(axis=0, dtype=np.float32) for each in rows.reshape(-1, count)]
    )
    overlaps = [overlap(likely > each, true).mean() for each in THRESHOLDS]
    return np.asarray(likely > THRESHOLDS[int(np.argmax(overlaps))])
