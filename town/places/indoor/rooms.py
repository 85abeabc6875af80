"""Rows of rooms along a corridor, and what stands along the corridor's walls."""

from functools import partial
from itertools import pairwise

import numpy as np

from town.places.indoor.draft import FloorDraft
from town.places.indoor.walls import DOOR_TOP, THICKNESS, Frame, Opening, door_leaf, inner_wall

AT_WALL = THICKNESS / 2 + 0.23
"""Distance of furniture from the middle of the wall that it stands at, meters."""


def row_of_rooms(
    draft: FloorDraft,
    frame: Frame,
    length: float,
    depth: float,
    height: float,
    *,
    back: bool,
    outside: bool = False,
) -> None:
    """Add rooms side by side, each with a door, a window or a wide opening to the corridor.

    Args:
        draft: draft of the floor.
        frame: frame of the wall along the corridor; y points into the rooms.
        length: length of the row, meters.
        depth: depth of the rooms, meters.
        height: height of the ceiling, meters.
        back: whether the row has a back wall.
        outside: whether the back wall is the building's outer wall, with windows.
    """
    rng = draft.rng
    edges = [0.0]
    while edges[-1] < length - 1e-6:
        rest = length - edges[-1]
        wide = float(rng.uniform(3.4, 8.0))
        edges.append(length if rest - wide < 3.4 else edges[-1] + wide)
    openings = list[Opening]()
    panes = list[Opening]()
    for start, end in pairwise(edges):
        openings += front(draft, frame, start, end)
        panes += [
            Opening(x, 1.4, 2.2, 0.9, panes=2) for x in np.arange(start + 0.5, end - 1.6, 2.0)
        ]
        furnish_room(draft, frame, (start, end), depth)
    draft.wall(frame, inner_wall(length, height, openings))
    for edge in edges:
        draft.wall(frame.moved(edge, 0, np.pi / 2), inner_wall(depth, height, []))
    if back:
        wall = inner_wall(length, height, panes if outside else [])
        draft.wall(frame.moved(0, depth), wall)
    along_wall(draft, frame, length, openings)


def front(draft: FloorDraft, frame: Frame, start: float, end: float) -> list[Opening]:
    """Return the openings of one room toward the corridor, and add its door."""
    rng = draft.rng
    kind = str(rng.choice(["door", "double door", "glass", "niche"], p=[0.55, 0.13, 0.2, 0.12]))
    if kind == "niche":
        wide = min(float(rng.uniform(1.8, 3.0)), end - start - 1.0)
        return [Opening((start + end - wide) / 2, wide, 2.4)]
    wide = 1.6 if kind == "double door" else 0.95
    at = start + 0.5 + float(rng.uniform(0.0, end - start - wide - 1.0))
    draft.door(partial(door_leaf, width=wide), frame, at + wide / 2, 0.65)
    openings = [Opening(at, wide, DOOR_TOP)]
    if kind == "glass":
        low, high = (start + 0.3, at - 0.3) if at - start > end - at - wide else (
            at + wide + 0.3, end - 0.3)  # fmt: skip
        if high - low > 0.8:
            pane = Opening(low, high - low, 2.2, float(rng.choice([0.2, 0.9])),
                           panes=max(1, round((high - low) / 1.1)))  # fmt: skip
            openings.append(pane)
    return sorted(openings, key=lambda each: each.start)


def along_wall(draft: FloorDraft, frame: Frame, length: float, openings: list[Opening]) -> None:
    """Add slots of furniture on the corridor's side of a wall, between its openings."""
    rng = draft.rng
    ends = [1.0, *(end for each in openings for end in (each.start, each.start + each.width)),
            length - 1.0]  # fmt: skip
    for low, high in zip(ends[::2], ends[1::2], strict=True):
        x = low + 0.9
        while x < high - 0.9:
            if rng.random() < 0.45:
                draft.slot("corridor", frame, x, -AT_WALL)
            x += float(rng.uniform(1.8, 3.6))


def side_of_corridor(draft: FloorDraft, frame: Frame, length: float) -> None:
    """Add slots of furniture on the corridor's side of a wall without openings."""
    along_wall(draft, frame, length, [])


def furnish_room(draft: FloorDraft, frame: Frame, ends: tuple[float, float], depth: float) -> None:
    """Add slots of furniture in a room: along its side walls and in its middle."""
    rng = draft.rng
    start, end = ends
    for x, turn in ((start + AT_WALL, np.pi / 2), (end - AT_WALL, -np.pi / 2)):
        for y in np.arange(1.3, depth - 1.2, 2.2):
            if rng.random() < 0.6:
                draft.slot("room wall", frame, x, float(y), turn, (0.6, 0.2))
    middle = (start + end) / 2
    if end - start > 4.2:
        turn = float(rng.choice([0.0, np.pi / 2]))
        draft.slot("office", frame, middle, 0.55 * depth, turn, (1.6, 1.6))
