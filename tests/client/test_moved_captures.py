"""Captures that moved, in delta files: their segments follow them exactly."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from placecell_client import CompactMap, Delta, MapFileError, encode
from placecell_client.maps.canonical import canonical
from placecell_client.maps.delta_file import decode_delta, encode_delta
from placecell_client.maps.edit import apply, compose, difference, join, moving_difference, take
from placecell_client.maps.moved_captures import MovedCaptures, moved_centroids
from placecell_client.maps.union import union

from tests.client.map_builders import random_map, with_tracks

NONE = np.zeros(0, np.uint32)


def turned(orientations: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """Turn orientations (f, 4) about z."""
    x, y, z, w = orientations.astype(np.float64).T
    cos, sin = np.cos(angles / 2), np.sin(angles / 2)
    parts = [cos * x - sin * y, cos * y + sin * x, cos * z + sin * w, cos * w - sin * z]
    return np.column_stack(parts).astype(np.float32)


def bent(before: CompactMap, seed: int, share: float = 1.0) -> CompactMap:
    """Return a map whose captures moved, by the rule; a share of them stay."""
    rng = np.random.default_rng(seed)
    f = len(before.frame_times)
    moves = rng.random(f) < share
    positions = before.frame_positions + moves[:, None] * rng.normal(0, 2, (f, 3))
    orientations = turned(before.frame_orientations, rng.normal(0, 0.2, f))
    orientations = np.where(moves[:, None], orientations, before.frame_orientations)
    rows = before.frame_index
    centroids = moved_centroids(
        before.centroids,
        before.frame_positions[rows],
        before.frame_orientations[rows],
        positions[rows],
        orientations[rows],
    )
    centroids[~moves[rows]] = before.centroids[~moves[rows]]
    after = replace(
        before, centroids=centroids, frame_positions=positions, frame_orientations=orientations
    )
    return canonical(after)


def moving_delta(before: CompactMap, after: CompactMap) -> Delta:
    changed, removed, moved = moving_difference(before, after)
    return decode_delta(encode_delta(Delta(changed, removed, 1, 2, moved)))


def test_quarter_turn_is_exact_by_hand() -> None:
    found = moved_centroids(
        np.array([[4.0, 2.0, 1.0]]),
        np.array([[1.004, 2.0, 0.5]]),  # 100 cm
        np.array([[0, 0, 0, 1]], np.float32),
        np.array([[10.0, 20.0, 0.5]]),
        np.array([[0, 0, np.sqrt(0.5), np.sqrt(0.5)]], np.float32),
    )
    assert found.tolist() == [[10.0, 23.0, 1.0]]


def test_segments_keep_their_place_as_their_capture_sees_them() -> None:
    before = canonical(random_map(segments=200, frames=8))
    after = bent(before, 1)
    reach = [
        np.linalg.norm(each.centroids - each.frame_positions[each.frame_index], axis=1)
        for each in (before, after)
    ]
    np.testing.assert_allclose(reach[0], reach[1], atol=0.02)


def test_delta_of_moved_captures_has_no_segments_and_leads_to_the_same_file() -> None:
    before = canonical(with_tracks(random_map(segments=500, frames=10)))
    after = bent(before, 2)
    delta = moving_delta(before, after)
    assert len(delta.changed) == 0
    assert delta.moved is not None
    assert len(delta.moved) == 10
    assert delta.moved.tracks is None  # the odometry stays
    assert encode(apply(before, delta)) == encode(after)
    assert encode(apply(apply(before, delta), replace(delta, moved=None))) == encode(after)
    whole = encode_delta(Delta(*difference(before, after), 1, 2))
    assert len(encode_delta(delta)) < len(whole) / 6  # most of it is the header


def test_first_odometry_comes_with_the_moved_captures() -> None:
    before = canonical(random_map(segments=50, frames=5))
    after = canonical(with_tracks(bent(before, 3, share=0.5)))
    delta = moving_delta(before, after)
    assert delta.moved is not None
    assert delta.moved.tracks is not None
    assert encode(apply(before, delta)) == encode(after)


@given(
    seed=st.integers(0, 10_000), share=st.sampled_from([0.0, 0.5, 1.0]), odometry=st.booleans(),
    optional=st.sampled_from([(), ("seen",), ("extents", "views", "source", "source_ids")]),
)  # fmt: skip
def test_any_edit_beside_moved_captures_leads_to_the_same_file(
    seed: int, share: float, odometry: bool, optional: tuple[str, ...]
) -> None:
    rng = np.random.default_rng(seed)
    before = canonical(random_map(segments=40, frames=6, seed=seed, optional=optional))
    before = with_tracks(before) if odometry else before
    after = bent(before, seed, share)
    after = take(after, rng.random(len(after)) < 0.9)  # some are removed
    codes = after.codes.copy()
    codes[rng.random(len(after)) < 0.1] += 1  # some are replaced
    nudged = after.centroids + 0.01 * (rng.random(len(after)) < 0.1)[:, None]
    after = canonical(replace(after, codes=codes, centroids=nudged))
    more = replace(
        random_map(segments=4, frames=1, seed=seed + 1, optional=optional),
        ids=np.arange(900, 904, dtype=np.uint32),
    )
    if "source" in optional:
        more = replace(more, source_ids=more.ids, source=np.zeros(4, np.uint16))
    after = union([after, more])
    delta = moving_delta(before, after)
    assert encode(apply(before, delta)) == encode(after)
    # Parts of it lead there as well.
    changed, moved = delta.changed, delta.moved
    half = np.arange(len(changed)) % 2 == 0
    parts = [Delta(canonical(take(changed, half)), delta.removed, 1, 2, moved)]
    parts += [Delta(canonical(take(changed, ~half)), NONE, 1, 2)]
    assert encode(apply(before, join(parts))) == encode(after)


def test_capture_whose_segments_go_apart_is_sent_as_segments() -> None:
    before = canonical(random_map(segments=30, frames=1))
    after = bent(before, 5)
    third = np.arange(30) % 3 == 0
    split = union([take(before, third), take(after, ~third)])
    delta = moving_delta(before, split)
    assert delta.moved is not None
    assert len(delta.changed) == 10  # they stay where they are
    assert encode(apply(before, delta)) == encode(split)


def moves(**columns: Any) -> MovedCaptures:
    given: dict[str, Any] = {
        "ids": np.array([3, 9], np.uint32),
        "positions": np.zeros((2, 3)),
        "orientations": np.array([[0, 0, 0, 1], [0, 0, 1, 0]], np.float32),
    }
    return MovedCaptures(**given | columns)


@pytest.mark.parametrize(
    ("columns", "named"),
    [
        ({"ids": np.array(3, np.uint32)}, "moved_ids"),
        ({"ids": np.array([9, 3], np.uint32)}, "moved_ids"),
        ({"ids": np.array([3, 9])}, "moved_ids"),
        ({"positions": np.full((2, 3), np.nan)}, "moved_positions"),
        ({"orientations": np.zeros((2, 4), np.float32)}, "moved_orientations"),
        ({"tracks": np.zeros(2, np.uint32)}, "moved_odometry"),
        (
            {"tracks": np.zeros(2, np.uint32), "odometry": np.full((2, 7), -1.0)},
            "moved_odometry: a variance",
        ),
    ],
)
def test_invalid_column_of_moved_captures_is_named(columns: dict[str, Any], named: str) -> None:
    delta = Delta(take(random_map(), slice(0, 0)), NONE, 1, 2, moves(**columns))
    with pytest.raises(MapFileError, match=named):
        encode_delta(delta)


def test_moved_captures_fit_only_their_version() -> None:
    nothing = canonical(take(random_map(), slice(0, 0)))
    with pytest.raises(MapFileError, match="only between two versions"):
        encode_delta(Delta(nothing, NONE, 0, 0, moves()))
    before = canonical(random_map(segments=30, frames=2))
    both = np.sort(before.ids[before.frame_index == 0])[:2]
    with pytest.raises(MapFileError, match="same capture"):
        apply(before, Delta(nothing, NONE, 1, 2, moves(ids=both)))
    with pytest.raises(MapFileError, match="has no segment"):
        apply(before, Delta(nothing, NONE, 1, 2, moves(ids=np.array([5_000, 5_001], np.uint32))))
    with pytest.raises(MapFileError, match="to the map itself"):
        compose(Delta(nothing, NONE, 1, 2), Delta(nothing, NONE, 2, 3, moves(ids=both)))
    mixed = moves(tracks=np.zeros(2, np.uint32), odometry=np.zeros((2, 7)))
    with pytest.raises(MapFileError, match="in all parts or in none"):
        join([Delta(nothing, NONE, 1, 2, each) for each in (moves(), mixed)])
