"""Triangle meshes of the town, which the rays are cast at."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from placecell.core.types import Float32, Float64, UInt16

UNLABELED = np.zeros(0, dtype=np.uint16)
"""Codes of a mesh whose triangles have no label."""


class Reflectance:
    """Reflectance of materials at the sensor's wavelength, 0 to 1."""

    ASPHALT = 0.15
    PAVING = 0.3
    PLASTER = 0.5
    BRICK = 0.35
    ROOF = 0.25
    GLASS = 0.02
    WOOD = 0.4
    LEAVES = 0.45
    BARK = 0.3
    METAL = 0.5
    RUBBER = 0.08
    CLOTH = 0.4
    SIGN = 0.95


@dataclass(frozen=True, slots=True)
class Mesh:
    """Triangles with corners of their own, so meshes are joined by concatenation.

    Attributes:
        triangles: float64 (n, 3, 3), x, y, z of each corner, meters.
        reflectance: float32 (n,), 0 to 1.
        codes: uint16 (n,), label of each triangle (`placecell.datasets.labels`); empty if the
            triangles have none.
    """

    triangles: Float64
    reflectance: Float32
    codes: UInt16 = field(default_factory=UNLABELED.copy)

    @classmethod
    def of_triangles(cls, triangles: Float64, reflectance: float) -> Self:
        """Build a mesh of triangles (n, 3, 3) with one reflectance."""
        return cls(triangles, np.full(len(triangles), reflectance, dtype=np.float32))

    @classmethod
    def of_quads(cls, quads: Float64, reflectance: float) -> Self:
        """Build a mesh of quadrilaterals (n, 4, 3), corners in order, two triangles each."""
        return cls.of_triangles(quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3, 3), reflectance)

    @classmethod
    def joined(cls, meshes: Iterable["Mesh"]) -> Self:
        """Concatenate several meshes."""
        parts = list(meshes)
        if not parts:
            return cls(np.empty((0, 3, 3)), np.empty(0, dtype=np.float32))
        return cls(
            np.concatenate([part.triangles for part in parts]),
            np.concatenate([part.reflectance for part in parts]),
            np.concatenate([part.labels() for part in parts])
            if any(len(part.codes) for part in parts)
            else UNLABELED,
        )

    def __len__(self) -> int:
        return len(self.triangles)

    def labels(self) -> UInt16:
        """Return the label of each triangle, uint16 (n,); 0 if it has none."""
        return self.codes if len(self.codes) else np.zeros(len(self), dtype=np.uint16)

    def coded(self, codes: UInt16) -> "Mesh":
        """Return the mesh with a label for each triangle, uint16 (n,)."""
        return replace(self, codes=codes)

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0, heading: float = 0.0) -> "Mesh":
        """Rotate about z by `heading` (radians, counterclockwise), then translate (meters)."""
        cosine, sine = np.cos(heading), np.sin(heading)
        turn = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        return Mesh(self.triangles @ turn + (x, y, z), self.reflectance, self.codes)

    def transformed(self, pose: Float64) -> "Mesh":
        """Apply a rigid transform (4, 4)."""
        return Mesh(self.triangles @ pose[:3, :3].T + pose[:3, 3], self.reflectance, self.codes)

    def bounds(self) -> Float64:
        """Return the lowest and the highest x, y, z, (2, 3), meters."""
        corners = self.triangles.reshape(-1, 3)
        return np.stack([corners.min(axis=0), corners.max(axis=0)])
