"""Queries with known answers: what a robot sees, described, and where it truly is in a map."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from time import perf_counter
from typing import Self

import numpy as np
from placecell_client import CompactMap
from scipy.spatial import cKDTree

from evaluation.poses.recordings import recording_of
from evaluation.poses.robot import Robot, clouds
from evaluation.poses.robots import robots_of_drive
from placecell.core.segments import Segments
from placecell.core.types import Float64, Int8, Int64
from placecell.datasets import open_drive
from placecell.localization import Hypothesis, Localization, LocalizationParameters, Pose
from placecell.localization.evidence import Evidence, RequestHistory
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine
from service.inference.describer import Descriptors
from service.maps.snapshot import MapSnapshot

MAPPED_METERS = 10.0
"""A query is within the map if the mapping robot was as near as this."""


@dataclass(frozen=True, slots=True, eq=False)
class PoseQuery:
    """What a robot asks at one moment.

    Attributes:
        scan: of the asking drive.
        time: seconds.
        meters: driven so far.
        codes: int8 (n, code bytes), of all segments that it sees.
        centroids: float64 (n, 3), theirs, metres, in the robot's frame.
        sensor: float64 (3,), where it is, in its own frame.
        truth: from the robot's frame to the map's.
        mapped: whether the mapping robot was near by.
    """

    scan: int
    time: float
    meters: float
    codes: Int8
    centroids: Float64
    sensor: Float64
    truth: Pose
    mapped: bool

    def some(self, chosen: Int64) -> Self:
        """Of these segments alone."""
        return replace(self, codes=self.codes[chosen], centroids=self.centroids[chosen])


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """A robot that has made a map, and one that asks where it is.

    Attributes:
        mapper, asker: the robots.
        blocks: whether both are one, on alternate blocks of its way.
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
    ) -> Self:
        """From two drives of a town, or from alternate blocks of one drive.

        Args:
            every: a frame every so many scans, as `Parameters.for_drive`.
            prepared: recordings of the two drives, where there are any.

        Raises:
            ValueError: no common frame of the two is known, a drive stands still, or a recording
                does not fit.
        """
        if query_folder is None:
            if any(prepared):
                raise ValueError(
                    "a recording is of a whole drive, but this drive is cut into blocks; give none"
                )
            mapper, asker = robots_of_drive(map_folder, progress, every)
            return cls(mapper, asker, blocks=True)
        folders = (map_folder, query_folder)
        origins = [origin_of(folder) for folder in folders]
        robots = []
        for folder, origin, file in zip(folders, origins, prepared, strict=True):
            drive = open_drive(folder)
            recording = recording_of(drive, every, file, progress)
            robots.append(Robot(folder.name, drive, [recording], origin))
        return cls(robots[0], robots[1], blocks=False)

    def swapped(self) -> Self:
        """The other way round."""
        return replace(self, mapper=self.asker, asker=self.mapper)

    def queries(self, engine: Engine, frame: Pose, most: int | None = None) -> Iterator[PoseQuery]:
        """What the other robot asks, frame by frame, also where it sees no segment.

        Args:
            frame: from the drive's world to the robot's own frame, which may be any.
            most: frames that are asked, spread evenly; all unless given.
        """
        drive = self.asker.drive
        steps = np.linalg.norm(np.diff(drive.poses[:, :3, 3], axis=0), axis=1)
        meters = np.concatenate([[0.0], np.cumsum(steps)])
        to_map = (
            Pose.of_matrix(self.mapper.to_common)
            .inverse()
            .after(Pose.of_matrix(self.asker.to_common))
        )
        positions = cKDTree(self.mapper.drive.poses[self.mapper.frames, :3, 3])
        asked = set(spread(len(self.asker.frames), most).tolist())
        for number, (scan, segments, _) in enumerate(self.asker.views()):
            if number not in asked:
                continue
            codes, centroids = described(engine, segments)
            where = drive.poses[scan, :3, 3]
            near, _ = positions.query(to_map.apply(where))
            yield PoseQuery(
                scan=scan,
                time=float(drive.times[scan]),
                meters=float(meters[scan]),
                codes=codes,
                centroids=frame.apply(centroids),
                sensor=frame.apply(where),
                truth=to_map.after(frame.inverse()),
                mapped=self.blocks or bool(near <= MAPPED_METERS),
            )


def described(engine: Engine, segments: Segments) -> tuple[Int8, Float64]:
    """Codes (n, code bytes) and centroids (n, 3) of those segments that can be described."""
    if not len(segments):
        return np.zeros((0, engine.model.manifest.code_bytes), dtype=np.int8), np.zeros((0, 3))
    found = engine.describe(clouds(segments), segments.sensors)
    assert found.centroids is not None
    return found.codes[found.usable], found.centroids[found.usable]


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
    seen = Descriptors(engine.model.id, query.codes, None, query.centroids, {})
    started = perf_counter()
    result = engine.localize(seen, [name], k, parameters, session)
    return result[0].localization, 1e3 * (perf_counter() - started)


def spread(count: int, most: int | None = None) -> Int64:
    """Indices of so many of `count` items, evenly from the first to the last; all unless given."""
    if most is None or most >= count:
        return np.arange(count)
    return np.linspace(0, count - 1, most).round().astype(np.int64)


def random_frame(seed: int) -> Pose:
    """An odometry frame that knows nothing of the map's: any yaw, within a kilometre."""
    random = np.random.default_rng(seed)
    return Pose.of_yaw(random.uniform(-np.pi, np.pi), random.uniform(-1000, 1000, 3))


def origin_of(folder: Path) -> Float64:
    """From a drive's world to the frame of its town (4, 4).

    Raises:
        ValueError: the drive is of no town, so nobody knows where it lies to another; or what
            tells so cannot be read.
    """
    from town import ORIGIN_FILE, read_origin

    if not (folder / ORIGIN_FILE).exists():
        raise ValueError(
            f"{folder}: has no {ORIGIN_FILE}, so it is not known where it lies to another drive; "
            "give one drive alone, which is cut into blocks"
        )
    return read_origin(folder)


def joined(maps: Sequence[CompactMap], shifts: Sequence[Float64]) -> CompactMap:
    """Maps of one model side by side, each shifted by so many metres (3,); core columns alone."""
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
