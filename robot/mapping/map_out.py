"""Map out: turns the segments of keyframes into edits of the robot's own map.

Everything here follows from the scans and the odometry alone, never from the link or the fixes. So
a run with a broken link, or one that was killed and continued, makes the same edits as a run
without faults.
"""

from dataclasses import dataclass, replace
from typing import Self
from zlib import crc32

import numpy as np
from placecell_client import CompactMap, Delta, encode_delta
from scipy.spatial.transform import Rotation

from placecell.core.segment_classes import ClassFilter
from placecell.core.segments import stored_extents
from placecell.core.types import Float32, Float64, Int8, Int64, UInt8
from placecell.segmentation.incremental import LiveSegments
from robot.core.usable_segments import UsableSegments
from robot.mapping.odometry_model import OdometryModel, stated_variances

ODOMETRY = OdometryModel()

NO_IDS = np.zeros(0, dtype=np.int64)
VIEW_METERS = 10.0
"""Distance after which a segment is stored again, as it looks from there, meters."""


@dataclass(frozen=True, slots=True, eq=False)
class Capture:
    """Moment of a scan.

    Attributes:
        time: time of the scan, seconds.
        odom_pose: pose of the sensor in the odometry frame, float64 (4, 4).
        covariance: covariance of this pose, of x, y, z and the rotations about the frame's axes,
            float64 (6, 6); None if it is not known.
    """

    time: float
    odom_pose: Float64
    covariance: Float64 | None = None


@dataclass(frozen=True, slots=True, eq=False)
class SeenSegments:
    """Segments around the robot with descriptors, in the odometry frame.

    Attributes:
        ids: id that each segment keeps while it grows, int64 (n,).
        codes: descriptors, int8 (n, code bytes).
        centroids: float64 (n, 3), meters.
        model_id: id of the model of the descriptors.
        preprocessing: version of the steps from points to the model's input.
        classes: class of each segment with its probability, uint8 (n,); None if the model has no
            semantic head.
        sides: sides of the boxes along the axes of the odometry frame, meters, float32 (n, 3); None
            if they are not known.
    """

    ids: Int64
    codes: Int8
    centroids: Float64
    model_id: str
    preprocessing: str
    classes: UInt8 | None = None
    sides: Float32 | None = None

    @classmethod
    def of(
        cls, found: UsableSegments, live: LiveSegments, model_id: str, preprocessing: str
    ) -> Self:
        """Return the segments of a capture that have a descriptor."""
        low, high = live.segments.bounds()
        return cls(
            live.ids[found.usable],
            found.codes,
            found.centroids,
            model_id,
            preprocessing,
            found.classes,
            (high - low)[found.usable],
        )

    def wanted(self, wanted: ClassFilter | None) -> Self:
        """Return the segments that a filter keeps; without classes, all."""
        if wanted is None or self.classes is None:
            return self
        rows = np.flatnonzero(wanted.keeps(self.classes))
        return replace(
            self,
            ids=self.ids[rows],
            codes=self.codes[rows],
            centroids=self.centroids[rows],
            classes=self.classes[rows],
            sides=None if self.sides is None else self.sides[rows],
        )


@dataclass(frozen=True, slots=True)
class MapEdit:
    """Edit of the robot's own map.

    Attributes:
        sequence: number of the edit in the session, from 0.
        part: number of the map: a jump of the odometry begins another one.
        content: delta file.
        segments: number of new segments.
    """

    sequence: int
    part: int
    content: bytes
    segments: int


def track_of(frame: str) -> int:
    """Return the number of an odometry track, from the name of its coordinate frame."""
    return crc32(frame.encode()) or 1  # 0 means that there is no odometry


class EditMaker:
    """Makes the edits of a session.

    A segment is sent when it is first seen, and again as another view after each 10 m of the way.
    The robot begins each map and numbers its views from 0, so no other robot has the same ids. The
    service leaves out views that it has already, and keeps at most eight of an object. If a
    segment moves, an edit removes the views of it that were sent before.

    Attributes:
        part: number of the map that is written now.
        sequence: number of the next edit.
    """

    def __init__(self, robot: str, session: str, odometry: OdometryModel = ODOMETRY) -> None:
        self._robot = robot
        self._session = session
        self._odometry = odometry
        self._last: Capture | None = None
        self._variances = np.zeros(3)
        self.part = 0
        self.sequence = 0
        self._next_id = 0
        self._viewed_at: dict[int, float] = {}
        self._stored: dict[int, list[int]] = {}  # ids in the map of each segment's views

    @property
    def frame(self) -> str:
        """Name of the coordinate frame of the current map; no other session has the same."""
        return f"{self._robot}/{self._session}/{self.part}"[-200:]

    def add(
        self,
        seen: SeenSegments,
        capture: Capture,
        meters: float,
        moved: Int64 = NO_IDS,
    ) -> MapEdit | None:
        """Return the edit with the new views of a keyframe; None if there is none.

        Args:
            seen: segments around the robot that did not move.
            capture: moment of the keyframe.
            meters: distance driven until then.
            moved: ids of segments that have moved, int64 (m,): their views leave the map.
        """
        self._drive(capture)
        left = [view for each in moved.tolist() for view in self._stored.pop(each, ())]
        before = self._viewed_at
        ids = seen.ids.tolist()
        chosen = [
            row
            for row, each in enumerate(ids)
            if each not in before or meters - before[each] >= VIEW_METERS
        ]
        # A segment that was not found again does not come back under its old id.
        self._viewed_at = {each: before[each] for each in ids if each in before}
        self._viewed_at |= {ids[row]: meters for row in chosen}
        self._stored = {each: self._stored.get(each, []) for each in self._viewed_at}
        for number, row in enumerate(chosen):
            self._stored[ids[row]].append(self._next_id + number)
        if not chosen and not left:
            return None
        count = len(chosen)
        pose = capture.odom_pose
        turn = Rotation.from_matrix(pose[:3, :3]).as_quat()
        segments = CompactMap(
            model_id=seen.model_id,
            preprocessing=seen.preprocessing,
            frame=self.frame,
            codes=seen.codes[chosen],
            centroids=seen.centroids[chosen],
            ids=np.arange(self._next_id, self._next_id + count, dtype=np.uint32),
            robots=(self._robot,) if count else (),
            robot=np.zeros(count, dtype=np.uint16),
            frame_index=np.zeros(count, dtype=np.uint32),
            frame_times=np.array([capture.time]),
            frame_positions=pose[None, :3, 3].copy(),
            frame_orientations=turn[None].astype(np.float32),
            frame_tracks=np.array([track_of(self.frame)], np.uint32),
            classes=None if seen.classes is None else seen.classes[chosen],
            extents=None if seen.sides is None else stored_extents(seen.sides[chosen]),
            frame_odometry=np.array(
                [[*pose[:3, 3], np.arctan2(pose[1, 0], pose[0, 0]), *self._variances]]
            ),
        )
        content = encode_delta(Delta(segments, np.array(sorted(left), dtype=np.uint32)))
        edit = MapEdit(self.sequence, self.part, content, count)
        self.sequence += 1
        self._next_id += count
        return edit

    def begin_part(self) -> None:
        """Begin another map: the odometry frame jumped, so new segments do not fit the old one."""
        self.part += 1
        self._next_id = 0
        self._viewed_at.clear()
        self._stored.clear()
        self._last = None
        self._variances = np.zeros(3)

    def _drive(self, capture: Capture) -> None:
        """Add the variances of the way since the last capture, also of one without an edit."""
        before, self._last = self._last, capture
        if before is None:
            return
        step = self._odometry.variances(before.odom_pose, capture.odom_pose)
        if before.covariance is not None and capture.covariance is not None:
            step = stated_variances(
                (before.odom_pose, before.covariance),
                (capture.odom_pose, capture.covariance),
                step,
            )
        self._variances = self._variances + step
