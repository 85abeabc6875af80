"""Draft of an indoor floor: collects walls, furniture, ceilings and the ways of robots.

Floors of one building have the same walls and the same *slots* of furniture. A slot has the same
object on all floors, or one of its own on each floor.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import box
from town.objects.interior import (
    bench_seat,
    bookcase,
    coat_rack,
    copier,
    counter,
    cupboard,
    desk,
    hydrant,
    machine,
    meeting_table,
    open_shelves,
    pallet,
    partition,
    pilaster,
    pot_plant,
    rack,
    radiator,
    sofa_group,
    vending_machine,
    waste_bins,
    workbench,
)
from town.places.builder import Builder, filled
from town.places.indoor.walls import Frame
from town.places.place import Spot

Furnish = Callable[[np.random.Generator], Mesh]

GROUPS: dict[str, tuple[Furnish, ...]] = {
    "corridor": (
        cupboard, radiator, vending_machine, copier, bench_seat, pot_plant, waste_bins, pilaster,
        hydrant, coat_rack, open_shelves,
    ),
    "room wall": (cupboard, open_shelves, open_shelves, radiator),
    "office": (desk, desk, meeting_table),
    "workshop": (machine, machine, workbench, pallet),
    "lobby": (sofa_group, partition, pot_plant, counter, meeting_table, waste_bins),
}  # fmt: skip
"""Builders of the furniture of each group of slots."""

LONG: dict[str, Callable[[np.random.Generator, float, float], Mesh]] = {
    "rack": rack,
    "bookcase": bookcase,
}
"""Builders of furniture of a given length and height."""


@dataclass(frozen=True, slots=True)
class Slot:
    """Slot of one piece of furniture.

    Attributes:
        group: name of the group, see `GROUPS` and `LONG`.
        x, y: position, meters.
        heading: direction of the object's x axis, radians.
        size: length and height of a long object, meters.
    """

    group: str
    x: float
    y: float
    heading: float
    size: tuple[float, float] = (0.0, 0.0)

    def build(self, rng: np.random.Generator) -> Mesh:
        """Build a piece of furniture for this slot."""
        if self.group in LONG:
            return LONG[self.group](rng, *self.size)
        makers = GROUPS[self.group]
        return makers[int(rng.integers(len(makers)))](rng)


class FloorDraft:
    """Collects the parts of a floor. Walls and slots do not depend on the floor's number."""

    def __init__(self, builder: Builder) -> None:
        self.builder = builder
        self.rng = builder.rng
        self.slots = list[Slot]()

    def wall(self, frame: Frame, mesh: Mesh) -> None:
        """Add a wall, given in a frame."""
        self.builder.put("wall", mesh, frame.x, frame.y, frame.heading)

    def slot(self, group: str, frame: Frame, x: float, y: float, turn: float = 0.0,
             ground: tuple[float, float] | None = None,
             size: tuple[float, float] = (0.0, 0.0)) -> bool:  # fmt: skip
        """Add a slot if its ground is free, and return whether it was added.

        Args:
            group: name of the group.
            frame: frame of the position.
            x, y: position, meters.
            turn: direction of the object's x axis in the frame, radians.
            ground: extent of the object along its x and y axis, meters; None: no check.
            size: length and height of a long object, meters.
        """
        at = frame.moved(x, y, turn)
        if ground is not None:
            disks = np.array(
                [at.at(*place) for place in filled(ground, 0.5) - np.divide(ground, 2)]
            )
            if not self.builder.is_free(disks, 0.3):
                return False
            self.builder.take(disks, 0.3)
        self.slots.append(Slot(group, at.x, at.y, at.heading, size))
        return True

    def furnish(self, seed: int, floor: int, differing: float) -> None:
        """Build the furniture of a floor.

        Args:
            seed: seed of the building.
            floor: number of the floor.
            differing: share of the slots whose object differs from that of floor 0.
        """
        draw = np.random.default_rng([seed, 30, floor]).random(len(self.slots))
        for number, slot in enumerate(self.slots):
            own = floor if draw[number] < differing else 0
            mesh = slot.build(np.random.default_rng([seed, 29, own, number]))
            self.builder.put(slot.group, mesh, slot.x, slot.y, slot.heading)

    def ceiling(self, low: Float64, high: Float64, height: float) -> None:
        """Add a ceiling with lamps over a rectangle, from its lowest to its highest x and y."""
        size = high - low
        slab = box((0, 0, height), (float(size[0]), float(size[1]), 0.2), Reflectance.PLASTER)
        lamps = [
            box((float(x) - 0.6, float(y) - 0.1, height - 0.08), (1.2, 0.2, 0.08), Reflectance.SIGN)
            for x in np.arange(1.5, size[0] - 0.7, 3.2)
            for y in np.arange(1.5, max(1.6, size[1] - 0.5), 3.2)
        ]
        self.builder.put("ceiling", Mesh.joined([slab, *lamps]), float(low[0]), float(low[1]))

    def column(self, x: float, y: float, side: float, height: float) -> None:
        """Add a square column, if its ground is free."""
        corner = (-side / 2, -side / 2, 0.0)
        make = partial(_box_of, corner, (side, side, height))
        self.builder.stand("column", make, x, y, side * 0.75, 0.0)

    def spot(self, kind: str, make: Furnish, frame: Frame, x: float, y: float, radius: float,
             chance: float, turn: float = 0.0) -> None:  # fmt: skip
        """Add a spot of a movable object, if its ground is free."""
        at = frame.moved(x, y, turn)
        spot = Spot(kind, make, at.x, at.y, at.heading, chance, 0.03, 0.15)
        self.builder.offer(spot, radius)

    def door(self, make: Furnish, frame: Frame, x: float, chance: float) -> None:
        """Add a door leaf, which is closed during a share of the drives."""
        at = frame.moved(x, 0.0)
        self.builder.offer(Spot("door", make, at.x, at.y, at.heading, chance, 0.0, 0.0), 0.2)


def _box_of(corner: tuple[float, float, float], size: tuple[float, float, float],
            rng: np.random.Generator) -> Mesh:  # fmt: skip
    del rng
    return box(corner, size, Reflectance.PLASTER)
