"""Optimization of pose graphs, against solutions that follow by hand and from another solver."""

import builtins

import numpy as np
import pytest
from scipy.optimize import least_squares

from placecell.pose_graph import GraphFrames, PoseGraphParameters, PoseGraphUnavailableError
from placecell.pose_graph.frames import Links, odometry_links
from placecell.pose_graph.loops import links_of
from placecell.pose_graph.optimize import anchors_of, optimize, parts_of, residuals
from tests.placecell.pose_graph.graph_builders import (
    drifted,
    error,
    frames_of,
    joined,
    loops_between,
    square_path,
)

PARAMETERS = PoseGraphParameters()


def no_loops() -> Links:
    return links_of([], PARAMETERS)


def test_line_with_a_loop_spreads_the_error_by_variance() -> None:
    """Five steps of 1.1 m in a line whose loop says 5 m: the surplus is shared by all links."""
    positions = np.column_stack([1.1 * np.arange(6.0), np.zeros(6), np.zeros(6)])
    frames = frames_of(positions, np.zeros(6))
    loop = Links(
        np.array([0]), np.array([5]), np.array([[5.0, 0.0, 0.0]]), np.zeros(1),
        np.array([[0.2, 0.2, 0.01]]),
    )  # fmt: skip
    found = optimize(frames, loop, PARAMETERS)
    link = 1.1 * PARAMETERS.drift**2
    surplus = 0.5 * 5 * link / (5 * link + 0.2**2)
    np.testing.assert_allclose(found.positions[:, 0], positions[:, 0] - surplus * np.arange(6) / 5,
                               atol=1e-5)  # fmt: skip
    np.testing.assert_allclose(found.positions[:, 1:], 0.0, atol=1e-6)
    assert found.kept.all()


def test_heights_follow_their_own_variances() -> None:
    positions = np.column_stack([5.0 * np.arange(5.0), np.zeros(5), 0.1 * np.arange(5.0)])
    frames = frames_of(positions, np.zeros(5))
    loop = Links(
        np.array([0]), np.array([4]), np.array([[20.0, 0.0, 0.0]]), np.zeros(1),
        np.array([[0.1, 0.05, 0.01]]),
    )  # fmt: skip
    found = optimize(frames, loop, PARAMETERS)
    links = odometry_links(frames, PARAMETERS)
    variance = (links.deviations[:, 1] ** 2).sum()
    expected = 0.4 - 0.4 * variance / (variance + 0.05**2)
    assert found.positions[4, 2] == pytest.approx(expected, abs=1e-6)


def test_square_agrees_with_the_least_squares_of_scipy() -> None:
    rng = np.random.default_rng(3)
    positions, yaws = square_path(side=4, laps=2)
    true = frames_of(positions, yaws)
    frames = frames_of(*drifted(positions, yaws, rng, 0.05, 0.05))
    pairs = np.column_stack([np.arange(16), np.arange(16) + 16])
    loops = links_of(loops_between(pairs, positions, yaws, rng), PARAMETERS)
    found = optimize(frames, loops, PARAMETERS)
    assert found.kept.all()
    odometry = odometry_links(frames, PARAMETERS)

    def cost(state: np.ndarray) -> np.ndarray:
        place = np.column_stack([state.reshape(-1, 3)[:, :2], np.zeros(len(frames))])
        heading = state.reshape(-1, 3)[:, 2]
        parts = [1e3 * (state[:3] - [*frames.positions[0, :2], frames.yaws[0]])]
        for links in (odometry, loops):
            meters, angles = residuals(place, heading, links)
            parts.append((meters[:, :2] / links.deviations[:, :1]).ravel())
            parts.append(angles / links.deviations[:, 2])
        return np.concatenate(parts)

    start = np.column_stack([frames.positions[:, :2], frames.yaws]).ravel()
    solved = least_squares(cost, start).x.reshape(-1, 3)
    # GTSAM measures a residual in the frame of the second pose: equal up to its square.
    np.testing.assert_allclose(found.positions[:, :2], solved[:, :2], atol=0.01)
    assert error(found.positions[:, :2], true.positions[:, :2]) < error(
        frames.positions[:, :2], true.positions[:, :2]
    )


def test_parts_without_loops_stay_where_they_are() -> None:
    first, second = (frames_of(*square_path(3, 1), track=track) for track in (1, 2))
    frames = joined([first, second])
    parts = parts_of(frames, no_loops())
    assert len(set(parts[:12])) == len(set(parts[12:])) == 1
    assert parts[0] != parts[12]
    assert sorted(anchors_of(frames, parts).tolist()) == [0, 12]
    found = optimize(frames, no_loops(), PARAMETERS)
    np.testing.assert_allclose(found.positions, frames.positions, atol=1e-6)


def test_captures_without_odometry_stand_alone() -> None:
    frames = frames_of(*square_path(2, 1), track=0)
    assert len(frames.links) == 0
    assert (frames.ways == 0).all()
    found = optimize(frames, no_loops(), PARAMETERS)
    np.testing.assert_allclose(found.positions, frames.positions, atol=1e-6)


def test_stated_covariance_replaces_that_of_the_parameters() -> None:
    frames = frames_of(*square_path(2, 1))
    stated = frames.odometry.variances + np.arange(8.0)[:, None] * [0.04, 0.01, 1e-4]
    odometry = type(frames.odometry)(
        frames.odometry.tracks, frames.odometry.positions, frames.odometry.yaws, stated
    )
    links = odometry_links(
        GraphFrames(frames.times, frames.positions, frames.yaws, odometry), PARAMETERS
    )
    np.testing.assert_allclose(links.deviations, np.tile([0.2, 0.1, 0.01], (7, 1)))


def test_missing_extra_is_named_with_its_command(monkeypatch: pytest.MonkeyPatch) -> None:
    real = builtins.__import__

    def without_gtsam(name: str, *args: object, **kwargs: object) -> object:
        if name == "gtsam":
            raise ImportError(name)
        return real(name, *args, **kwargs)  # type: ignore[arg-type]

    monkeypatch.setattr(builtins, "__import__", without_gtsam)
    with pytest.raises(PoseGraphUnavailableError, match=r"placecell\[pose-graph\]"):
        optimize(frames_of(*square_path(2, 1)), no_loops(), PARAMETERS)
