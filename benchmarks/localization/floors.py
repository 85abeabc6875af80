"""Look-alike floors: how often /localize confuses one floor with another, and how surely.

A floor is a set of things, each with a descriptor and a place. Another floor has the same things in
the same places, but for a share that is replaced by others. Each map sees each thing anew: its
descriptors differ as two views of one real segment do (`map_content`), its centroids by decimeters.
The robot sees a part of one floor, in a frame of its own, and asks in all maps at once, by the code
that answers `/localize`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.edit import take

from benchmarks.synthetic_maps.descriptor_sampler import DescriptorSampler
from benchmarks.synthetic_maps.road_map import road_map
from evaluation.machine import machine
from evaluation.poses.queries import random_frame
from placecell.core.types import Float32, Float64, Int8, Int64
from placecell.localization import LocalizationParameters, Pose
from placecell.segmentation.pipeline import Progress, silent
from service.core.metrics import Metrics
from service.core.settings import Settings
from service.core.timing import Timing
from service.inference.model_registry import Model, Models
from service.maps.index import LayeredIndex
from service.maps.layers import MapLayers
from service.maps.shared_index import SharedIndexes
from service.maps.snapshot import MapSnapshot
from service.maps.store import MapHead
from service.search.localization import MapLocalization, ModelQuery, localize_among

SIZE = np.array([90.0, 40.0, 4.0])
"""Size of a floor along x, y, z, meters."""

SCATTER = 0.3
"""Scatter of a thing's centroid between views: standard deviation along each axis, meters."""

SURE = 0.9

NEAR = 3.0, 10.0
"""Tolerance of a right pose, meters and degrees; how exact a pose is, other benches measure."""

K = 25


@dataclass(frozen=True, slots=True)
class FloorCase:
    """A kind of trial.

    Attributes:
        name: of the case.
        floors: that look like the true one, all of one building.
        things: on a floor.
        seen: segments that the robot sees.
        views: of each thing in a map; 1: the map was deduplicated.
        unchanged: the robot sees only what all floors have.
        differing: things that differ between two floors; None: the share of the trial.
        larger: how many times larger the other floors' maps are, by things elsewhere in the
            building; less than 1: how many times larger the true floor's is.
        other_model: the other floors were mapped with another model.
        others: maps of other buildings beside them.
    """

    name: str
    floors: int = 1
    things: int = 150
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
    FloorCase("twenty floors", floors=19, things=80),
    FloorCase("among other buildings", others=30),
)


@dataclass(frozen=True, slots=True)
class Trial:
    """Result of one trial: one robot that asked once.

    Attributes:
        case: name of it.
        share: of the other floors' things that were replaced.
        differs: share of what the robot sees that the most similar other floor does not have.
        right: localized in the right map, at the right place.
        wrong_but_sure: localized elsewhere with a probability of 0.9 or more.
        wrong: localized elsewhere.
        ambiguous: not localized, for another place fits as well.
        names_both: not localized, and both places are told: the true one and its rival.
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
    views: Sequence[DescriptorSampler],
    models: Sequence[Model],
    trials: int,
    seed: int = 0,
    cases: Sequence[FloorCase] = CASES,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Run the trials, spread evenly over cases and shares of change; return the report.

    Args:
        views: of each model, the first one's maps are asked.
        models: the same models, loaded.
    """
    done = [
        run_trial(views, models, cases[number % len(cases)], seed + number)
        for number in progress(range(trials), trials, "trials")
    ]
    decided = [each for each in done if difference_decides(each)]
    return {
        "trials": len(done),
        "wrong_but_sure": sum(each.wrong_but_sure for each in done),
        "wrong": sum(each.wrong for each in done),
        "right": sum(each.right for each in done),
        "ambiguous": sum(each.ambiguous for each in done),
        "where_the_difference_decides": summarize(decided),
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
        "models": [each.id for each in models],
        "machine": machine(),
        "seed": seed,
    }


DECIDES, LEAST = 0.3, 10
"""Share of the robot's segments, and number of segments, that only the true floor must have for the
difference to decide."""


def difference_decides(trial: Trial) -> bool:
    """Return whether the robot sees enough of the difference, and scores of one model show it."""
    seen = {case.name: case.seen for case in CASES}.get(trial.case, 0)
    is_enough = trial.differs >= DECIDES and trial.differs * seen >= LEAST
    return is_enough and trial.case != "two models"


def summarize(trials: Sequence[Trial]) -> dict[str, Any]:
    """Summarize the trials of each case."""
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
    """Floor of a building: things by number, and their positions, float64 (n, 3)."""

    things: Int64
    places: Float64


def run_trial(
    views: Sequence[DescriptorSampler], models: Sequence[Model], case: FloorCase, seed: int
) -> Trial:
    """Draw floors, map them, and localize a robot of the first floor."""
    random = np.random.default_rng(seed)
    share = float(random.uniform(0, 0.6)) if case.differing is None else 0.0
    count = case.things
    changed = round(share * count) if case.differing is None else case.differing
    true = Floor(np.arange(count), random.uniform(0, 1, (count, 3)) * SIZE)
    floors, fresh = [true], count
    common = np.ones(count, dtype=bool)
    for _ in range(case.floors):
        other = Floor(true.things.copy(), true.places.copy())
        replaced = random.choice(count, changed, replace=False)
        other.things[replaced] = fresh + np.arange(changed)
        other.places[replaced] = random.uniform(0, 1, (changed, 3)) * SIZE
        common[replaced] = False
        fresh += changed
        floors.append(other)
    for _ in range(case.others):
        things = fresh + np.arange(count)
        floors.append(Floor(things, random.uniform(0, 1, (count, 3)) * SIZE))
        fresh += count
    extra = round(count * (max(case.larger, 1 / case.larger) - 1))
    floors = [
        _extended(floor, extra, fresh + number * extra, random)
        if (number > 0) == (case.larger > 1)
        else floor
        for number, floor in enumerate(floors)
    ]
    fresh += extra * len(floors)
    of_model = [0] + [int(case.other_model)] * (len(floors) - 1)
    looks = [each.sample_objects(fresh, random) for each in views]
    # Both orders of the names.
    names = [f"floor-{number:02}" for number in random.permutation(len(floors))]
    maps = [
        _mapped(floor, views[model], looks[model], case.views, name, random)
        for floor, model, name in zip(floors, of_model, names, strict=True)
    ]
    # What the robot sees: things around a place, of what all floors have or of all.
    among = np.flatnonzero(common) if case.unchanged else np.arange(count)
    middle = true.places[random.choice(among)]
    away = np.linalg.norm((true.places[among] - middle)[:, :2], axis=1)
    seen = np.sort(among[np.argsort(away)[: case.seen]])
    differs = 1.0 - max(
        float(np.isin(true.things[seen], floor.things).mean()) for floor in floors[1:]
    )
    frame = random_frame(seed)
    here = frame.apply(true.places[seen] + random.normal(scale=SCATTER, size=(len(seen), 3)))
    groups = []
    for number, (each, model) in enumerate(zip(views, models, strict=True)):
        own = tuple(
            _stored(content, model, name)
            for content, name, of in sorted(
                zip(maps, names, of_model, strict=True), key=lambda one: one[1]
            )
            if of == number
        )
        if own:
            codes = each.sample_views(looks[number], true.things[seen], random)
            groups.append(ModelQuery(model, own, codes, here, np.arange(len(codes))))
    shared = _Shared()
    answers = localize_among(
        groups, K, LocalizationParameters(), Timing(), shared.parts, lambda _: None
    )
    return _outcome(answers, case, share, differs, names[0], frame.inverse(), here)


def _outcome(
    answers: Sequence[MapLocalization],
    case: FloorCase,
    share: float,
    differs: float,
    name: str,
    truth: Pose,
    here: Float64,
) -> Trial:
    """Return what the robot makes of the answer."""
    best = answers[0]
    pose, probability = best.judged.localization.pose, best.judged.localization.probability
    is_told = pose is not None
    right = is_told and best.stored.name == name and _near(pose, truth, here)
    told = {each.stored.name for each in answers[:1]} | {
        each.rival.name for each in answers[:1] if each.rival is not None
    }
    return Trial(
        case.name,
        share,
        differs,
        right,
        is_told and not right and probability >= SURE,
        is_told and not right,
        not is_told and best.judged.localization.reason == "ambiguous",
        not is_told and name in told and len(told) == 2,
    )


def _near(pose: Pose | None, truth: Pose, here: Float64) -> bool:
    assert pose is not None
    meters, angle = pose.difference(truth, here.mean(axis=0))
    return meters <= NEAR[0] and bool(np.degrees(angle) <= NEAR[1])


def _extended(floor: Floor, count: int, first: int, random: np.random.Generator) -> Floor:
    """Return a floor with further things beside it, as part of a larger map."""
    reach = SIZE * (np.ceil(count / len(floor.things)), 1.0, 1.0)
    places = random.uniform(0, 1, (count, 3)) * reach + (SIZE[0] + 20.0, 0.0, 0.0)
    return Floor(
        np.concatenate([floor.things, first + np.arange(count)]),
        np.concatenate([floor.places, places]),
    )


def _mapped(
    floor: Floor,
    views: DescriptorSampler,
    looks: Float32,
    times: int,
    name: str,
    random: np.random.Generator,
) -> CompactMap:
    """Return a map of a floor, with each thing seen `views` times."""
    things = np.repeat(floor.things, times)
    codes: Int8 = views.sample_views(looks, things, random)
    content = road_map(codes, views.manifest, f"robot of {name}", int(random.integers(2**31)))
    places = np.repeat(floor.places, times, axis=0)
    places = places + random.normal(scale=SCATTER, size=places.shape)
    return replace(content, centroids=places, frame=name)


def _stored(content: CompactMap, model: Model, name: str) -> MapSnapshot:
    layers = MapLayers.of(take(content, np.arange(len(content))))
    head = MapHead(name, name, 1, "0" * 16, 1, len(content), 0, 0, "")
    index = LayeredIndex.of(layers, model.manifest.quantizer)
    return MapSnapshot(head, layers, 1, 1, index)


class _Shared:
    """Shared indexes of one trial."""

    def __init__(self) -> None:
        self.shared = SharedIndexes()

    def parts(self, group: ModelQuery) -> Any:
        quantizer = group.model.manifest.quantizer
        return self.shared.parts(group.searched, group.searched, group.model.id, quantizer, ())


def load_models(folder: Path, names: Sequence[str]) -> list[Model]:
    """Load the models of a folder as the service loads them."""
    settings = Settings(models_dir=folder, model=names[0], also=tuple(names[1:]))
    models = Models(settings, Metrics())
    return [models.named(name) for name in names]
