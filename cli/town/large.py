"""Large towns: parses --route and draws pairs of stretches."""

import re
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from town import City, Route
    from town.streets.planner import Way


def planned(city: "City", text: str) -> "Way":
    """Plan the route that `--route` names.

    Raises:
        ValueError: the text is not a valid route.
    """
    rng = np.random.default_rng([city.seed, 11])
    number = r"(\d+(?:\.\d*)?)"
    if text == "all":
        return city.planner.every_street()
    if match := re.fullmatch(f"wander:{number}", text):
        return city.planner.wander(float(match[1]), rng)
    if match := re.fullmatch(rf"loop:{number}(?::(\d+))?", text):
        return city.planner.loop(float(match[1]), rng, int(match[2] or 1))
    if match := re.fullmatch(r"(\d+),(\d+):(\d+),(\d+)", text):
        a, b, c, d = (int(part) for part in match.groups())
        return city.planner.between((a, b), (c, d))
    raise ValueError(
        f"Invalid --route {text!r}: expected all, wander:METERS, loop:METERS, loop:METERS:LAPS or "
        "C,R:C,R."
    )


def pairs_of(
    city: "City",
    route: "Route",
    scans: int | None,
    spacing: float,
    start: float,
    count: int,
    meters: float,
    height: float,
) -> dict[str, Any]:
    """Draw pairs of stretches from the first two robots' drives along a route."""
    from town import Traversal, draw_pairs, way_of

    ways = [way_of(number, route, scans, spacing, start) for number in (0, 1)]
    a, b = (Traversal.of(*way, spacing, height) for way in ways)
    overlapping, apart = draw_pairs(city, a, b, count, meters, city.seed)
    return {
        "seed": city.seed,
        "street_metres": round(city.network.meters(), 1),
        "metres": meters,
        "drives": ["robot_a", "robot_b"],
        "overlapping": [pair.as_dict() for pair in overlapping],
        "apart": [pair.as_dict() for pair in apart],
    }
