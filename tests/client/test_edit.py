from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from placecell_client import CompactMap, Delta, MapFileError, decode, encode, encode_delta
from placecell_client.maps.compact_map import OPTIONAL
from placecell_client.maps.edit import (
    apply,
    compose,
    delta_between,
    difference,
    empty,
    is_same_kind,
    join,
    take,
    with_optional,
)
from placecell_client.maps.union import with_odometry

from tests.client.map_builders import (
    COLUMN_SETS,
    PROVENANCE,
    column_sets,
    deltas,
    maps,
    random_map,
)

NOTHING = np.zeros(0, np.uint32)
NARROW = column_sets(("extents",), ("seen",), PROVENANCE)
WIDE = column_sets(("points",)).map(lambda names: {"extents", "seen", *PROVENANCE, *names})


def plain(compact_map: CompactMap) -> dict[int, dict[str, Any]]:
    """Return the segments by id, each as a tuple of all its values."""
    segments = {}
    known = with_odometry(compact_map)
    assert known.frame_tracks is not None
    assert known.frame_odometry is not None
    odometry = np.column_stack([known.frame_tracks, known.frame_odometry + 0.0])
    for row, key in enumerate(compact_map.ids.tolist()):
        frame = compact_map.frame_index[row]
        turn = compact_map.frame_orientations[frame].astype(float) + 0.0
        last = [value for value in turn if value][-1]
        segments[key] = {
            "codes": compact_map.codes[row].tolist(),
            "centimetres": [round(value * 100) for value in compact_map.centroids[row].tolist()],
            "robot": compact_map.robots[compact_map.robot[row]],
            "time": float(compact_map.frame_times[frame]),
            "position": (compact_map.frame_positions[frame] + 0.0).tolist(),
            "orientation": (turn * np.sign(last) + 0.0).tolist(),
            "odometry": odometry[frame].tolist(),
        } | {name: getattr(compact_map, name)[row].tolist() for name in compact_map.optional}
        if compact_map.source is not None:
            segments[key]["source"] = ("", *compact_map.sources)[compact_map.source[row]]
    return segments


def applied(compact_map: CompactMap, delta: Delta) -> dict[int, dict[str, Any]]:
    """Compute the result of `apply` by hand."""
    segments = plain(compact_map)
    for key in delta.removed.tolist():
        segments.pop(key, None)
    segments |= plain(delta.changed)
    for key, segment in segments.items():
        defaults = {
            "extents": [0, 0, 0],
            "points": 0,
            "classes": 0,
            "missed": 0,
            "confirmed": 0,
            "absent": 0,
            "views": key,
            "seen": max(0, int(np.floor(segment["time"]))),
            "source": "",
            "source_ids": key,
        }
        for name in {*compact_map.optional, *delta.changed.optional}:
            segment.setdefault(name, defaults[name])
    return segments


@pytest.mark.slow
@given(maps(), deltas())
def test_apply_equals_a_computation_by_hand(compact_map: CompactMap, delta: Delta) -> None:
    after = apply(compact_map, delta)
    assert plain(after) == applied(compact_map, delta)
    assert encode(decode(encode(after))) == encode(after)
    assert set(after.optional) == {*compact_map.optional, *delta.changed.optional}


@pytest.mark.slow
@given(maps(), deltas())
def test_applying_a_delta_twice_changes_nothing(compact_map: CompactMap, delta: Delta) -> None:
    once = apply(compact_map, delta)
    assert encode(apply(once, delta)) == encode(once)


@pytest.mark.slow
@given(maps(NARROW), maps(WIDE))
def test_difference_turns_the_old_map_into_the_new(old: CompactMap, new: CompactMap) -> None:
    if old.has_odometry and not new.has_odometry:
        with pytest.raises(MapFileError, match="frame_odometry: a difference cannot remove"):
            difference(old, new)
        new = with_odometry(new)
    changed, removed = difference(old, new)
    assert encode(apply(old, Delta(changed, removed))) == encode(new)
    before, after = plain(with_optional(old, new.optional)), plain(new)
    assert plain(changed) == {
        key: segment for key, segment in after.items() if before.get(key) != segment
    }
    assert removed.tolist() == sorted(set(before) - set(after))


@pytest.mark.slow
@given(maps(), maps(), st.booleans(), st.integers(0, 2))
def test_delta_between_turns_any_map_into_the_new(
    old: CompactMap, new: CompactMap, is_other_model: bool, since: int
) -> None:
    if is_other_model:
        new = replace(new, model_id="n", codes=new.codes.repeat(2, axis=1))
    delta = delta_between(old, new, since, since + 1)
    assert encode(apply(old, delta)) == encode(new)
    is_told = not is_other_model and set(old.optional) <= set(new.optional)
    is_told &= new.has_odometry or not old.has_odometry
    assert delta.is_whole is not (since > 0 and is_told)
    assert delta.until == since + 1


@pytest.mark.slow
@given(maps())
def test_equal_maps_have_an_empty_difference(compact_map: CompactMap) -> None:
    changed, removed = difference(compact_map, decode(encode(compact_map)))
    assert (len(changed), len(removed)) == (0, 0)


@pytest.mark.slow
@given(maps(), deltas(since=1), deltas(since=2), deltas(since=3))
def test_composed_deltas_equal_both_in_turn(
    compact_map: CompactMap, first: Delta, second: Delta, third: Delta
) -> None:
    in_turn = apply(apply(apply(compact_map, first), second), third)
    left = compose(compose(first, second), third)
    right = compose(first, compose(second, third))
    assert encode(apply(compact_map, left)) == encode(in_turn)
    assert encode_delta(left) == encode_delta(right)
    assert (left.since, left.until) == (1, 4)


@pytest.mark.slow
@given(maps(), maps(), deltas(since=5))
def test_compose_after_a_whole_map_gives_a_whole_map(
    compact_map: CompactMap, other: CompactMap, delta: Delta
) -> None:
    whole = Delta(compact_map, NOTHING, 0, 5)
    both = compose(whole, delta)
    assert both.is_whole
    assert encode(apply(other, both)) == encode(apply(compact_map, delta))
    again = compose(delta, Delta(other, NOTHING, 0, 7))
    assert encode_delta(again) == encode_delta(Delta(other, NOTHING, 0, 7))


def test_deltas_that_are_not_consecutive_are_not_composed() -> None:
    one = Delta(random_map(), NOTHING, 1, 2)
    with pytest.raises(MapFileError, match="since version 3 does not follow one until version 2"):
        compose(one, replace(one, since=3, until=4))


@pytest.mark.slow
@given(maps(COLUMN_SETS), st.integers(1, 4))
def test_parts_of_a_delta_are_joined(compact_map: CompactMap, count: int) -> None:
    removed = np.arange(20, 30, dtype=np.uint32)
    whole = Delta(compact_map, removed, 2, 7)
    parts = [
        Delta(take(compact_map, slice(part, None, count)), removed[part::count], 2, 7)
        for part in range(count)
    ]
    assert encode_delta(join(parts[::-1])) == encode_delta(whole)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"until": 8}, "parts"),
        ({"changed": random_map(segments=4, seed=1)}, "occurs twice"),
        ({"removed": np.array([50, 90], np.uint32)}, "ascend"),
        ({"removed": random_map(segments=4).ids[:1]}, "also in changed"),
        ({"changed": random_map(segments=0, dimension=5)}, "code_bytes"),
    ],
)
def test_parts_of_different_deltas_are_not_joined(changes: dict[str, Any], message: str) -> None:
    first = Delta(random_map(segments=4), np.array([50], np.uint32), 2, 7)
    second = replace(Delta(random_map(segments=0), NOTHING, 2, 7), **changes)
    with pytest.raises(MapFileError, match=message):
        join([first, second])


def test_join_of_no_parts_is_refused() -> None:
    with pytest.raises(MapFileError, match="parts"):
        join([])


@pytest.mark.parametrize(
    "changes",
    [
        {"model_id": "other"},
        {"preprocessing": "2"},
        {"frame": "field"},
        {"codes": np.zeros((20, 5), np.int8)},
    ],
)
def test_segments_of_another_kind_are_refused(changes: dict[str, Any]) -> None:
    one = random_map()
    other = replace(one, **changes)
    what = next(iter(changes)).replace("codes", "code_bytes")
    assert not is_same_kind(one, other)
    with pytest.raises(MapFileError, match=f"{what}: the maps have"):
        apply(one, Delta(other, NOTHING))
    with pytest.raises(MapFileError, match=what):
        difference(one, other)
    with pytest.raises(MapFileError, match=what):
        delta_between(one, other, 0, 0)


def test_difference_that_removes_a_column_is_refused() -> None:
    with pytest.raises(MapFileError, match="points: a difference cannot"):
        difference(random_map(optional=("points",)), random_map())


def test_invalid_delta_is_not_applied() -> None:
    broken = replace(random_map(), frame_index=np.full(20, 9, np.uint32))
    with pytest.raises(MapFileError, match="index 9"):
        apply(random_map(), Delta(broken, NOTHING))


def test_too_many_robots_are_refused() -> None:
    one = random_map(robots=tuple(f"a{number}" for number in range(40_000)))
    other = replace(one, robots=tuple(f"b{number}" for number in range(40_000)))
    with pytest.raises(MapFileError, match="80000 names; the limit is 65536"):
        apply(one, Delta(other, NOTHING))


def test_too_many_sources_are_refused() -> None:
    one = replace(
        random_map(optional=PROVENANCE), sources=tuple(f"a{number}" for number in range(40_000))
    )
    other = replace(one, sources=tuple(f"b{number}" for number in range(40_000)))
    with pytest.raises(MapFileError, match="sources: 80000 names; the limit is 65535"):
        apply(one, Delta(other, NOTHING))


def test_largest_number_of_sources_is_accepted() -> None:
    n = 65_535
    one = replace(
        random_map(segments=n, dimension=1, optional=PROVENANCE),
        sources=tuple(f"{number:05}" for number in range(n)),
        source=np.arange(n, 0, -1).astype(np.uint16),
    )
    halves = [take(one, slice(0, n, 2)), take(one, slice(1, n, 2))]
    back = join([Delta(half, NOTHING) for half in halves]).changed
    assert back.source is not None
    assert back.source.tolist() == one.source[np.argsort(one.ids)].tolist()  # type: ignore[index]
    assert back.sources == one.sources


def test_difference_compares_sources_by_name() -> None:
    one = replace(
        random_map(segments=3),
        ids=np.array([1, 2, 3], np.uint32),
        sources=("west", "east"),
        source=np.array([0, 1, 2], np.uint16),
        source_ids=np.array([1, 8, 8], np.uint32),
    )
    same = replace(one, sources=("east", "west"), source=np.array([0, 2, 1], np.uint16))
    assert len(difference(one, same)[0]) == 0
    renamed = replace(one, sources=("north", "east"))
    assert difference(one, renamed)[0].ids.tolist() == [2]
    assert difference(one, renamed)[0].sources == ("north",)
    bare = replace(one, source=None, source_ids=None, sources=())
    assert difference(bare, one)[0].ids.tolist() == [2, 3]
    after = apply(one, Delta(take(bare, np.array([1])), NOTHING))
    assert after.source is not None
    assert (after.source.tolist(), after.sources) == ([0, 0, 1], ("east",))


def test_missing_columns_get_their_defaults() -> None:
    given_map = replace(
        random_map(segments=4, frames=4), frame_times=np.array([-3.5, 1.9, 1.7e9 + 0.5, 8e9])
    )
    filled = with_optional(given_map, OPTIONAL)
    assert filled.extents is not None
    assert filled.points is not None
    assert filled.views is not None
    assert filled.seen is not None
    assert filled.extents.tolist() == [[0, 0, 0]] * 4
    assert filled.points.tolist() == [0] * 4
    assert filled.classes is not None
    assert filled.classes.tolist() == [0] * 4
    assert filled.views.tolist() == given_map.ids.tolist()
    assert filled.seen.tolist() == [0, 1, 1_700_000_000, (1 << 32) - 1]
    assert filled.source is not None
    assert filled.source_ids is not None
    assert (filled.source.tolist(), filled.sources) == ([0] * 4, ())
    assert filled.source_ids.tolist() == given_map.ids.tolist()
    assert with_optional(filled, OPTIONAL).optional == filled.optional == tuple(OPTIONAL)
    filled.check()


def test_empty_map_has_the_asked_columns() -> None:
    nothing = empty("tiny-0123456789abcdef", "1", "town", 4, ("points",))
    assert len(decode(encode(nothing))) == 0
    given_map = random_map()
    assert encode(apply(nothing, Delta(given_map, NOTHING))) == encode(
        with_optional(given_map, ("points",))
    )


@pytest.mark.parametrize("rows", [np.array([3, 1]), slice(1, 4), np.arange(20) % 7 == 0])
def test_take_selects_segments(rows: Any) -> None:
    given_map = random_map(optional=OPTIONAL)
    some = take(given_map, rows)
    everything = plain(given_map)
    assert plain(some) == {key: everything[key] for key in given_map.ids[rows].tolist()}
