"""Robot as a client of the service: segments its drive, builds a map, and matches."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike
from placecell_client import Client, CompactMap, Info
from scipy.spatial.transform import Rotation

from placecell.core.segment_classes import ClassFilter
from placecell.core.segments import Segments, stored_extents
from placecell.core.types import Float64, Int8, UInt8
from placecell.segmentation.recording import Recording


class DescribedSegments(Protocol):
    """Descriptors of n segments: a client's `Description`, or an engine's `Descriptors`."""

    @property
    def model_id(self) -> str:
        """Return the id of the model."""

    @property
    def codes(self) -> Int8:
        """Return the codes, int8 (n, code bytes)."""

    @property
    def centroids(self) -> Float64 | None:
        """Return the centroids, float64 (n, 3), meters."""

    @property
    def classes(self) -> UInt8 | None:
        """Return class and probability of each segment, uint8 (n,); None without a head."""


class SegmentDescriber(Protocol):
    """Service that describes segments: a `Client`, or an `Engine` in this process."""

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> DescribedSegments:
        """Describe the segments of one scan."""

    def info(self) -> Info:
        """Return facts about the service, among them its model's preprocessing."""


class DrivePath(Protocol):
    """Path of a drive: a `Drive`, or what is kept of it.

    Attributes:
        folder: folder of the drive.
        poses: float64 (scans, 4, 4), sensor to the drive's world.
        times: float64 (scans,), seconds.
    """

    folder: Path
    poses: Float64
    times: Float64

    def __len__(self) -> int: ...

    @property
    def title(self) -> str:
        """Return the name of the drive in reports."""

    def path_length(self) -> float:
        """Return the length of the path, meters."""


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot with its drive.

    Attributes:
        name: name of the robot.
        drive: the drive.
        recordings: segments of the drive, or of parts of it.
        to_common: transform (4, 4) from the drive's frame to a frame that all robots share. Only
            the score uses it; the service never gets it.
        sensor: name of the simulated sensor; None if it is not known.
    """

    name: str
    drive: DrivePath
    recordings: Sequence[Recording]
    to_common: Float64
    sensor: str | None = None

    def views(self) -> Iterator[tuple[int, Segments, np.ndarray]]:
        """Yield scan and segments of each capture, and which segments are no duplicates."""
        for recording in self.recordings:
            for scan in recording.capture_scans:
                members = np.flatnonzero(recording.captures == scan)
                yield scan, recording.segments.take(members), recording.distinct[members]

    @property
    def frames(self) -> list[int]:
        """Return the scans of all captures, in the order of `views`."""
        return [scan for recording in self.recordings for scan in recording.capture_scans]

    def check_segments(self) -> None:
        """Check that the drive has segments.

        Raises:
            ValueError: the drive has no segments, so the robot can neither map nor localize.
        """
        if any(len(recording.segments) for recording in self.recordings):
            return
        made_by = self.recordings[0].parameters
        raise ValueError(
            f"{self.drive.folder}: the drive has no segments for {self.name}. A segment has at "
            f"least {made_by.min_points} points, each within {made_by.growing_radius} m of the "
            f"next, in a local map of {made_by.accumulated_scans} scans. Use a sensor with more "
            "beams, or scans that are closer together."
        )

    def in_common(self, points: Float64) -> Float64:
        """Transform points (n, 3) from the drive's frame into the common frame."""
        return np.asarray(points @ self.to_common[:3, :3].T + self.to_common[:3, 3])

    def build_map(
        self,
        client: SegmentDescriber,
        frame: str,
        wanted: ClassFilter | None = None,
        with_classes: bool = False,
    ) -> CompactMap:
        """Build a map of the drive from all segments that are no duplicates.

        Args:
            client: describes the segments.
            frame: name of the map's coordinate frame.
            wanted: filter of the segments by their class; None keeps all.
            with_classes: whether the map has the column `classes`; the model must have classes.

        Raises:
            ValueError: the drive has no segments.
        """
        self.check_segments()
        codes, centroids, frame_index, classes, extents = [], [], [], [], []
        scans: list[int] = []
        model_id = ""
        for scan, segments, distinct in self.views():
            if not len(segments):
                continue
            description = client.describe(clouds(segments), segments.sensors)
            model_id = description.model_id
            kept = distinct
            if wanted is not None and description.classes is not None:
                kept = distinct & wanted.keeps(description.classes)
            assert description.centroids is not None
            if with_classes:
                assert description.classes is not None
                classes.append(description.classes[kept])
            codes.append(description.codes[kept])
            centroids.append(description.centroids[kept])
            low, high = segments.bounds()
            extents.append(stored_extents((high - low)[kept]))
            frame_index.append(np.full(int(kept.sum()), len(scans), dtype=np.uint32))
            scans.append(scan)
        poses = self.drive.poses[scans]
        count = sum(map(len, codes))
        return CompactMap(
            model_id=model_id,
            preprocessing=client.info().model["preprocessing"]["version"],
            frame=frame,
            codes=np.concatenate(codes),
            centroids=np.concatenate(centroids),
            ids=np.arange(count, dtype=np.uint32),
            robots=(self.name,),
            robot=np.zeros(count, dtype=np.uint16),
            frame_index=np.concatenate(frame_index),
            frame_times=self.drive.times[scans],
            frame_positions=poses[:, :3, 3],
            frame_orientations=Rotation.from_matrix(poses[:, :3, :3]).as_quat().astype(np.float32),
            classes=np.concatenate(classes) if with_classes else None,
            extents=np.concatenate(extents),
        )


@dataclass(frozen=True, slots=True)
class Answer:
    """Candidates of one segment.

    Attributes:
        centroid: float64 (3,), centroid of the query in the common frame, meters.
        candidates: float64 (k, 3), centroids of the candidates in the map's frame, nearest
            descriptor first.
        robot_position: float64 (3,), position of the robot in the common frame.
    """

    centroid: Float64
    candidates: Float64
    robot_position: Float64


def ask(
    robot: Robot, client: Client, maps: Sequence[str], k: int, views: Sequence[tuple[int, Segments]]
) -> tuple[list[Answer], list[float]]:
    """Match the segments of each view; return the candidates and the time per request, ms."""
    answers, milliseconds = [], []
    for scan, segments in views:
        points = clouds(segments)
        started = time.perf_counter()
        matches = client.match(segments=points, sensors=segments.sensors, maps=maps, k=k)
        milliseconds.append(1000 * (time.perf_counter() - started))
        position = robot.in_common(robot.drive.poses[scan, :3, 3])
        centroids = robot.in_common(segments.centroids())
        for centroid, candidates in zip(centroids, matches.queries, strict=True):
            places = np.array([candidate.centroid for candidate in candidates]).reshape(-1, 3)
            answers.append(Answer(centroid, places, position))
    return answers, milliseconds


def clouds(segments: Segments) -> list[np.ndarray]:
    """Return the points of each segment, float32 (n, 3)."""
    return [segments.cloud(index) for index in range(len(segments))]
