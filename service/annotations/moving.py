"""Movement of anchors: an anchor follows the capture beside it when captures are moved.

An anchor belongs to the capture that is nearest when it moves for the first time. It keeps this
capture, so restoring the version before brings it back to where it was.
"""

import numpy as np
from placecell_client import CompactMap
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64, Int64
from placecell.localization import Pose
from placecell.pose_graph.frames import headings


class CaptureMovement:
    """Movement of the captures that two versions of a map have in common."""

    def __init__(self, before: CompactMap, after: CompactMap) -> None:
        """Compare two versions by the ids of their segments.

        Args:
            before: the earlier version, with ascending ids.
            after: the later version, with ascending ids.
        """
        ids, rows, places = np.intersect1d(
            before.ids, after.ids, assume_unique=True, return_indices=True
        )
        here, there = before.frame_index[rows], after.frame_index[places]
        # A segment with another time was replaced: it is of another capture.
        same = before.frame_times[here] == after.frame_times[there]
        # The smallest id stands for the capture.
        self._frames, first = np.unique(here[same], return_index=True)
        self._ids, others = ids[same][first], there[same][first]
        self._members = dict(zip(ids[same].tolist(), here[same].tolist(), strict=True))
        self._before = _poses(before, self._frames)
        self._after = _poses(after, others)

    @property
    def is_none(self) -> bool:
        """Whether no capture moved."""
        return all(
            np.array_equal(one, other) for one, other in zip(self._before, self._after, strict=True)
        )

    def nearest(self, position: Float64) -> int | None:
        """Return the id of a segment of the capture nearest to a position; None without one."""
        if not len(self._ids):
            return None
        away = np.linalg.norm(self._before[0] - position, axis=1)
        return int(self._ids[away.argmin()])

    def of(self, segment: int) -> Pose | None:
        """Return how the capture of a segment moved; None if only one version has it."""
        frame = self._members.get(segment)
        if frame is None:
            return None
        row = int(np.searchsorted(self._frames, frame))
        (position, yaw), (there, turned) = (
            (positions[row], float(yaws[row])) for positions, yaws in (self._before, self._after)
        )
        turn = Pose.of_yaw(turned - yaw, np.zeros(3))
        return Pose(turn.rotation, there - turn.apply(position))

    def at(self, position: Float64) -> Pose:
        """Return how the capture nearest to a position moved."""
        segment = self.nearest(position)
        found = None if segment is None else self.of(segment)
        return Pose.of_yaw(0.0, np.zeros(3)) if found is None else found

    def bound(self, position: Float64, segment: int | None) -> tuple[int, Pose] | None:
        """Return the segment whose capture an anchor follows, and how the capture moved.

        Args:
            position: position of the anchor.
            segment: segment whose capture it followed before; None if it has not moved yet.

        Returns:
            None if there is no capture to follow.
        """
        found = None if segment is None else self.of(segment)
        if found is None or segment is None:
            segment = self.nearest(position)
            found = None if segment is None else self.of(segment)
        return None if segment is None or found is None else (segment, found)


def _poses(content: CompactMap, frames: Int64) -> tuple[Float64, Float64]:
    """Return positions (f, 3) and headings (f,) of captures."""
    rotations = Rotation.from_quat(content.frame_orientations[frames].reshape(-1, 4))
    return content.frame_positions[frames], headings(rotations.as_matrix().reshape(-1, 3, 3))
