import numpy as np
import pytest
from scipy.spatial import cKDTree

from town import Route, Town
from town.streets.route import arc_lengths


@pytest.fixture(scope="module")
def town() -> Town:
    return Town.build(seed=3, streets=(3, 3))


@pytest.fixture(scope="module")
def route(town: Town) -> Route:
    """Return a route: straight, left, right."""
    return Route.through(town.plan, town.terrain, [(0, 0), (1, 0), (1, 1), (2, 1)])


def headings(route: Route, step: float = 1.0) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    poses = route.poses(np.arange(0, route.length(), step), height=1.73)
    return np.asarray(np.unwrap(np.arctan2(poses[:, 1, 0], poses[:, 0, 0])))


def test_lane_lies_to_the_right_of_the_center_line(route: Route) -> None:
    lane = route.lane()
    ahead = np.gradient(route.center, axis=0)
    to_lane = lane - route.center
    side = ahead[:, 0] * to_lane[:, 1] - ahead[:, 1] * to_lane[:, 0]
    assert (side < 0).all()
    assert np.linalg.norm(to_lane, axis=1) == pytest.approx(1.6)


def test_reversed_drives_the_same_streets_in_the_other_lane(route: Route) -> None:
    back = route.reversed()
    distance, _ = cKDTree(route.lane()).query(back.lane())
    assert distance.max() < 2 * 1.6 + 0.01
    assert distance.min() > 2 * 1.6 - 0.1


def test_reversed_heads_the_other_way(route: Route) -> None:
    there = route.poses(np.arange(5.0, 80.0), 1.73)
    back = route.reversed()
    again = back.poses(np.arange(5.0, back.length() - 5.0), 1.73)
    _, nearest = cKDTree(again[:, :2, 3]).query(there[:, :2, 3])
    cosine = np.einsum("ij,ij->i", there[:, :2, 0], again[nearest, :2, 0])
    assert cosine.max() < -0.95


def test_turns_are_smooth(route: Route) -> None:
    turn_a_meter = np.abs(np.diff(headings(route)))
    # The tightest is the right turn in the right lane.
    assert turn_a_meter.max() < 1.2 / (9.0 - 1.6)
    assert np.ptp(headings(route)) > 1.2  # it does turn


def test_poses_are_rigid_and_keep_their_height(town: Town, route: Route) -> None:
    poses = route.poses(np.arange(0, route.length(), 2.0), height=1.73)
    rotations = poses[:, :3, :3]
    assert rotations @ rotations.transpose(0, 2, 1) == pytest.approx(
        np.tile(np.eye(3), (len(poses), 1, 1)), abs=1e-12
    )
    assert np.linalg.det(rotations) == pytest.approx(1.0)
    above = poses[:, 2, 3] - town.terrain.height(poses[:, :2, 3])
    assert above == pytest.approx(1.73, abs=0.01)
    assert rotations[:, 2, 2].min() > np.cos(np.arctan(0.031))


def test_distances_are_meters_along_the_lane(route: Route) -> None:
    places = route.poses(np.arange(0, route.length(), 1.0), 1.73)[:, :3, 3]
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    assert steps == pytest.approx(1.0, abs=0.01)


def test_cut_takes_the_stretch_asked_for(route: Route) -> None:
    part = route.cut(start=20.0, length=50.0)
    assert arc_lengths(part.center)[-1] == pytest.approx(50.0, abs=0.5)
    assert np.linalg.norm(part.center - route.center[0], axis=1).min() > 15.0
    with pytest.raises(ValueError, match="too short to cut"):
        route.cut(start=20.0, length=route.length())


@pytest.mark.parametrize("seed", range(5))
def test_wander_is_as_long_as_asked(town: Town, seed: int) -> None:
    wandering = Route.wander(town.plan, town.terrain, 300.0, seed=seed)
    assert wandering.length() >= 300.0
    assert np.abs(np.diff(headings(wandering))).max() < 0.2  # no turning on the spot


def test_a_route_needs_streets(town: Town) -> None:
    with pytest.raises(ValueError, match="two crossings"):
        Route.through(town.plan, town.terrain, [(0, 0)])
    with pytest.raises(ValueError, match="no street joins"):
        Route.through(town.plan, town.terrain, [(0, 0), (1, 1)])
