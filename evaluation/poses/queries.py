"""Pose queries: descriptors of the segments around a robot, and its true pose in a map."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Self

import numpy as np
from placecell_client import CompactMap
from placecell_client.hints import Hints, SensorPose
from scipy.spatial import cKDTree

from evaluation.poses.recordings import recording_of
from evaluation.poses.robot import Robot, clouds
from evaluation.poses.robots import robots_of_drive
from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.segment_classes import ClassFilter
from placecell.core.segments import Segments
from placecell.core.types import Float64, Int8, Int64
from placecell.datasets import Drive, open_drive
from placecell.localization import Hypothesis, Localization, LocalizationParameters, Pose
from placecell.localization.evidence import Evidence, RequestHistory
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine
from service.inference.describer import Descriptors
from service.maps.snapshot import MapSnapshot

MAPPED_METERS = 10.0
"""Distance to the mapping robot's path within which a query is in the mapped area, meters."""


@dataclass(frozen=True, slots=True, eq=False)
class DescribedCapture:
    """Descriptors of the segments that a robot saw at one moment, in the frame of its drive.

    Attributes:
        scan: scan of the drive.
        time: time of the scan, seconds.
        meters: distance driven so far, meters.
        codes: int8 (n, code bytes), codes of all segments around the robot.
        centroids: float64 (n, 3), their centroids, meters.
        sensor: float64 (3,), sensor position.
        heights: float64 (n,), heights of the segments' boxes, meters.
    """

    scan: int
    time: float
    meters: float
    codes: Int8
    centroids: Float64
    sensor: Float64
    heights: Float64


@dataclass(frozen=True, slots=True, eq=False)
class PoseQuery:
    """Localization query of a robot at one moment.

    Attributes:
        scan: scan of the drive.
        time: time of the scan, seconds.
        meters: distance driven so far, meters.
        codes: int8 (n, code bytes), codes of all segments around the robot.
        centroids: float64 (n, 3), their centroids in the robot's frame, meters.
        sensor: float64 (3,), sensor position in the robot's frame.
        truth: true transform from the robot's frame to the map's.
        mapped: whether the query is in the mapped area.
        heights: float64 (n,), heights of the segments' boxes, meters; None if they are not known.
    """

    scan: int
    time: float
    meters: float
    codes: Int8
    centroids: Float64
    sensor: Float64
    truth: Pose
    mapped: bool
    heights: Float64 | None = None

    def some(self, chosen: Int64) -> Self:
        """Return the query with only these segments."""
        return replace(
            self,
            codes=self.codes[chosen],
            centroids=self.centroids[chosen],
            heights=None if self.heights is None else self.heights[chosen],
        )


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """Two robots: one makes a map, the other localizes in it.

    Attributes:
        mapper: robot that makes the map.
        asker: robot that localizes.
        blocks: whether both are alternate blocks of one drive.
    """

    mapper: Robot
    asker: Robot
    blocks: bool

    @classmethod
    def of(
        cls,
        map_folder: Path,
        query_folder: Path | None = None,
        every: int | None = None,
        prepared: tuple[Path | None, Path | None] = (None, None),
        progress: Progress = silent,
        protocol: Parameters = PROTOCOL_V1,
    ) -> Self:
        """Make the robots from two drives of a town, or from alternate blocks of one drive.

        Args:
            map_folder: folder of the map's drive.
            query_folder: folder of the queries' drive; None: alternate blocks of the map's drive.
            every: scans from one capture to the next, as `Parameters.for_drive`.
            prepared: recording of each drive; None: segment the drive.
            progress: wraps the loops.
            protocol: parameters of the segmentation.

        Raises:
            ValueError: the drives have no common frame, a drive is too short for a second block,
                or a recording is of another drive.
        """
        if query_folder is None:
            if any(prepared):
                raise ValueError(
                    "A recording holds a whole drive, but this drive is split into blocks. Omit "
                    "the recording."
                )
            mapper, asker = robots_of_drive(map_folder, progress, every, protocol)
            return cls(mapper, asker, blocks=True)
        drives = [open_drive(folder) for folder in (map_folder, query_folder)]
        frames = [to_common(drive) for drive in drives]
        robots = []
        for drive, frame, file in zip(drives, frames, prepared, strict=True):
            recording = recording_of(drive, every, file, progress, protocol)
            robots.append(Robot(drive.title, drive, [recording], frame))
        return cls(robots[0], robots[1], blocks=False)

    def swapped(self) -> Self:
        """Return the pair with the roles of the robots swapped."""
        return replace(self, mapper=self.asker, asker=self.mapper)

    def queries(
        self,
        engine: Engine,
        frame: Pose,
        most: int | None = None,
        wanted: ClassFilter | None = None,
    ) -> Iterator[PoseQuery]:
        """Yield the query of each capture, also of captures without segments.

        Args:
            engine: describes the segments.
            frame: transform from the drive's frame to the robot's own frame.
            most: largest number of queries, spread evenly; None: all.
            wanted: filter of the segments by their class; None keeps all.
        """
        yield from self.posed(described_captures(self.asker, engine, most, wanted), frame)

    def posed(self, captures: Iterable[DescribedCapture], frame: Pose) -> Iterator[PoseQuery]:
        """Yield the query of each capture of the asking robot, with its true pose in the map.

        Args:
            captures: the captures, in the drive's frame.
            frame: transform from the drive's frame to the robot's own frame.
        """
        to_map = (
            Pose.of_matrix(self.mapper.to_common)
            .inverse()
            .after(Pose.of_matrix(self.asker.to_common))
        )
        positions = cKDTree(self.mapper.drive.poses[self.mapper.frames, :3, 3])
        for capture in captures:
            near, _ = positions.query(to_map.apply(capture.sensor))
            yield PoseQuery(
                scan=capture.scan,
                time=capture.time,
                meters=capture.meters,
                codes=capture.codes,
                centroids=frame.apply(capture.centroids),
                sensor=frame.apply(capture.sensor),
                truth=to_map.after(frame.inverse()),
                mapped=self.blocks or bool(near <= MAPPED_METERS),
                heights=capture.heights,
            )


def described_captures(
    robot: Robot, engine: Engine, most: int | None = None, wanted: ClassFilter | None = None
) -> Iterator[DescribedCapture]:
    """Yield the captures of a robot, also those without segments, in the frame of its drive.

    Args:
        robot: the robot.
        engine: describes the segments.
        most: largest number of captures, spread evenly; None: all.
        wanted: filter of the segments by their class; None keeps all.
    """
    drive = robot.drive
    steps = np.linalg.norm(np.diff(drive.poses[:, :3, 3], axis=0), axis=1)
    meters = np.concatenate([[0.0], np.cumsum(steps)])
    asked = set(spread(len(robot.frames), most).tolist())
    for number, (scan, segments, _) in enumerate(robot.views()):
        if number in asked:
            codes, centroids, heights = described(engine, segments, wanted)
            yield DescribedCapture(
                scan=scan,
                time=float(drive.times[scan]),
                meters=float(meters[scan]),
                codes=codes,
                centroids=centroids,
                sensor=drive.poses[scan, :3, 3],
                heights=heights,
            )


def described(
    engine: Engine, segments: Segments, wanted: ClassFilter | None = None
) -> tuple[Int8, Float64, Float64]:
    """Return codes (n, code bytes), centroids (n, 3) and heights (n,) of the wanted segments."""
    if not len(segments):
        codes = np.zeros((0, engine.model.manifest.code_bytes), dtype=np.int8)
        return codes, np.zeros((0, 3)), np.zeros(0)
    found = engine.describe(clouds(segments), segments.sensors).searched(wanted)
    assert found.centroids is not None
    assert found.heights is not None
    usable = found.usable
    return found.codes[usable], found.centroids[usable], found.heights[usable]


@dataclass(slots=True, eq=False)
class DriveSession:
    """Session of a robot on a recorded drive, whose clock is that of the scans.

    Attributes:
        history: results of the earlier requests.
        time: time of the present request, seconds.
    """

    history: RequestHistory
    time: float = 0.0

    def evidence(self, snapshot: MapSnapshot, middle: Float64) -> Evidence | None:
        """Return the evidence of the earlier requests."""
        del snapshot  # a drive is localized in one map
        return self.history.at(self.time, middle)

    def remember(
        self, snapshot: MapSnapshot, middle: Float64, hypotheses: Sequence[Hypothesis]
    ) -> None:
        """Add the hypotheses of a request."""
        del snapshot
        self.history.add(self.time, middle, hypotheses)


def localize_query(
    engine: Engine,
    query: PoseQuery,
    name: str,
    k: int,
    parameters: LocalizationParameters,
    session: DriveSession | None = None,
) -> tuple[Localization, float]:
    """Localize a query in one map; return the result and the time it took, milliseconds."""
    seen = Descriptors(
        engine.model.id, query.codes, None, query.centroids, {}, heights=query.heights
    )
    started = perf_counter()
    hints = Hints(sensor=SensorPose(tuple(query.sensor.tolist())))
    result = engine.localize(seen, [name], k, parameters, session, hints=hints)
    return result[0].localization, 1e3 * (perf_counter() - started)


def spread(count: int, most: int | None = None) -> Int64:
    """Return `most` indices of `count` items, spread evenly from first to last; None: all."""
    if most is None or most >= count:
        return np.arange(count)
    return np.linspace(0, count - 1, most).round().astype(np.int64)


def random_frame(seed: int) -> Pose:
    """Return a random odometry frame: any yaw, within one kilometer along each axis."""
    random = np.random.default_rng(seed)
    return Pose.of_yaw(random.uniform(-np.pi, np.pi), random.uniform(-1000, 1000, 3))


def to_common(drive: Drive) -> Float64:
    """Return the transform (4, 4) from the frame of a drive to one that it shares with others.

    Raises:
        ValueError: the drive is of no town and its poses are not georeferenced, so it has no common
            frame with another drive; or the file of the transform is unreadable.
    """
    from town import ORIGIN_FILE, read_origin

    if drive.georeferenced:
        frame = np.eye(4)
        frame[:3, 3] = drive.origin
        return frame
    if not (drive.folder / ORIGIN_FILE).exists():
        raise ValueError(
            f"{drive.folder} has no {ORIGIN_FILE}, so its transform to another drive is unknown. "
            "Give one drive only; it is then split into blocks."
        )
    return read_origin(drive.folder)


def joined(maps: Sequence[CompactMap], shifts: Sequence[Float64]) -> CompactMap:
    """Join maps of one model side by side, without optional columns.

    Args:
        maps: the maps.
        shifts: float64 (3,) per map, shift of the map, meters.
    """
    count = sum(map(len, maps))
    frames = np.cumsum([0, *(len(each.frame_times) for each in maps)])
    return replace(
        maps[0],
        codes=np.concatenate([each.codes for each in maps]),
        centroids=np.concatenate(
            [each.centroids + shift for each, shift in zip(maps, shifts, strict=True)]
        ),
        ids=np.arange(count, dtype=np.uint32),
        robots=maps[0].robots[:1],
        robot=np.zeros(count, dtype=np.uint16),
        frame_index=np.concatenate(
            [each.frame_index + first for each, first in zip(maps, frames[:-1], strict=True)]
        ).astype(np.uint32),
        frame_times=np.concatenate([each.frame_times for each in maps]),
        frame_positions=np.concatenate(
            [each.frame_positions + shift for each, shift in zip(maps, shifts, strict=True)]
        ),
        frame_orientations=np.concatenate([each.frame_orientations for each in maps]),
        extents=None,
        points=None,
        views=None,
        seen=None,
    )
