"""Usable segments: the stored form of those that have a descriptor."""

from dataclasses import dataclass

from placecell.core.types import Float64, Int8, Int64, UInt8


@dataclass(frozen=True, slots=True, eq=False)
class UsableSegments:
    """Segments of one capture that have a descriptor, without the others.

    Attributes:
        codes: descriptors, int8 (k, code bytes).
        centroids: float64 (k, 3), meters, in the frame of the points.
        usable: indices of these segments among those of the capture, int64 (k,).
        classes: class of each segment with its probability, uint8 (k,); None if the model has no
            semantic head.
    """

    codes: Int8
    centroids: Float64
    usable: Int64
    classes: UInt8 | None = None
