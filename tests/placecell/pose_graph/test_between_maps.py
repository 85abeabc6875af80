"""Maps of several robots, each in its own frame, bent by the loops between them."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.core.types import Int64
from placecell.localization import Pose
from placecell.localization.registration import register_yaw
from placecell.pose_graph import GraphFrames, PoseGraphParameters, judged
from placecell.pose_graph.between_maps import in_own_frames, initial_poses, united
from placecell.pose_graph.frames import wrapped
from placecell.pose_graph.loops import FoundLoop, GraphMap, links_of
from tests.placecell.pose_graph.graph_builders import (
    drifted,
    frames_of,
    loops_between,
    outliers,
    square_path,
)

PARAMETERS = PoseGraphParameters()
COUNT = 80

PLACES = (
    Pose.of_yaw(0.0, np.zeros(3)),
    Pose.of_yaw(2.5, np.array([900.0, -400.0, 20.0])),
    Pose.of_yaw(-1.0, np.array([-3_000.0, 70.0, -5.0])),
)
"""Pose of each map's frame in the first one's."""


def graph(seed: int, place: Pose) -> GraphMap:
    """Return a map of one lap around the block with drift, in a frame of its own."""
    positions, yaws = square_path(COUNT // 4, 1)
    positions, yaws = drifted(positions, yaws, np.random.default_rng(seed), 0.1, 0.1)
    own = place.inverse()
    frames = frames_of(own.apply(positions), wrapped(yaws + own.yaw))
    return GraphMap(frames, frames.positions.copy(), np.arange(COUNT))


def three_maps(*seen: tuple[int, int]) -> tuple[GraphFrames, Int64, list[FoundLoop]]:
    """Return the captures of three maps, the map of each, and loops between pairs of maps."""
    together, maps = united([graph(seed, place) for seed, place in enumerate(PLACES)])
    positions, yaws = square_path(COUNT // 4, 1)
    every = np.arange(COUNT)
    pairs = [np.column_stack([every + COUNT * one, every + COUNT * other]) for one, other in seen]
    rng = np.random.default_rng(9)
    true = np.tile(positions, (3, 1)), np.tile(yaws, 3)
    loops = [loop for each in pairs for loop in loops_between(each, *true, rng)]
    return together.frames, maps, loops


def test_maps_have_tracks_of_their_own() -> None:
    frames, maps, _ = three_maps()
    assert [len(set(frames.odometry.tracks[maps == number])) for number in range(3)] == [1, 1, 1]
    assert len(set(frames.odometry.tracks.tolist())) == 3


def test_boxes_stay_those_of_their_segments() -> None:
    graphs = [graph(seed, place) for seed, place in enumerate(PLACES)]
    sides = np.arange(2 * COUNT, dtype=np.float64).reshape(COUNT, 2)
    together, _ = united([graphs[0], replace(graphs[1], sides=sides), graphs[2]])
    assert together.sides is not None
    assert np.array_equal(together.sides, np.concatenate([0 * sides, sides, 0 * sides]))
    assert united(graphs)[0].sides is None


@pytest.mark.parametrize("wrong", [0, 80])
def test_loops_place_maps_in_the_first_frame_in_either_direction(wrong: int) -> None:
    frames, maps, loops = three_maps((1, 0), (1, 2))
    loops += outliers(wrong, frames, np.random.default_rng(3))
    poses = initial_poses(frames, maps, links_of(loops, PARAMETERS), PARAMETERS)
    middle = np.array([50.0, 50.0, 0.0])
    for number, place in enumerate(PLACES):
        meters, angle = poses[number].difference(place, place.inverse().apply(middle))
        assert meters < 5.0  # drift
        assert np.degrees(angle) < 6.0


def test_maps_without_loops_between_them_stay_apart() -> None:
    frames, maps, loops = three_maps((1, 2))
    poses = initial_poses(frames, maps, links_of(loops, PARAMETERS), PARAMETERS)
    for number in (0, 1):
        assert np.array_equal(poses[number].matrix, np.eye(4))
    block = PLACES[2].inverse().apply(np.array([50.0, 50.0, 0.0]))
    meters, _ = poses[2].difference(PLACES[1].inverse().after(PLACES[2]), block)
    assert meters < 5.0  # drift


def test_bent_maps_fit_as_a_whole_and_lie_where_they_lay() -> None:
    frames, maps, loops = three_maps((0, 1), (1, 2))
    poses = initial_poses(frames, maps, links_of(loops, PARAMETERS), PARAMETERS)
    placed = [poses[number] for number in maps.tolist()]
    begun = frames.moved(
        np.array([pose.apply(at) for pose, at in zip(placed, frames.positions, strict=True)]),
        wrapped(frames.yaws + np.array([pose.yaw for pose in placed])),
    )
    positions, _ = in_own_frames(judged(begun, loops, PARAMETERS), frames, maps)
    parts = [positions[maps == number] for number in range(3)]
    before = [frames.positions[maps == number] for number in range(3)]
    for number in (1, 2):
        assert misfit(before[number], before[0]) > 1.0
        assert misfit(parts[number], parts[0]) < 0.3
    for now, then in zip(parts, before, strict=True):
        lies = register_yaw(now, then, np.ones(COUNT))
        meters, angle = lies.difference(Pose.of_matrix(np.eye(4)), now.mean(axis=0))
        assert meters < 0.3
        assert np.degrees(angle) < 1.0


def test_map_without_accepted_loops_is_not_moved_at_all() -> None:
    frames, maps, loops = three_maps((0, 1))
    positions, yaws = in_own_frames(judged(frames, loops[:1], PARAMETERS), frames, maps)
    assert np.array_equal(positions, frames.positions)
    assert np.array_equal(yaws, frames.yaws)


def misfit(one: np.ndarray, other: np.ndarray) -> float:
    """Return the root mean square distance in the plane after the best rigid alignment."""
    pose = register_yaw(one, other, np.ones(len(one)))
    return float(np.sqrt(((pose.apply(one) - other)[:, :2] ** 2).sum(axis=1).mean()))
