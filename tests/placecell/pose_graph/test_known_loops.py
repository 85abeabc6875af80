"""Loops of an earlier optimization, in a map that grew."""

from dataclasses import replace

import numpy as np

from placecell.pose_graph import GraphFrames
from placecell.pose_graph.frames import CaptureOdometry
from placecell.pose_graph.known_loops import KnownLoops
from placecell.pose_graph.parameters import PoseGraphParameters
from tests.placecell.pose_graph.graph_builders import frames_of, loops_between, square_path

PARAMETERS = PoseGraphParameters()


def two_laps(count: int = 160) -> GraphFrames:
    """Return the first captures of two laps around a square."""
    positions, yaws = square_path(20, 2)
    return frames_of(positions[:count], yaws[:count])


def test_grown_map_has_the_known_loops_and_only_new_captures_to_localize() -> None:
    positions, yaws = square_path(20, 2)
    pairs = np.array([[0, 80], [10, 90], [20, 100]])
    loops = loops_between(pairs, positions, yaws, np.random.default_rng(1))
    known = KnownLoops.of(two_laps(101), np.arange(0, 101, 2), loops)
    order = np.random.default_rng(2).permutation(160)
    grown = two_laps()
    odometry = grown.odometry
    shuffled = GraphFrames(
        grown.times[order],
        grown.positions[order],
        grown.yaws[order],
        CaptureOdometry(
            odometry.tracks, odometry.positions[order], odometry.yaws[order], odometry.variances
        ),
    )
    back = np.argsort(order)
    found, before, left = known.in_map(shuffled, back[np.arange(0, 160, 2)], PARAMETERS)
    assert [(each.one, each.other) for each in found] == [
        (back[one], back[other]) for one, other in pairs
    ]
    assert sorted(before.tolist()) == sorted(back[np.arange(0, 101, 2)].tolist())
    assert sorted(order[left].tolist()) == list(range(102, 160, 2))


def test_capture_beside_a_localized_one_is_not_localized_again() -> None:
    frames = two_laps()
    near = replace(PARAMETERS, every=12.0)
    known = KnownLoops.of(frames, np.array([10]), [])
    _, _, left = known.in_map(frames, np.array([9, 10, 11, 12]), near)
    assert left.tolist() == [12]


def test_loops_of_captures_that_are_gone_are_forgotten() -> None:
    positions, yaws = square_path(20, 2)
    loops = loops_between(np.array([[0, 80]]), positions, yaws, np.random.default_rng(1))
    known = KnownLoops.of(two_laps(), np.array([0, 80]), loops)
    found, before, left = known.in_map(two_laps(50), np.array([0, 20]), PARAMETERS)
    assert found == []
    assert before.tolist() == [0]
    assert left.tolist() == [20]


def test_captures_without_odometry_or_with_the_same_time_are_not_remembered() -> None:
    frames = two_laps(10)
    loose = replace(frames, odometry=replace(frames.odometry, tracks=np.zeros(10, dtype=np.int64)))
    assert not KnownLoops.of(loose, np.arange(10), []).localized
    twice = replace(frames, times=np.zeros(10))
    assert not KnownLoops.of(twice, np.arange(10), []).localized
