"""Placing of cast things among the segments of a simulated drive."""

from dataclasses import dataclass

import numpy as np

from placecell.core.segment_classes import CLASSES
from placecell.core.segments import Segments
from placecell.core.types import Int64, UInt8
from training.classes.casting import cast
from training.classes.things import MAKERS

THINGS = {
    "car": (110, ("vehicle",)),
    "tree": (15, ("pole", "vegetation")),
    "post": (25, ("sign", "pole")),
    "furniture": (12, ("other",)),
    "hedge": (12, ("vegetation",)),
    "crown": (10, ("vegetation",)),
    "fence": (12, ("fence", "vegetation")),
}
"""Number of things of each kind in a drive, and the classes of the segments in whose places they
are; any segment if the drive has none of these."""

MOUNT, SLOPE = (1.75, 0.15), 0.3
"""Mean and deviation of the sensor's height over ground, and deviation of the ground, meters."""


@dataclass(frozen=True, slots=True)
class PlacedThings:
    """Segments that were cast.

    Attributes:
        segments: the segments.
        classes: class index of most points of each, uint8 (n,).
        places: segment of the drive in whose place each is, int64 (n,).
    """

    segments: Segments
    classes: UInt8
    places: Int64


def placed_things(segments: Segments, classes: UInt8, rng: np.random.Generator) -> PlacedThings:
    """Return things that are cast in the places of segments, toward their sensors.

    Args:
        segments: segments of a simulated drive.
        classes: class index of each, uint8 (n,).
        rng: random number generator.
    """
    centroids = segments.centroids()
    clouds, kinds, places = [], [], []
    for name, (number, like) in THINGS.items():
        rows = np.flatnonzero(np.isin(classes, [CLASSES.index(each) for each in like]))
        rows = rows if len(rows) else np.arange(len(segments))
        for row in rng.choice(rows, number if len(rows) else 0).tolist():
            to_sensor = (segments.sensors[row] - centroids[row])[:2]
            height = float(rng.normal(*MOUNT))
            bearing = float(np.arctan2(to_sensor[1], to_sensor[0]))
            found = cast(MAKERS[name](bearing, rng), to_sensor, height, rng)
            if found is None:
                continue
            ground = segments.sensors[row, 2] - height + rng.normal(0, SLOPE)
            origin = np.array([*centroids[row, :2], ground])
            clouds.append((found.points + origin).astype(np.float32))
            kinds.append(found.kind)
            places.append(row)
    chosen = np.array(places, np.int64)
    sensors = segments.sensors[chosen]
    return PlacedThings(Segments.of(clouds, sensors), np.array(kinds, np.uint8), chosen)
