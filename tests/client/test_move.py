"""Transforms of maps into other frames, and provenance before a merge."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray
from placecell_client import CompactMap, Delta, MapFileError, encode, moved, originated
from placecell_client.maps.compact_map import OPTIONAL, SEGMENT_COLUMNS
from placecell_client.maps.edit import apply
from scipy.spatial.transform import Rotation

from tests.client.map_builders import PROVENANCE, maps, random_map

NOTHING = np.zeros(0, np.uint32)
QUARTER = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
HALF = np.float32(np.sqrt(0.5))
Moves = tuple[NDArray[np.float64], NDArray[np.float64]]


@st.composite
def moves(draw: st.DrawFn) -> Moves:
    """Draw any rotation, with 0 and 180 degrees among them, and kilometers of translation."""
    angles = st.sampled_from([0.0, 90.0, 180.0]) | st.floats(-180, 180)
    turn = Rotation.from_euler("zyx", [draw(angles) for _ in range(3)], degrees=True)
    return turn.as_matrix(), np.array([draw(st.floats(-1e4, 1e4)) for _ in range(3)])


def turns(compact_map: CompactMap) -> Rotation:
    return Rotation.from_quat(compact_map.frame_orientations.astype(np.float64))


def assert_same_place(one: CompactMap, other: CompactMap) -> None:
    np.testing.assert_allclose(one.centroids, other.centroids, rtol=0, atol=1e-7)
    np.testing.assert_allclose(one.frame_positions, other.frame_positions, rtol=0, atol=1e-7)
    assert ((turns(one).inv() * turns(other)).magnitude() < 1e-6).all()


def test_rotation_by_90_degrees_equals_a_computation_by_hand() -> None:
    one = replace(
        random_map(segments=1, frames=3),
        centroids=np.array([[1.0, 2.0, 3.0]]),
        frame_positions=np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        frame_orientations=np.array(
            [[0, 0, 0, 1], [0, 0, HALF, HALF], [HALF, 0, 0, HALF]], np.float32
        ),
    )
    other = moved(one, QUARTER, [10, 20, 30], "site")
    assert other.frame == "site"
    np.testing.assert_allclose(other.centroids, [[8.0, 21.0, 33.0]])
    np.testing.assert_allclose(other.frame_positions, [[10, 21, 30], [9, 20, 30], [10, 20, 31]])
    expected = np.array([[0, 0, HALF, HALF], [0, 0, 1, 0], [0.5, 0.5, 0.5, 0.5]])
    signs = np.sign((other.frame_orientations * expected).sum(axis=1, keepdims=True))
    np.testing.assert_allclose(other.frame_orientations * signs, expected, atol=1e-7)


@given(moves(), st.integers(0, 9))
def test_orientations_are_rotated_and_stay_unit_quaternions(move: Moves, seed: int) -> None:
    one = random_map(seed=seed)
    other = moved(one, *move, "site")
    assert other.frame_orientations.dtype == np.float32
    norms = np.linalg.norm(other.frame_orientations.astype(np.float64), axis=1)
    np.testing.assert_allclose(norms, 1, rtol=0, atol=2e-7)
    expected = Rotation.from_matrix(move[0]) * turns(one)
    assert ((expected.inv() * turns(other)).magnitude() < 1e-6).all()
    other.check()


@given(moves(), st.integers(0, 9))
def test_transform_and_its_inverse_restore_the_map(move: Moves, seed: int) -> None:
    one = random_map(seed=seed)
    rotation, translation = move
    back = moved(moved(one, *move, "site"), rotation.T, -rotation.T @ translation, one.frame)
    assert back.frame == one.frame
    assert_same_place(back, one)


@given(moves(), moves(), st.integers(0, 9))
def test_two_transforms_equal_their_product(first: Moves, second: Moves, seed: int) -> None:
    one = random_map(seed=seed)
    in_turn = moved(moved(one, *first, "a"), *second, "b")
    at_once = moved(one, second[0] @ first[0], second[0] @ first[1] + second[1], "b")
    assert_same_place(in_turn, at_once)


@pytest.mark.slow
@given(maps(), moves())
def test_transform_keeps_all_other_columns(one: CompactMap, move: Moves) -> None:
    other = moved(one, *move, "site")
    for name in ({*SEGMENT_COLUMNS, *OPTIONAL} - {"centroids"}) | {"frame_times"}:
        assert getattr(other, name) is getattr(one, name)
    assert (other.model_id, other.preprocessing) == (one.model_id, one.preprocessing)
    assert (other.robots, other.sources) == (one.robots, one.sources)


def test_orientations_are_normalized_before_rotation() -> None:
    one = random_map(segments=1, frames=1)
    long = replace(one, frame_orientations=one.frame_orientations * np.float32(1.0009))
    long.check()
    norm = np.linalg.norm(moved(long, QUARTER, [0, 0, 0], "site").frame_orientations)
    assert norm == pytest.approx(1, abs=2e-7)


@pytest.mark.parametrize(
    ("rotation", "translation", "message"),
    [
        (np.eye(4), [0, 0, 0], "finite"),
        (np.eye(3) * 1.1, [0, 0, 0], "orthonormal"),
        (np.full((3, 3), np.nan), [0, 0, 0], "finite"),
        (np.diag([1, 1, np.inf]), [0, 0, 0], "finite"),
        (np.zeros((3, 3)), [0, 0, 0], "orthonormal"),
        (np.diag([1, 1, -1]), [0, 0, 0], "reflection"),
        (np.eye(3), [0, 0], "translation"),
        (np.eye(3), 0.0, "translation"),
        (np.eye(3), [0, 0, np.nan], "translation"),
        (np.eye(3), [0, 0, np.inf], "translation"),
    ],
)
def test_invalid_transform_is_refused(rotation: Any, translation: Any, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        moved(random_map(), rotation, translation, "site")


def told(compact_map: CompactMap) -> dict[int, tuple[str, int]]:
    """Return source and source id of each segment by its id."""
    assert compact_map.source is not None
    assert compact_map.source_ids is not None
    names = np.array(["", *compact_map.sources], object)[compact_map.source]
    whence = zip(names.tolist(), compact_map.source_ids.tolist(), strict=True)
    return dict(zip(compact_map.ids.tolist(), whence, strict=True))


@pytest.mark.slow
@given(maps(), st.sampled_from(["yard", "east"]))
def test_segment_keeps_its_first_source(one: CompactMap, name: str) -> None:
    before = told(one) if one.source is not None else {}
    after = originated(one, name)
    after.check()
    assert told(after) == {
        key: before[key] if before.get(key, ("", 0))[0] else (name, key) for key in one.ids.tolist()
    }
    bare = replace(after, source=None, source_ids=None, sources=())
    assert encode(bare) == encode(replace(one, source=None, source_ids=None, sources=()))
    assert encode(originated(after, "elsewhere")) == encode(after)


def test_merged_map_names_both_sources() -> None:
    yard, dock = random_map(segments=3), random_map(segments=2, seed=1)
    ids = np.array([1000, 1001], np.uint32)
    added = replace(originated(dock, "dock"), ids=ids)
    site = apply(originated(yard, "yard"), Delta(added, NOTHING))
    assert {*told(site).values()} == {
        *(("yard", key) for key in yard.ids.tolist()),
        *(("dock", key) for key in dock.ids.tolist()),
    }


def test_empty_map_has_no_sources() -> None:
    nothing = originated(random_map(segments=0), "yard")
    assert nothing.optional == PROVENANCE
    assert told(nothing) == {}


@pytest.mark.parametrize("name", ["", "a\nb", "n" * 201])
def test_invalid_source_name_is_refused(name: str) -> None:
    with pytest.raises(MapFileError, match="sources"):
        originated(random_map(), name)


def test_too_many_source_names_are_refused() -> None:
    full = replace(
        random_map(optional=PROVENANCE), sources=tuple(f"{number}" for number in range(65_535))
    )
    assert originated(full, "7").sources == full.sources
    with pytest.raises(MapFileError, match="sources: 65536 names; the limit is 65535"):
        originated(full, "another")
