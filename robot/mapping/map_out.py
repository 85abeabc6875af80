"""Map out: turns the segments of keyframes into edits of the robot's own map.

Everything here follows from the scans and the odometry alone, never from the link or the fixes. So
a run with a broken link, or one that was killed and continued, makes the same edits as a run
without faults.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from placecell_client import CompactMap, Delta, encode_delta
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64, Int8, Int64
from placecell.segmentation.incremental import LiveSegments


@dataclass(frozen=True, slots=True, eq=False)
class Capture:
    """Moment of a scan.

    Attributes:
        time: time of the scan, seconds.
        odom_pose: pose of the sensor in the odometry frame, float64 (4, 4).
    """

    time: float
    odom_pose: Float64


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


class EditMaker:
    """Makes the edits of a session.

    A segment is sent when it is complete, and again in place of its former view if it grew. The
    robot begins each map and numbers its segments from 0, so no other robot has the same ids. The
    service leaves out views that it has already.

    Attributes:
        part: number of the map that is written now.
        sequence: number of the next edit.
    """

    def __init__(self, robot: str, session: str) -> None:
        self._robot = robot
        self._session = session
        self.part = 0
        self.sequence = 0
        self._next_id = 0
        self._ids: dict[int, int] = {}

    @property
    def frame(self) -> str:
        """Name of the coordinate frame of the current map; no other session has the same."""
        return f"{self._robot}/{self._session}/{self.part}"[-200:]

    def add(
        self,
        views: LiveSegments,
        codes: Int8,
        centroids: Float64,
        captures: Sequence[Capture],
        live: Int64,
        model_id: str,
        preprocessing: str,
        is_last: bool = False,
    ) -> MapEdit | None:
        """Return the edit with the segments that became complete; None if there is none.

        Args:
            views: final views of segments.
            codes: their descriptors, int8 (n, code bytes).
            centroids: their centroids, float64 (n, 3), meters.
            captures: capture of each view.
            live: ids of the segments that may still grow.
            model_id: id of the model of the descriptors.
            preprocessing: version of the steps from points to the model's input.
            is_last: the drive ends here, so that segments that are not complete are sent, too.
        """
        chosen = np.flatnonzero(views.complete | is_last)
        ids = [self._id_of(each) for each in views.ids[chosen].tolist()]
        # A segment that was not found again does not come back under its old id.
        going_on = set(live.tolist())
        self._ids = {each: id_ for each, id_ in self._ids.items() if each in going_on}
        if not len(chosen):
            return None
        _, first, frame_index = np.unique(
            views.scans[chosen], return_index=True, return_inverse=True
        )
        moments = [captures[int(chosen[row])] for row in first]
        poses = np.array([each.odom_pose for each in moments])
        count = len(chosen)
        segments = CompactMap(
            model_id=model_id,
            preprocessing=preprocessing,
            frame=self.frame,
            codes=codes[chosen],
            centroids=centroids[chosen],
            ids=np.array(ids, dtype=np.uint32),
            robots=(self._robot,),
            robot=np.zeros(count, dtype=np.uint16),
            frame_index=frame_index.astype(np.uint32).reshape(-1),
            frame_times=np.array([each.time for each in moments]),
            frame_positions=poses[:, :3, 3].copy(),
            frame_orientations=Rotation.from_matrix(poses[:, :3, :3]).as_quat().astype(np.float32),
        )
        edit = MapEdit(
            self.sequence,
            self.part,
            encode_delta(Delta(segments, np.zeros(0, dtype=np.uint32))),
            count,
        )
        self.sequence += 1
        return edit

    def begin_part(self) -> None:
        """Begin another map: the odometry frame jumped, so new segments do not fit the old one."""
        self.part += 1
        self._next_id = 0
        self._ids.clear()

    def _id_of(self, live_id: int) -> int:
        if live_id not in self._ids:
            self._ids[live_id] = self._next_id
            self._next_id += 1
        return self._ids[live_id]
