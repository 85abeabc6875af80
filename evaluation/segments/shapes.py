"""Reconstruction of segments from what a map stores of them, beside a baseline without a decoder.

Both are compared with the grids of the segments themselves. The baseline knows the training
segments: the shape of a code is the mean grid of the nearest training codes.
"""

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.segments import Segments, stored_extents
from placecell.core.types import Bool, Float32, Float64, Int8, Int64
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
    def of(cls, segments: Segments, descriptors: Float32, extractor: Extractor) -> "CodedGrids":
        """Return segments that the extractor has described."""
        grids, _ = voxelize(segments, extractor.manifest.parameters)
        return cls(segments, extractor.manifest.quantizer.encode(descriptors), grids > 0)

    @classmethod
    def drawn(
        cls, recording: Recording, extractor: Extractor, most: int, seed: int
    ) -> "CodedGrids":
        """Return segments of a recording, at most `most`, drawn at random."""
        parameters = extractor.manifest.neighborhood
        around = None if parameters is None else recording.neighborhood(parameters)
        rows = drawn_rows(len(recording.segments), most, seed)
        segments = recording.segments.take(rows)
        descriptors = extractor.describe(segments, None if around is None else around[rows])
        return cls.of(segments, descriptors, extractor)

    def stored(self, *, extents: bool = True) -> StoredSegments:
        """Return what a map holds of the segments, with or without the column `extents`."""
        low, high = self.segments.bounds()
        return StoredSegments(
            codes=self.codes,
            centroids=self.segments.centroids(),
            sensors=self.segments.sensors.astype(np.float64),
            extents=stored_extents(high - low) if extents else None,
        )


def drawn_rows(count: int, most: int, seed: int) -> Int64:
    """Return rows that are drawn at random, at most `most`, ascending, int64 (rows,)."""
    return np.sort(np.random.default_rng(seed).permutation(count)[:most])


def shape_figures(
    segments: Segments,
    descriptors: Float32,
    extractor: Extractor,
    decoder: ShapeDecoder | None,
    training: Recording | None,
    seed: int = 0,
) -> dict[str, Any]:
    """Return the figures of reconstruction; all are null for a model without a decoder.

    Args:
        segments: segments to reconstruct.
        descriptors: their descriptors, float32 (n, dimension).
        extractor: model that described them.
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
    rows = drawn_rows(len(segments), MEASURED, seed)
    known = CodedGrids.of(segments.take(rows), descriptors[rows], extractor)
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
        learned = CodedGrids.drawn(training, extractor, 10 * MEASURED, seed)
        figures |= baseline_figures(known, learned, extractor)
        figures["baseline_training"] = training.name
    return figures


def baseline_figures(
    known: CodedGrids, learned: CodedGrids, extractor: Extractor
) -> dict[str, float | None]:
    """Return the figures of the mean grid of the nearest training codes.

    Args:
        known: measured segments.
        learned: training segments.
        extractor: model that described both.
    """
    nearest = nearest_codes(known.codes, learned, extractor)
    guessed = mean_shapes(learned.grids, nearest, known.grids)
    stored = known.stored()
    bearings = bearings_of(stored.sensors - stored.centroids)
    voxel = extractor.manifest.parameters.grid_voxel
    placed = Shapes(guessed, true_centers(known.segments), bearings, voxel)
    return {
        "baseline_iou": rounded(overlap(guessed, known.grids)),
        "nearest_code_iou": rounded(overlap(learned.grids[nearest[:, 0]], known.grids)),
        "baseline_chamfer_m": chamfer(placed, known.segments),
    }


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


def nearest_codes(codes: Int8, learned: CodedGrids, extractor: Extractor) -> Int64:
    """Return the nearest training segments of each code, nearest first, int64 (n, at most 16)."""
    decode = extractor.manifest.quantizer.decode
    count = min(NEAREST, len(learned.codes))
    _, rows = cKDTree(decode(learned.codes)).query(decode(codes), k=[*range(1, count + 1)])
    return np.asarray(rows, np.int64)


def mean_shapes(grids: Bool, nearest: Int64, true: Bool) -> Bool:
    """Return the mean grid of the nearest training codes, at the best threshold.

    Args:
        grids: grids of the training segments, bool (m, x, y, z).
        nearest: nearest training segments of each segment, int64 (n, k).
        true: true grids, bool (n, x, y, z), which choose the threshold.
    """
    likely = np.stack([grids[each].mean(axis=0, dtype=np.float32) for each in nearest])
    overlaps = [overlap(likely > each, true).mean() for each in THRESHOLDS]
    return np.asarray(likely > THRESHOLDS[int(np.argmax(overlaps))])
