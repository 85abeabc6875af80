"""Study of recognition by size, viewpoint, occlusion, density and storage, and of its misses.

All figures are of a test drive, with descriptors as stored unless stated otherwise.
"""

from itertools import pairwise
from typing import Any

import numpy as np

from evaluation.recognition import retrieval
from evaluation.recognition.evaluate import mean
from placecell.core.types import Bool, Float32, Float64, Int64
from placecell.descriptors.extractor import Extractor
from placecell.descriptors.orientation import sensor_bearings
from training.data.augmentation import Augmentation
from training.data.training_set import TrainingSet

SIZES = (100, 150, 250, 400, 700, 1500, 15_001)
METERS = (0.0, 2.0, 5.0, 10.0, 15.0, 20.0)
DEGREES = (0.0, 5.0, 10.0, 20.0, 40.0, 60.0)
SHARES = (0.0, 0.2, 0.4, 0.6, 0.8)
DIMENSIONS = (8, 16, 24, 32, 48, 64, 96, 128)
REACH = {8: 0.9995, 6: 0.998, 5: 0.995, 4: 0.99, 3: 0.96, 2: 0.85}
"""Share of the values within the range of the levels, by bits per level."""
NEAR_PLACE = 1.5
"""Distance between centroids within which two segments are at one place, meters."""

Curve = list[dict[str, Any]]


def study(extractor: Extractor, test: TrainingSet) -> dict[str, Any]:
    """Return all curves of one model."""
    quantizer = extractor.manifest.quantizer
    described = extractor.describe(test.segments, test.neighborhood)
    stored = quantizer.rounded(described)
    sensors = test.segments.sensors
    centroids = test.segments.centroids()
    bearings = sensor_bearings(test.segments)
    return {
        "by_points": by_points(test, stored),
        "by_metres": [
            {"metres": meters} | share(stored, test, retrieval.seen_within(sensors, meters))
            for meters in METERS
        ],
        "by_degrees": [
            {"degrees": degrees} | share(stored, test, retrieval.seen_from_angle(bearings, degrees))
            for degrees in DEGREES
        ],
        "by_occlusion": [
            {"lost": lost}
            | altered(extractor, test, stored, Augmentation(0.0, 1.0, lost, 0.0), lost)
            for lost in SHARES
        ],
        "by_density": [
            {"lost": lost}
            | altered(extractor, test, stored, Augmentation(0.0, 0.0, 0.0, lost), lost)
            for lost in SHARES
        ],
        "by_storage": by_storage(described, test),
        "misses": misses(stored, test, centroids),
    }


def share(
    stored: Float32, test: TrainingSet, too_easy: retrieval.TooEasy | None = None
) -> dict[str, Any]:
    """Return top-1 of the segments with a mate that is not too easy, and their number."""
    found = retrieval.retrieve(stored, test.groups, too_easy)
    return {"top1": mean(found.right[found.has_mate]), "queries": int(found.has_mate.sum())}


def by_points(test: TrainingSet, stored: Float32) -> Curve:
    """Return top-1 by the number of points of the segment."""
    found = retrieval.retrieve(stored, test.groups)
    counts = test.segments.counts
    return [
        {
            "points": [low, high - 1],
            "top1": mean(found.right[(counts >= low) & (counts < high) & found.has_mate]),
            "queries": int(((counts >= low) & (counts < high) & found.has_mate).sum()),
        }
        for low, high in pairwise(SIZES)
    ]


def altered(
    extractor: Extractor, test: TrainingSet, stored: Float32, change: Augmentation, lost: float
) -> dict[str, Any]:
    """Return top-1 of queries that lost some of their points, among unaltered segments.

    Only the segment itself is altered, not its neighborhood.
    """
    asked = stored
    if lost:
        segments = change.segments(test.segments, np.random.default_rng(0), exactly=True)
        described = extractor.describe(segments, test.neighborhood)
        asked = extractor.manifest.quantizer.rounded(described)
    found = retrieval.retrieve(stored, test.groups, queries=asked)
    return {"top1": mean(found.right[found.has_mate])}


def by_storage(described: Float32, test: TrainingSet) -> Curve:
    """Return top-1 with fewer (principal) dimensions, and fewer bits per dimension.

    Axes and steps are fitted to the test segments, so rounding is the only loss.
    """
    center = described.mean(axis=0)
    axes = np.linalg.svd((described - center).T @ (described - center))[2]
    curve = []
    for dimension in sorted({min(d, described.shape[1]) for d in DIMENSIONS}):
        projected = (described - center) @ axes[:dimension].T
        # A random rotation spreads the variance evenly, which few bits need.
        turn = np.linalg.qr(np.random.default_rng(0).normal(size=(dimension, dimension)))[0]
        turned = np.asarray(projected @ turn, dtype=np.float32)
        for bits in (32, *REACH):
            kept = turned if bits == 32 else rounded(turned, bits)
            found = retrieval.retrieve(kept, test.groups)
            curve.append(
                {
                    "dimension": dimension,
                    "bits": bits,
                    "bytes": dimension * bits / 8,
                    "top1": mean(found.right),
                }
            )
    return curve


def rounded(values: Float32, bits: int) -> Float32:
    """Round values to uniform steps of this number of bits."""
    count = 2**bits
    step = 2 * float(np.quantile(np.abs(values), REACH[bits])) / (count - 1)
    cells = np.floor(values / step).clip(-count // 2, count // 2 - 1)
    return np.asarray((cells + 0.5) * step, dtype=np.float32)


def misses(stored: Float32, test: TrainingSet, centroids: Float64) -> dict[str, float]:
    """Return the shares of segments whose nearest segment is not a mate, by reason.

    Each miss counts once, under the first reason that holds:

    - `no_mate`: the segment has no mate.
    - `near_place`: the nearest segment is within 1.5 m of the query or a mate, but of another
      group: a neighbor, or the same object with another label.
    - `wandering`: the centroids of the group are more than 1 m apart, because the object moves or
      is seen in changing parts.
    - `small`: the segment has less than 250 points.
    - `other`: any other reason.
    """
    found = retrieval.retrieve(stored, test.groups)
    missed = ~found.right
    counts = {"right": float(found.right.mean())}
    reasons = {
        "no_mate": ~found.has_mate,
        "near_place": in_near_place(test.groups, centroids, found.nearest),
        "wandering": wander(test, centroids) > 1.0,
        "small": test.segments.counts < 250,
        "other": np.ones(len(test), dtype=bool),
    }
    for name, holds in reasons.items():
        counts[name] = float((missed & holds).mean())
        missed = missed & ~holds
    return counts


def in_near_place(groups: Int64, centroids: Float64, nearest: Int64) -> Bool:
    """Return whether the nearest segment is within 1.5 m of the query or of a mate."""
    same = np.zeros(len(groups), dtype=bool)
    for group in np.unique(groups):
        members = np.flatnonzero(groups == group)
        hits = centroids[nearest[members]]
        apart = np.linalg.norm(hits[:, None] - centroids[members][None], axis=2)
        same[members] = apart.min(axis=1) <= NEAR_PLACE
    return same


def wander(test: TrainingSet, centroids: Float64) -> Float64:
    """Return the extent of the centroids of each segment's group, meters."""
    far = np.zeros(len(test.group_sizes()))
    for group in np.unique(test.groups):
        places = centroids[test.groups == group]
        far[group] = np.linalg.norm(places.max(axis=0) - places.min(axis=0))
    return np.asarray(far[test.groups])
