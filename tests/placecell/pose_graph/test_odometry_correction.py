"""Correction of odometry by segments that are seen several times, on paths drawn by hand."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.core.types import Float64, Int64
from placecell.pose_graph import CaptureOdometry, GraphFrames, GraphMap
from placecell.pose_graph.frames import composed, relative
from placecell.pose_graph.loops import GraphMap as Map
from placecell.pose_graph.odometry_correction import repeated_views, with_corrected_odometry
from placecell.pose_graph.parameters import PoseGraphParameters
from tests.placecell.pose_graph.graph_builders import STEP, square_path

PARAMETERS = PoseGraphParameters()


def seen_from(
    positions: Float64, yaws: Float64, rng: np.random.Generator
) -> tuple[Int64, Float64, Float64]:
    """Return views of poles beside a path: captures, places in their level frames, true places.

    A pole is stored every 10 m while it is within 30 m: at every second capture, half of the poles
    at each.
    """
    middle = positions.mean(axis=0)
    poles = middle + np.column_stack([rng.uniform(-90, 90, (300, 2)), rng.uniform(0, 3, 300)])
    near = np.linalg.norm(positions[:, None, :2] - poles[None, :, :2], axis=2) < 30
    turn = (np.arange(len(positions))[:, None] + np.arange(len(poles))) % 2 == 0
    captures, which = np.nonzero(near & turn)
    places, _ = relative(positions[captures], yaws[captures], poles[which], np.zeros(len(captures)))
    return captures, places + rng.normal(0.0, 0.05, places.shape), poles[which]


def drifting(errors: Float64, turns: Float64, variances: float = 0.0) -> tuple[Map, Float64]:
    """Return the map of a lap around a square whose odometry has errors, and the true positions."""
    true, yaws = square_path(20, 1)
    captures, places, _ = seen_from(true, yaws, np.random.default_rng(1))
    steps, bends = relative(true[:-1], yaws[:-1], true[1:], yaws[1:])
    positions, headings = [true[:1]], [yaws[:1]]
    for step, bend, error, turn in zip(steps, bends, errors, turns, strict=True):
        place, heading = composed(
            positions[-1], headings[-1], (step * (1 + error))[None], np.array([bend + turn])
        )
        positions.append(place)
        headings.append(heading)
    driven, turned = np.concatenate(positions), np.concatenate(headings)
    tracks = np.ones(len(true), dtype=np.int64)
    grown = np.tile(variances * np.arange(len(true))[:, None], (1, 3))
    odometry = CaptureOdometry(tracks, driven, turned, grown)
    frames = GraphFrames(np.arange(len(true), dtype=float), driven, turned, odometry)
    centroids, _ = composed(driven[captures], turned[captures], places, np.zeros(len(captures)))
    return GraphMap(frames, centroids, captures), true


def lengths(positions: Float64) -> Float64:
    return np.asarray(np.linalg.norm(np.diff(positions, axis=0), axis=1))


def wandering(count: int) -> Float64:
    """Return a scale error that goes from 2% too long to 2% too short and back."""
    return np.asarray(0.02 * np.cos(np.arange(count) / 10))


def test_wandering_scale_is_corrected_by_the_segments() -> None:
    graph, true = drifting(wandering(79), np.zeros(79))
    corrected = with_corrected_odometry(graph, PARAMETERS)
    before = lengths(graph.frames.positions) / lengths(true) - 1
    after = lengths(corrected.frames.positions) / lengths(true) - 1
    assert np.sqrt((before**2).mean()) > 0.013
    assert np.sqrt((after**2).mean()) < 0.005
    np.testing.assert_allclose(corrected.frames.odometry.positions, corrected.frames.positions)


def test_wandering_heading_is_corrected_by_the_segments() -> None:
    turns = np.radians(0.3) * np.sign(np.sin(np.arange(79) / 8))
    graph, _ = drifting(np.zeros(79), turns)
    corrected = with_corrected_odometry(graph, PARAMETERS)
    _, yaws = square_path(20, 1)
    before, after = (
        np.degrees(np.abs(np.unwrap(each.frames.yaws) - np.unwrap(yaws))).max()
        for each in (graph, corrected)
    )
    assert before > 5.0
    assert after < before / 2


def test_segments_move_with_their_captures() -> None:
    graph, _ = drifting(wandering(79), np.zeros(79))
    corrected = with_corrected_odometry(graph, PARAMETERS)
    for each in (graph, corrected):
        spots = each.frames.positions[each.captures]
        there, _ = relative(
            spots, each.frames.yaws[each.captures], each.centroids, np.zeros(len(spots))
        )
        if each is graph:
            expected = there
    np.testing.assert_allclose(there, expected, atol=1e-9)


def test_correction_does_not_depend_on_the_order_of_captures() -> None:
    graph, _ = drifting(wandering(79), np.zeros(79))
    order = np.random.default_rng(4).permutation(80)
    back = np.argsort(order)
    frames, odometry = graph.frames, graph.frames.odometry
    turned = GraphMap(
        GraphFrames(
            frames.times[order],
            frames.positions[order],
            frames.yaws[order],
            CaptureOdometry(
                odometry.tracks, odometry.positions[order], odometry.yaws[order],
                odometry.variances[order],
            ),
        ),
        graph.centroids,
        back[graph.captures],
    )  # fmt: skip
    one = with_corrected_odometry(graph, PARAMETERS)
    other = with_corrected_odometry(turned, PARAMETERS)
    np.testing.assert_allclose(other.frames.positions[back], one.frames.positions, atol=1e-6)


def test_stated_covariance_keeps_the_odometry() -> None:
    graph, _ = drifting(wandering(79), np.zeros(79), variances=1e-4)
    assert with_corrected_odometry(graph, PARAMETERS) is graph


def test_odometry_that_is_stated_to_be_worse_is_corrected() -> None:
    graph, true = drifting(wandering(79), np.zeros(79), variances=0.0125)  # 5 cm after a meter
    corrected = with_corrected_odometry(graph, PARAMETERS)
    after = lengths(corrected.frames.positions) / lengths(true) - 1
    assert np.sqrt((after**2).mean()) < 0.005
    variances = corrected.frames.odometry.variances
    np.testing.assert_allclose(variances[:, 0], 0.02**2 * corrected.frames.ways, rtol=0.02)
    np.testing.assert_array_equal(variances[:, 1:], graph.frames.odometry.variances[:, 1:])


def test_stated_covariance_of_one_track_keeps_only_that_track() -> None:
    graph, true = drifting(wandering(79), np.zeros(79))
    frames, odometry = graph.frames, graph.frames.odometry
    second = CaptureOdometry(
        np.concatenate([odometry.tracks, odometry.tracks + 1]),
        np.concatenate([odometry.positions, odometry.positions]),
        np.concatenate([odometry.yaws, odometry.yaws]),
        np.concatenate([odometry.variances, 1e-4 * np.arange(80)[:, None] * np.ones(3)]),
    )
    both = GraphMap(
        GraphFrames(
            np.concatenate([frames.times, frames.times]),
            second.positions,
            second.yaws,
            second,
        ),
        np.concatenate([graph.centroids, graph.centroids]),
        np.concatenate([graph.captures, graph.captures + 80]),
    )
    corrected = with_corrected_odometry(both, PARAMETERS)
    np.testing.assert_allclose(corrected.frames.positions[80:], frames.positions, atol=1e-9)
    np.testing.assert_array_equal(corrected.frames.odometry.variances[80:], second.variances[80:])
    after = lengths(corrected.frames.positions[:80]) / lengths(true) - 1
    assert np.sqrt((after**2).mean()) < 0.005


@pytest.mark.parametrize("count", [0, 3])
def test_few_segments_correct_nothing(count: int) -> None:
    graph, _ = drifting(wandering(79), np.zeros(79))
    few = replace(graph, centroids=graph.centroids[:count], captures=graph.captures[:count])
    assert with_corrected_odometry(few, PARAMETERS) is few


def test_captures_without_odometry_stay() -> None:
    graph, _ = drifting(wandering(79), np.zeros(79))
    odometry = replace(graph.frames.odometry, tracks=np.zeros(80, dtype=np.int64))
    alone = replace(graph, frames=replace(graph.frames, odometry=odometry))
    assert with_corrected_odometry(alone, PARAMETERS) is alone


def test_views_are_paired_with_the_nearest_ones_of_the_next_view() -> None:
    positions = np.column_stack([STEP * np.arange(7), np.zeros(7), np.zeros(7)])
    tracks = np.ones(7, dtype=np.int64)
    frames = GraphFrames(
        np.arange(7.0),
        positions,
        np.zeros(7),
        CaptureOdometry.from_poses(tracks, positions, np.zeros(7)),
    )
    # One pole seen at 0, 10 and 30 m of the way, and another one 0.8 m beside it, seen at 10 m.
    places = np.array([[15, 5, 0], [15.1, 5, 0], [15, 5, 0], [15, 5.8, 0]], dtype=float)
    graph = GraphMap(frames, places, np.array([0, 2, 6, 2]))
    np.testing.assert_array_equal(repeated_views(graph, np.array([1]), 1.0), [[0, 1]])
    assert len(repeated_views(graph, np.array([2]), 1.0)) == 0
