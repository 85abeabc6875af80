"""Ray casting with Embree."""

from typing import Protocol

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from placecell.core.types import Float32, Float64, Int32
from town.geometry.mesh import Mesh


class Scene:
    """A mesh, indexed for ray casting."""

    def __init__(self, mesh: Mesh) -> None:
        self.reflectance: Float32 = mesh.reflectance
        self._scene = EmbreeScene()
        # The scene borrows the mesh's buffers: both live as long as this object.
        self._mesh = TriangleMesh(self._scene, mesh.triangles.astype(np.float32))

    def cast(self, origins: Float32, directions: Float32) -> tuple[Float32, Int32]:
        """Where rays first hit.

        Args:
            origins: float32 (n, 3), meters, the mesh's frame.
            directions: float32 (n, 3), unit vectors.

        Returns:
            ranges in meters, float32 (n,), infinite where nothing is hit, and the triangles hit,
            int32 (n,), -1 where nothing is.
        """
        hits = self._scene.run(origins, directions, query="INTERSECT", output=1)
        triangles: Int32 = hits["primID"]
        ranges: Float32 = np.where(triangles < 0, np.float32(np.inf), hits["tfar"])
        return ranges, triangles


class Surfaces(Protocol):
    """What rays are cast at."""

    @property
    def reflectance(self) -> Float32:
        """Of each triangle."""
        ...

    def cast(self, origins: Float32, directions: Float32) -> tuple[Float32, Int32]:
        """Where rays first hit, as `Scene.cast`."""
        ...


class Layers:
    """Two scenes in one place: one that stays, and one that is made anew for each scan."""

    def __init__(self, standing: Scene, moving: Scene) -> None:
        self.reflectance = np.concatenate([standing.reflectance, moving.reflectance])
        self._standing = standing
        self._moving = moving

    def cast(self, origins: Float32, directions: Float32) -> tuple[Float32, Int32]:
        """Where rays first hit either, as `Scene.cast`; the second's triangles are counted on."""
        ranges, triangles = self._standing.cast(origins, directions)
        nearer, moving = self._moving.cast(origins, directions)
        hidden = nearer < ranges
        on = moving + np.int32(len(self._standing.reflectance))
        return np.where(hidden, nearer, ranges), np.where(hidden, on, triangles)


class Scenes(Protocol):
    """A town on one day, for a sensor that drives through it."""

    def around(self, place: Float64) -> Scene:
        """A scene that holds all that a sensor at this place (2,) can reach, town frame."""
        ...


class WholeTown:
    """A town that is small enough for one scene."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def around(self, place: Float64) -> Scene:  # noqa: ARG002
        """The one scene, wherever the sensor is."""
        return self._scene
