"""Objects of the suburb that are no plants: banks, mesh fences, cars with cabins, trailers.

The origin is the middle of the foot (the left end of what is long); z = 0 is the ground.
"""

import numpy as np

from town.geometry.mesh import Mesh, Reflectance
from town.geometry.shapes import box, circle, loft, pole, prism, quads
from town.objects.car import car


def bank(rng: np.random.Generator, length: float, width: float, height: float) -> Mesh:
    """Build a rough grass bank along x, which rises from y = 0 to its crest and falls again.

    Args:
        rng: random number generator.
        length, width: extent along x and y, meters.
        height: height of the crest, meters.
    """
    x = np.linspace(0, length, int(length / 0.5) + 2)
    y = np.linspace(0, width, int(width / 0.35) + 2)
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    across = np.interp(grid_y / width, [0, float(rng.uniform(0.25, 0.6)), 0.8, 1], [0, 1, 0.9, 0])
    ends = np.clip(np.minimum(grid_x, length - grid_x) / 2.0, 0, 1)
    waves = np.sin(grid_x * float(rng.uniform(0.3, 1.2)) + float(rng.uniform(0, 2 * np.pi)))
    rough = rng.normal(scale=0.03, size=grid_x.shape)
    z = height * across * ends * (1 + 0.25 * waves) + rough - 0.03
    near, far = (slice(None, -1), slice(1, None))
    corners = [
        (grid_x[i, j], grid_y[i, j], z[i, j])
        for i, j in ((near, near), (far, near), (far, far), (near, far))
    ]
    return Mesh.of_quads(quads(corners[0], corners[1], corners[2], corners[3]), Reflectance.PAVING)


def mesh_fence(rng: np.random.Generator, length: float) -> Mesh:
    """Build a fence of thin posts and wire mesh, 0.8 to 2 m high."""
    height, step = float(rng.uniform(0.8, 2.0)), float(rng.uniform(1.8, 3.0))
    posts = [
        pole(float(x), 0.0, 0.04, (-0.3, height + 0.05), Reflectance.METAL)
        for x in np.arange(0, length, step)
    ]
    gap, wire = float(rng.uniform(0.1, 0.2)), 0.012
    wires = [
        box((0, -wire, float(z)), (length, wire, wire), Reflectance.METAL)
        for z in np.arange(0.05, height, gap)
    ]
    bars = [
        box((float(x), -wire, 0.05), (wire, wire, height - 0.05), Reflectance.METAL)
        for x in np.arange(0, length, gap)
    ]
    return Mesh.joined([*posts, *wires, *bars])


def used_car(rng: np.random.Generator) -> Mesh:
    """Build a car whose cabin returns rays: pillars, seats, and glass that is not clean."""
    body = car(rng)
    clear = body.reflectance == np.float32(2 * Reflectance.GLASS)
    shades = body.reflectance.copy()
    shades[clear] = np.where(
        rng.random(int(clear.sum())) < 0.75, rng.uniform(0.1, 0.6), Reflectance.GLASS
    )
    low, high = body.bounds()
    seats = [
        box((x, y, 0.5), (0.5, 0.5, float(rng.uniform(0.5, 0.75))), Reflectance.CLOTH)
        for x in (-0.9, 0.1)
        for y in (-0.6, 0.1)
    ]
    whole = Mesh(body.triangles, shades)
    if high[2] > 1.9 or low[2] > 0.5:
        return whole
    return Mesh.joined([whole, *seats])


def trailer(rng: np.random.Generator) -> Mesh:
    """Build a trailer, or a caravan."""
    is_caravan = rng.random() < 0.4
    long = float(rng.uniform(3.8, 5.5) if is_caravan else rng.uniform(1.8, 3.2))
    wide = float(rng.uniform(1.9, 2.2) if is_caravan else rng.uniform(1.1, 1.6))
    high = float(rng.uniform(1.8, 2.1) if is_caravan else rng.uniform(0.4, 1.3))
    outline = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * (long, wide) - (long / 2, wide / 2)
    parts = [
        prism(outline, 0.5, 0.5 + high, Reflectance.METAL, taper=float(rng.uniform(0.85, 1.0))),
        box((long / 2, -0.05, 0.45), (1.2, 0.1, 0.1), Reflectance.METAL),
    ]
    wheel = circle(0.3, 10)
    for y in (-wide / 2 - 0.15, wide / 2):
        rings = [
            np.column_stack([wheel[:, 0], np.full(10, side), wheel[:, 1] + 0.3])
            for side in (y, y + 0.15)
        ]
        parts.append(loft(rings[0], rings[1], Reflectance.RUBBER))
    return Mesh.joined(parts)


def garage(rng: np.random.Generator, width: float, depth: float) -> Mesh:
    """Build a garage with a flat roof. Frame: x along its front, y into it."""
    high, wall = float(rng.uniform(2.3, 2.9)), 0.15
    door = float(rng.uniform(0.05, 0.5))
    shade = float(rng.uniform(0.3, 0.6))
    return Mesh.joined(
        [
            box((0, 0, -0.5), (wall, depth, high + 0.5), shade),
            box((width - wall, 0, -0.5), (wall, depth, high + 0.5), shade),
            box((0, depth - wall, -0.5), (width, wall, high + 0.5), shade),
            box((wall, door, -0.3), (width - 2 * wall, 0.08, high + 0.1), Reflectance.METAL),
            box((-0.2, -0.2, high), (width + 0.4, depth + 0.4, 0.25), Reflectance.ROOF),
        ]
    )


def clutter(rng: np.random.Generator) -> Mesh:
    """Build what stands about: crates, a wood pile, a compost heap or a water butt."""
    parts = []
    for _ in range(int(rng.integers(1, 5))):
        x, y = (float(value) for value in rng.uniform(-0.7, 0.7, size=2))
        high = float(rng.uniform(0.4, 1.5))
        if rng.random() < 0.3:
            outline = circle(float(rng.uniform(0.25, 0.5)), 10) + (x, y)
            parts.append(prism(outline, -0.1, high, Reflectance.RUBBER))
        else:
            size = (*(float(value) for value in rng.uniform(0.3, 1.3, size=2)), high)
            parts.append(box((x, y, -0.1), (size[0], size[1], size[2]), Reflectance.WOOD))
    return Mesh.joined(parts)


def electric_post(rng: np.random.Generator) -> Mesh:
    """Build a wooden or concrete post of a power line, sometimes with a box."""
    radius = float(rng.uniform(0.08, 0.16))
    parts = [pole(0, 0, radius, (-0.3, 8.0), Reflectance.WOOD)]
    if rng.random() < 0.3:
        parts.append(box((-0.2, -0.35, 1.0), (0.4, 0.3, 0.6), Reflectance.METAL))
    return Mesh.joined(parts)
