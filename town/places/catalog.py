"""Catalog of the places: builds a place by its name, with a route through it."""

from collections.abc import Callable
from dataclasses import dataclass

from town.places.campus import campus
from town.places.car_park import car_park
from town.places.garden import garden
from town.places.indoor.floor import DIFFERING, indoor
from town.places.place import Place
from town.places.suburb.plan import suburb
from town.streets.route import Route
from town.town import Town

STREETS = "streets"
"""Name of the default place: the streets of the small town."""

INDOOR = "indoor"
"""Name of the place that has several floors."""

Build = Callable[[int, float], tuple[Town | Place, Route]]
"""Function that builds the place of a seed, with a route of a smallest length, meters."""


@dataclass(frozen=True, slots=True)
class PlaceKind:
    """Kind of place.

    Attributes:
        build: function that builds a place of this kind.
        spacing: usual distance between scans, meters: the speed of a car, a cart or a person.
        sensor_height: usual height of the sensor above the ground, meters.
        headroom: largest height of a sensor that passes everywhere, meters.
    """

    build: Build
    spacing: float
    sensor_height: float
    headroom: float = 3.0


def streets(seed: int, meters: float) -> tuple[Town, Route]:
    """Build the small town and draw a route of this length, meters."""
    town = Town.build(seed)
    route = Route.wander(town.plan, town.terrain, meters + 20.0, seed)
    return town, route.cut(start=10.0, length=meters)


PLACES: dict[str, PlaceKind] = {
    STREETS: PlaceKind(streets, spacing=1.0, sensor_height=1.73),
    "campus": PlaceKind(campus, spacing=0.7, sensor_height=1.5),
    "garden": PlaceKind(garden, spacing=0.4, sensor_height=1.4),
    INDOOR: PlaceKind(indoor, spacing=0.3, sensor_height=1.0, headroom=2.0),
    "car-park": PlaceKind(car_park, spacing=0.7, sensor_height=1.73),
    "suburb": PlaceKind(suburb, spacing=1.0, sensor_height=1.73),
}
"""Places by name."""


def build_place(
    name: str, seed: int, meters: float, floor: int = 0, differing: float = DIFFERING
) -> tuple[Town | Place, Route]:
    """Build a place and a route through it. The same arguments give the same place.

    Args:
        name: name of the place, one of `PLACES`.
        seed: seed of the place and the route.
        meters: smallest length of the route's center line, meters.
        floor: number of the floor; only the place "indoor" has floors above 0.
        differing: share of the furniture that differs between floor 0 and another floor, 0 to 1.

    Returns:
        The place, and the route of the first robot; the second one travels `route.reversed()`.

    Raises:
        ValueError: There is no such place or floor, or the share is out of range.
    """
    kind = kind_of(name)
    if name == INDOOR:
        return indoor(seed, meters, floor, differing)
    if floor:
        raise ValueError(f"Invalid floor {floor}: the place {name!r} has floor 0 only.")
    return kind.build(seed, meters)


def kind_of(name: str) -> PlaceKind:
    """Return the kind of place of a name.

    Raises:
        ValueError: There is no such place.
    """
    if name not in PLACES:
        raise ValueError(f"Invalid place {name!r}: expected one of {', '.join(PLACES)}.")
    return PLACES[name]
