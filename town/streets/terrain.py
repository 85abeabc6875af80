"""Terrain: the bend of the plan's straight streets and the height of the ground."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh


@dataclass(frozen=True, slots=True)
class Terrain:
    """Sums of plane waves, which are smooth and known everywhere in closed form.

    The plan is a straight grid. `bend` shifts it sideways by a few meters, so that streets curve
    and crossings have different angles. Lengths are in meters; the town frame has z up.

    Attributes:
        bend_waves: (n, 2), wave vectors on the plan, 1/m.
        bend_shifts: (n, 2), shift along x and y at each wave's crest, meters.
        bend_phases: (n,), radians.
        hill_waves: (m, 2), wave vectors in the town frame, 1/m.
        hill_heights: (m,), amplitudes, meters.
        hill_phases: (m,), radians.
    """

    bend_waves: Float64
    bend_shifts: Float64
    bend_phases: Float64
    hill_waves: Float64
    hill_heights: Float64
    hill_phases: Float64

    @classmethod
    def draw(cls, rng: np.random.Generator, slope: float = 0.03) -> Self:
        """Draw a random terrain.

        Args:
            rng: random number generator.
            slope: largest slope of the ground, as rise over run.
        """
        bends, hills = 3, 4
        hill_waves = waves(rng, hills, shortest=140.0, longest=420.0)
        steepness = rng.uniform(0.5, 1.0, size=hills)
        steepness *= slope / steepness.sum()
        return cls(
            bend_waves=waves(rng, bends, shortest=150.0, longest=300.0),
            bend_shifts=rng.uniform(-2.5, 2.5, size=(bends, 2)),
            bend_phases=rng.uniform(0, 2 * np.pi, size=bends),
            hill_waves=hill_waves,
            hill_heights=steepness / np.linalg.norm(hill_waves, axis=1),
            hill_phases=rng.uniform(0, 2 * np.pi, size=hills),
        )

    @classmethod
    def winding(cls, rng: np.random.Generator, slope: float = 0.03) -> Self:
        """Draw a random terrain for a large town, whose streets wind by tens of meters.

        Each wave shifts perpendicular to its direction. Streets are nearly parallel or
        perpendicular to the waves. So a bent street becomes longer and seldom shorter, and its
        objects have room.

        Args:
            rng: random number generator.
            slope: largest slope of the ground, as rise over run.
        """
        hills = cls.draw(rng, slope)
        angles = rng.uniform(-0.1, 0.1, size=4) + np.array([0, 0, np.pi / 2, np.pi / 2])
        lengths = rng.uniform(450.0, 900.0, size=4)
        directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        # Largest rotation of a street by a wave, as a slope: four to nine degrees.
        turns = rng.uniform(0.07, 0.16, size=(4, 1)) * rng.choice([-1.0, 1.0], size=(4, 1))
        across = np.stack([-directions[:, 1], directions[:, 0]], axis=1)
        return replace(
            hills,
            bend_waves=2 * np.pi / lengths[:, None] * directions,
            bend_shifts=turns * lengths[:, None] / (2 * np.pi) * across,
            bend_phases=rng.uniform(0, 2 * np.pi, size=4),
        )

    def bend(self, plan: Float64) -> Float64:
        """Transform places of the plan (..., 2) to the town frame (..., 2)."""
        return plan + np.sin(plan @ self.bend_waves.T + self.bend_phases) @ self.bend_shifts

    def height(self, places: Float64) -> Float64:
        """Return the ground height (carriageway level), (...), at places (..., 2), town frame."""
        waves_there = np.sin(places @ self.hill_waves.T + self.hill_phases)
        return np.asarray(waves_there @ self.hill_heights)

    def normals(self, places: Float64) -> Float64:
        """Return the unit normals of the ground, (..., 3), at places (..., 2), town frame."""
        phases = np.cos(places @ self.hill_waves.T + self.hill_phases)
        slopes = (phases * self.hill_heights) @ self.hill_waves
        normals = np.concatenate([-slopes, np.ones((*slopes.shape[:-1], 1))], axis=-1)
        return np.asarray(normals / np.linalg.norm(normals, axis=-1, keepdims=True))

    def place(self, mesh: Mesh, plan: Float64, heading: float, lift: float = 0.0) -> Mesh:
        """Place an object upright on the ground.

        Args:
            mesh: mesh in the object's frame.
            plan: (2,), position of the object's origin on the plan, meters.
            heading: direction of the object's x axis on the plan, radians. It follows the bend.
            lift: height above the carriageway, meters (such as the curb's height).
        """
        ahead = plan + 0.5 * np.array([np.cos(heading), np.sin(heading)])
        here, there = self.bend(np.stack([plan, ahead]))
        turned = float(np.arctan2(there[1] - here[1], there[0] - here[0]))
        return mesh.moved(here[0], here[1], float(self.height(here)) + lift, turned)


def waves(rng: np.random.Generator, count: int, shortest: float, longest: float) -> Float64:
    """Draw random wave vectors (count, 2), 1/m, of wavelengths between two bounds, meters."""
    lengths = rng.uniform(shortest, longest, size=count)
    angles = rng.uniform(0, 2 * np.pi, size=count)
    directions = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return np.asarray(2 * np.pi / lengths[:, None] * directions)
