"""Ray casting with Embree."""

from typing import Protocol

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

from placecell.core.types import Float32, Float64, Int32, UInt16
from town.geometry.mesh import Mesh


class Scene:
    """A mesh, indexed for ray casting."""

    def __init__(self, mesh: Mesh) -> None:
        self.reflectance: Float32 = mesh.reflectance
        self.codes: UInt16 = mesh.labels()
        self._scene = EmbreeScene()
        # The scene borrows the mesh's buffers: both live as long as this object.
        self._mesh = TriangleMesh(self._scene, mesh.triangles.astype(np.float32))

    def cast(self, origins: Float32, directions: Float32) -> tuple[Float32, Int32]:
        """Cast rays and return their first hits.

        Args:
            origins: float32 (n, 3), meters, in the mesh's frame.
            directions: float32 (n, 3), unit vectors.

        Returns:
            Ranges, float32 (n,), meters, infinite without a hit; and indices of the triangles,
            int32 (n,), -1 without a hit.
        """
        hits = self._scene.run(origins, directions, query="INTERSECT", output=1)
        triangles: Int32 = hits["primID"]
        ranges: Float32 = np.where(triangles < 0, np.float32(np.inf), hits["tfar"])
        return ranges, triangles


class Surfaces(Protocol):
    """Surfaces that rays are cast at."""

    @property
    def reflectance(self) -> Float32:
        """Reflectance of each triangle, float32 (n,)."""
        ...

    @property
    def codes(self) -> UInt16:
        """Label of each triangle, uint16 (n,); 0 without a label."""
        ...

    def cast(self, origins: Float32, directions: Float32) -> tuple[Float32, Int32]:
        """Cast rays and return their first hits, see `Scene.cast`."""
        ...


class Layers:
    """Two scenes in one place: a static one, and one that is rebuilt for each scan."""

    def __init__(self, standing: Scene, moving: Scene) -> None:
        self.reflectance = np.concatenate([standing.reflectance, moving.reflectance])
        self.codes = np.concatenate([standing.codes, moving.codes])
        self._standing = standing
        self._moving = moving

    def cast(self, origins: Float32, directions: Float32) -> tuple[Float32, Int32]:
        """Cast rays at both scenes, see `Scene.cast`.

        Indices of the second scene's triangles follow those of the first.
        """
        ranges, triangles = self._standing.cast(origins, directions)
        nearer, moving = self._moving.cast(origins, directions)
        hidden = nearer < ranges
        on = moving + np.int32(len(self._standing.reflectance))
        return np.where(hidden, nearer, ranges), np.where(hidden, on, triangles)


class Scenes(Protocol):
    """Scenes of a town during one drive."""

    def around(self, place: Float64) -> Scene:
        """Return a scene with everything in range of a sensor at a place (2,) of the town frame."""
        ...


class WholeTown:
    """Scene of a town that is small enough for one scene."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def around(self, place: Float64) -> Scene:  # noqa: ARG002
        """Return the scene of the whole town."""
        return self._scene
