"""Cases for the fit of the pose probability: best hypotheses of queries, right and wrong.

In each place, two robots drive the same way in opposite directions. Each capture of one robot is
localized in the other's map, with all segments and with a few, and in a joined map of all places.
It is also localized where no answer is right: in the map of another place, and in the other's map
without the segments near the robot, where at best a similar street is found. And it is localized in
a part of the other's map that ends near the robot: half of what it sees lies beyond the edge.
"""

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.edit import take

from evaluation.poses.queries import (
    Pair,
    PoseQuery,
    described,
    joined,
    localize_query,
    random_frame,
)
from evaluation.poses.report import OFF, RIGHT
from placecell.core.types import Bool, Float64, Int64
from placecell.localization import Localization, LocalizationParameters, Pose
from placecell.localization.confidence import FEATURES
from placecell.localization.localize import rejection_of
from placecell.segmentation.pipeline import Progress
from service.engine import Engine

FEW = (6, 8, 12, 20)
"""Numbers of segments drawn from a capture."""

APART = 3_000.0
"""Distance between the places of a joined map, meters."""

NEAR = 60.0
"""Horizontal radius around the robot that is removed from a map without a right answer, meters. A
robot's segments are within 40 m."""

EDGE = (-15.0, 25.0)
"""Range of the distance from the robot to the edge of a map's part, meters; negative: the robot is
behind the edge, in the mapped area."""

LEAST = 20
"""Smallest number of segments of a map's part."""

LOOK_ALIKES = "look-alikes"
"""Kind of place: streets with rows of identical houses, all over a town."""

K = 25
"""Candidates per segment."""

START_METERS = 5.0
"""Distance over which the growth of the number of segments is measured, meters."""


@dataclass(frozen=True, slots=True, eq=False)
class FitPair:
    """Two robots in one place, and what they see it with.

    Attributes:
        pair: the robots.
        town: seed of the place; pairs of one seed show the same place.
        sensor: name of the first robot's sensor.
        place: kind of the place: one of the town's, or `LOOK_ALIKES`.
        look_alikes: share of streets with identical houses; None for the default.
        other_sensor: name of the second robot's sensor; None for that of the first.
    """

    pair: Pair
    town: int
    sensor: str = "hdl-64e"
    place: str = "streets"
    look_alikes: float | None = None
    other_sensor: str | None = None

    @property
    def sensors(self) -> tuple[str, str]:
        """Names of the map's sensor and of the queries' sensor."""
        return self.sensor, self.other_sensor or self.sensor

    def swapped(self) -> Self:
        """Return the pair with the roles of the robots swapped."""
        sensor, other = reversed(self.sensors)
        return replace(self, pair=self.pair.swapped(), sensor=sensor, other_sensor=other)

    @classmethod
    def of_folder(cls, folder: Path, progress: Progress) -> Self:
        """Read SEED-SENSOR-PLACE/robot_a and robot_b, with the recordings beside them.

        SEED-SENSOR+OTHER-PLACE has the sensors of both robots.

        Raises:
            ValueError: the folder has another name, or its recordings are of other drives.
        """
        from town import SENSORS

        names = "|".join(map(re.escape, SENSORS))
        match = re.fullmatch(rf"(\d+)-({names})(?:\+({names}))?-(.+)", folder.name)
        if match is None:
            raise ValueError(
                f"Invalid folder name {folder.name!r}: expected SEED-SENSOR-PLACE, such as "
                "101-vlp-16-streets, or SEED-SENSOR+OTHER-PLACE for two sensors. Sensors: "
                f"{', '.join(SENSORS)}."
            )
        seed, sensor, other, place = match.groups()
        drives = [folder / "robot_a", folder / "robot_b"]
        files = [drive.with_suffix(".safetensors") for drive in drives]
        prepared = [file if file.is_file() else None for file in files]
        pair = Pair.of(drives[0], drives[1], 2, (prepared[0], prepared[1]), progress)
        share = 1.0 if place == LOOK_ALIKES else None
        return cls(pair, int(seed), sensor, place, share, other)


@dataclass(frozen=True, slots=True, eq=False)
class Cases:
    """Queries with their best hypotheses; n queries.

    Attributes:
        features: float64 (n, features), features of the best hypothesis; NaN without one.
        limits: float64 (n,), largest probability, because of a second place or an open direction;
            1 without such a reason, 0 without a hypothesis.
        rejected: bool (n,), whether the pose is rejected whatever its probability.
        right: bool (n,), whether the hypothesis is right.
        false: bool (n,), whether there is a hypothesis, and it is off by more than 3 m or 10
            degrees.
        usable: int64 (n,), segments with candidates.
        answerable: bool (n,), whether the query is in the mapped area of one place's map.
        whole: bool (n,), whether the query has all segments of its capture.
        towns: int64 (n,), seed of the place.
        sensors: (n, 2), names of the map's sensor and of the query's sensor.
        places: (n,), kind of the place.
        growth: float64 (robots,), segments that each robot's first meters add, per meter.
    """

    features: Float64
    limits: Float64
    rejected: Bool
    right: Bool
    false: Bool
    usable: Int64
    answerable: Bool
    whole: Bool
    towns: Int64
    sensors: "np.ndarray[tuple[int, int], np.dtype[np.str_]]"
    places: "np.ndarray[tuple[int], np.dtype[np.str_]]"
    growth: Float64

    def __len__(self) -> int:
        return len(self.limits)


@dataclass(frozen=True, slots=True, eq=False)
class Ask:
    """Query in one map.

    Attributes:
        query: the query.
        name: name of the map.
        truth: true pose in the map; None if there is no right answer.
        own: whether the map is that of the query's place alone.
    """

    query: PoseQuery
    name: str
    truth: Pose | None
    own: bool = False


def ask(
    pairs: Sequence[FitPair], engine: Engine, most: int, seed: int, progress: Progress
) -> Cases:
    """Localize each robot of each pair in the map of the other, and in other maps.

    Args:
        pairs: two or more pairs.
        engine: engine of the model.
        most: largest number of captures of each robot, spread evenly.
        seed: random seed of the drawn segments.
        progress: wraps the loop.
    """
    random, frame = np.random.default_rng(seed), random_frame(seed)
    both = [*pairs, *(each.swapped() for each in pairs)]
    maps = [each.pair.mapper.build_map(engine, "town") for each in both]
    names = [f"map-{index}" for index in range(len(both))]
    for name, compact in zip(names, maps, strict=True):
        engine.put_map(name, compact)
    shifts = [np.array([APART * index, 0.0, 0.0]) for index in range(len(pairs))]
    # A joined map holds one map per place, because a robot would find its own map.
    for way in range(2):
        half = maps[way * len(pairs) : (way + 1) * len(pairs)]
        engine.put_map(f"joined-{way}", joined(half, shifts))
    rows: list[tuple[Localization, PoseQuery, Ask, FitPair]] = []
    growth = []
    for index in progress(range(len(both)), len(both), "localizing"):
        number, way = index % len(pairs), index // len(pairs)
        elsewhere = names[way * len(pairs) + (number + 1) % len(pairs)]
        growth.append(_growth(both[index].pair, engine))
        for query in both[index].pair.queries(engine, frame, most):
            there = Pose(np.eye(3), shifts[number]).after(query.truth)
            _put_without(engine, maps[index], query)
            edge = _put_edge(engine, maps[index], query, random)
            asked = [
                Ask(query, names[index], query.truth, own=query.mapped),
                Ask(query, elsewhere, None),
                *(Ask(each, "without", None) for each in (query, *parts(query, random, (20,)))),
                *(
                    Ask(each, names[index], query.truth, own=query.mapped)
                    for each in parts(query, random)
                ),
                *(
                    Ask(each, f"joined-{way}", there)
                    for each in (query, *parts(query, random, (12,)))
                ),
                *(
                    Ask(each, "edge", query.truth)
                    for each in (query, *parts(query, random, (20,)))
                    if edge
                ),
            ]
            for each in asked:
                found, _ = localize_query(engine, each.query, each.name, K, PARAMETERS)
                rows.append((found, query, each, both[index]))
    return _cases(rows, np.array(growth))


PARAMETERS = LocalizationParameters()


def _put_without(engine: Engine, compact: CompactMap, query: PoseQuery) -> None:
    """Store the map `without`: the map without the segments near the robot."""
    place = query.truth.apply(query.sensor)
    far = np.linalg.norm((compact.centroids - place)[:, :2], axis=1) > NEAR
    _put_anew(engine, "without", take(compact, far))


def _put_edge(
    engine: Engine, compact: CompactMap, query: PoseQuery, random: np.random.Generator
) -> bool:
    """Store the map `edge`: the captures on one side of a line across the way, near the robot.

    Returns:
        Whether the part has enough segments; it is not stored otherwise.
    """
    place = query.truth.apply(query.sensor)
    side, away = float(random.choice([-1.0, 1.0])), random.uniform(*EDGE)
    part = ahead_of(compact.frame_positions, place, side * away, side)[compact.frame_index]
    if np.count_nonzero(part) < LEAST:
        return False
    _put_anew(engine, "edge", take(compact, part))
    return True


def _put_anew(engine: Engine, name: str, compact: CompactMap) -> None:
    """Store a map; an earlier one of this name is deleted with its versions."""
    if engine.maps.find(name) is not None:
        engine.delete_map(name)
    engine.put_map(name, compact)


def ahead_of(frames: Float64, place: Float64, meters: float, side: float = 1.0) -> Bool:
    """Return which captures lie beyond a line across the way of the robot that made the map.

    Args:
        frames: float64 (n, 3), meters, sensor positions of the captures, in their order.
        place: float64 (3,), meters, place near the way.
        meters: distance along the way from the place to the line.
        side: 1 for the captures after the line; -1 for those before it.

    Returns:
        bool (n,).
    """
    apart = (frames - place)[:, :2]
    nearest = int(np.argmin(np.linalg.norm(apart, axis=1)))
    along = apart[min(nearest + 1, len(frames) - 1)] - apart[max(nearest - 1, 0)]
    along = along / max(float(np.linalg.norm(along)), 1e-9)
    return np.asarray(side * (apart @ along - meters) > 0)


def parts(
    query: PoseQuery, random: np.random.Generator, sizes: Sequence[int] = FEW
) -> Iterator[PoseQuery]:
    """Yield the query with some of its segments, for each size."""
    for size in sizes:
        if size < len(query.codes):
            yield query.some(np.sort(random.choice(len(query.codes), size, replace=False)))


def _growth(pair: Pair, engine: Engine) -> float:
    """Return how many segments the first meters of a drive add, per meter."""
    drive = pair.asker.drive
    steps = np.linalg.norm(np.diff(drive.poses[:, :3, 3], axis=0), axis=1)
    meters = np.concatenate([[0.0], np.cumsum(steps)])
    first: tuple[float, int] | None = None
    for scan, segments, _ in pair.asker.views():
        if first is None:
            first = float(meters[scan]), len(described(engine, segments)[0])
        elif meters[scan] - first[0] >= START_METERS:
            count = len(described(engine, segments)[0])
            return (count - first[1]) / (float(meters[scan]) - first[0])
    return np.nan


def _cases(rows: Sequence[tuple[Localization, PoseQuery, Ask, FitPair]], growth: Float64) -> Cases:
    features = np.full((len(rows), len(FEATURES)), np.nan)
    limits, rejected, right, false = np.zeros((4, len(rows)))
    for index, (found, query, asked, _) in enumerate(rows):
        if found.best is None or found.features is None:
            continue
        features[index] = found.features
        rival = 1.0 - float(found.features[FEATURES.index("margin")])
        reason, limits[index] = rejection_of(found.best, rival, PARAMETERS)
        rejected[index] = reason is not None
        meters = degrees = np.inf
        if asked.truth is not None:
            meters, angle = found.best.pose.difference(asked.truth, query.sensor)
            degrees = np.degrees(angle)
        right[index] = meters <= RIGHT[0] and degrees <= RIGHT[1]
        false[index] = meters > OFF[0] or degrees > OFF[1]
    return Cases(
        features=features,
        limits=limits,
        rejected=rejected.astype(bool),
        right=right.astype(bool),
        false=false.astype(bool),
        usable=np.array([found.usable for found, *_ in rows]),
        answerable=np.array([asked.own for _, _, asked, _ in rows]),
        whole=np.array([asked.query is query for _, query, asked, _ in rows]),
        towns=np.array([pair.town for *_, pair in rows]),
        sensors=np.array([pair.sensors for *_, pair in rows]),
        places=np.array([pair.place for *_, pair in rows]),
        growth=growth,
    )
