"""Odometry of captures in map and delta files."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from placecell_client import Delta, MapFileError, decode, encode
from placecell_client.maps.canonical import canonical
from placecell_client.maps.delta_file import decode_delta, encode_delta
from placecell_client.maps.edit import apply, delta_between, difference, take
from placecell_client.maps.move import moved

from tests.client.map_builders import random_map, with_tracks

NONE = np.zeros(0, np.uint32)


def test_odometry_survives_a_file() -> None:
    given = canonical(with_tracks(random_map(segments=40, frames=5)))
    back = decode(encode(given))
    np.testing.assert_array_equal(back.frame_tracks, given.frame_tracks)
    np.testing.assert_array_equal(back.frame_odometry, given.frame_odometry)
    assert encode(back) == encode(given)


def test_odometry_follows_its_capture_when_captures_are_sorted_and_dropped() -> None:
    given = canonical(with_tracks(random_map(segments=40, frames=5)))
    kept = canonical(take(given, given.frame_index != 1))
    rows = [0, 2, 3, 4]
    assert given.frame_odometry is not None
    np.testing.assert_array_equal(kept.frame_odometry, given.frame_odometry[rows])
    shuffled = replace(
        given,
        frame_index=(4 - given.frame_index).astype(np.uint32),
        **{
            name: getattr(given, name)[::-1].copy()
            for name in (
                "frame_times", "frame_positions", "frame_orientations", "frame_tracks",
                "frame_odometry",
            )
        },
    )  # fmt: skip
    assert encode(shuffled) == encode(given)


def test_map_without_odometry_is_the_same_file_as_before() -> None:
    plain = random_map(segments=10, frames=2)
    assert b"frame_tracks" not in encode(plain)


def test_delta_adds_odometry_and_never_removes_it() -> None:
    plain = canonical(random_map(segments=20, frames=3))
    told = canonical(with_tracks(plain))
    delta = delta_between(plain, told, 1, 2)
    assert len(delta.changed) == 20
    assert encode(apply(plain, decode_delta(encode_delta(delta)))) == encode(told)
    back = delta_between(told, plain, 2, 3)
    assert back.is_whole
    with pytest.raises(MapFileError, match="frame_odometry"):
        difference(told, plain)


def test_segments_of_a_map_without_odometry_get_none() -> None:
    told = canonical(with_tracks(random_map(segments=20, frames=3)))
    more = canonical(
        replace(random_map(segments=4, frames=1), ids=np.arange(100, 104, dtype=np.uint32))
    )
    more = replace(more, model_id=told.model_id, preprocessing=told.preprocessing, frame=told.frame)
    both = apply(told, Delta(more, NONE))
    assert both.frame_tracks is not None
    assert sorted(set(both.frame_tracks.tolist())) == [0, 7]


def test_rigid_transform_keeps_the_odometry() -> None:
    told = canonical(with_tracks(random_map(segments=20, frames=3)))
    there = moved(told, np.diag([-1.0, -1.0, 1.0]), np.ones(3), "elsewhere")
    np.testing.assert_array_equal(there.frame_odometry, told.frame_odometry)


@pytest.mark.parametrize(
    ("change", "named"),
    [
        ({"frame_odometry": None}, "both columns"),
        ({"frame_tracks": np.zeros(2, np.uint32)}, "frame_tracks"),
        ({"frame_odometry": np.full((3, 7), np.nan)}, "not finite"),
        ({"frame_odometry": np.full((3, 7), -1.0)}, "negative"),
    ],
)
def test_invalid_odometry_is_named(change: dict[str, Any], named: str) -> None:
    told = with_tracks(random_map(segments=20, frames=3))
    with pytest.raises(MapFileError, match=named):
        replace(told, **change).check()
