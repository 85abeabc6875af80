"""Simple solids and surfaces, the parts of the town's objects.

Every shape is in its object's frame: meters, z up, z = 0 at the ground.
"""

import numpy as np

from placecell.core.types import Float64
from town.geometry.mesh import Mesh

ICOSAHEDRON_FACES = np.array(
    [
        [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11],
        [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6], [7, 1, 8],
        [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9],
        [4, 9, 5], [2, 4, 11], [6, 2, 10], [8, 6, 7], [9, 8, 1],
    ]
)  # fmt: skip


def box(lowest: tuple[float, float, float], size: tuple[float, float, float],
        reflectance: float) -> Mesh:  # fmt: skip
    """Return an upright box, given its lowest corner and its size."""
    x, y, z = lowest
    outline = np.add(np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * size[:2], (x, y))
    return prism(outline, z, z + size[2], reflectance)


def prism(outline: Float64, low: float, high: float, reflectance: float,
          taper: float = 1.0) -> Mesh:  # fmt: skip
    """Return the prism of a convex outline (n, 2) from z = low to z = high.

    Args:
        outline: (n, 2), corners, meters.
        low, high: heights of bottom and top, meters.
        reflectance: reflectance of all faces.
        taper: scale of the top about the outline's center.
    """
    center = outline.mean(axis=0)
    bottom = np.column_stack([outline, np.full(len(outline), low)])
    top = np.column_stack([center + taper * (outline - center), np.full(len(outline), high)])
    return loft(bottom, top, reflectance)


def loft(start: Float64, end: Float64, reflectance: float) -> Mesh:
    """Return the solid between two convex polygons (n, 3) with corresponding corners."""
    sides = np.stack([start, np.roll(start, -1, axis=0), np.roll(end, -1, axis=0), end], axis=1)
    caps = [
        np.stack([np.tile(ring[0], (len(ring) - 2, 1)), ring[1:-1], ring[2:]], axis=1)
        for ring in (start, end)
    ]
    return Mesh.joined(
        [Mesh.of_quads(sides, reflectance)] + [Mesh.of_triangles(cap, reflectance) for cap in caps]
    )


def circle(radius: float, corners: int = 8) -> Float64:
    """Return the corners of a regular polygon about the origin, (corners, 2), meters."""
    angles = 2 * np.pi * np.arange(corners) / corners
    return radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def pole(x: float, y: float, radius: float, span: tuple[float, float], reflectance: float) -> Mesh:
    """Return an upright post at (x, y) between the two heights of `span`."""
    return prism(np.add(circle(radius, corners=6), (x, y)), *span, reflectance)


def blob(
    rng: np.random.Generator,
    center: tuple[float, float, float],
    radii: tuple[float, float, float],
    reflectance: float,
) -> Mesh:
    """Return an ellipsoid of 80 triangles, its corners displaced radially by up to 25%."""
    golden = (1 + np.sqrt(5)) / 2
    rectangle = np.array([[-1, golden, 0], [1, golden, 0], [-1, -golden, 0], [1, -golden, 0]])
    corners = np.concatenate([np.roll(rectangle, turn, axis=1) for turn in (0, 1, 2)])
    a, b, c = corners[ICOSAHEDRON_FACES].transpose(1, 0, 2)
    ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
    faces = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
    triangles = np.concatenate([np.stack(face, axis=1) for face in faces])
    directions = triangles / np.linalg.norm(triangles, axis=2, keepdims=True)
    # Waves displace the surface, not random values per corner: shared corners must stay together.
    waves = rng.normal(scale=1.6, size=(4, 3))
    phases = rng.uniform(0, 2 * np.pi, size=4)
    swelling = 1 + 0.0625 * np.sin(directions @ waves.T * 1.5 + phases).sum(axis=2)
    return Mesh.of_triangles(directions * swelling[..., None] * radii + center, reflectance)


def leaves(
    rng: np.random.Generator,
    center: tuple[float, float, float],
    radii: tuple[float, float, float],
    count: int,
    reflectance: float,
) -> Mesh:
    """Return loose triangles of about 0.3 m in an ellipsoid: foliage that rays can pass."""
    middles = rng.normal(size=(count, 1, 3))
    middles *= rng.uniform(0.5, 1.1, size=(count, 1, 1)) / np.linalg.norm(
        middles, axis=2, keepdims=True
    )
    corners = rng.normal(scale=0.17, size=(count, 3, 3))
    return Mesh.of_triangles(middles * radii + center + corners, reflectance)


def relief(along: Float64, up: Float64, depth: Float64, reflectance: Float64) -> Mesh:
    """Return a wall in the plane y = 0 with protruding and recessed cells.

    Args:
        along: (columns + 1,), x of the cell edges, ascending, meters.
        up: (rows + 1,), z of the cell edges, ascending, meters.
        depth: (columns, rows), protrusion of each cell toward -y, meters; negative for a niche.
        reflectance: (columns, rows), reflectance of each cell.
    """
    left, right = (edge[:, None] + 0 * depth for edge in (along[:-1], along[1:]))
    low, high = (edge[None, :] + 0 * depth for edge in (up[:-1], up[1:]))
    faces = quads((left, -depth, low), (right, -depth, low),
                  (right, -depth, high), (left, -depth, high))  # fmt: skip
    shades = np.repeat(reflectance.ravel(), 2).astype(np.float32)
    parts = [Mesh(Mesh.of_quads(faces, 0.0).triangles, shades)]
    wall = float(reflectance.max())
    for axis in (0, 1):
        # Where two neighbors differ in depth, a strip joins them; the rim is joined to y = 0.
        padded = np.pad(depth, [(1, 1), (0, 0)] if axis == 0 else [(0, 0), (1, 1)])
        first, second = (padded[:-1], padded[1:]) if axis == 0 else (padded[:, :-1], padded[:, 1:])
        columns, rows = np.nonzero(first != second)
        near, far = -first[columns, rows], -second[columns, rows]
        if axis == 0:
            x, z0, z1 = along[columns], up[rows], up[rows + 1]
            strips = quads((x, near, z0), (x, far, z0), (x, far, z1), (x, near, z1))
        else:
            x0, x1, z = along[columns], along[columns + 1], up[rows]
            strips = quads((x0, near, z), (x1, near, z), (x1, far, z), (x0, far, z))
        parts.append(Mesh.of_quads(strips, wall))
    return Mesh.joined(parts)


def quads(*corners: tuple[Float64, Float64, Float64]) -> Float64:
    """Stack four corners, each given as arrays of x, y and z, into (n, 4, 3)."""
    return np.stack([np.stack([c.ravel() for c in corner], axis=1) for corner in corners], axis=1)
