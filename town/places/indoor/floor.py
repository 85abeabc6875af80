"""Indoor floor: rooms along corridors, and halls with racks, bookcases, machines or tables.

Floors of one building have the same walls. Furniture differs in part, and what people move differs
for every floor and every drive.
"""

from itertools import pairwise, product

import numpy as np

from town.objects.car import person
from town.objects.interior import (
    carton_stack,
    chair,
    hand_cart,
    pallet,
    pallet_truck,
    waste_bins,
)
from town.places.builder import Builder
from town.places.indoor.draft import FloorDraft
from town.places.indoor.plan import FloorPlan
from town.places.indoor.rooms import row_of_rooms, side_of_corridor
from town.places.indoor.walls import GATE_TOP, Frame, Opening, inner_wall
from town.places.place import Place
from town.streets.route import Route
from town.streets.terrain import Terrain

DIFFERING = 0.3
"""Default share of the furniture that differs between two floors."""

FREE = 0.95
"""Half of the width of the free ground along a robot's way, meters."""

GATE_WIDTH = 3.0
"""Width of a gate of a hall, meters."""


def indoor(
    seed: int, meters: float, floor: int = 0, differing: float = DIFFERING
) -> tuple[Place, Route]:
    """Build a floor of a building and draw a route of at least this length through it.

    Args:
        seed: seed of the building and of the route, which all floors share.
        meters: smallest length of the route, meters.
        floor: number of the floor.
        differing: share of the furniture that differs from that of floor 0, 0 to 1.

    Raises:
        ValueError: `floor` is negative, or `differing` is out of range.
    """
    if floor < 0 or not 0 <= differing <= 1:
        raise ValueError(
            f"Invalid floor {floor} or share {differing} of differing furniture: expected a floor "
            "from 0 and a share of 0 to 1."
        )
    rng = np.random.default_rng([seed, 28])
    terrain = Terrain.draw(rng, slope=0.0)
    plan = FloorPlan.draw(rng)
    paths = plan.walkways()
    builder = Builder(seed, terrain, rng)
    builder.take(paths.points(), FREE)
    draft = FloorDraft(builder)
    add_blocks(draft, plan)
    add_outer_rooms(draft, plan)
    add_portals(draft, plan)
    add_ceilings(draft, plan)
    add_loose(draft, plan)
    draft.furnish(seed, floor, differing)
    low, high = plan.inner()
    area = (float(low[0]), float(low[1]), float(high[0]), float(high[1]))
    line = paths.wander(meters, np.random.default_rng([seed, 31]), radius=1.6)
    ground = builder.open_ground(area, margin=plan.depth + 2.0)
    return builder.place(ground, floor), Route(terrain, line, lane_offset=0.4)


def add_blocks(draft: FloorDraft, plan: FloorPlan) -> None:
    """Add the rooms and halls between the corridors."""
    for (i, j), kind in plan.blocks.items():
        low, high = plan.block(i, j)
        width, depth = (high - low).tolist()
        south = Frame(float(low[0]), float(low[1]), 0.0)
        north = Frame(float(high[0]), float(high[1]), np.pi)
        if kind == "rooms":
            row_of_rooms(draft, south, width, depth / 2, plan.height, back=True)
            row_of_rooms(draft, north, width, depth / 2, plan.height, back=False)
        else:
            add_hall(draft, plan, (i, j), kind)
        for side in (south.moved(width, 0, np.pi / 2), north.moved(width, 0, np.pi / 2)):
            side_of_corridor(draft, side, depth)


def add_hall(draft: FloorDraft, plan: FloorPlan, block: tuple[int, int], kind: str) -> None:
    """Add a hall: walls with gates in the south and north, columns, furniture, and a ceiling."""
    rng = draft.rng
    low, high = plan.block(*block)
    width, depth = (high - low).tolist()
    height = float(rng.uniform(4.2, 6.0)) if kind in ("warehouse", "workshop") else plan.height
    gate = plan.gates[block] - float(low[0])
    south = Frame(float(low[0]), float(low[1]), 0.0)
    for frame, at in ((south, gate), (south.moved(width, depth, np.pi), width - gate)):
        openings = [Opening(at - GATE_WIDTH / 2, GATE_WIDTH, GATE_TOP)]
        if kind in ("office", "lobby", "library"):
            openings = windows(rng, width, openings[0])
        draft.wall(frame, inner_wall(width, height, openings))
    for frame in (south.moved(width, 0, np.pi / 2), south.moved(0, depth, -np.pi / 2)):
        draft.wall(frame, inner_wall(depth, height, []))
    for x in np.arange(2.5, width - 1.5, float(rng.uniform(5.0, 7.5))):
        for y in (0.33 * depth, 0.67 * depth):
            draft.column(*south.at(float(x), y), float(rng.uniform(0.35, 0.6)), height)
    if kind in ("warehouse", "library"):
        add_shelves(draft, south, (width, depth), gate, kind)
    else:
        step = float(rng.uniform(2.8, 3.6))
        for x, y in product(np.arange(1.8, width - 1.4, step), np.arange(2.2, depth - 1.8, step)):
            place = (float(x + rng.uniform(-0.3, 0.3)), float(y + rng.uniform(-0.3, 0.3)))
            turn = float(rng.choice([0.0, np.pi / 2, np.pi, -np.pi / 2]))
            if rng.random() < 0.8:
                draft.slot(kind, south, *place, turn, (1.6, 1.6))
    movables = (
        (pallet, pallet_truck, carton_stack, hand_cart)
        if kind in ("warehouse", "workshop")
        else (chair, chair, waste_bins, hand_cart)
    )
    area = (float(low[0]) + 0.8, float(low[1]) + 0.8, float(high[0]) - 0.8, float(high[1]) - 0.8)
    for make in movables:
        draft.builder.sprinkle(make.__name__.replace("_", " "), make, 3, 0.6, area)
    draft.builder.sprinkle("person", person, 4, 0.35, area)
    draft.ceiling(low, high, height)


def add_shelves(
    draft: FloorDraft, frame: Frame, size: tuple[float, float], gate: float, kind: str
) -> None:
    """Add rows of racks or bookcases along the way through a hall.

    Args:
        draft: draft of the floor.
        frame: frame of the hall's south wall.
        size: width and depth of the hall, meters.
        gate: x of the gate, meters.
        kind: kind of the hall.
    """
    rng = draft.rng
    width, depth = size
    group, thick, aisle = ("rack", 1.0, 2.6) if kind == "warehouse" else ("bookcase", 0.6, 1.7)
    height = float(rng.uniform(3.0, 4.0) if group == "rack" else rng.uniform(1.6, 2.2))
    runs = max(1, round((depth - 4.4) / 5.0))
    run = (depth - 4.4 - 1.6 * (runs - 1)) / runs
    for side in (-1.0, 1.0):
        x = gate + side * (FREE + 0.7 + thick / 2)
        while 0.8 + thick / 2 < x < width - 0.8 - thick / 2:
            for number in range(runs):
                y = 2.2 + number * (run + 1.6) + run / 2
                length = run * float(rng.uniform(0.7, 1.0))
                draft.slot(
                    group, frame, x, y, np.pi / 2, (length - 0.4, thick - 0.4), (length, height)
                )
            x += side * (thick + aisle)


def windows(rng: np.random.Generator, width: float, gate: Opening) -> list[Opening]:
    """Return the openings of a wall with windows on both sides of its gate."""
    openings = [gate]
    for start, end in ((0.6, gate.start - 0.8), (gate.start + gate.width + 0.8, width - 0.6)):
        x = start
        while x + 1.4 < end:
            wide = min(float(rng.uniform(1.2, 3.0)), end - x)
            openings.append(Opening(x, wide, 2.2, 0.9, panes=max(1, round(wide / 0.9))))
            x += wide + float(rng.uniform(0.4, 1.5))
    return sorted(openings, key=lambda each: each.start)


def add_outer_rooms(draft: FloorDraft, plan: FloorPlan) -> None:
    """Add the rooms between the outer corridors and the outer walls."""
    low, high = plan.inner()
    width, depth = (high - low).tolist()
    south = Frame(float(low[0]), float(low[1]), 0.0)
    for frame, length in (
        (south.moved(width, 0, np.pi), width),
        (south.moved(width, depth, -np.pi / 2), depth),
        (south.moved(0, depth, 0), width),
        (south.moved(0, 0, np.pi / 2), depth),
    ):
        row_of_rooms(draft, frame, length, plan.depth, plan.height, back=True, outside=True)


def add_portals(draft: FloorDraft, plan: FloorPlan) -> None:
    """Add fire doors, which stand open, where a corridor meets a crossing."""
    rng = draft.rng
    for i, j in product(range(len(plan.spans_x)), range(len(plan.spans_y))):
        (west, east), (south, north) = plan.spans_x[i], plan.spans_y[j]
        sides = [
            (i > 0, Frame(float(west) - 0.35, float(south), np.pi / 2), north - south),
            (j > 0, Frame(float(west), float(south) - 0.35, 0.0), east - west),
        ]
        for inside, frame, across in sides:
            if inside and rng.random() < 0.45:
                wide = float(rng.uniform(2.2, min(2.9, across - 0.4)))
                opening = Opening(float(across - wide) / 2, wide, DOOR_CLEARANCE)
                draft.wall(frame, inner_wall(float(across), plan.height, [opening]))


DOOR_CLEARANCE = 2.3
"""Height of a fire door, meters."""


def add_ceilings(draft: FloorDraft, plan: FloorPlan) -> None:
    """Add the ceilings of corridors and rooms; halls have their own."""
    low, high = plan.inner()
    xs = [float(low[0]) - plan.depth, *plan.spans_x.ravel(), float(high[0]) + plan.depth]
    ys = [float(low[1]) - plan.depth, *plan.spans_y.ravel(), float(high[1]) + plan.depth]
    for (i, (west, east)), (j, (south, north)) in product(
        enumerate(pairwise(xs)), enumerate(pairwise(ys))
    ):
        # Even intervals are blocks, from the outer rooms on; odd ones are corridors.
        block = (i // 2 - 1, j // 2 - 1)
        hall = i % 2 == 0 and j % 2 == 0 and plan.blocks.get(block, "rooms") != "rooms"
        if not hall:
            draft.ceiling(np.array([west, south]), np.array([east, north]), plan.height)


def add_loose(draft: FloorDraft, plan: FloorPlan) -> None:
    """Add spots of people, carts, cartons and chairs along the walls of the corridors."""
    rng = draft.rng
    low, high = plan.inner()
    lines = [
        (Frame(float(low[0]), float(y), 0.0), float(high[0] - low[0]), (north - south) / 2)
        for (south, north), y in zip(plan.spans_y, plan.spans_y.mean(axis=1), strict=True)
    ]
    lines += [
        (Frame(float(x), float(low[1]), np.pi / 2), float(high[1] - low[1]), (east - west) / 2)
        for (west, east), x in zip(plan.spans_x, plan.spans_x.mean(axis=1), strict=True)
    ]
    makers = (person, person, hand_cart, carton_stack, chair)
    for frame, length, half in lines:
        for x in np.arange(2.0, length - 2.0, 1.5):
            make = makers[int(rng.integers(len(makers)))]
            side = float(rng.choice([-1.0, 1.0]))
            turn = 0.0 if make is hand_cart else float(rng.uniform(0, 2 * np.pi))
            if rng.random() < 0.5:
                kind = make.__name__.replace("_", " ")
                draft.spot(
                    kind, make, frame, float(x), side * (float(half) - 0.42), 0.28, 0.3, turn
                )
