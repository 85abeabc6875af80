"""Trees, hedges and bushes: irregular shapes that let part of the rays pass.

The origin is the middle of the foot (the left end of a hedge); z = 0 is the ground.
"""

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import blob, circle, leaves, loft, pole


def tree(rng: np.random.Generator) -> Mesh:
    """Build a street tree, 4 to 11 m high, with a leaning, sometimes forked trunk and a crown."""
    height = float(rng.uniform(4.0, 11.0))
    radius = 0.06 + 0.022 * height * float(rng.uniform(0.7, 1.3))
    fork = float(rng.uniform(0.25, 0.4)) * height
    lean = rng.uniform(-0.04, 0.04, size=2) * height
    foot = np.column_stack([circle(radius), np.full(8, -0.5)])
    top = np.column_stack([0.7 * circle(radius) + lean, np.full(8, fork + 0.5)])
    parts = [loft(foot, top, Reflectance.BARK)]
    spread = float(rng.uniform(0.16, 0.28)) * height
    for _ in range(int(rng.integers(4, 8))):
        offset = rng.uniform(-0.6, 0.6, size=2) * spread + lean
        middle = (
            float(offset[0]),
            float(offset[1]),
            float(rng.uniform(fork + 0.35 * spread, height - 0.5 * spread)),
        )
        radii = rng.uniform(0.45, 0.8, size=3) * spread
        outer = (float(radii[0]), float(radii[1]), float(radii[2]))
        # The core is opaque, like the inside of a crown; the leaves make its surface irregular.
        core = (0.55 * outer[0], 0.55 * outer[1], 0.55 * outer[2])
        parts.append(blob(rng, middle, core, Reflectance.LEAVES))
        parts.append(leaves(rng, middle, outer, 60, Reflectance.LEAVES))
        branch = np.array([[0.05, 0], [-0.03, 0.05], [-0.03, -0.05]])
        start = np.column_stack([branch + lean, np.full(3, fork)])
        end = np.column_stack([branch + offset, np.full(3, middle[2])])
        parts.append(loft(start, end, Reflectance.BARK))
    if rng.random() < 0.3:
        for x, y in ((-0.6, 0.0), (0.6, 0.0)):
            parts.append(pole(x, y, 0.05, (-0.3, 1.8), Reflectance.WOOD))
    return Mesh.joined(parts)


def hedge(rng: np.random.Generator, length: float) -> Mesh:
    """Build a hedge along x from a row of overlapping clumps of similar height."""
    height, thickness = float(rng.uniform(0.9, 2.0)), float(rng.uniform(0.35, 0.6))
    parts = []
    x = 0.4
    while x < length - 0.3:
        tall = height * float(rng.uniform(0.85, 1.1))
        radii = (float(rng.uniform(0.5, 0.8)), thickness * float(rng.uniform(0.8, 1.2)), tall * 0.6)
        middle = (x, float(rng.uniform(-0.1, 0.1)), tall * 0.45)
        parts.append(blob(rng, middle, radii, Reflectance.LEAVES))
        parts.append(leaves(rng, middle, radii, 12, Reflectance.LEAVES))
        x += float(rng.uniform(0.5, 0.9))
    return Mesh.joined(parts)


def bush(rng: np.random.Generator) -> Mesh:
    """Build a bush of one to four clumps, up to about 2 m high."""
    parts = []
    for _ in range(int(rng.integers(1, 5))):
        offset = rng.uniform(-0.6, 0.6, size=2)
        radii = rng.uniform(0.35, 0.9, size=3)
        middle = (float(offset[0]), float(offset[1]), float(radii[2]) * 0.8)
        outer = (float(radii[0]), float(radii[1]), float(radii[2]))
        parts.append(blob(rng, middle, outer, Reflectance.LEAVES))
        parts.append(leaves(rng, middle, outer, 20, Reflectance.LEAVES))
    return Mesh.joined(parts)
