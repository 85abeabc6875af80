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
    np.testing.assert_allclose(variances[:, 1], graph.frames.odometry.variances[:, 1])
    heading = np.radians(PARAMETERS.drift_yaw_corrected) ** 2 * corrected.frames.ways
    np.testing.assert_allclose(variances[:, 2], heading, rtol=0.02)


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


def test_heading_that_is_stated_to_be_better_keeps_its_variance() -> None:
    graph, _ = drifting(wandering(79), np.zeros(79), variances=0.0125)
    odometry = graph.frames.odometry
    stated = odometry.variances * np.array([1.0, 1.0, 1e-7])
    odometry = replace(odometry, variances=stated)
    graph = replace(graph, frames=replace(graph.frames, odometry=odometry))
    corrected = with_corrected_odometry(graph, PARAMETERS)
    np.testing.assert_allclose(corrected.frames.odometry.variances[:, 2], stated[:, 2])


def gathering(turns: Float64, seconds: float) -> Map:
    """Return a map whose odometry turns wrongly, with views whose points were seen on 10 m of way.

    Args:
        turns: float64 (79,), errors of the heading, radians.
        seconds: time between two captures, which are 5 m apart.
    """
    graph, _ = drifting(np.zeros(79), turns)
    frames = graph.frames
    true, yaws = square_path(20, 1)
    _, _, poles = seen_from(true, yaws, np.random.default_rng(1))
    centroids = np.zeros_like(poles)
    weights = ((0, 0.25), (1, 0.5), (2, 0.25))  # the mean of the points of two steps of the way
    for back, weight in weights:
        rows = np.maximum(graph.captures - back, 0)
        places, _ = relative(true[rows], yaws[rows], poles, np.zeros(len(rows)))
        there, _ = composed(frames.positions[rows], frames.yaws[rows], places, np.zeros(len(rows)))
        centroids += weight * there
    moved = replace(frames, times=seconds * np.arange(80.0))
    return replace(graph, frames=moved, centroids=centroids)


def test_views_of_a_fast_robot_correct_turns_at_the_right_place() -> None:
    turns = np.zeros(79)
    turns[[25, 50]] = np.radians([3.0, -3.0])
    found = {}
    for seconds in (0.5, 100.0):  # 10 m in the time of a view, and 0.05 m
        graph = gathering(turns, seconds)
        after = with_corrected_odometry(graph, PARAMETERS).frames.yaws
        _, yaws = square_path(20, 1)
        off = np.degrees(np.unwrap(after) - np.unwrap(yaws))
        found[seconds] = float(np.sqrt((np.diff(off) ** 2).mean()))
    assert found[0.5] < 0.8 * found[100.0]


def half_hidden(graph: Map, seed: int) -> Map:
    """Return a map in which half of the views show only a part of their segment."""
    rng = np.random.default_rng(seed)
    hidden = rng.random(len(graph.captures)) < 0.5
    share = rng.uniform(0.0, 1.0, (int(hidden.sum()), 2))
    sides = np.full((len(hidden), 2), 2.0)
    sides[hidden] -= share
    centroids = graph.centroids.copy()
    centroids[hidden, :2] += share / 2 * rng.choice([-1.0, 1.0], share.shape)
    return replace(graph, centroids=centroids, sides=sides)


def test_segments_whose_boxes_change_count_less() -> None:
    _, yaws = square_path(20, 1)
    graph, _ = drifting(np.zeros(79), np.radians(0.3) * np.sign(np.sin(np.arange(79) / 8)))
    errors = []
    for seed in range(6):
        known = half_hidden(graph, seed)
        for each in (replace(known, sides=None), known):
            after = with_corrected_odometry(each, PARAMETERS).frames.yaws
            off = np.unwrap(after) - np.unwrap(yaws)
            errors.append(np.sqrt(((off[20:] - off[:-20]) ** 2).mean()))  # over 100 m
    without, by_boxes = np.reshape(errors, (-1, 2)).mean(axis=0)
    assert by_boxes < 0.85 * without


def leaning(graph: Map, amount: float) -> Map:
    """Return a map with things on the right-hand side only, which lean toward the sensor."""
    arms = graph.centroids - graph.frames.positions[graph.captures]
    yaws = graph.frames.yaws[graph.captures]
    right = np.cos(yaws) * arms[:, 1] - np.sin(yaws) * arms[:, 0] < 0
    flat = arms[right, :2]
    centroids = graph.centroids[right]
    centroids[:, :2] -= amount * flat / np.linalg.norm(flat, axis=1)[:, None]
    sides = np.full((len(centroids), 2), 0.5)
    return replace(graph, centroids=centroids, captures=graph.captures[right], sides=sides)


def test_way_stays_straight_though_things_on_one_side_lean_to_the_sensor() -> None:
    graph, _ = drifting(np.zeros(79), np.zeros(79))
    _, yaws = square_path(20, 1)
    turned = []
    for amount in (0.0, 0.3):
        after = with_corrected_odometry(leaning(graph, amount), PARAMETERS).frames.yaws
        off = np.unwrap(after) - np.unwrap(yaws)
        turned.append(np.degrees(off[-1] - off[0]))
    assert abs(turned[1] - turned[0]) < 0.3


def along_walls(graph: Map, seed: int) -> Map:
    """Return a map in which half of the segments are long walls, whose centroids slide along."""
    rng = np.random.default_rng(seed)
    wall = np.arange(len(graph.captures)) % 2 == 0
    sides = np.full((len(wall), 2), 0.4)
    sides[wall, 0] = 6.0
    centroids = graph.centroids.copy()
    centroids[wall, 0] += rng.normal(0.0, 0.25, int(wall.sum()))
    return replace(graph, centroids=centroids, sides=sides)


def test_long_walls_count_less_along_their_long_side() -> None:
    _, yaws = square_path(20, 1)
    graph, _ = drifting(np.zeros(79), np.radians(0.3) * np.sign(np.sin(np.arange(79) / 8)))
    errors = []
    for seed in range(4):
        known = along_walls(graph, seed)
        assert known.sides is not None
        for each in (replace(known, sides=known.sides[:, ::-1]), known):
            after = with_corrected_odometry(each, PARAMETERS).frames.yaws
            off = np.unwrap(after) - np.unwrap(yaws)
            errors.append(np.sqrt(((off[20:] - off[:-20]) ** 2).mean()))  # over 100 m
    turned, by_boxes = np.reshape(errors, (-1, 2)).mean(axis=0)
    assert by_boxes < 0.8 * turned


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
