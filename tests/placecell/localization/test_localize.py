"""Localization: properties of any scene, and misleading scenes."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from placecell.core.types import Float64
from placecell.localization import Candidates, Localization, LocalizationParameters, Pose
from placecell.localization import localize as localize_with
from placecell.localization.confidence import shipped
from placecell.localization.localize import chance_of_direction
from tests.placecell.localization.scene_builders import (
    Scene,
    a_pose,
    any_rotation,
    concatenate,
    scene,
    scene_of,
    street,
    take,
)

SE3 = LocalizationParameters(model="se3")
LENIENT = replace(shipped(), acceptance=None)
"""Returns poses above 0.5: what these tests check does not depend on the calibration."""
localize = partial(localize_with, confidence=LENIENT)
seeds = st.integers(0, 100_000)


def off(found: Localization, truth: Pose) -> tuple[float, float]:
    """Return the errors of the pose at the segments, meters and degrees."""
    assert found.pose is not None, (found.reason, found.detail)
    assert found.best is not None
    meters, angle = found.pose.difference(truth, found.best.source.mean(axis=0))
    return meters, float(np.degrees(angle))


def assert_right(found: Localization, truth: Pose) -> None:
    meters, degrees = off(found, truth)
    assert meters < 0.3
    assert degrees < 1.0


@pytest.mark.slow
@settings(max_examples=30, deadline=None)
@given(seeds)
def test_a_robot_in_the_map_is_found(seed: int) -> None:
    made = scene(seed)
    found = localize(made.candidates)
    assert_right(found, made.pose)
    assert found.detail == ""


@pytest.mark.slow
def test_a_robot_in_the_map_is_nearly_always_sure() -> None:
    told = [localize(scene(seed).candidates).probability for seed in range(50)]
    assert np.mean(np.array(told) > 0.9) > 0.9


@settings(max_examples=20, deadline=None)
@given(seeds)
def test_the_inliers_are_the_segments_and_their_rows(seed: int) -> None:
    made = scene(seed)
    best = localize(made.candidates).best
    assert best is not None
    assert len(set(best.queries)) == len(set(best.rows)) == len(best)
    assert np.mean(best.queries == best.rows) > 0.9  # row i of the map is segment i
    moved = best.pose.apply(made.candidates.centroids[best.queries])
    distances = np.linalg.norm(moved - made.map[best.rows], axis=1)
    np.testing.assert_allclose(distances, best.residuals, atol=1e-9)
    np.testing.assert_array_equal(best.source, made.candidates.centroids[best.queries])


@settings(max_examples=20, deadline=None)
@given(seeds)
def test_if_the_robot_s_frame_turns_the_pose_turns_along(seed: int) -> None:
    made = scene(seed)
    moved = made.seen_from(a_pose(np.random.default_rng(seed)))
    one, other = localize(made.candidates), localize(moved.candidates)
    assert_right(one, made.pose)
    assert_right(other, moved.pose)
    assert other.probability == pytest.approx(one.probability, abs=0.05)


@settings(max_examples=20, deadline=None)
@given(seeds)
def test_if_the_map_s_frame_turns_the_pose_turns_along(seed: int) -> None:
    made = scene(seed)
    moved = made.in_map(a_pose(np.random.default_rng(seed), reach=1e5))
    assert_right(localize(moved.candidates), moved.pose)


@settings(max_examples=20, deadline=None)
@given(seeds)
def test_in_space_any_turn_is_followed(seed: int) -> None:
    random = np.random.default_rng(seed)
    made = scene(seed, found=0.8).in_map(any_rotation(random)).seen_from(any_rotation(random))
    found = localize(made.candidates, SE3)
    meters, degrees = off(found, made.pose)
    # Segments along a street fix the roll about it less well than the rest.
    assert meters < 0.5
    assert degrees < 5.0
    assert found.best is not None
    assert found.best.covariance.shape == (6, 6)


@settings(max_examples=20, deadline=None)
@given(seeds)
def test_the_order_of_the_segments_changes_nothing(seed: int) -> None:
    made = scene(seed)
    order = np.random.default_rng(seed).permutation(len(made.candidates))
    one, other = localize(made.candidates), localize(take(made.candidates, order))
    assert one.best is not None
    assert other.best is not None
    np.testing.assert_allclose(other.best.pose.matrix, one.best.pose.matrix, atol=1e-9)
    assert set(order[other.best.queries]) == set(one.best.queries)
    assert other.probability == pytest.approx(one.probability)


@pytest.mark.slow
@settings(max_examples=20, deadline=None)
@given(seeds, st.integers(0, 150))
def test_outliers_leave_the_pose_where_it_is(seed: int, outliers: int) -> None:
    made = scene(seed)
    random = np.random.default_rng(seed)
    strange = scene_of(
        random.uniform(-40, 40, (outliers, 3)) * (1, 1, 0.1), made.map,
        random.integers(0, len(made.map), (outliers, 10)), made.pose, random,
    ).candidates  # fmt: skip
    both = concatenate(made.candidates, strange)
    best = localize(both).best
    assert best is not None
    meters, angle = best.pose.difference(made.pose, best.source.mean(axis=0))
    assert meters < 0.4
    assert np.degrees(angle) < 1.5


def test_pure_noise_is_not_localized() -> None:
    for seed in range(30):
        assert localize(scene(seed, found=0.0).candidates).reason == "inconsistent"


@pytest.mark.parametrize("seed", range(20))
def test_few_segments_give_the_right_pose_or_none(seed: int) -> None:
    made = scene(seed, segments=24, found=0.5)
    assert_right(localize(made.candidates), made.pose)
    for found in (0.1, 0.2):
        few = scene(seed, segments=24, found=found)
        told = localize(few.candidates)
        if told.pose is not None:
            meters, degrees = off(told, few.pose)
            assert meters < 1
            assert degrees < 3


def look_alikes(places: int, spacing: float, seed: int = 0, turned: bool = False) -> Scene:
    """Return a scene of twenty segments that are at several places alike."""
    random = np.random.default_rng(seed)
    local = street(random, 40.0, 20)
    copies = []
    for place in range(places):
        move = Pose.of_yaw(float(place) if turned else 0.0, np.array([spacing * place, 0.0, 0.0]))
        copies.append(move.apply(local))
    rows = np.concatenate(copies)
    k = places
    chosen = np.arange(20)[:, None] + 20 * np.arange(k)
    same = np.full((20, k), 0.9)
    seen = local + random.normal(scale=0.1, size=local.shape)
    return Scene(Candidates(seen, chosen, rows[chosen], same), rows, Pose.of_yaw(0, np.zeros(3)))


@pytest.mark.parametrize("places", [2, 3, 8])
@pytest.mark.parametrize("turned", [False, True])
def test_identical_places_are_ambiguous(places: int, turned: bool) -> None:
    found = localize(look_alikes(places, 60.0, turned=turned).candidates)
    assert found.reason == "ambiguous"
    assert found.pose is None
    assert found.probability < 0.56  # one of two, if the second is as good as 80%
    assert found.best is not None
    assert found.second is not None
    meters, _ = found.best.pose.difference(found.second.pose, found.best.source.mean(axis=0))
    assert meters > 30


def houses(landmarks: int) -> Candidates:
    """Return a scene of four of ten identical houses, five segments each, and landmarks."""
    random = np.random.default_rng(1)
    house = random.uniform(0, 8, (5, 3))
    row = np.concatenate([house + (12.0 * number, 0, 0) for number in range(10)])
    signs = random.uniform(-20, -2, (landmarks, 3)) * (1, 1, 0.1)
    rows = np.concatenate([row, signs])
    seen = np.concatenate([row[:20], signs]) + random.normal(scale=0.1, size=(20 + landmarks, 3))
    alike = np.tile(np.arange(5)[:, None] + 5 * np.arange(10), (4, 1))
    # A landmark is like itself alone.
    known = np.column_stack([50 + np.arange(landmarks), np.tile(np.arange(9), (landmarks, 1))])
    chosen = np.concatenate([alike, known])
    match_probabilities = np.full(chosen.shape, 0.8)
    match_probabilities[20:, 1:] = 0.001
    return Candidates(seen, chosen, rows[chosen], match_probabilities)


def test_street_of_identical_houses_is_ambiguous() -> None:
    found = localize(houses(landmarks=0))
    assert found.reason == "ambiguous"
    assert "Another place" in found.detail


def test_landmarks_resolve_identical_houses() -> None:
    found = localize(houses(landmarks=6))
    assert_right(found, Pose.of_yaw(0, np.zeros(3)))
    assert found.second is not None  # another house is the second best
    houses_away = found.second.pose.translation[0] / 12.0
    assert abs(houses_away) > 0.9
    assert houses_away == pytest.approx(round(houses_away), abs=0.1)


def test_one_segment_a_thousand_times_in_the_map_is_not_localized() -> None:
    """All descriptors are equal, so all rows are equally good candidates."""
    random = np.random.default_rng(2)
    rows = random.uniform(-200, 200, (1_000, 3)) * (1, 1, 0.01)
    chosen = np.tile(np.arange(25), (40, 1))
    same = np.ones(chosen.shape)
    seen = rows[random.choice(1_000, 40, replace=False)]
    assert localize(Candidates(seen, chosen, rows[chosen], same)).pose is None


def test_one_segment_a_thousand_times_around_the_robot() -> None:
    made = scene(3, segments=30)
    given = made.candidates
    repeated = concatenate(given, take(given, np.zeros(1_000, dtype=np.int64)))
    found = localize(repeated)
    assert found.best is not None
    meters, _ = found.best.pose.difference(made.pose, found.best.source.mean(axis=0))
    assert meters < 0.5
    # The thousand count as one.
    alone = localize(given).best
    assert alone is not None
    assert found.best.score < alone.score + 5


def exact(seen: Float64) -> Candidates:
    """Return a scene of exact segments, each with its own row as the only candidate."""
    rows = np.arange(len(seen))[:, None]
    return Candidates(seen, rows, seen[rows] + 100.0, np.ones(rows.shape))


def test_coincident_segments_do_not_determine_the_rotation() -> None:
    found = localize(exact(np.tile([3.0, 4.0, 1.0], (30, 1))))
    assert found.reason == "inconsistent"


def test_a_crowd_in_one_point_ends() -> None:
    """All correspondences are consistent: the graph is as large as possible."""
    random = np.random.default_rng(4)
    seen = random.normal(scale=0.01, size=(400, 3))
    rows = 3.0 * np.arange(25)[None] + np.zeros((400, 1))
    places = np.stack([rows, np.zeros_like(rows), np.zeros_like(rows)], axis=2)
    chosen = np.tile(np.arange(25), (400, 1))
    same = np.ones(chosen.shape)
    assert localize(Candidates(seen, chosen, places, same)).pose is None


def test_a_pole_does_not_determine_the_rotation() -> None:
    found = localize(exact(np.outer(np.arange(10.0), [0, 0, 1])))
    assert found.reason == "inconsistent"
    assert "do not determine the rotation" in found.detail
    assert found.probability == 0


def test_parts_of_one_tree_are_one_piece_of_evidence() -> None:
    """A sensor with few beams sees a tree as parts above each other, up to 0.3 m apart in plan."""
    trees = np.array([[0.0, 0, 0], [30, 0, 0], [10, 20, 0], [-15, 8, 0]])
    parts = np.array([[0.0, 0, 1], [0.3, 0, 3], [0, 0.2, 5]])
    four = (trees[:, None] + parts).reshape(-1, 3)
    three = four[:9]
    assert_right(localize(exact(four)), Pose.of_yaw(0, np.full(3, 100.0)))
    found = localize(exact(three))
    assert found.best is not None
    assert len(found.best) == 9
    assert found.reason == "inconsistent"
    assert "The 9 inlier segments stand at 3 places; 4 or more are needed" in found.detail
    assert found.probability <= 0.5
    # Without gravity, parts above each other are as good as any others.
    assert "places" not in localize(exact(three), SE3).detail


def test_the_chance_of_a_direction_by_hand() -> None:
    assert chance_of_direction(np.radians(3.0)) == pytest.approx(0.6827, abs=1e-4)
    assert chance_of_direction(np.radians(1.0)) == pytest.approx(0.9973, abs=1e-4)
    assert chance_of_direction(np.inf) == 0


def test_segments_in_a_row_tell_a_yaw_but_no_roll() -> None:
    row = np.outer(4.0 * np.arange(12.0), [1, 0.5, 0])
    truth = Pose.of_yaw(0, np.full(3, 100.0))
    assert_right(localize(exact(row)), truth)
    assert localize(exact(row), SE3).reason == "inconsistent"


@pytest.mark.parametrize("segments", [0, 1, 3])
def test_too_few_segments_are_reported(segments: int) -> None:
    found = localize(exact(np.random.default_rng(5).uniform(-20, 20, (segments, 3))))
    assert found.reason == "too-few-segments"
    assert found.best is None
    assert found.probability == 0
    assert str(segments) in found.detail


def test_nan_is_ignored() -> None:
    made = scene(6)
    given = made.candidates
    broken = Candidates(
        given.centroids.copy(), given.rows, given.places.copy(), given.probabilities.copy()
    )  # fmt: skip
    broken.centroids[0] = np.nan
    broken.places[1, 2] = np.inf
    broken.probabilities[3, 4] = np.nan
    found = localize(broken)
    assert_right(found, made.pose)
    assert found.best is not None
    assert 0 not in found.best.queries
    nothing = Candidates(
        np.full((9, 3), np.nan), given.rows[:9], given.places[:9], given.probabilities[:9]
    )
    assert localize(nothing).reason == "too-few-segments"


@pytest.mark.slow
@pytest.mark.parametrize("k", [25, 100])
def test_ten_thousand_candidates(k: int) -> None:
    made = scene(7, segments=10_000 // k, found=0.3, k=k, rows=20_000)
    assert_right(localize(made.candidates), made.pose)
    noise = scene(8, segments=10_000 // k, found=0.0, k=k, rows=20_000)
    assert localize(noise.candidates).pose is None


def test_far_from_any_origin_nothing_is_lost() -> None:
    made = scene(10).in_map(Pose.of_yaw(0.5, np.array([5e5, 5.4e6, 300.0])))
    moved = made.seen_from(Pose.of_yaw(1.0, np.array([-3e6, 4e6, 100.0])))
    assert_right(localize(moved.candidates), moved.pose)


def test_inputs_are_not_changed() -> None:
    made = scene(11)
    before = made.candidates.centroids.copy(), made.candidates.places.copy()
    localize(made.candidates)
    np.testing.assert_array_equal(made.candidates.centroids, before[0])
    np.testing.assert_array_equal(made.candidates.places, before[1])
