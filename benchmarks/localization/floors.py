"""Similar floors: how often /localize confuses one floor with another, and how surely.

A floor is a set of objects, each with a descriptor and a position. Another floor has the same
objects at the same positions, except for a share that is replaced by other objects. Each map sees
each object anew: its descriptors differ like two views of one real segment (`descriptor_sampler`),
its centroids by some decimeters. The robot sees part of one floor, in its own frame, and localizes
in all maps at once, with the engine that answers `/localize`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from placecell_client import CompactMap

from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
from benchmarks.synthetic_maps.road_map import road_map
from evaluation.machine import machine
from evaluation.poses.queries import random_frame
from placecell.core.types import Float32, Float64, Int8, Int64
from placecell.localization import Pose
from placecell.segmentation.pipeline import Progress, silent
from service.core.auth import ANYONE
from service.core.settings import Settings
from service.core.timing import Timing
from service.engine import Engine
from service.inference.describer import Descriptors
from service.search.localization import LocalizationResult
from service.search.query import Query, select_maps

FLOOR_SIZE_M = np.array([90.0, 40.0, 4.0])
"""Size of a floor along x, y, z, meters."""

CENTROID_SCATTER_M = 0.3
"""Standard deviation of an object's centroid between views, along each axis, meters."""

SURE = 0.9
"""Probability from which a pose counts as sure."""

TOLERANCE = 3.0, 10.0
"""Tolerance of a right pose, meters and degrees; other benchmarks measure the accuracy of poses."""

K = 25
"""Candidates per segment."""


@dataclass(frozen=True, slots=True)
class FloorCase:
    """Kind of trial.

    Attributes:
        name: name of the case.
        floors: number of other floors of the building, all similar to the true floor.
        objects: number of objects on a floor.
        seen: number of segments that the robot sees.
        views: views of each object in a map; 1: the map was deduplicated.
        unchanged: whether the robot sees only objects that all floors have.
        differing: number of objects that differ between two floors; None: drawn per trial.
        larger: size of the other floors' maps over that of the true floor's map, due to objects
            elsewhere in the building; below 1, the true floor's map is larger.
        other_model: whether another model made the maps of the other floors.
        others: number of maps of other buildings.
    """

    name: str
    floors: int = 1
    objects: int = 150
    seen: int = 50
    views: int = 3
    unchanged: bool = False
    differing: int | None = None
    larger: float = 1.0
    other_model: bool = False
    others: int = 0


CASES = (
    FloorCase("two floors"),
    FloorCase("two floors, eight segments", seen=8),
    FloorCase("unchanged part only", unchanged=True),
    FloorCase("unchanged part only, eight segments", unchanged=True, seen=8),
    FloorCase("five floors", floors=4),
    FloorCase("five things differ", differing=5),
    FloorCase("large other map", larger=20.0),
    FloorCase("large true map", larger=1 / 20),
    FloorCase("deduplicated maps", views=1),
    FloorCase("two models", other_model=True),
    FloorCase("twenty floors", floors=19, objects=80),
    FloorCase("among other buildings", others=30),
)


@dataclass(frozen=True, slots=True)
class Trial:
    """Result of one trial: one localization of one robot.

    Attributes:
        case: name of the case.
        share: share of the other floors' objects that were replaced.
        differs: share of the seen objects that the most similar other floor does not have.
        right: whether the pose is right: in the right map, within the tolerance.
        wrong_but_sure: whether the pose is wrong, with a probability of at least 0.9.
        wrong: whether the pose is wrong.
        ambiguous: whether the robot is not localized because another place fits equally well.
        names_both: whether the robot is not localized, and the answer names both the true map and
            its rival.
    """

    case: str
    share: float
    differs: float
    right: bool
    wrong_but_sure: bool
    wrong: bool
    ambiguous: bool
    names_both: bool


def measure_floors(
    samplers: Sequence[DescriptorSampler],
    folder: Path,
    names: Sequence[str],
    trials: int,
    seed: int = 0,
    cases: Sequence[FloorCase] = CASES,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Run the trials, spread evenly over the cases; return the report of `placecell bench floors`.

    Args:
        samplers: sampler of each model's descriptors.
        folder: folder of the models.
        names: names of the models; the first one makes the map of the true floor.
        trials: number of trials.
        seed: random seed of the first trial; the next trials count up.
        cases: cases to run.
        progress: wraps the loop.

    Raises:
        StartError: a model cannot be loaded.
    """
    with TemporaryDirectory(prefix="placecell-floors-") as data:
        settings = Settings(
            data_dir=Path(data), models_dir=folder, model=names[0], also=tuple(names[1:])
        )
        with Engine.open(settings) as engine:
            done = [
                run_trial(engine, samplers, names, cases[number % len(cases)], seed + number)
                for number in progress(range(trials), trials, "trials")
            ]
            ids = [engine.models.named(name).id for name in names]
    return {
        "trials": len(done),
        "wrong_but_sure": sum(each.wrong_but_sure for each in done),
        "wrong": sum(each.wrong for each in done),
        "right": sum(each.right for each in done),
        "ambiguous": sum(each.ambiguous for each in done),
        "where_the_difference_decides": summarize([one for one in done if difference_decides(one)]),
        "by_share": {
            f"{low:.1f} to {low + 0.1:.1f}": summarize(
                [each for each in done if low <= each.share < low + 0.1 + 1e-9 * (low > 0.45)]
            )
            for low in np.arange(0, 0.6, 0.1).round(1).tolist()
        },
        "by_case": {
            case.name: summarize([each for each in done if each.case == case.name])
            for case in cases
        },
        "models": ids,
        "machine": machine(),
        "seed": seed,
    }


DECISIVE_SHARE, DECISIVE_SEGMENTS = 0.3, 10
"""Share and number of the seen segments that only the true floor must have, so that the difference
decides."""


def difference_decides(trial: Trial) -> bool:
    """Return whether the robot sees enough of the difference, in maps of one model."""
    seen = {case.name: case.seen for case in CASES}.get(trial.case, 0)
    is_enough = trial.differs >= DECISIVE_SHARE and trial.differs * seen >= DECISIVE_SEGMENTS
    return is_enough and trial.case != "two models"


def summarize(trials: Sequence[Trial]) -> dict[str, Any]:
    """Return the counts of some trials."""
    count = len(trials)
    return {
        "trials": count,
        "wrong_but_sure": sum(each.wrong_but_sure for each in trials),
        "wrong": sum(each.wrong for each in trials),
        "right": sum(each.right for each in trials),
        "ambiguous": sum(each.ambiguous for each in trials),
        "names_both": sum(each.names_both for each in trials),
        "share_right": round(sum(each.right for each in trials) / count, 4) if count else None,
    }


@dataclass(frozen=True, slots=True, eq=False)
class Floor:
    """Floor of a building.

    Attributes:
        objects: int64 (n,), number of each object.
        positions: float64 (n, 3), position of each object, meters.
    """

    objects: Int64
    positions: Float64


def run_trial(
    engine: Engine,
    samplers: Sequence[DescriptorSampler],
    names: Sequence[str],
    case: FloorCase,
    seed: int,
) -> Trial:
    """Draw floors, store their maps, localize a robot of the first floor, and delete the maps."""
    random = np.random.default_rng(seed)
    share = float(random.uniform(0, 0.6)) if case.differing is None else 0.0
    count = case.objects
    changed = round(share * count) if case.differing is None else case.differing
    true = Floor(np.arange(count), random.uniform(0, 1, (count, 3)) * FLOOR_SIZE_M)
    floors, unused = [true], count
    common = np.ones(count, dtype=bool)
    for _ in range(case.floors):
        other = Floor(true.objects.copy(), true.positions.copy())
        replaced = random.choice(count, changed, replace=False)
        other.objects[replaced] = unused + np.arange(changed)
        other.positions[replaced] = random.uniform(0, 1, (changed, 3)) * FLOOR_SIZE_M
        common[replaced] = False
        unused += changed
        floors.append(other)
    for _ in range(case.others):
        objects = unused + np.arange(count)
        floors.append(Floor(objects, random.uniform(0, 1, (count, 3)) * FLOOR_SIZE_M))
        unused += count
    extra = round(count * (max(case.larger, 1 / case.larger) - 1))
    floors = [
        _extended(floor, extra, unused + number * extra, random)
        if (number > 0) == (case.larger > 1)
        else floor
        for number, floor in enumerate(floors)
    ]
    unused += extra * len(floors)
    model_of = [0] + [int(case.other_model)] * (len(floors) - 1)
    descriptors = [each.sample_objects(unused, random) for each in samplers]
    # The names are in random order, because they decide between maps that are otherwise equal.
    map_names = [f"floor-{number:02}" for number in random.permutation(len(floors))]
    for floor, number, name in zip(floors, model_of, map_names, strict=True):
        content = _map_of(floor, samplers[number], descriptors[number], case.views, name, random)
        engine.put_map(name, content)
    # The robot sees the objects around a position: those that all floors have, or all.
    visible = np.flatnonzero(common) if case.unchanged else np.arange(count)
    middle = true.positions[random.choice(visible)]
    distance = np.linalg.norm((true.positions[visible] - middle)[:, :2], axis=1)
    seen = np.sort(visible[np.argsort(distance)[: case.seen]])
    differs = 1.0 - max(
        float(np.isin(true.objects[seen], floor.objects).mean()) for floor in floors[1:]
    )
    frame = random_frame(seed)
    scatter = random.normal(scale=CENTROID_SCATTER_M, size=(len(seen), 3))
    centroids = frame.apply(true.positions[seen] + scatter)
    codes = {
        engine.models.named(names[number]).id: samplers[number].sample_views(
            descriptors[number], true.objects[seen], random
        )
        for number in sorted(set(model_of))
    }
    result = _localize(engine, codes, centroids)
    for name in map_names:
        engine.delete_map(name)
    return _trial_of(result, case, share, differs, map_names[0], frame.inverse(), centroids)


def _localize(engine: Engine, codes: dict[str, Int8], centroids: Float64) -> LocalizationResult:
    """Localize in all maps, with the codes of each model."""
    selection = select_maps(engine.maps, engine.models, None, None, ANYONE)
    query = Query(engine.model.id, selection, K, None, (), searched_k=K, is_reranked=False)
    described = [
        Descriptors(model.id, codes[model.id], None, centroids, {})
        for model, _ in selection.searched
    ]
    return engine.poses(query, described, Timing())


def _trial_of(
    result: LocalizationResult,
    case: FloorCase,
    share: float,
    differs: float,
    name: str,
    truth: Pose,
    centroids: Float64,
) -> Trial:
    """Compare the result with the truth."""
    best = result[0]
    pose, probability = best.localization.pose, best.localization.probability
    right = best.snapshot.name == name and _is_near(pose, truth, centroids)
    named = {best.snapshot.name} | ({best.rival.name} if best.rival is not None else set())
    return Trial(
        case=case.name,
        share=share,
        differs=differs,
        right=right,
        wrong_but_sure=pose is not None and not right and probability >= SURE,
        wrong=pose is not None and not right,
        ambiguous=pose is None and best.localization.reason == "ambiguous",
        names_both=pose is None and name in named and len(named) == 2,
    )


def _is_near(pose: Pose | None, truth: Pose, centroids: Float64) -> bool:
    if pose is None:
        return False
    distance, angle = pose.difference(truth, centroids.mean(axis=0))
    return distance <= TOLERANCE[0] and bool(np.degrees(angle) <= TOLERANCE[1])


def _extended(floor: Floor, count: int, first: int, random: np.random.Generator) -> Floor:
    """Return a floor with further objects beside it, as part of a larger map."""
    size = FLOOR_SIZE_M * (np.ceil(count / len(floor.objects)), 1.0, 1.0)
    positions = random.uniform(0, 1, (count, 3)) * size + (FLOOR_SIZE_M[0] + 20.0, 0.0, 0.0)
    return Floor(
        np.concatenate([floor.objects, first + np.arange(count)]),
        np.concatenate([floor.positions, positions]),
    )


def _map_of(
    floor: Floor,
    sampler: DescriptorSampler,
    descriptors: Float32,
    views: int,
    name: str,
    random: np.random.Generator,
) -> CompactMap:
    """Return a map of a floor with `views` views of each object."""
    codes = sampler.sample_views(descriptors, np.repeat(floor.objects, views), random)
    seed = int(random.integers(2**31))
    positions = np.repeat(floor.positions, views, axis=0)
    positions = positions + random.normal(scale=CENTROID_SCATTER_M, size=positions.shape)
    # The segments of a capture must lie near its sensor: captures follow each other along x.
    order = np.argsort(positions[:, 0])
    content = road_map(codes[order], sampler.manifest, f"robot of {name}", seed)
    captures = np.split(positions[order], np.flatnonzero(np.diff(content.frame_index)) + 1)
    return replace(
        content,
        centroids=positions[order],
        frame_positions=np.array([each.mean(axis=0) for each in captures]),
        frame=name,
    )
