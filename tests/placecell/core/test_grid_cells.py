"""Grid cells find near points at any coordinates."""

import numpy as np
import pytest

from placecell.core.grid_cells import neighboring


@pytest.mark.parametrize("offset", [0.0, 5.0, -3.2e6, 9e7])
@pytest.mark.parametrize("radius", [0.3, 0.5, 10.0])
def test_A1_points_within_the_radius_are_in_neighboring_cells(offset: float, radius: float) -> None:
    random = np.random.default_rng(0)
    points = random.uniform(-3, 3, (200, 3)) * radius + offset
    points[100:] = points[:100] + random.choice([-radius, 0, radius], (100, 3)) * (1, 0, 0)
    cells, around = neighboring(points, radius)
    for point in range(200):
        near = np.flatnonzero(np.linalg.norm(points - points[point], axis=1) <= radius)
        assert set(cells[near].tolist()) <= set(around[cells[point]].tolist())


def test_A1_cells_far_away_are_not_neighbors() -> None:
    points = np.arange(3_000.0).reshape(-1, 3) * 10
    cells, around = neighboring(points, 1.0)
    assert len(set(cells.tolist())) == 1_000
    assert (around[:, 0] == np.arange(1_000)).all()
    assert (around[:, 1:] == -1).all()


def test_A1_cells_of_a_column_are_neighbors() -> None:
    points = np.column_stack([np.zeros((10, 2)), np.arange(-5.0, 5.0) + 0.5])
    cells, around = neighboring(points, 1.0)
    assert sorted((around[cells] >= 0).sum(axis=1).tolist()) == [2, 2, *[3] * 8]


def test_A1_no_points() -> None:
    cells, around = neighboring(np.zeros((0, 3)), 1.0)
    assert cells.shape == (0,)
    assert around.shape == (0, 27)
