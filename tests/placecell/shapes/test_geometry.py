"""Points and surfaces of decoded grids, by hand."""

import numpy as np

from placecell.shapes.decoder import Shapes, turned
from placecell.shapes.geometry import mesh_of, points_of


def shapes(occupied: list[tuple[int, int, int]], bearing: float = 0.0) -> Shapes:
    grid = np.zeros((1, 4, 4, 2), bool)
    for cell in occupied:
        grid[(0, *cell)] = True
    return Shapes(grid, np.array([[10.0, 20.0, 5.0]]), np.array([bearing]), 0.2)


def test_points_are_the_centers_of_voxels_turned_toward_the_sensor() -> None:
    points, owners = points_of(shapes([(2, 2, 1), (3, 2, 1)]))
    assert np.allclose(points, [[10.1, 20.1, 5.1], [10.3, 20.1, 5.1]])
    assert owners.tolist() == [0, 0]
    # The sensor lies to the north: the grid's x axis points there.
    points, _ = points_of(shapes([(3, 2, 1)], bearing=np.pi / 2))
    assert np.allclose(points, [[9.9, 20.3, 5.1]], atol=1e-6)


def test_surface_of_one_voxel_is_a_cube_and_of_two_has_no_wall_between() -> None:
    corners, triangles = mesh_of(shapes([(0, 0, 0)]), 0)
    assert len(corners) == 8
    assert len(triangles) == 12
    _, triangles = mesh_of(shapes([(0, 0, 0), (1, 0, 0)]), 0)
    assert len(triangles) == 20


def test_surface_points_outward() -> None:
    corners, triangles = mesh_of(shapes([(1, 1, 1)], bearing=0.7), 0)
    middle = corners.mean(axis=0)
    a, b, c = (corners[triangles[:, index]] for index in range(3))
    outward = np.einsum("ij,ij->i", np.cross(b - a, c - a), (a + b + c) / 3 - middle)
    assert (outward > 0).all()


def test_vectors_turn_about_z() -> None:
    found = turned(np.array([[1.0, 0, 2], [0, 1, 0]]), np.array([np.pi / 2, np.pi]))
    assert np.allclose(found, [[0, 1, 2], [0, -1, 0]])
