"""Judgment of loops, and properties of the optimization as a whole."""

import numpy as np
import pytest

from placecell.pose_graph import FoundLoop, GraphFrames, judged
from placecell.pose_graph.frames import CaptureOdometry, composed, relative, rotated
from tests.placecell.pose_graph.graph_builders import (
    drifted,
    error,
    frames_of,
    joined,
    loops_between,
    outliers,
    square_path,
)

SIDE = 25


def drifting_square(seed: int) -> tuple[GraphFrames, GraphFrames, list[FoundLoop]]:
    """Return the true captures of two laps, those of the odometry, and a loop at each capture."""
    rng = np.random.default_rng(seed)
    positions, yaws = square_path(SIDE, 2)
    frames = frames_of(*drifted(positions, yaws, rng, 0.05, 0.1))
    pairs = np.column_stack([np.arange(100), np.arange(100) + 100])
    return frames_of(positions, yaws), frames, loops_between(pairs, positions, yaws, rng)


def test_loops_remove_the_drift_of_the_second_lap() -> None:
    true, frames, loops = drifting_square(1)
    bent = judged(frames, loops)
    assert bent.accepted == 100
    assert bent.after < 0.2 < bent.before
    assert set(bent.parts.tolist()) == {0}
    second = slice(100, 200)
    apart = bent.positions[second] - bent.positions[:100]
    assert np.linalg.norm(apart, axis=1).max() < 0.5
    assert error(bent.positions, true.positions) < error(frames.positions, true.positions)


@pytest.mark.parametrize("seed", range(3))
def test_as_many_outliers_as_loops_change_the_result_by_less_than_a_tenth(seed: int) -> None:
    _, frames, loops = drifting_square(seed)
    clean = judged(frames, loops)
    wrong = outliers(100, frames, np.random.default_rng(100 + seed))
    bent = judged(frames, [*loops, *wrong])
    assert all(each.verdict != "accepted" for each in bent.loops[100:])
    moved = np.linalg.norm(clean.positions - frames.positions, axis=1)
    change = np.linalg.norm(bent.positions - clean.positions, axis=1)
    assert np.sqrt((change**2).mean()) < 0.1 * np.sqrt((moved**2).mean())


def test_loops_that_support_each_other_but_no_drift_explains_are_rejected() -> None:
    true, frames, loops = drifting_square(4)
    rng = np.random.default_rng(5)
    # A street that looks like another one, 60 m farther: ten consistent wrong loops.
    pairs = np.column_stack([np.arange(10), np.arange(10) + 137])
    alike = [
        FoundLoop(each.one, each.other + 12, each.position, each.yaw, each.covariance, 0.99, 20)
        for each in loops_between(pairs - np.array([0, 37]), true.positions, true.yaws, rng)
    ]
    bent = judged(frames, [*loops, *alike])
    assert {each.verdict for each in bent.loops[100:]} <= {
        "not-explained-by-drift",
        "inconsistent",
        "outlier",
    }
    assert bent.verdicts["accepted"] >= 95


def test_one_loop_alone_is_unsupported() -> None:
    _, frames, loops = drifting_square(6)
    bent = judged(frames, loops[:1])
    assert [each.verdict for each in bent.loops] == ["unsupported"]
    np.testing.assert_allclose(bent.positions, frames.positions, atol=1e-6)


def test_rotated_and_shifted_map_gives_the_same_result_rotated_and_shifted() -> None:
    _, frames, loops = drifting_square(7)
    bent = judged(frames, loops)
    angle, shift = 1.1, np.array([4_000.0, -90_000.0, 12.0])

    def turned(points: np.ndarray) -> np.ndarray:
        return np.asarray(rotated(points, np.full(len(points), angle)) + shift)

    whole = frames.moved(turned(frames.positions), frames.yaws + angle)
    there = judged(whole, loops)
    np.testing.assert_allclose(there.positions, turned(bent.positions), atol=1e-3)


def test_order_of_robots_and_captures_does_not_matter() -> None:
    rng = np.random.default_rng(8)
    positions, yaws = square_path(SIDE, 1)
    robots = [
        frames_of(*drifted(positions, yaws, rng, 0.05, 0.1), track=track, start=1000.0 * track)
        for track in (1, 2, 3)
    ]
    frames = joined(robots)
    every = np.concatenate([positions] * 3), np.concatenate([yaws] * 3)
    pairs = np.concatenate(
        [np.column_stack([np.arange(100), np.arange(100) + shift]) for shift in (100, 200)]
    )
    loops = loops_between(pairs, *every, rng)
    bent = judged(frames, loops)
    assert bent.accepted == 200
    assert bent.parts.max() == 0
    order = rng.permutation(300)
    back = np.argsort(order)
    odometry = frames.odometry
    shuffled = GraphFrames(
        frames.times[order],
        frames.positions[order],
        frames.yaws[order],
        CaptureOdometry(
            odometry.tracks[order],
            odometry.positions[order],
            odometry.yaws[order],
            odometry.variances[order],
        ),
    )
    renamed = [
        FoundLoop(
            int(back[each.one]), int(back[each.other]), each.position, each.yaw,
            each.covariance, each.probability, each.inliers,
        )
        for each in reversed(loops)
    ]  # fmt: skip
    again = judged(shuffled, renamed)
    np.testing.assert_allclose(again.positions[back], bent.positions, atol=2e-3)


def test_optimizing_the_result_again_moves_nothing() -> None:
    _, frames, loops = drifting_square(9)
    bent = judged(frames, loops)
    again = judged(frames.moved(bent.positions, bent.yaws), loops)
    assert again.moved.max() < 1e-3


def test_swapped_loop_is_the_same_loop() -> None:
    _, frames, loops = drifting_square(10)
    swapped = []
    for each in loops:
        back, yaw = relative(
            each.position[None], np.array([each.yaw]), np.zeros((1, 3)), np.zeros(1)
        )
        here, _ = composed(each.position[None], np.array([each.yaw]), back, yaw)
        np.testing.assert_allclose(here, 0.0, atol=1e-9)
        swapped.append(
            FoundLoop(each.other, each.one, back[0], float(yaw[0]), each.covariance, 0.99, 20)
        )
    assert judged(frames, swapped).accepted == 100


def test_robots_that_never_meet_stay_apart() -> None:
    _, frames, loops = drifting_square(11)
    far = frames_of(*square_path(5, 1), track=2, start=5000.0)
    bent = judged(joined([frames, far]), loops)
    assert len(set(bent.parts.tolist())) == 2
    np.testing.assert_allclose(bent.positions[200:], far.positions, atol=1e-6)


def test_captures_without_loops_stay_even_if_their_odometry_was_corrected() -> None:
    true, frames, _ = drifting_square(6)
    corrected = GraphFrames(frames.times, frames.positions, frames.yaws, true.odometry)
    bent = judged(corrected, [])
    np.testing.assert_array_equal(bent.positions, frames.positions)
    np.testing.assert_array_equal(bent.yaws, frames.yaws)
