"""Inner walls with doors, gates and windows, and the frame in which a row of rooms is built."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import box

THICKNESS = 0.16
"""Thickness of an inner wall, meters."""

DOOR_TOP = 2.1
"""Height of a door, meters."""

GATE_TOP = 2.6
"""Height of a gate that robots pass, meters."""


@dataclass(frozen=True, slots=True)
class Frame:
    """Frame on the floor plan: x along a wall, y to the left of it.

    Attributes:
        x, y: origin, meters.
        heading: direction of the x axis, radians.
    """

    x: float
    y: float
    heading: float

    def at(self, x: float, y: float) -> tuple[float, float]:
        """Transform a position of this frame to the floor plan."""
        cosine, sine = float(np.cos(self.heading)), float(np.sin(self.heading))
        return self.x + cosine * x - sine * y, self.y + sine * x + cosine * y

    def moved(self, x: float, y: float, turn: float = 0.0) -> "Frame":
        """Return a frame with its origin at a position of this one, turned by radians."""
        return Frame(*self.at(x, y), self.heading + turn)


@dataclass(frozen=True, slots=True)
class Opening:
    """Opening in a wall.

    Attributes:
        start: position along the wall, meters.
        width: width, meters.
        top: height of its upper edge, meters.
        sill: height of its lower edge, meters.
        panes: number of panes, with bars between them; 0 for none.
    """

    start: float
    width: float
    top: float
    sill: float = 0.0
    panes: int = 0


def inner_wall(length: float, height: float, openings: Sequence[Opening]) -> Mesh:
    """Build a wall along x, in the middle of its thickness, with framed openings.

    Args:
        length: length, meters.
        height: height, meters.
        openings: openings, in ascending order.
    """
    back, parts, at = -THICKNESS / 2, [], 0.0
    for each in openings:
        if each.start > at:
            parts.append(box((at, back, 0), (each.start - at, THICKNESS, height),
                             Reflectance.PLASTER))  # fmt: skip
        size = (each.width, THICKNESS, height - each.top)
        parts.append(box((each.start, back, each.top), size, Reflectance.PLASTER))
        if each.sill > 0:
            parts.append(box((each.start, back, 0), (each.width, THICKNESS, each.sill),
                             Reflectance.PLASTER))  # fmt: skip
        parts += frame_of(each)
        at = each.start + each.width
    if at < length:
        parts.append(box((at, back, 0), (length - at, THICKNESS, height), Reflectance.PLASTER))
    return Mesh.joined(parts)


def frame_of(opening: Opening) -> list[Mesh]:
    """Build the frame of an opening, which stands out of the wall, and the bars of its panes."""
    deep, thick = THICKNESS + 0.08, 0.09
    high = opening.top - opening.sill
    ends = (opening.start - thick / 2, opening.start + opening.width - thick / 2)
    parts = [
        box((x, -deep / 2, opening.sill), (thick, deep, high + 0.06), Reflectance.WOOD)
        for x in ends
    ]
    parts += [
        box((opening.start + opening.width * n / opening.panes - 0.025, -0.03, opening.sill),
            (0.05, 0.06, high), Reflectance.METAL)
        for n in range(1, opening.panes)
    ]  # fmt: skip
    return parts


def door_leaf(rng: np.random.Generator, width: float) -> Mesh:
    """Build a door leaf in its frame, closed; it is recessed and has a handle."""
    side = float(rng.choice([-1.0, 1.0]))
    return Mesh.joined(
        [
            box((-width / 2, -0.02, 0.01), (width, 0.05, DOOR_TOP), Reflectance.WOOD),
            box((side * 0.38 * width - 0.07, -0.09, 1.0), (0.14, 0.18, 0.04), Reflectance.METAL),
        ]
    )
