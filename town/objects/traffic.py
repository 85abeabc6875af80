"""Parked cars and people, which differ for each drive."""

from collections.abc import Iterator

import numpy as np

from town.objects.block import SceneObject
from town.objects.car import car, person
from town.streets.plan import BAY_WIDTH, CURB_HEIGHT, Frontage, StreetPlan
from town.streets.terrain import Terrain


def traffic(plan: StreetPlan, terrain: Terrain, seed: int) -> Iterator[SceneObject]:
    """Yield the parked cars and the people on the sidewalks of one drive."""
    rng = np.random.default_rng([seed, 1])
    for frontage in plan.frontages():
        yield from traffic_along(frontage, terrain, rng)


def traffic_along(
    frontage: Frontage, terrain: Terrain, rng: np.random.Generator
) -> Iterator[SceneObject]:
    """Yield the parked cars and people along one side of a block.

    Half of the parking bays have a car of a random kind, not exactly in the middle.
    """
    for x in frontage.bays():
        if rng.random() < 0.5:
            spot = frontage.on_plan(
                x + float(rng.uniform(-0.2, 0.2)),
                -BAY_WIDTH / 2 + float(rng.uniform(-0.05, 0.1)),
            )
            heading = frontage.heading + float(rng.normal(scale=0.02))
            # Cars face in the direction of their lane, a few in the opposite direction.
            if rng.random() < 0.9:
                heading += np.pi
            yield SceneObject("parked car", terrain.place(car(rng), spot, heading))
    for _ in range(int(rng.poisson(frontage.length / 40))):
        spot = frontage.on_plan(float(rng.uniform(2, frontage.length - 2)), 1.8)
        heading = float(rng.uniform(0, 2 * np.pi))
        yield SceneObject("person", terrain.place(person(rng), spot, heading, CURB_HEIGHT))
