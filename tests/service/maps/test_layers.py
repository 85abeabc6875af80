"""Layers: they equal the map after all edits, before and after flattening."""

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from placecell_client import CompactMap, Delta, encode, encode_delta, originated
from placecell_client.maps.edit import apply, empty

from placecell.descriptors.quantizer import Quantizer
from service.maps.index import LayeredIndex, index_of
from service.maps.layers import MapLayers, robots_of
from tests.service.service_builders import map_of

QUANTIZER = Quantizer(0.1)
NOTHING = empty("m", "1", "town", 7)


def segments(ids: list[int], value: int = 0, robot: str = "ann", source: str = "") -> CompactMap:
    """Return segments with these ids, whose codes contain id and value."""
    codes = np.zeros((len(ids), 7), np.int8)
    codes[:, 0], codes[:, 1] = ids, value
    made = replace(map_of(codes, "m", robot=robot), ids=np.array(ids, np.uint32))
    if source:
        made = originated(made, source)
    return apply(NOTHING, Delta(made, np.zeros(0, np.uint32)))


def edit(
    ids: list[int], removed: list[int], value: int, robot: str = "ann", source: str = ""
) -> Delta:
    changed = segments(ids, value, robot, source)
    return Delta(changed, np.array(sorted({*removed} - {*ids}), np.uint32))


IDS = st.lists(st.integers(0, 12), unique=True)
EDITS = st.lists(
    st.builds(
        edit,
        IDS,
        IDS,
        st.integers(0, 2),
        st.sampled_from(["ann", "zoe"]),
        st.sampled_from(["", "east", "west"]),
    ),
    max_size=8,
)
STARTS = IDS.map(sorted).map(segments)


@pytest.mark.slow
@given(STARTS, EDITS)
@settings(max_examples=200, deadline=None)
def test_layers_equal_edits_applied_one_by_one(start: CompactMap, edits: list[Delta]) -> None:
    layers, expected = MapLayers.of(start), start
    for each in edits:
        layers, expected = layers.after(each), apply(expected, each)
        assert encode(layers.content()) == encode(expected)
    assert len(layers) == len(expected)
    assert layers.ids.tolist() == expected.ids.tolist()
    assert layers.robots == robots_of(expected)
    places = [] if expected.source is None else expected.source.tolist()
    assert layers.sources == Counter(expected.sources[place - 1] for place in places if place)
    assert layers.time_span == expected.time_span
    wanted = np.arange(0, 20, 3, dtype=np.uint32)
    rows = np.flatnonzero(np.isin(expected.ids, wanted))
    found = layers.take(wanted)
    assert found.ids.tolist() == expected.ids[rows].tolist()
    assert found.codes.tolist() == expected.codes[rows].tolist()


@pytest.mark.slow
@given(STARTS, EDITS, EDITS)
@settings(max_examples=200, deadline=None)
def test_rebased_layers_are_the_same_map(
    start: CompactMap, first: list[Delta], then: list[Delta]
) -> None:
    before = MapLayers.of(start)
    for each in first:
        before = before.after(each)
    after = before
    for each in then:
        after = after.after(each)
    folded = after.rebased(before.content(), before)
    assert encode(folded.content()) == encode(after.content())
    assert len(folded) == len(after)


@pytest.mark.slow
@given(STARTS, EDITS, EDITS.filter(len))
@settings(max_examples=200, deadline=None)
def test_effect_of_an_edit_is_all_that_it_changes(
    start: CompactMap, edits: list[Delta], asked: list[Delta]
) -> None:
    layers = MapLayers.of(start)
    for each in edits:
        layers = layers.after(each)
    change = layers.effect_of(asked[0])
    effect, after = change.delta, layers.after(asked[0])
    assert encode(layers.after(effect).content()) == encode(after.content())
    assert change.is_empty == (encode(after.content()) == encode(layers.content()))
    # The segments before are those of the map that the delta replaces or removes.
    assert {*change.before.ids} == {*effect.removed} | ({*effect.changed.ids} & {*layers.ids})
    assert after.effect_of(asked[0]).is_empty


@given(STARTS, EDITS, EDITS)
@settings(max_examples=100, deadline=None)
def test_change_to_another_content_is_found_by_one_comparison(
    start: CompactMap, edits: list[Delta], others: list[Delta]
) -> None:
    layers = MapLayers.of(start)
    for each in edits:
        layers = layers.after(each)
    other = layers
    for each in others:
        other = other.after(each)
    change = layers.change_to(other.content(), 3)
    assert encode(layers.after(change.delta).content()) == encode(other.content())
    assert change.is_empty == (encode(other.content()) == encode(layers.content()))
    # The change has no entries without effect.
    again = layers.effect_of(change.delta)
    assert encode_delta(again.delta) == encode_delta(change.delta)
    assert again.before.ids.tolist() == change.before.ids.tolist()


@pytest.mark.slow
@given(STARTS, EDITS, st.integers(1, 15))
@settings(max_examples=100, deadline=None)
def test_search_over_layers_equals_search_of_flat_map(
    start: CompactMap, edits: list[Delta], k: int
) -> None:
    layers = MapLayers.of(start)
    for each in edits:
        layers = layers.after(each)
    flat = layers.content()
    queries = segments(list(range(13)), 1).codes
    distances, rows = LayeredIndex.of(layers, QUANTIZER).search(layers, queries, k)
    expected, places = index_of(flat.codes, QUANTIZER).search(queries, k)
    np.testing.assert_array_equal(distances, expected)
    np.testing.assert_array_equal(layers.column("ids", rows), flat.ids[places])
    np.testing.assert_array_equal(layers.column("centroids", rows), flat.centroids[places])
    names = np.array(flat.robots or ("",), dtype=object)[flat.robot[places]]
    np.testing.assert_array_equal(layers.robot_names(rows), names)


def test_optional_columns_of_an_edit_are_added_to_the_map() -> None:
    start = MapLayers.of(segments([1, 2, 3]))
    seen = replace(segments([2, 9]), seen=np.array([7, 8], np.uint32))
    after = start.after(Delta(seen, np.zeros(0, np.uint32)))
    assert after.optional == {"seen"}
    assert after.content().seen is not None
    assert dict(zip(*(column.tolist() for column in after.last_seen()), strict=True)) == {
        1: 1_700_000_000,
        2: 7,
        3: 1_700_000_000,
        9: 8,
    }
    # An edit without the column gets its default values.
    plain = Delta(segments([9], 5), np.zeros(0, np.uint32))
    effect = after.effect_of(plain).delta
    assert effect.changed.seen is not None
    assert effect.changed.seen.tolist() == [1_700_000_000]
    # A new column alone is a change, once.
    nothing = Delta(replace(NOTHING, seen=np.zeros(0, np.uint32)), np.zeros(0, np.uint32))
    assert not start.effect_of(nothing).is_empty
    assert after.effect_of(nothing).is_empty


def test_whole_delta_replaces_the_map() -> None:
    start = MapLayers.of(segments([1, 2, 3], robot="zoe"))
    other = replace(segments([5]), model_id="another")
    whole = Delta(other, np.zeros(0, np.uint32), 0, 9)
    change = start.effect_of(whole)
    assert change.before.ids.tolist() == [1, 2, 3]
    assert not change.is_empty
    after = start.after(change.delta)
    assert (after.base.model_id, after.ids.tolist()) == ("another", [5])
    assert after.robots == Counter(ann=1)


def test_capture_positions_are_those_of_each_layer() -> None:
    base, above = segments([1, 2, 3]), edit([2, 7], [], value=1)
    base = replace(base, frame_positions=base.frame_positions + 5.0)
    above = replace(above, changed=replace(above.changed, frame_positions=np.full((1, 3), 9.0)))
    layers = MapLayers.of(base).after(above)
    rows = np.array([[0, 2], [3, 4]])
    positions = layers.capture_positions(rows)
    assert positions.shape == (2, 2, 3)
    assert positions[..., 0].tolist() == [[5.0, 5.0], [9.0, 9.0]]
    assert layers.capture_positions(rows[0]).tolist() == [[5.0] * 3, [5.0] * 3]


def test_heights_come_from_the_boxes_of_both_layers() -> None:
    """A stored 4 stands for more than 0.3 m and at most 0.4 m; 0 is unknown, as is no column."""
    boxed = replace(segments([1, 2]), extents=np.array([[9, 9, 4], [0, 0, 0]], np.uint8))
    added = Delta(segments([5]), np.zeros(0, np.uint32))
    layers = MapLayers.of(boxed).after(added)
    np.testing.assert_allclose(layers.heights(np.array([2, 0, 1])), [np.nan, 0.35, np.nan])
    plain = MapLayers.of(segments([1, 2]))
    assert np.isnan(plain.heights(np.array([1, 0]))).all()
    assert plain.heights(np.zeros(0, np.int64)).shape == (0,)
