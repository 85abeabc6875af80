from dataclasses import replace

import numpy as np
import pytest

from town import HDL_64E, Mesh, Route, Scene, Town
from town.drives.oncoming import NEAR, Oncoming
from town.geometry.scene import Layers
from town.geometry.shapes import box


@pytest.fixture(scope="module")
def route() -> Route:
    town = Town.build(seed=3, streets=(4, 2))
    return Route.through(town.plan, town.terrain, [(0, 0), (1, 0), (2, 0), (3, 0)])


def test_cars_keep_to_the_other_lane(route: Route) -> None:
    cars = Oncoming.draw(route, per_km=60.0, seed=1)
    assert 5 <= len(cars.cars) <= 25
    middle = route.lane()[len(route.lane()) // 2]
    low, high = cars.around(middle, time=0.0).bounds()
    assert high[0] - low[0] <= 2 * NEAR + 6.0
    poses = cars.lane.poses(cars.starts, height=0.0)
    beside = np.linalg.norm(route.lane()[None] - poses[:, None, :2, 3], axis=2).min(axis=1)
    assert beside == pytest.approx(np.full(len(beside), 3.2), abs=0.1)


def test_cars_move_at_their_speed_and_begin_anew(route: Route) -> None:
    one = replace(
        Oncoming.draw(route, per_km=60.0, seed=1),
        cars=(box((-2.0, -1.0, 0.0), (4.0, 2.0, 1.5), 0.5),),
        starts=np.array([10.0]),
        speeds=np.array([8.0]),
    )

    def middle(time: float) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
        (place,) = one.lane.poses(np.array([10.0 + 8.0 * time]) % one.lane.length(), 0.0)[:, :3, 3]
        center = one.around(place[:2], time).bounds().mean(axis=0)
        assert center[:2] == pytest.approx(place[:2], abs=0.3)
        return np.asarray(center)

    assert np.linalg.norm(middle(3.0) - middle(2.0)) == pytest.approx(8.0, abs=0.2)
    lap = one.lane.length() / 8.0
    assert middle(1.0 + lap) == pytest.approx(middle(1.0))


def test_far_cars_are_left_out(route: Route) -> None:
    cars = Oncoming.draw(route, per_km=60.0, seed=1)
    assert len(cars.around(np.array([900.0, 900.0]), 0.0)) == 0
    assert len(Oncoming.draw(route, per_km=0.0, seed=1).around(route.lane()[0], 0.0)) == 0


@pytest.mark.parametrize("per_km", [-1.0, 101.0, np.nan])
def test_impossible_numbers_of_cars_are_refused(route: Route, per_km: float) -> None:
    with pytest.raises(ValueError, match="expected 0 to 100"):
        Oncoming.draw(route, per_km, seed=1)


def test_layers_show_the_nearer(route: Route) -> None:
    wall = box((10.0, -5.0, -5.0), (1.0, 10.0, 10.0), 0.8)
    board = box((5.0, -1.0, -1.0), (0.1, 2.0, 2.0), 0.3)
    behind = box((20.0, -5.0, -5.0), (1.0, 10.0, 10.0), 0.1)
    lidar = replace(HDL_64E, columns=360, range_noise=0.0, dropout=0.0)

    def scan(surfaces: Scene | Layers) -> np.ndarray[tuple[int, int], np.dtype[np.float32]]:
        sweep = np.tile(np.eye(4), (lidar.columns, 1, 1))
        return lidar.scan(surfaces, sweep, np.eye(4), np.random.default_rng(0))

    layers = Layers(Scene(wall), Scene(Mesh.joined([board, behind])))
    points = scan(layers)
    assert np.array_equal(points, scan(Scene(Mesh.joined([wall, board, behind]))))
    assert {round(float(value), 2) for value in points[:, 3]} == {0.8, 0.3}
    assert len(scan(Layers(Scene(wall), Scene(box((0, 0, 500.0), (1, 1, 1), 0.5))))) > 0
