"""Maps of robots that drive through a simulated town with drifting odometry, kept in a folder."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from placecell_client import CompactMap, decode, decode_delta, encode
from placecell_client.maps.edit import apply

from benchmarks.drift.drifting_odometry import WanderingOdometry
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float32, Float64
from placecell.segmentation.incremental import IncrementalSegmentation
from robot.localization.local_engine import LocalEngine
from robot.mapping.keyframes import Keyframes
from robot.mapping.map_out import Capture, EditMaker, SeenSegments
from robot.mapping.perception import clouds_of
from town import City, Route, sensor
from town.sensing.lidar import SWEEP_SECONDS

KEYFRAME = 3.0
"""Distance between two keyframes, meters."""

SPACING = 1.0
"""Distance between two scans, meters."""

LONG = 10_000.0
"""Way from which scans are twice as far apart, so that 20 km are simulated in minutes."""

COLUMNS = 384
"""Azimuth steps of the simulated sensor: few, to simulate 20 km in minutes."""


@dataclass(frozen=True, slots=True)
class DriftCase:
    """Town and drives.

    Attributes:
        meters: total distance that the robots drive.
        robots: number of robots: 1 drives through all streets; 3 share streets in both directions.
        look_alikes: share of the streets that are lined by identical houses.
        seed: seed of the town and the noise.
    """

    meters: float
    robots: int = 1
    look_alikes: float = 0.25
    seed: int = 7

    @property
    def name(self) -> str:
        """Name of the case in reports and of its files."""
        kind = "look-alikes" if self.look_alikes > 0.5 else "town"
        return f"{kind}-{self.meters / 1000:g}km-{self.robots}robots-seed{self.seed}"

    @property
    def spacing(self) -> float:
        """Distance between two scans, meters."""
        return SPACING if self.meters < LONG else 2 * SPACING

    def routes(self) -> tuple[City, list[Route]]:
        """Return the town and the route of each robot.

        One robot drives the tour through all streets again and again. Of three robots, the second
        one drives against the others, and each shares most streets with each other one.
        """
        share = self.meters / self.robots
        streets = share / 2 if self.robots == 1 else share
        city = City.build(self.seed, max(500.0, streets), self.look_alikes)
        way = city.planner.every_street()
        tour = city.route(way)
        if self.robots == 1:
            laps = 1
            while tour.length() < share + 4.0:
                laps += 1
                tour = city.route([*way, *way[1:] * (laps - 1)])
            return city, [tour.cut(0.0, share)]
        share = min(share, 0.8 * tour.length())
        starts = np.linspace(0.0, tour.length() - share - 4.0, self.robots)
        ways = [tour.cut(float(start), share) for start in starts]
        return city, [way.reversed() if number % 2 else way for number, way in enumerate(ways)]


@dataclass(frozen=True, slots=True, eq=False)
class TrueMap:
    """Map of a robot in the frame of its drifting odometry, with the truth.

    Attributes:
        content: the map.
        poses: true pose of each capture in the town, float64 (f, 4, 4).
        meters: distance driven.
    """

    content: CompactMap
    poses: Float64
    meters: float


def robot_maps(
    case: DriftCase,
    percents: Sequence[float],
    cache: Path,
    tell: Callable[[str], None] = lambda _: None,
) -> dict[float, list[TrueMap]]:
    """Return the map of each robot, by drift in percent; simulate those that are not kept.

    A drive is simulated once for all drifts, because the scans do not depend on the odometry.
    """
    city, routes = case.routes()
    files = {
        (percent, number): cache / f"{case.name}-{percent:g}percent-{number}"
        for percent in percents
        for number in range(case.robots)
    }
    for number, route in enumerate(routes):
        missing = [each for each in percents if not _path(files[each, number], ".npz").exists()]
        if missing:
            cache.mkdir(parents=True, exist_ok=True)
            found = _drive(
                city, route, case.seed * 100 + number, number, missing, tell, case.spacing
            )
            for percent, (content, poses, meters) in found.items():
                file = files[percent, number]
                _path(file, ".map").write_bytes(encode(content))
                part = _path(file, ".part.npz")
                np.savez(part, times=content.frame_times, poses=poses, meters=meters)
                part.rename(_path(file, ".npz"))
    return {
        percent: [_kept(files[percent, number]) for number in range(case.robots)]
        for percent in percents
    }


def _path(file: Path, ending: str) -> Path:
    """Return a file's path with an ending; its name may have dots."""
    return file.with_name(file.name + ending)


def _kept(file: Path) -> TrueMap:
    with np.load(_path(file, ".npz")) as kept:
        poses, meters = kept["poses"], float(kept["meters"])
    return TrueMap(decode(_path(file, ".map").read_bytes()), poses, meters)


def _drive(
    city: City,
    route: Route,
    seed: int,
    number: int,
    percents: Sequence[float],
    tell: Callable[[str], None],
    spacing: float = SPACING,
) -> dict[float, tuple[CompactMap, Float64, float]]:
    """Simulate a drive once, and map it with each odometry."""
    distances = np.arange(2.0, route.length() - 2.0, spacing)
    true = route.poses(distances, sensor("hdl-64e").height)
    meters = float(np.linalg.norm(np.diff(true[:, :3, 3], axis=0), axis=1).sum())
    engine = LocalEngine()
    try:
        mappers = [
            _Mapper(f"robot-{number}", engine, WanderingOdometry(each).poses(true, seed))
            for each in percents
        ]
        for scan, (_, points) in enumerate(scans_of(city, route, seed, spacing)):
            for mapper in mappers:
                mapper.add(scan, points, scan * spacing)
            if scan % 500 == 0:
                tell(f"robot {number}: {scan * spacing:,.0f} of {meters:,.0f} m")
        found = {}
        for percent, mapper in zip(percents, mappers, strict=True):
            content = mapper.content()
            scans = np.rint(content.frame_times / SWEEP_SECONDS).astype(np.int64)
            found[percent] = content, true[scans], meters
        return found
    finally:
        engine.close()


def scans_of(
    city: City, route: Route, seed: int, spacing: float = SPACING
) -> Iterator[tuple[Float64, Float32]]:
    """Simulate a drive scan by scan.

    Args:
        city: the town.
        route: route of the robot.
        seed: seed of the noise and of parked cars.
        spacing: distance between two scans, meters.

    Yields:
        True pose of each scan, float64 (4, 4), and its points, float32 (n, 3), meters, deskewed.
    """
    lidar = replace(sensor("hdl-64e"), columns=COLUMNS)
    scenes = city.scenes(seed, lidar.max_range)
    distances = np.arange(2.0, route.length() - 2.0, spacing)
    true = route.poses(distances, lidar.height)
    for scan, (distance, pose) in enumerate(zip(distances, true, strict=True)):
        rng = np.random.default_rng([seed, 77, scan])
        sweep = route.poses(float(distance) + SPACING * lidar.sweep_times(), lidar.height)
        points = lidar.scan(scenes.around(pose[:2, 3]), sweep, pose, rng, 0.0)
        yield pose, np.ascontiguousarray(points[:, :3], dtype=np.float32)


class _Mapper:
    """Robot that maps with one odometry: the steps of the agent, without its checks of jumps."""

    def __init__(self, name: str, engine: LocalEngine, odometry: Float64) -> None:
        self._engine = engine
        self._odometry = odometry
        self._segmentation = IncrementalSegmentation(PROTOCOL_V1)
        self._keyframes = Keyframes(KEYFRAME, PROTOCOL_V1.accumulated_scans // 2)
        self._edits = EditMaker(name, "drift")
        self._deltas: list[bytes] = []

    def add(self, scan: int, points: np.ndarray, meters: float) -> None:
        pose = self._odometry[scan]
        self._segmentation.add(points, pose)
        if not self._keyframes.add(pose):
            return
        live = self._segmentation.segments()
        self._segmentation.take_final_views()
        found = self._engine.describe(clouds_of(live), live.segments.sensors)
        seen = SeenSegments.of(found, live, self._engine.model_id, self._engine.preprocessing)
        capture = Capture(scan * SWEEP_SECONDS, pose)
        edit = self._edits.add(seen, capture, meters)
        if edit is not None:
            self._deltas.append(edit.content)

    def content(self) -> CompactMap:
        """Return the map of all keyframes."""
        parts = [decode_delta(each) for each in self._deltas]
        while len(parts) > 1:  # pairs, so that each segment is copied a few times only
            parts = [
                parts[at]
                if at + 1 == len(parts)
                else replace(parts[at], changed=apply(parts[at].changed, parts[at + 1]))
                for at in range(0, len(parts), 2)
            ]
        return parts[0].changed
