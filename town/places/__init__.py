"""Places beside the streets: campus, garden, indoor floor and car park.

    place, route = build_place("campus", seed=7, meters=200.0)

A place has what `write_drive` needs. Every drive has other movable objects: cars, people, chairs.
"""

from town.places.catalog import INDOOR, PLACES, STREETS, PlaceKind, build_place, kind_of
from town.places.place import Place, Spot

__all__ = ["INDOOR", "PLACES", "STREETS", "Place", "PlaceKind", "Spot", "build_place", "kind_of"]
