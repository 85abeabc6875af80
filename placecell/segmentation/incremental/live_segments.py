"""Live segments: the segments of one capture, with ids that persist."""

from dataclasses import dataclass

import numpy as np

from placecell.core.segments import Segments
from placecell.core.types import Bool, Int64


@dataclass(frozen=True, slots=True, eq=False)
class LiveSegments:
    """Segments of a robot's local map, or best views of its segments.

    Attributes:
        segments: segments in the odometry frame, with the sensor position at capture.
        ids: int64 (segments,), unique; a segment keeps its id while it grows.
        complete: bool (segments,), whether the segment was seen whole: it is clear of the local
            map's border and has stopped growing.
        scans: int64 (segments,), number of the scan at which each view was captured, from 0.
        moved: bool (segments,), whether the segment has moved since it was first seen (see
            `motion`). A segment that has moved once stays marked.
    """

    segments: Segments
    ids: Int64
    complete: Bool
    scans: Int64
    moved: Bool

    def __len__(self) -> int:
        return len(self.segments)

    def take(self, indices: Int64) -> "LiveSegments":
        """Return the segments at these indices, in this order."""
        return LiveSegments(
            self.segments.take(indices),
            self.ids[indices],
            self.complete[indices],
            self.scans[indices],
            self.moved[indices],
        )

    @classmethod
    def none(cls) -> "LiveSegments":
        """Return no segments."""
        return cls.concatenate([])

    @classmethod
    def concatenate(cls, parts: "list[LiveSegments]") -> "LiveSegments":
        """Concatenate several sets of segments."""
        return cls(
            Segments.concatenate([part.segments for part in parts]),
            np.concatenate([np.zeros(0, np.int64), *(part.ids for part in parts)]),
            np.concatenate([np.zeros(0, bool), *(part.complete for part in parts)]),
            np.concatenate([np.zeros(0, np.int64), *(part.scans for part in parts)]),
            np.concatenate([np.zeros(0, bool), *(part.moved for part in parts)]),
        )
