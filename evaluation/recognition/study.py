"""What recognition depends on, and what limits it: size, viewpoint, occlusion, density, labels.

All on a test drive, of descriptors as they are stored unless said otherwise.
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
"""Share of the values within reach of the levels, by bits of a level."""
NEAR_PLACE = 1.5
"""Metres between centroids of segments that stand in one place, whatever group they are of."""

Curve = list[dict[str, Any]]


def study(extractor: Extractor, test: TrainingSet) -> dict[str, Any]:
    """All curves of one model."""
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
    """Of the segments that have a mate left, how many find one first; and how many they are."""
    found = retrieval.retrieve(stored, test.groups, too_easy)
    return {"top1": mean(found.right[found.has_mate]), "queries": int(found.has_mate.sum())}


def by_points(test: TrainingSet, stored: Float32) -> Curve:
    """Recognition of small and of large segments."""
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
    """Queries that lost a part of their points, among the others as they are.

    What stands around them is as it was: only the segment itself is altered.
    """
    asked = stored
    if lost:
        segments = change.segments(test.segments, np.random.default_rng(0), exactly=True)
        described = extractor.describe(segments, test.neighborhood)
        asked = extractor.manifest.quantizer.rounded(described)
    found = retrieval.retrieve(stored, test.groups, queries=asked)
    return {"top1": mean(found.right[found.has_mate])}


def by_storage(described: Float32, test: TrainingSet) -> Curve:
    """Fewer dimensions (the principal ones), and fewer bits for each.

    Axes and steps are the test segments' own: what is lost is lost to rounding alone.
    """
    center = described.mean(axis=0)
    axes = np.linalg.svd((described - center).T @ (described - center))[2]
    curve = []
    for dimension in sorted({min(d, described.shape[1]) for d in DIMENSIONS}):
        projected = (described - center) @ axes[:dimension].T
        # Spread evenly over the dimensions, as few bits want it.
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
    """To uniform steps of so many bits."""
    count = 2**bits
    step = 2 * float(np.quantile(np.abs(values), REACH[bits])) / (count - 1)
    cells = np.floor(values / step).clip(-count // 2, count // 2 - 1)
    return np.asarray((cells + 0.5) * step, dtype=np.float32)


def misses(stored: Float32, test: TrainingSet, centroids: Float64) -> dict[str, float]:
    """What the segments that find no mate first are, as shares of all segments.

    Each miss counts once, under the first of: `no_mate`, nothing to be found; `near_place`, what
    was found stands within 1.5 m of the query or a mate, but is of another group: its neighbour, or
    itself under another label;
    `wandering`, the group's centroid wanders by more than a metre, for it moves or shows ever other
    parts of itself; `small`, under 250 points;
    `other`.
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
    """Whether what was found stands within 1.5 m of the query or a mate of it."""
    same = np.zeros(len(groups), dtype=bool)
    for group in np.unique(groups):
        members = np.flatnonzero(groups == group)
        hits = centroids[nearest[members]]
        apart = np.linalg.norm(hits[:, None] - centroids[members][None], axis=2)
        same[members] = apart.min(axis=1) <= NEAR_PLACE
    return same


def wander(test: TrainingSet, centroids: Float64) -> Float64:
    """Of each segment: how far apart, in metres, its group's centroids lie."""
    far = np.zeros(len(test.group_sizes()))
    for group in np.unique(test.groups):
        places = centroids[test.groups == group]
        far[group] = np.linalg.norm(places.max(axis=0) - places.min(axis=0))
    return np.asarray(far[test.groups])
