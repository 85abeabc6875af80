"""Perception: from scans and odometry to keyframes with segments, and to edits of a map.

The result depends on the scans and the odometry only. `Perception` can be pickled: a restarted
agent continues after the last checkpoint and makes the same edits.
"""

import pickle
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal, Self

import numpy as np

from placecell.core.parameters import Parameters
from placecell.core.segment_classes import ClassFilter
from placecell.core.types import Float32, Float64, Int8, UInt8
from placecell.segmentation.incremental import IncrementalSegmentation, LiveSegments
from robot.core.usable_segments import UsableSegments
from robot.localization.scan_jump import ScanAgreement, object_columns
from robot.mapping.keyframes import Keyframes
from robot.mapping.map_out import Capture, EditMaker, MapEdit, SeenSegments

VERSION = 5
"""Version of the checkpoints."""
STANDING = 0.1
"""Steps below this length are noise of the odometry of a standing robot, meters."""
LARGE_STEP = 5.0
"""Distance between two scans from which their columns are not compared, meters: scans between them
are missing."""

Jump = Literal["doubt", "cleared", "carried away"]
"""A scan that does not fit the one before; the next one that does; a second one that does not."""

Describe = Callable[[list[Float32], Float32], UsableSegments]
"""Function that describes the segments of a capture."""


@dataclass(frozen=True, slots=True, eq=False)
class Keyframe:
    """Segments around the robot at a keyframe, in the odometry frame.

    Attributes:
        live: the segments; without those that have moved, unless they are kept.
        codes: descriptors of those that have one, int8 (n, code bytes).
        centroids: their centroids, float64 (n, 3), meters.
        classes: their classes, uint8 (n,); None if the model has no semantic head.
        heights: vertical sides of their boxes, meters, float64 (n,).
    """

    live: LiveSegments
    codes: Int8
    centroids: Float64
    classes: UInt8 | None = None
    heights: Float64 | None = None


@dataclass(frozen=True, slots=True, eq=False)
class PerceptionStep:
    """Result of a scan.

    Attributes:
        jump: whether the scan fits the one before; None if it does.
        keyframe: segments, if the scan is a keyframe.
        edit: edit of the robot's map, if there is one.
    """

    jump: Jump | None = None
    keyframe: Keyframe | None = None
    edit: MapEdit | None = None


@dataclass(slots=True)
class Perception:
    """Local map, keyframes and edits of one session.

    Attributes:
        map_out: makes the edits.
        scans: number of scans, with those that were dropped.
        meters: distance driven.
        keyframes: number of keyframes.
        part: number of jumps so far.
        keep_moving: whether segments that move while they are seen are stored and localized.
        unmapped: classes of segments that are not stored.
    """

    map_out: EditMaker
    keyframe_rule: Keyframes
    segmentation: IncrementalSegmentation
    model_id: str
    preprocessing: str
    keep_moving: bool = False
    unmapped: tuple[str, ...] = ()
    agreement: ScanAgreement = field(default_factory=ScanAgreement)
    scans: int = 0
    meters: float = 0.0
    keyframes: int = 0
    part: int = 0
    _last_position: Float64 | None = None
    _last_step: Float64 | None = None
    _doubted: Capture | None = None
    _doubted_points: Float32 | None = None

    @classmethod
    def begin(
        cls,
        robot: str,
        session: str,
        parameters: Parameters,
        keyframe_meters: float,
        model_id: str,
        preprocessing: str,
        keep_moving: bool = False,
        unmapped: tuple[str, ...] = (),
    ) -> Self:
        """Begin a session; the attributes have the arguments' names."""
        return cls(
            EditMaker(robot, session),
            Keyframes(keyframe_meters, max(1, parameters.accumulated_scans // 2)),
            IncrementalSegmentation(parameters),
            model_id,
            preprocessing,
            keep_moving,
            unmapped,
        )

    @classmethod
    def load(cls, checkpoint: bytes, model_id: str) -> Self | None:
        """Return the state of a checkpoint; None if it is of another version or model."""
        try:
            version, found = pickle.loads(checkpoint)
        except Exception:  # Anything may happen with a damaged pickle.
            return None
        same = version == VERSION and isinstance(found, cls) and found.model_id == model_id
        return found if same else None

    def checkpoint(self) -> bytes:
        """Return the state, to continue from."""
        return pickle.dumps((VERSION, self), protocol=pickle.HIGHEST_PROTOCOL)

    def keyframe_now(self) -> None:
        """Make the next scan a keyframe."""
        self.keyframe_rule.expect()

    def skip(self) -> None:
        """Count a scan that is not processed."""
        self.scans += 1

    def add(
        self,
        points: Float32,
        time: float,
        odom_pose: Float64,
        describe: Describe,
        odom_covariance: Float64 | None = None,
    ) -> PerceptionStep:
        """Process a scan.

        Args:
            points: float32 (n, 3), meters, in the sensor's frame.
            time: time of the scan, seconds.
            odom_pose: pose of the sensor in the odometry frame, float64 (4, 4).
            describe: describes the segments of a capture.
            odom_covariance: covariance of the pose, float64 (6, 6); None if it is not known.
        """
        self.scans += 1
        self._drive(odom_pose)
        columns = object_columns(points, odom_pose)
        if self._is_after_gap(odom_pose):
            self.agreement.reset()
        fit = self.agreement.examine(columns)
        capture = Capture(time, odom_pose.copy(), odom_covariance)
        jump: Jump | None = None
        if not fit.fits and self._doubted is None:
            self._doubted, self._doubted_points = capture, points
            return PerceptionStep("doubt")
        if not fit.fits and self._doubted is not None:
            jump = "carried away"
            assert self._doubted_points is not None
            self._begin_anew(self._doubted)
            self._take(self._doubted_points, self._doubted)
            fit = self.agreement.examine(columns)
        elif self._doubted is not None:
            jump = "cleared"  # The doubtful scan is left out.
        self._doubted = self._doubted_points = None
        self.agreement.accept(columns, fit)
        self._take(points, capture)
        if not self.keyframe_rule.add(odom_pose):
            return PerceptionStep(jump)
        keyframe, edit = self._keyframe(describe, capture)
        return PerceptionStep(jump, keyframe, edit)

    def _keyframe(self, describe: Describe, capture: Capture) -> tuple[Keyframe, MapEdit | None]:
        self.keyframes += 1
        every = self.segmentation.segments()
        moves = every.moved & (not self.keep_moving)
        live = every.take(np.flatnonzero(~moves))
        self.segmentation.take_final_views()  # Views of all sides are stored, not only the best.
        found = describe(clouds_of(live), live.segments.sensors)
        low, high = live.segments.bounds()
        heights = (high - low)[found.usable, 2].astype(np.float64)
        keyframe = Keyframe(live, found.codes, found.centroids, found.classes, heights)
        if not self.keyframe_rule.is_complete:
            return keyframe, None  # The first scans show too little of a segment to store it.
        seen = SeenSegments.of(found, live, self.model_id, self.preprocessing)
        mapped = seen.wanted(ClassFilter.of(None, self.unmapped))
        edit = self.map_out.add(mapped, capture, self.meters, every.ids[moves])
        return keyframe, edit

    def _take(self, points: Float32, capture: Capture) -> None:
        self.segmentation.add(points, capture.odom_pose)

    def _begin_anew(self, first: Capture) -> None:
        self.part += 1
        self.segmentation.reset()
        self.agreement.reset()
        self.keyframe_rule.reset(first.odom_pose)
        self.map_out.begin_part()

    def _drive(self, odom_pose: Float64) -> None:
        position = odom_pose[:3, 3].copy()
        if self._last_position is None:
            self._last_position = position
        step = float(np.linalg.norm(position - self._last_position))
        if step >= STANDING:
            self.meters += step
            self._last_position = position

    def _is_after_gap(self, odom_pose: Float64) -> bool:
        before, self._last_step = self._last_step, odom_pose[:3, 3].copy()
        return before is not None and float(np.linalg.norm(self._last_step - before)) > LARGE_STEP


def clouds_of(live: LiveSegments) -> list[Float32]:
    """Return the points of each segment."""
    return [live.segments.cloud(index) for index in range(len(live))]
