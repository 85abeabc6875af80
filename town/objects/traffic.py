"""Parked cars and people, which differ for each drive."""

from collections.abc import Iterator

import numpy as np

from town.objects.block import SceneObject
from town.objects.car import car, person
from town.streets.plan import BAY_WIDTH, CURB_HEIGHT, Frontage, StreetPlan
from town.streets.terrain import Terrain


def traffic(
    plan: StreetPlan, terrain: Terrain, seed: int, *, other_cars: bool = False
) -> Iterator[SceneObject]:
    """Yield the parked cars and the people on the sidewalks of one drive.

    Args:
        plan: streets.
        terrain: terrain under the streets.
        seed: seed of the drive.
        other_cars: whether it is another day, see `other_traffic_along`.
    """
    rng = np.random.default_rng([seed, 1])
    other_day = np.random.default_rng([seed, 10])
    for frontage in plan.frontages():
        if other_cars:
            yield from other_traffic_along(frontage, terrain, rng, other_day)
        else:
            yield from traffic_along(frontage, terrain, rng)


def traffic_along(
    frontage: Frontage, terrain: Terrain, rng: np.random.Generator
) -> Iterator[SceneObject]:
    """Yield the parked cars and people along one side of a block.

    Half of the parking bays have a car of a random kind, not exactly in the middle.
    """
    for x in frontage.bays().tolist():
        if rng.random() < 0.5:
            yield parked_car(frontage, terrain, x, rng)
    yield from people(frontage, terrain, rng)


def other_traffic_along(
    frontage: Frontage,
    terrain: Terrain,
    rng: np.random.Generator,
    other_day: np.random.Generator,
) -> Iterator[SceneObject]:
    """Yield the parked cars and people of another day: no bay has a car on both days.

    Args:
        frontage: side of the block.
        terrain: terrain under it.
        rng: generator of the first day. It draws the same numbers as `traffic_along`.
        other_day: generator of the other day.
    """
    for x in frontage.bays().tolist():
        if rng.random() < 0.5:
            parked_car(frontage, terrain, x, rng)
        else:
            yield parked_car(frontage, terrain, x, other_day)
    list(people(frontage, terrain, rng))
    yield from people(frontage, terrain, other_day)


def parked_car(
    frontage: Frontage, terrain: Terrain, x: float, rng: np.random.Generator
) -> SceneObject:
    """Build a car in the parking bay whose center is at x of the frontage, meters."""
    spot = frontage.on_plan(
        x + float(rng.uniform(-0.2, 0.2)),
        -BAY_WIDTH / 2 + float(rng.uniform(-0.05, 0.1)),
    )
    heading = frontage.heading + float(rng.normal(scale=0.02))
    # Cars face in the direction of their lane, a few in the opposite direction.
    if rng.random() < 0.9:
        heading += np.pi
    return SceneObject("parked car", terrain.place(car(rng), spot, heading))


def people(frontage: Frontage, terrain: Terrain, rng: np.random.Generator) -> Iterator[SceneObject]:
    """Yield the people on the sidewalk of one side of a block."""
    for _ in range(int(rng.poisson(frontage.length / 40))):
        spot = frontage.on_plan(float(rng.uniform(2, frontage.length - 2)), 1.8)
        heading = float(rng.uniform(0, 2 * np.pi))
        yield SceneObject("person", terrain.place(person(rng), spot, heading, CURB_HEIGHT))
