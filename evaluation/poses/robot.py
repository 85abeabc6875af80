"""A robot as the service knows it: it cuts its drive into segments, uploads a map, and asks."""

import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike
from placecell_client import Client, CompactMap, Info
from scipy.spatial.transform import Rotation

from placecell.core.segments import Segments
from placecell.core.types import Float64, Int8
from placecell.datasets import Drive
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


class SegmentDescriber(Protocol):
    """Service that describes segments: a `Client`, or an `Engine` in this process."""

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> DescribedSegments:
        """Describe the segments of one scan."""

    def info(self) -> Info:
        """Return facts about the service, among them its model's preprocessing."""


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot that has driven.

    Attributes:
        name: of the robot.
        drive: what it drove.
        recordings: segments of the drive, or of parts of it.
        to_common: transform (4, 4) from the drive's world to a frame that all robots share, known
            for the score alone: the service never sees it.
    """

    name: str
    drive: Drive
    recordings: Sequence[Recording]
    to_common: Float64

    def views(self) -> Iterator[tuple[int, Segments, np.ndarray]]:
        """Each frame's scan, all its segments, if any, and which of them are no duplicates."""
        for recording in self.recordings:
            for scan in recording.capture_scans:
                members = np.flatnonzero(recording.captures == scan)
                yield scan, recording.segments.take(members), recording.distinct[members]

    @property
    def frames(self) -> list[int]:
        """Scans that are frames, in the order of `views`."""
        return [scan for recording in self.recordings for scan in recording.capture_scans]

    def check_segments(self) -> None:
        """See that the robot saw something.

        Raises:
            ValueError: it saw no segments, so that it can neither map nor ask.
        """
        if any(len(recording.segments) for recording in self.recordings):
            return
        made_by = self.recordings[0].parameters
        raise ValueError(
            f"{self.drive.folder}: the drive gives no segments for {self.name}: nothing has "
            f"{made_by.min_points} points, each within {made_by.growing_radius} m of the next, in "
            f"the local map of any frame ({made_by.accumulated_scans} scans); take a drive with a "
            "sensor of more beams, or with scans closer together"
        )

    def in_common(self, points: Float64) -> Float64:
        """Points (n, 3) of the drive's world, in the common frame."""
        return np.asarray(points @ self.to_common[:3, :3].T + self.to_common[:3, 3])

    def build_map(self, client: SegmentDescriber, frame: str) -> CompactMap:
        """Have the service describe each frame's segments; keep those that are no duplicates.

        Raises:
            ValueError: there are none.
        """
        self.check_segments()
        codes, centroids, frame_index = [], [], []
        scans: list[int] = []
        model_id = ""
        for scan, segments, distinct in self.views():
            if not len(segments):
                continue
            description = client.describe(clouds(segments), segments.sensors)
            model_id = description.model_id
            assert description.centroids is not None
            codes.append(description.codes[distinct])
            centroids.append(description.centroids[distinct])
            frame_index.append(np.full(int(distinct.sum()), len(scans), dtype=np.uint32))
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
        )


@dataclass(frozen=True, slots=True)
class Answer:
    """What the service said of one segment.

    Attributes:
        centroid: of the query, float64 (3,), meters, common frame.
        candidates: centroids of the candidates, nearest descriptor first, float64 (k, 3), in the
            map's frame.
        robot_position: of the asking robot, float64 (3,), common frame.
    """

    centroid: Float64
    candidates: Float64
    robot_position: Float64


def ask(
    robot: Robot, client: Client, maps: Sequence[str], k: int, views: Sequence[tuple[int, Segments]]
) -> tuple[list[Answer], list[float]]:
    """Send each view's segments to /match: the answers, and the milliseconds of each request."""
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
    """Points of each segment, float32 (n, 3)."""
    return [segments.cloud(index) for index in range(len(segments))]
