"""Labels of the town's objects: the semantic class of each triangle, as codes of SemanticKITTI.

A trunk and its stakes are a pole, the crown is vegetation. A traffic sign is one object with its
post, and a house is a building with everything that is attached to it.
"""

import numpy as np

from placecell.core.types import UInt16
from placecell.datasets.labels import CODES
from town.geometry.mesh import Mesh, Reflectance
from town.objects.block import SceneObject

KINDS: dict[str, tuple[str, ...]] = {
    "building": (
        "house", "garage", "building", "shed", "carport", "wall", "column", "ceiling", "door",
        "partition",
    ),
    "vegetation": ("tree", "hedge", "bush", "undergrowth", "flower bed"),
    "pole": ("lamp post", "light mast", "electric post", "bollards"),
    "vehicle": ("parked car", "trailer", "bicycles"),
    "person": ("person",),
    "fence": ("fence", "garden wall"),
    "sign": ("traffic sign",),
}  # fmt: skip
"""Kinds of objects of each class. All other kinds are `other`."""

CODE_OF_KIND = {kind: CODES[name][0] for name, kinds in KINDS.items() for kind in kinds}

TRUNKS = (Reflectance.BARK, Reflectance.WOOD)
"""Materials of the parts of a tree that are no leaves."""


def labeled(thing: SceneObject) -> Mesh:
    """Return the mesh of an object with the code of each triangle."""
    codes = np.full(len(thing.mesh), CODE_OF_KIND.get(thing.kind, CODES["other"][0]), np.uint16)
    if thing.kind == "tree":
        codes[np.isin(thing.mesh.reflectance, np.array(TRUNKS, np.float32))] = CODES["pole"][1]
    if thing.kind == "flower bed":
        codes[thing.mesh.reflectance == np.float32(Reflectance.WOOD)] = CODES["other"][0]
    return thing.mesh.coded(codes)


def all_of(mesh: Mesh, code: int) -> Mesh:
    """Return a mesh with one code for all triangles."""
    codes: UInt16 = np.full(len(mesh), code, np.uint16)
    return mesh.coded(codes)
