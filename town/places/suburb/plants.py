"""Plants of the suburb: crowns without a smooth core, grown hedges, undergrowth and ivy.

The origin is the middle of the foot (the left end of what is long); z = 0 is the ground.
"""

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import circle, loft

LEAF = (0.05, 0.13)
"""Smallest and largest standard deviation of a leaf's corners, meters."""


def foliage(rng: np.random.Generator, places: Float64) -> Mesh:
    """Return a small loose triangle at each of the places (n, 3)."""
    size = rng.uniform(*LEAF)
    corners = rng.normal(scale=size, size=(len(places), 3, 3))
    return Mesh.of_triangles(places[:, None] + corners, Reflectance.LEAVES)


def clump(
    rng: np.random.Generator, center: tuple[float, float, float], radii: Float64, count: int
) -> Mesh:
    """Return leaves in an ellipsoid, denser at its surface. Rays pass between them."""
    ways = rng.normal(size=(count, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    depths = 1 - 0.6 * rng.random((count, 1)) ** 1.5
    return foliage(rng, np.asarray(center + ways * depths * radii))


def old_tree(rng: np.random.Generator) -> Mesh:
    """Build a tree with a wide crown of loose leaves that hangs down to 1.6 to 4 m."""
    height, low = float(rng.uniform(6.0, 14.0)), float(rng.uniform(1.6, 4.0))
    radius = float(rng.uniform(0.1, 0.35))
    lean = rng.uniform(-0.06, 0.06, size=2) * height
    parts = []
    stems = 1 if rng.random() < 0.7 else int(rng.integers(2, 5))
    for _ in range(stems):
        shift = rng.uniform(-0.35, 0.35, size=2) if stems > 1 else np.zeros(2)
        thick = radius if stems == 1 else 0.5 * radius
        foot = np.column_stack([circle(1.2 * thick) + shift, np.full(8, -0.5)])
        knee = np.column_stack([circle(0.9 * thick) + 1.4 * shift + 0.3 * lean, np.full(8, low)])
        top = np.column_stack([circle(0.5 * thick) + 2.5 * shift + lean, np.full(8, 0.7 * height)])
        parts += [loft(foot, knee, Reflectance.BARK), loft(knee, top, Reflectance.BARK)]
    spread = float(rng.uniform(1.2, 3.6))
    for _ in range(int(rng.integers(7, 14))):
        ways = rng.normal(size=2)
        offset = lean + ways / np.linalg.norm(ways) * spread * np.sqrt(rng.random())
        size = rng.uniform(0.5, 1.3, size=3) * (0.4 + 0.25 * spread)
        z = float(rng.uniform(low + 0.6 * size[2], max(height, low + 2.0)))
        parts.append(clump(rng, (float(offset[0]), float(offset[1]), z), size, 170))
    for _ in range(int(rng.integers(2, 7))):
        angle, reach = rng.uniform(0, 2 * np.pi), float(rng.uniform(0.5, 1.0)) * spread
        end = lean + reach * np.array([np.cos(angle), np.sin(angle)])
        twig = np.array([[0.04, 0.0], [-0.03, 0.03], [-0.03, -0.03]])
        rise = low + float(rng.uniform(0.2, 2.0))
        parts.append(loft(np.column_stack([twig + 0.5 * lean, np.full(3, low)]),
                          np.column_stack([twig + end, np.full(3, rise)]),
                          Reflectance.BARK))  # fmt: skip
    return Mesh.joined(parts)


def conifer(rng: np.random.Generator) -> Mesh:
    """Build a conifer: a cone of leaves that begins near the ground."""
    height, radius = float(rng.uniform(2.5, 10.0)), float(rng.uniform(0.7, 2.2))
    low = float(rng.choice([0.1, 0.4, 1.2]))
    count = int(350 * radius)
    up = 1 - np.sqrt(rng.random(count))
    angles = rng.uniform(0, 2 * np.pi, count)
    outs = radius * (1 - up) * (1 - 0.5 * rng.random(count) ** 2) * (1 + 0.25 * np.sin(9 * up))
    places = np.column_stack([outs * np.cos(angles), outs * np.sin(angles), low + up * height])
    trunk = [np.column_stack([circle(0.12), np.full(8, z)]) for z in (-0.5, 0.8 * height)]
    return Mesh.joined([foliage(rng, places), loft(trunk[0], trunk[1], Reflectance.BARK)])


def undergrowth(rng: np.random.Generator) -> Mesh:
    """Build tall grass, nettles or brambles: a low irregular heap of leaves."""
    parts = []
    for _ in range(int(rng.integers(2, 6))):
        x, y = rng.uniform(-1.0, 1.0, size=2)
        radii = np.array([*rng.uniform(0.4, 1.0, size=2), rng.uniform(0.25, 0.8)])
        parts.append(clump(rng, (float(x), float(y), 0.4 * float(radii[2])), radii, 100))
    return Mesh.joined(parts)


def shrub(rng: np.random.Generator) -> Mesh:
    """Build a tall shrub of loose leaves, 1 to 4 m high."""
    height, parts = float(rng.uniform(1.0, 4.0)), []
    for _ in range(int(rng.integers(3, 9))):
        z = float(rng.uniform(0.3, max(0.4, height - 0.4)))
        x, y = rng.normal(scale=0.3 + 0.12 * height, size=2)
        radii = rng.uniform(0.35, 0.9, size=3)
        parts.append(clump(rng, (float(x), float(y), z), radii, 130))
    return Mesh.joined(parts)


def grown_hedge(rng: np.random.Generator, length: float) -> Mesh:
    """Build a hedge along x: flat where it is cut, ragged where it is not."""
    height, thick = float(rng.uniform(0.8, 3.0)), float(rng.uniform(0.3, 0.8))
    ragged = float(rng.choice([0.04, 0.12, 0.3]))
    waves, phases = rng.uniform(0.4, 3.0, size=4), rng.uniform(0, 2 * np.pi, size=4)
    count = int(length * (height + thick) * 90)
    x = rng.uniform(0, length, count)
    swelling = np.sin(np.outer(x, waves) + phases).sum(axis=1) / 4
    top, half = height + 2 * ragged * swelling, thick + ragged * swelling
    is_top = rng.random(count) < thick / (height + thick)
    side = rng.choice([-1.0, 1.0], count)
    y = np.where(is_top, rng.uniform(-1, 1, count) * half, side * half)
    z = np.where(is_top, top, rng.random(count) * top)
    places = np.column_stack([x, y, z]) + rng.normal(scale=0.5 * ragged, size=(count, 3))
    return foliage(rng, places)


def climbing(rng: np.random.Generator, length: float, height: float) -> Mesh:
    """Build leaves that grow through a fence along x, in patches."""
    parts, x = [], float(rng.uniform(0, 2.0))
    while x < length:
        radii = np.array([rng.uniform(0.3, 1.2), rng.uniform(0.1, 0.35), rng.uniform(0.3, 0.8)])
        z = float(rng.uniform(0.2, 1.0)) * height
        parts.append(clump(rng, (x, float(rng.uniform(-0.2, 0.3)), z), radii, 60))
        x += float(rng.uniform(0.4, 2.5))
    return Mesh.joined(parts)
