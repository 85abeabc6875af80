"""Similar places that are simulated: indoor floors of one building, and streets of equal houses.

Two robots drive through each place in opposite directions. One makes the map, the other localizes.
Each query is asked with the right place among the maps, and without it. Without it every pose is
wrong.

Floors: each floor has its own map. Without the right floor, the maps of the other floors remain, or
the map of one of them. Streets: all houses of the town have one of four designs. Without the right
street, the map has no segment within 60 m of the robot.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.edit import take

from benchmarks.localization.floors import SURE, TOLERANCE, K
from evaluation.machine import machine
from evaluation.poses.queries import Pair, PoseQuery, random_frame, spread
from evaluation.poses.recordings import recording_of
from evaluation.poses.robot import Robot
from placecell.datasets import open_drive
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine
from service.inference.describer import Descriptors
from service.search.localization import LocalizationResult
from town import City, several_robots, two_robots
from town.drives.drive import read_origin
from town.drives.robots import fitted
from town.sensing.lidar import Lidar

FEWEST_SEGMENTS = 5
"""Smallest number of segments of a query. With fewer, no robot is localized anywhere."""

LEFT_OUT_M = 60.0
"""Radius around the robot in which the map without the right street has no segment, meters."""

FLOORS = 3
"""Number of floors of a building."""

DIFFERING = (0.0, 0.1, 0.3, 0.5)
"""Share of the furniture that differs between the floors, for one building after the other."""

PRESENT, ABSENT, ONE_OTHER = "right place in the maps", "right place left out", "one other floor"
"""Which maps a query is asked in: all, all but the right one, or one that is not the right one."""

STREET_METERS = 900.0
"""Total length of the streets of a town, meters."""


@dataclass(frozen=True, slots=True, eq=False)
class SimilarPlaces:
    """Places that look alike, each with the robot that maps it and the robot that localizes in it.

    Attributes:
        name: name of the building or town.
        kind: "indoor" or "streets".
        pairs: mapping and localizing robot of each place.
        differing: share of the furniture that differs between floors; None for streets.
    """

    name: str
    kind: str
    pairs: tuple[Pair, ...]
    differing: float | None = None


@dataclass(frozen=True, slots=True)
class SimilarTrial:
    """Result of one localization.

    Attributes:
        places: name of the building or town.
        case: which maps were searched: `PRESENT`, `ABSENT` or `ONE_OTHER`.
        differing: share of the furniture that differs between the floors; None for streets.
        segments: number of segments of the query.
        right: whether the pose is right: in the right map, within the tolerance.
        wrong: whether there is a pose that is wrong.
        wrong_but_sure: whether the pose is wrong, with a probability of at least 0.9.
        ambiguous: whether there is no pose because several places fit.
    """

    places: str
    case: str
    differing: float | None
    segments: int
    right: bool
    wrong: bool
    wrong_but_sure: bool
    ambiguous: bool


def indoor_floors(
    folder: Path, seed: int, scans: int, lidar: Lidar, differing: float, progress: Progress = silent
) -> SimilarPlaces:
    """Simulate the floors of one building.

    Args:
        folder: folder of the drives.
        seed: seed of the building.
        scans: number of scans of each drive.
        lidar: simulated sensor.
        differing: share of the furniture that differs between the floors.
        progress: wraps the loops.
    """
    pairs = []
    for floor in range(FLOORS):
        drives = two_robots(
            folder / f"building-{seed}-floor-{floor}",
            seed=seed,
            scans=scans,
            place="indoor",
            floor=floor,
            differing=differing,
            lidar=lidar,
            overwrite=True,
            progress=progress,
        )
        pairs.append(pair_of(drives, f"floor {floor}", progress))
    return SimilarPlaces(f"building {seed}", "indoor", tuple(pairs), differing)


def look_alike_streets(
    folder: Path, seed: int, scans: int, lidar: Lidar, progress: Progress = silent
) -> SimilarPlaces:
    """Simulate a town of which each street has identical houses.

    Args:
        folder: folder of the drives.
        seed: seed of the town.
        scans: number of scans of each drive.
        lidar: simulated sensor.
        progress: wraps the loops.
    """
    city = City.build(seed, STREET_METERS, look_alikes=1.0)
    whole = city.route(city.planner.every_street())
    scans = min(scans, int(0.9 * whole.length()))
    drives = several_robots(
        folder / f"town-{seed}",
        city,
        fitted(whole, scans),
        2,
        scans=scans,
        lidar=lidar,
        overwrite=True,
        progress=progress,
    )
    return SimilarPlaces(f"town {seed}", "streets", (pair_of(drives, "streets", progress),))


def pair_of(drives: Sequence[Path], name: str, progress: Progress) -> Pair:
    """Segment two drives and return their robots: the first one maps, the second one localizes."""
    robots = []
    for folder in drives:
        drive = open_drive(folder)
        recording = recording_of(drive, progress=progress)
        robots.append(Robot(name, drive, [recording], read_origin(folder)))
    return Pair(robots[0], robots[1], blocks=False)


def measure_similar_places(
    groups: Iterator[SimilarPlaces],
    model: Path,
    trials: int,
    per_group: int,
    seed: int = 0,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Localize in similar places; return the report of `placecell bench floors --simulate`.

    Args:
        groups: groups of similar places; as many are simulated as the trials need.
        model: folder of the model.
        trials: number of trials.
        per_group: largest number of trials in one group.
        seed: random seed of the robots' frames.
        progress: wraps the loops.

    Raises:
        ValueError: the groups have too few queries.
    """
    done, names = list[SimilarTrial](), list[str]()
    kind = ""
    with Engine.temporary(model) as engine:
        for group in groups:
            done += run_group(engine, group, min(per_group, trials - len(done)), seed, progress)
            names.append(group.name)
            kind = group.kind
            if len(done) >= trials:
                break
        model_id = engine.model.id
    if len(done) < trials:
        raise ValueError(
            f"{len(names)} groups of similar places have {len(done)} queries of "
            f"{FEWEST_SEGMENTS} segments or more; {trials} trials need more. Increase --scans."
        )
    shares = sorted({one.differing for one in done if one.differing is not None})
    return {
        **summary(done),
        "kind": kind,
        "by_case": {
            case: summary([one for one in done if one.case == case])
            for case in dict.fromkeys(one.case for one in done)
        },
        "by_share": {
            f"{share:.1f}": summary([one for one in done if one.differing == share])
            for share in shares
        },
        "groups": names,
        "tolerance": {"meters": TOLERANCE[0], "degrees": TOLERANCE[1]},
        "sure_from": SURE,
        "model_id": model_id,
        "machine": machine(),
        "seed": seed,
    }


def summary(trials: Sequence[SimilarTrial]) -> dict[str, Any]:
    """Return the counts of some trials."""
    return {
        "trials": len(trials),
        "right": sum(one.right for one in trials),
        "ambiguous": sum(one.ambiguous for one in trials),
        "wrong": sum(one.wrong for one in trials),
        "wrong_but_sure": sum(one.wrong_but_sure for one in trials),
    }


def run_group(
    engine: Engine, group: SimilarPlaces, trials: int, seed: int, progress: Progress
) -> list[SimilarTrial]:
    """Run up to this number of trials in one group, spread evenly over its queries."""
    maps = {f"place-{n}": pair.mapper.build_map(engine, f"place-{n}")
            for n, pair in enumerate(group.pairs)}  # fmt: skip
    for name, content in maps.items():
        engine.put_map(name, content)
    frame = random_frame(seed)
    queries = [
        (f"place-{number}", query)
        for number, pair in enumerate(group.pairs)
        for query in pair.queries(engine, frame)
        if len(query.codes) >= FEWEST_SEGMENTS and query.mapped
    ]
    cases = (PRESENT, ABSENT, ONE_OTHER) if len(maps) > 1 else (PRESENT, ABSENT)
    asked = [(*one, case) for one in queries for case in cases]
    chosen = spread(len(asked), trials)
    done = []
    for number in progress(chosen.tolist(), len(chosen), f"trials in {group.name}"):
        name, query, case = asked[number]
        found = localized(engine, maps, query, name, case)
        done.append(trial_of(found, group, query, name, case))
    for name in maps:
        engine.delete_map(name)
    return done


def localized(
    engine: Engine, maps: dict[str, CompactMap], query: PoseQuery, name: str, case: str
) -> LocalizationResult:
    """Localize a query in the maps of a case; `name` is the right one."""
    seen = Descriptors(engine.model.id, query.codes, None, query.centroids, {})
    if case == PRESENT:
        return engine.localize(seen, list(maps), K)
    others = [each for each in maps if each != name]
    if others:
        return engine.localize(seen, others[:1] if case == ONE_OTHER else others, K)
    content = maps[name]
    where = query.truth.apply(query.sensor)
    apart = np.linalg.norm((content.centroids - where)[:, :2], axis=1)
    engine.put_map("rest", take(content, apart > LEFT_OUT_M))
    try:
        return engine.localize(seen, ["rest"], K)
    finally:
        engine.delete_map("rest")


def trial_of(
    found: LocalizationResult, group: SimilarPlaces, query: PoseQuery, name: str, case: str
) -> SimilarTrial:
    """Compare the result of a query with the truth."""
    best = found[0]
    pose, probability = best.localization.pose, best.localization.probability
    right = False
    if pose is not None and case == PRESENT and best.snapshot.name == name:
        meters, angle = pose.difference(query.truth, query.sensor)
        right = meters <= TOLERANCE[0] and bool(np.degrees(angle) <= TOLERANCE[1])
    wrong = pose is not None and not right
    return SimilarTrial(
        places=group.name,
        case=case,
        differing=group.differing,
        segments=len(query.codes),
        right=right,
        wrong=wrong,
        wrong_but_sure=wrong and probability >= SURE,
        ambiguous=pose is None and best.localization.reason == "ambiguous",
    )
