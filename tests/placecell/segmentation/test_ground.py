import numpy as np
import pytest
from scipy import ndimage

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Bool, Float32
from placecell.segmentation.ground import is_ground, lowest_in_disk
from tests.placecell.segment_builders import box, plane

CAR = (4.4, 1.8, 1.5)
WALL = (12.0, 0.3, 2.5)
LORRY = (11.0, 2.5, 3.8)
TRUNK = (0.4, 0.4, 6.0)
THINGS = {"car": CAR, "wall": WALL, "lorry": LORRY, "tree": TRUNK}


def removed(*clouds: Float32) -> list[Bool]:
    """Return whether each point of each cloud is ground, with all clouds in one map."""
    ground = is_ground(np.concatenate(clouds), PROTOCOL_V1)
    return np.split(ground, np.cumsum([len(cloud) for cloud in clouds])[:-1])


def above(thing: Float32, height: float) -> Bool:
    return thing[:, 2] > height


def test_flat_ground_is_removed() -> None:
    assert is_ground(plane(20), PROTOCOL_V1).all()


@pytest.mark.parametrize("slope", [0.05, 0.15, -0.15])
def test_sloped_ground_is_removed(slope: float) -> None:
    assert is_ground(plane(20, slope=slope), PROTOCOL_V1).all()


@pytest.mark.parametrize("slope", [0.0, 0.15])
@pytest.mark.parametrize("thing", THINGS)
def test_objects_stay_and_the_ground_below_them_is_removed(thing: str, slope: float) -> None:
    x, y = 3.2, -2.1
    cloud = box((x, y, 0.0), THINGS[thing])
    cloud[:, 2] += slope * cloud[:, 0]
    ground, of_thing = removed(plane(20, slope=slope), cloud)

    assert ground.all()
    height = cloud[:, 2] - slope * cloud[:, 0]
    # 0.3 m of clearance, and what a slope of 15% rises within a cell of 0.5 m.
    assert not of_thing[height > 0.3 + 0.5 * slope + 0.01].any()
    assert of_thing[height < 0.15].all()


def test_parked_car_hides_the_ground_below_it() -> None:
    # No returns from below the car, as in a real scan.
    ground = plane(20)
    hidden = (np.abs(ground[:, 0] - 5) < CAR[0] / 2) & (np.abs(ground[:, 1]) < CAR[1] / 2)
    car = box((5.0, 0.0, 0.0), CAR)
    of_ground, of_car = removed(ground[~hidden], car)
    assert of_ground.all()
    assert not of_car[above(car, 0.31)].any()


@pytest.mark.parametrize("sensor_height", [0.5, 1.7, 3.0, -40.0])
def test_sensor_height_makes_no_difference(sensor_height: float) -> None:
    things = [box((2, 3, 0.1), CAR), box((-6, -4, -0.2), TRUNK)]
    scene = np.concatenate([plane(15, slope=0.04), *things])
    # Heights in whole 128ths of a meter: no rounding decides about points at the limit.
    scene[:, 2] = np.round(scene[:, 2] * 128) / 128
    lowered = scene - np.array([0, 0, round(sensor_height * 128) / 128], np.float32)
    assert np.array_equal(is_ground(lowered, PROTOCOL_V1), is_ground(scene, PROTOCOL_V1))


def test_reflection_below_the_ground_does_not_ruin_its_neighborhood() -> None:
    reflection = np.array([[1.3, 2.2, -2.0]], dtype=np.float32)
    car = box((3.5, 2.0, 0.0), CAR)
    of_ground, of_car, of_reflection = removed(plane(20), car, reflection)
    assert of_ground.all()
    assert of_reflection.all()
    assert not of_car[above(car, 0.31)].any()


def test_curb_is_ground() -> None:
    ground = plane(20)
    ground[ground[:, 1] > 4.1, 2] += 0.12
    assert is_ground(ground, PROTOCOL_V1).all()


def test_terrace_wider_than_the_window_is_ground_as_well() -> None:
    ground = plane(25)
    terrace = ground[:, 0] > 0.1
    ground[terrace, 2] += 1.0
    assert is_ground(ground, PROTOCOL_V1).mean() > 0.99


def test_roof_alone_in_the_air_stays() -> None:
    roof = box((0, 0, 4.0), (6.0, 6.0, 0.1), sides=False)
    of_ground, of_roof = removed(plane(20), roof)
    assert of_ground.all()
    assert not of_roof.any()


def test_no_points() -> None:
    assert is_ground(np.zeros((0, 3), np.float32), PROTOCOL_V1).shape == (0,)


@pytest.mark.parametrize("count", [1, 2, 5])
def test_tiny_flat_clouds_are_ground(count: int) -> None:
    cloud = np.array([[0.3 * at, -0.2 * at, 1.0] for at in range(count)], dtype=np.float32)
    assert is_ground(cloud, PROTOCOL_V1).all()


def test_map_narrower_than_the_window() -> None:
    # Some meters of a street, and a post: too small for the reflected border.
    post = box((0.1, 0.1, 0.0), (0.2, 0.2, 2.0))
    of_ground, of_post = removed(plane(3), post)
    assert of_ground.all()
    assert not of_post[above(post, 0.31)].any()


@pytest.mark.parametrize("reach", [0, 1, 5, 15])
def test_minimum_over_runs_is_the_minimum_over_the_disk(reach: int) -> None:
    shape = (2 * reach + 21, 2 * reach + 9)
    heights = np.random.default_rng(0).normal(size=shape).astype(np.float32)
    disk = np.hypot(*np.mgrid[-reach : reach + 1, -reach : reach + 1]) <= reach
    expected = ndimage.grey_erosion(heights, footprint=disk)
    inner = expected[reach : shape[0] - reach, reach : shape[1] - reach]
    np.testing.assert_array_equal(lowest_in_disk(heights, reach), inner)
