"""Routes of robots, in the right-hand lane of the town's streets."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Self

import numpy as np

from placecell.core.types import Float64
from town.streets.plan import Crossing, StreetPlan
from town.streets.terrain import Terrain

CORNER_RADIUS = 9.0
"""Radius of the center line where a route turns at a crossing, meters."""

STEP = 0.25
"""Distance between the points of a line, meters."""


@dataclass(frozen=True)
class Route:
    """Route along the center lines of streets, at an offset to them.

    Attributes:
        terrain: terrain with the height of the ground.
        center: (n, 2), center line in the direction of travel, town frame, meters.
        lane_offset: offset of the lane to the right, meters; negative for the opposite lane.
    """

    terrain: Terrain
    center: Float64
    lane_offset: float = 1.6

    @classmethod
    def through(
        cls,
        plan: StreetPlan,
        terrain: Terrain,
        crossings: Sequence[Crossing],
        lane_offset: float = 1.6,
    ) -> Self:
        """Build a route over adjacent crossings (column, row).

        Raises:
            ValueError: There are fewer than two crossings, or two that no street joins.
        """
        if len(crossings) < 2:
            raise ValueError("a route needs two crossings or more")
        for (i, j), (k, m) in pairwise(crossings):
            if abs(i - k) + abs(j - m) != 1:
                raise ValueError(f"no street joins the crossings {(i, j)} and {(k, m)} directly")
        return cls.over(plan, terrain, crossings, lane_offset)

    @classmethod
    def over(
        cls,
        plan: StreetPlan,
        terrain: Terrain,
        crossings: Sequence[Crossing],
        lane_offset: float = 1.6,
    ) -> Self:
        """Build a route straight from crossing to crossing, without a check of streets."""
        corners = np.stack([plan.crossing(*crossing) for crossing in crossings])
        return cls(terrain, terrain.bend(rounded(corners)), lane_offset)

    @classmethod
    def wander(
        cls,
        plan: StreetPlan,
        terrain: Terrain,
        length: float,
        seed: int = 0,
        lane_offset: float = 1.6,
    ) -> Self:
        """Draw a random route without U-turns.

        Args:
            plan: street plan.
            terrain: terrain of the town.
            length: smallest length, meters.
            seed: seed of the route.
            lane_offset: offset of the lane to the right of the center line, meters.
        """
        crossings = stroll(plan, length, np.random.default_rng([seed, 2]))
        return cls.through(plan, terrain, crossings, lane_offset)

    def reversed(self) -> Self:
        """Return the route in the opposite direction and lane."""
        return replace(self, center=self.center[::-1])

    def cut(self, start: float, length: float) -> Self:
        """Return a part of the route, given start and length along the center line, meters.

        Raises:
            ValueError: The route is too short.
        """
        traveled = arc_lengths(self.center)
        if start < 0 or start + length > traveled[-1] + STEP:
            raise ValueError(
                f"the route is {traveled[-1]:.1f} m long: too short to cut {length:.1f} m "
                f"from {start:.1f} m on"
            )
        wanted = (traveled >= start) & (traveled <= start + length)
        return replace(self, center=self.center[wanted])

    def lane(self) -> Float64:
        """Line of the lane in the town frame, (n, 2), meters."""
        ahead = np.gradient(self.center, axis=0)
        ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
        right = np.stack([ahead[:, 1], -ahead[:, 0]], axis=1)
        return np.asarray(self.center + self.lane_offset * right)

    def length(self) -> float:
        """Return the length of the lane, meters."""
        return float(self._driven[1][-1])

    @cached_property
    def _driven(self) -> tuple[Float64, Float64, Float64]:
        """Return the lane (n, 2), the arc length of each point (n,) and the heading there (n,)."""
        lane = self.lane()
        direction = np.gradient(lane, axis=0)
        headings = np.unwrap(np.arctan2(direction[:, 1], direction[:, 0]))
        return lane, arc_lengths(lane), headings

    def poses(self, distances: Float64, height: float) -> Float64:
        """Return the sensor poses at distances along the lane.

        Args:
            distances: (n,), distance from the start of the route, meters.
            height: height of the sensor above the carriageway, meters.

        Returns:
            float64 (n, 4, 4), sensor (x ahead, y left, z normal to the slope) to town.
        """
        lane, traveled, headings = self._driven
        heading = np.interp(distances, traveled, headings)
        places = np.stack([np.interp(distances, traveled, lane[:, axis]) for axis in (0, 1)], 1)
        up = self.terrain.normals(places)
        level = np.stack([np.cos(heading), np.sin(heading), np.zeros(len(heading))], axis=1)
        left = np.cross(up, level)
        left /= np.linalg.norm(left, axis=1, keepdims=True)
        poses = np.tile(np.eye(4), (len(heading), 1, 1))
        poses[:, :3, :3] = np.stack([np.cross(left, up), left, up], axis=2)
        poses[:, :2, 3] = places
        poses[:, 2, 3] = self.terrain.height(places)
        poses[:, :3, 3] += height * up
        return poses


def arc_lengths(line: Float64) -> Float64:
    """Return the arc length from a line's start to each of its points (n, 2), (n,), meters."""
    steps = np.linalg.norm(np.diff(line, axis=0), axis=1)
    return np.concatenate([[0.0], np.cumsum(steps)])


def rounded(corners: Float64) -> Float64:
    """Return a line over corners (n, 2) with rounded right angles: points (m, 2) a step apart."""
    points = [corners[0]]
    for before, corner, after in zip(corners[:-2], corners[1:-1], corners[2:], strict=True):
        entry = corner - CORNER_RADIUS * unit(corner - before)
        exit_ = corner + CORNER_RADIUS * unit(after - corner)
        if np.allclose(unit(corner - before), unit(after - corner)):
            continue
        center = entry + exit_ - corner
        angles = np.linspace(0, np.pi / 2, int(CORNER_RADIUS * np.pi / 2 / STEP))[:, None]
        points.extend(
            center + np.cos(angles) * (entry - center) + np.sin(angles) * (exit_ - center)
        )
    line = np.stack([*points, corners[-1]])
    traveled = arc_lengths(line)
    even = np.linspace(0, traveled[-1], int(traveled[-1] / STEP) + 1)
    return np.stack([np.interp(even, traveled, line[:, axis]) for axis in (0, 1)], axis=1)


def unit(vector: Float64) -> Float64:
    """Return the unit vector in the direction of a vector."""
    return np.asarray(vector / np.linalg.norm(vector))


def stroll(plan: StreetPlan, length: float, rng: np.random.Generator) -> list[tuple[int, int]]:
    """Return the crossings of a random walk on the grid of at least this length, meters."""
    columns, rows = len(plan.easts), len(plan.norths)
    here = (int(rng.integers(columns)), int(rng.integers(rows)))
    walk, walked = [here], 0.0
    while walked < length or len(walk) < 2:
        i, j = walk[-1]
        around = [(i + 1, j), (i, j + 1), (i - 1, j), (i, j - 1)]
        ways = [
            (k, m)
            for k, m in around
            if 0 <= k < columns and 0 <= m < rows and (len(walk) < 2 or (k, m) != walk[-2])
        ]
        walk.append(ways[int(rng.integers(len(ways)))])
        street = np.linalg.norm(plan.crossing(*walk[-1]) - plan.crossing(*walk[-2]))
        # A rounded corner is shorter than a right angle; a bend is longer by at most about 4 m.
        walked += float(street) - CORNER_RADIUS * (2 - np.pi / 2)
    return walk
