"""Augmentation for classes: altered copies of segments that keep their class.

Simulated surfaces are flatter, smoother and better registered than real ones. So copies of
simulated segments are bent and stretched, get noise, and vegetation grows together with other
vegetation. Copies of all segments lose parts and points (`training.data.augmentation`).
"""

import numpy as np

from placecell.core.segment_classes import CLASSES
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64, UInt8
from training.data.augmentation import Augmentation

LOSSES = Augmentation(beam_share=0.2)
"""Losses of parts and points."""

WAVES = 3
"""Number of waves that bend a segment."""

BEND = 0.18
"""Largest amplitude of a wave, meters."""

WAVELENGTHS = (1.5, 5.0)
"""Shortest and longest wave, meters."""

STRETCH = 0.15
"""Largest logarithm of the factor of a segment's size."""

NOISE = 0.05
"""Largest standard deviation of the noise of a point's coordinates, meters."""

MOUNT = 0.4
"""Standard deviation of the height of the sensor, meters: slopes, and mounts of other robots."""

GROWN = 0.4
"""Share of the segments of vegetation that grow together with others."""

MOST_POINTS = 8000
"""Largest number of points of vegetation that grew together."""


def lossy(segments: Segments, rng: np.random.Generator) -> Segments:
    """Return copies that lost parts and points, for recorded drives."""
    return LOSSES.segments(segments, rng)


def varied(
    segments: Segments, classes: UInt8, captures: Int64, rng: np.random.Generator
) -> Segments:
    """Return copies that differ as real segments differ from simulated ones.

    Args:
        segments: simulated segments.
        classes: class index of each segment.
        captures: capture of each segment.
        rng: random number generator.
    """
    some = lossy(grown(segments, classes, captures, rng), rng)
    sensors = some.sensors.copy()
    sensors[:, 2] += rng.normal(0, MOUNT, len(some)).astype(np.float32)
    return Segments(bent(some, rng), some.ends, sensors)


def bent(segments: Segments, rng: np.random.Generator) -> Float32:
    """Return the points of segments that are bent by waves, stretched and noisy."""
    count, owners = len(segments), segments.owners
    centers = segments.centroids()[owners]
    points = segments.points - centers
    amplitudes = rng.uniform(0, BEND, count)
    moved = points.copy()
    for _ in range(WAVES):
        waves = directions(rng, count) * (2 * np.pi / rng.uniform(*WAVELENGTHS, count))[:, None]
        shifts = directions(rng, count) * amplitudes[:, None]
        phases = (points * waves[owners]).sum(axis=1) + rng.uniform(0, 2 * np.pi, count)[owners]
        moved += shifts[owners] * np.sin(phases)[:, None]
    factors = np.exp(rng.uniform(-STRETCH, STRETCH, (count, 3)))
    factors[:, 1] = factors[:, 0]
    moved *= factors[owners]
    moved += rng.standard_normal(moved.shape) * rng.uniform(0, NOISE, count)[owners, None]
    return np.asarray(moved + centers, dtype=np.float32)


def directions(rng: np.random.Generator, count: int) -> Float64:
    """Return random unit vectors, float64 (count, 3)."""
    drawn = rng.normal(size=(count, 3))
    return np.asarray(drawn / np.linalg.norm(drawn, axis=1, keepdims=True))


def grown(
    segments: Segments, classes: UInt8, captures: Int64, rng: np.random.Generator
) -> Segments:
    """Return the segments, some of the vegetation joined with other vegetation beside it."""
    low, high = segments.bounds()
    centroids, wide = segments.centroids(), (high - low)[:, :2].max(axis=1)
    clouds = [segments.cloud(index) for index in range(len(segments))]
    joined = list(clouds)
    plants = classes == CLASSES.index("vegetation")
    for capture in np.unique(captures):
        members = np.flatnonzero(plants & (captures == capture))
        for index in members.tolist():
            if len(members) < 2 or rng.random() >= GROWN:
                continue
            parts = [clouds[index]]
            for other in rng.choice(members, size=int(rng.integers(1, 5))).tolist():
                angle, apart = rng.uniform(0, 2 * np.pi), 0.4 * (wide[index] + wide[other])
                beside = centroids[index] - centroids[other]
                beside[:2] += apart * np.array([np.cos(angle), np.sin(angle)])
                # On the same ground, or up to 1.5 m higher.
                beside[2] = low[index, 2] - low[other, 2] + max(0.0, rng.uniform(-0.5, 1.5))
                parts.append((clouds[other] + beside).astype(np.float32))
            cloud = np.concatenate(parts)
            if len(cloud) > MOST_POINTS:
                cloud = cloud[rng.permutation(len(cloud))[:MOST_POINTS]]
            joined[index] = cloud
    return Segments.of(joined, segments.sensors)
