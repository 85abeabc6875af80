import hashlib
import random as random_module
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import safetensors.numpy
from hypothesis import given
from hypothesis import strategies as st
from placecell_client import CompactMap, MapFileError, decode, encode
from placecell_client.maps.canonical import take
from placecell_client.maps.compact_map import OPTIONAL

from tests.client.file_surgery import inner_header, with_inner_header
from tests.client.map_builders import (
    COLUMN_SETS,
    GROUPS,
    PROVENANCE,
    maps,
    random_map,
)

SMALL = encode(random_map(segments=3, frames=2))
PROVENANCE_OF_3: dict[str, Any] = {
    "source": np.array([1, 2, 1], np.uint16),
    "source_ids": np.array([4, 4, 4], np.uint32),
    "sources": ("yard", "dock"),
}
MERGED = encode(random_map(segments=3, frames=2, optional=PROVENANCE))


def test_decoded_map_is_sorted_by_id() -> None:
    given_map = random_map(segments=50)
    back = decode(encode(given_map))
    order = np.argsort(given_map.ids)
    assert (back.model_id, back.preprocessing, back.frame) == (
        given_map.model_id,
        given_map.preprocessing,
        given_map.frame,
    )
    np.testing.assert_array_equal(back.ids, given_map.ids[order])
    np.testing.assert_array_equal(back.codes, given_map.codes[order])
    np.testing.assert_allclose(back.centroids, given_map.centroids[order], atol=0.0051)
    assert [back.robots[i] for i in back.robot] == [
        given_map.robots[i] for i in given_map.robot[order]
    ]
    frames, before = back.frame_index, given_map.frame_index[order]
    np.testing.assert_array_equal(back.frame_times[frames], given_map.frame_times[before])
    np.testing.assert_array_equal(back.frame_positions[frames], given_map.frame_positions[before])
    turned = back.frame_orientations[frames] * given_map.frame_orientations[before]
    np.testing.assert_allclose(np.abs(turned.sum(axis=1)), 1, atol=1e-6)
    assert back.time_span == given_map.time_span


def test_equal_maps_are_equal_files() -> None:
    one = random_map(segments=30, robots=("b", "a", "unused"))
    one = replace(one, robot=(one.robot % 2).astype(np.uint16))
    rows = np.random.default_rng(1).permutation(30)
    tables = np.array([4, 2, 0, 1, 3, 4])  # another order, with a duplicate capture
    other = replace(
        one,
        codes=one.codes[rows],
        centroids=one.centroids[rows],
        ids=one.ids[rows],
        robots=("a", "b"),
        robot=(1 - one.robot[rows]).astype(np.uint16),
        frame_index=np.array([2, 3, 1, 4, 5], np.uint32)[one.frame_index[rows]],
        frame_times=one.frame_times[tables],
        frame_positions=one.frame_positions[tables],
        frame_orientations=-one.frame_orientations[tables],
    )
    assert encode(one) == encode(other)
    assert encode(one) != encode(replace(one, frame="field"))


@given(
    segments=st.integers(0, 40),
    dimension=st.integers(1, 9),
    frames=st.integers(1, 6),
    extent=st.floats(0, 1e8),
    seed=st.integers(0, 1 << 32),
    optional=COLUMN_SETS,
)
def test_encoding_a_decoded_map_gives_the_same_bytes(
    segments: int, dimension: int, frames: int, extent: float, seed: int, optional: set[str]
) -> None:
    data = encode(random_map(segments, dimension, frames, extent, seed, optional=optional))
    assert encode(decode(data)) == data


@pytest.mark.slow
@given(maps())
def test_small_decoded_maps_give_the_same_bytes(given_map: CompactMap) -> None:
    data = encode(given_map)
    back = decode(data)
    assert encode(back) == data
    assert back.optional == given_map.optional


@pytest.mark.slow
@given(maps(st.just(set(OPTIONAL))), st.randoms(use_true_random=False))
def test_order_of_rows_and_tables_does_not_change_the_file(
    one: CompactMap, random: random_module.Random
) -> None:
    rows = random.sample(range(len(one)), len(one))
    frames = random.sample(range(len(one.frame_times)), len(one.frame_times))
    other = take(one, np.array(rows, np.intp))
    other = replace(
        other,
        frame_index=np.argsort(frames)[other.frame_index].astype(np.uint32),
        frame_times=one.frame_times[frames],
        frame_positions=one.frame_positions[frames],
        frame_orientations=-one.frame_orientations[frames],
        sources=(one.sources[2], *one.sources[:2]),
        source=np.array([0, 2, 3, 1], np.uint16)[other.source],
        frame_tracks=None if one.frame_tracks is None else one.frame_tracks[frames],
        frame_odometry=None if one.frame_odometry is None else one.frame_odometry[frames],
    )
    assert encode(one) == encode(other)


@pytest.mark.parametrize("names", GROUPS)
def test_optional_columns_are_decoded(names: tuple[str, ...]) -> None:
    given_map = random_map(segments=20, optional=names)
    back = decode(encode(given_map))
    assert back.optional == names
    for name in set(names) - {"source"}:
        given_column, column = getattr(given_map, name), getattr(back, name)
        np.testing.assert_array_equal(column, given_column[np.argsort(given_map.ids)])
        assert column.dtype == given_column.dtype


def test_provenance_is_decoded() -> None:
    one = replace(
        random_map(segments=4),
        ids=np.array([9, 3, 5, 7], np.uint32),
        sources=("west", "unused", "east"),
        source=np.array([3, 0, 1, 3], np.uint16),
        source_ids=np.array([70, 3, 70, 71], np.uint32),
    )
    back = decode(encode(one))
    assert back.ids.tolist() == [3, 5, 7, 9]
    assert back.sources == ("east", "west")
    assert back.source is not None
    assert back.source.dtype == np.uint16
    assert back.source.tolist() == [0, 2, 1, 1]
    assert back.source_ids is not None
    assert back.source_ids.tolist() == [3, 70, 71, 70]
    assert inner_header(encode(one))["sources"] == ["east", "west"]
    assert "sources" not in inner_header(SMALL)


def test_provenance_without_segments_is_decoded() -> None:
    back = decode(encode(random_map(segments=0, optional=PROVENANCE)))
    assert (back.optional, back.sources) == (PROVENANCE, ())


@pytest.mark.parametrize(
    ("optional", "each", "entries"),
    [
        (("extents",), 3, 1),
        (("points",), 2, 1),
        (("views",), 4, 1),
        (("seen",), 4, 1),
        (("classes",), 1, 1),
        (PROVENANCE, 6, 3),  # the source names are a third entry
    ],
)
def test_optional_column_has_the_documented_size(
    optional: tuple[str, ...], each: int, entries: int
) -> None:
    bare = encode(random_map(segments=10_000, dimension=32, frames=250))
    more = encode(random_map(segments=10_000, dimension=32, frames=250, optional=optional))
    assert 0 <= len(more) - len(bare) - 10_000 * each < 100 * entries


@pytest.mark.parametrize("extent", [0.0, 600.0, 1e6, 1.9e8])
def test_a_map_of_any_extent_keeps_centimeters(extent: float) -> None:
    given_map = random_map(segments=50, extent=extent)
    back = decode(encode(given_map))
    expected = np.rint(given_map.centroids[np.argsort(given_map.ids)] * 100) / 100
    np.testing.assert_array_equal(back.centroids, expected)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1, -1])
def test_segment_at_the_largest_distance_from_its_sensor_is_accepted(axis: int, sign: int) -> None:
    one = random_map(segments=1, frames=1)
    sensor = np.array([5e5, 5.4e6, 300.0])
    for offset, is_near in {327.67: True, 327.6749: True, 327.6751: False, 327.68: False}.items():
        centroid = sensor.copy()
        centroid[axis] += sign * offset
        placed = replace(one, centroids=centroid[None], frame_positions=sensor[None])
        if is_near:
            np.testing.assert_allclose(decode(encode(placed)).centroids[0], centroid, atol=0.00501)
        else:
            with pytest.raises(MapFileError, match=rf"segment {one.ids[0]} is 327.68 m .* {axis};"):
                encode(placed)


def test_removing_segments_does_not_round_a_map_again() -> None:
    once = decode(encode(random_map(segments=40, extent=600)))
    kept = slice(0, 25)
    less = replace(
        once,
        codes=once.codes[kept],
        centroids=once.centroids[kept],
        ids=once.ids[kept],
        robot=once.robot[kept],
        frame_index=once.frame_index[kept],
    )
    np.testing.assert_array_equal(decode(encode(less)).centroids, once.centroids[kept])


def test_at_most_48_bytes_a_segment() -> None:
    data = encode(random_map(segments=10_000, dimension=32, frames=250))
    assert len(data) / 10_000 <= 48


def test_file_bytes_equal_those_of_the_first_release() -> None:
    # Fixed values: maps stored today must stay readable.
    given_map = CompactMap(
        model_id="m-0",
        preprocessing="1",
        frame="yard",
        codes=np.array([[1, -2], [3, 127]], np.int8),
        centroids=np.array([[1.0, 2.0, 3.0], [-4.0, 5.5, 0.25]]),
        ids=np.array([7, 3], np.uint32),
        robots=("b", "a"),
        robot=np.array([0, 1], np.uint16),
        frame_index=np.array([0, 0], np.uint32),
        frame_times=np.array([12.5]),
        frame_positions=np.array([[0.0, 0.0, 1.73]]),
        frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
    )
    data = encode(given_map)
    assert len(data) == 910
    assert hashlib.sha256(data).hexdigest() == (
        "f9d725a982234553997ba8e79a806e4647693b07412822680e8e31050a03f3c4"
    )


def test_file_is_readable_by_the_safetensors_library() -> None:
    given_map = random_map(segments=9)
    columns = safetensors.numpy.load(encode(given_map))
    np.testing.assert_array_equal(columns["codes"], given_map.codes[np.argsort(given_map.ids)])
    assert columns["centroids"].dtype == np.int16
    header = inner_header(encode(given_map))
    sensors = np.rint(columns["frame_positions"] * 100)[columns["frame_index"]]
    meters = (sensors + columns["centroids"]) / 100
    np.testing.assert_allclose(meters, given_map.centroids[np.argsort(given_map.ids)], atol=0.0051)
    assert (header["count"], header["version"], header["scale_cm"]) == (9, 1, 1)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": "other"}, "format"),
        ({"version": 0}, "version 0; this program reads version 1"),
        ({"version": 2}, "version 2; this program reads version 1"),
        ({"version": False}, "version False"),
        ({"count": 4}, "canonical"),
        ({"extra": 1}, "canonical"),
        ({"robots": ["zoe", "ann"]}, "canonical"),
        ({"robots": ["ann"]}, "robot: index 1, but the table has 1"),
        ({"robots": ["ann", "ann"]}, "twice"),
        ({"robots": 7}, "wrong type"),
        ({"robots": [1, 2]}, "not a string"),
        ({"model_id": ""}, "model_id"),
        ({"model_id": None}, "not a string"),
        ({"frame": "a\nb"}, "printable"),
        ({"scale_cm": 0}, "scale_cm"),
        ({"scale_cm": "x"}, "scale_cm"),
        ({"scale_cm": True}, "scale_cm"),
        ({"scale_cm": 2}, "scale_cm is 2, expected 1"),
        ({"time_span_us": [0, 1]}, "canonical"),
    ],
)
def test_wrong_header_is_refused(changes: dict[str, object], message: str) -> None:
    assert with_inner_header(SMALL) == SMALL
    with pytest.raises(MapFileError, match=message):
        decode(with_inner_header(SMALL, **changes))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"sources": ["west", "east"]}, "canonical"),
        ({"sources": ["east", "unused", "west"]}, "canonical"),
        ({"sources": ["east"]}, "source: 2, but there are 1 names"),
        ({"sources": ["east", "east"]}, "sources: a name occurs twice"),
        ({"sources": ["east", ""]}, r"sources\[1\]: expected 1 to 200 printable"),
        ({"sources": ["east", "a\nb"]}, "printable"),
        ({"sources": ["east", "w" * 201]}, "printable"),
        ({"sources": "ew"}, "canonical"),
        ({"sources": None}, "wrong type"),
        ({"sources": [1, 2]}, "sources is not a string"),
        ({"sources": [["east"], "west"]}, "sources is not a string"),
    ],
)
def test_wrong_source_names_are_refused(changes: dict[str, object], message: str) -> None:
    assert inner_header(MERGED)["sources"] == ["east", "west"]
    assert with_inner_header(MERGED) == MERGED
    with pytest.raises(MapFileError, match=message):
        decode(with_inner_header(MERGED, **changes))


def test_source_names_and_columns_without_each_other_are_refused() -> None:
    with pytest.raises(
        MapFileError, match="sources: has names, but source and source_ids are missing"
    ):
        decode(with_inner_header(SMALL, sources=["east"]))
    with pytest.raises(MapFileError, match="canonical"):
        decode(with_inner_header(SMALL, sources=[]))
    with pytest.raises(MapFileError, match="source: 2, but there are 0 names"):
        decode(with_inner_header(MERGED, "sources"))
    own = encode(random_map(segments=0, optional=PROVENANCE))
    with pytest.raises(MapFileError, match="canonical"):
        decode(with_inner_header(own, "sources"))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"ids": np.array([1, 1, 2], np.uint32)}, "ids"),
        ({"ids": np.array([1, 2, 3], np.int64)}, "ids"),
        ({"ids": np.array(1, np.uint32)}, "ids"),
        ({"frame_times": np.array(1.0)}, "frame_times"),
        ({"codes": np.zeros((3, 65_536), np.int8)}, "codes"),
        ({"robot": np.array([0, 1, 2], np.uint16)}, "robot: index 2"),
        ({"frame_index": np.array([0, 1, 2], np.uint32)}, "frame_index: index 2"),
        ({"codes": np.zeros((3, 0), np.int8)}, "codes"),
        ({"codes": np.zeros((2, 4), np.int8)}, "codes"),
        ({"centroids": np.full((3, 3), np.nan)}, "centroids"),
        ({"centroids": np.full((3, 3), 2e8)}, "centroids"),
        ({"frame_times": np.array([0.0, np.inf])}, "frame_times"),
        ({"frame_times": np.array([0.0, 1.7e18])}, "frame_times"),
        ({"frame_positions": np.full((2, 3), -np.inf)}, "frame_positions"),
        ({"frame_orientations": np.zeros((2, 4), np.float32)}, "unit"),
        ({"frame_orientations": np.full((2, 4), np.nan, np.float32)}, "frame_orientations"),
        ({"robots": ("a", "a")}, "robots"),
        ({"robots": ("a", "\ud800")}, "printable"),
        ({"extents": np.zeros((3, 2), np.uint8)}, "extents"),
        ({"points": np.zeros(3, np.int64)}, "points"),
        ({"views": np.zeros(2, np.uint32)}, "views"),
        ({"seen": np.zeros(3)}, "seen"),
        ({"classes": np.zeros(3, np.int64)}, "classes: int64"),
        ({"classes": np.array([0, 249, 1], np.uint8)}, "classes: 249, expected 0 to 248"),
        ({"source": np.zeros(3, np.uint16)}, "expected both columns or neither"),
        ({"source_ids": np.zeros(3, np.uint32)}, "expected both columns or neither"),
        ({"sources": ("yard",)}, "sources: has names, but source and source_ids are missing"),
        (PROVENANCE_OF_3 | {"sources": ("yard",)}, "source: 2, but there are 1 names"),
        (PROVENANCE_OF_3 | {"sources": ("yard", "yard")}, "sources: a name occurs twice"),
        (PROVENANCE_OF_3 | {"sources": ("yard", "")}, r"sources\[1\]: expected"),
        (
            PROVENANCE_OF_3 | {"source": np.zeros(3, np.uint16)},
            "source_ids: expected the segment's own id",
        ),
        (PROVENANCE_OF_3 | {"source": np.ones(2, np.uint16)}, r"source: uint16 \(2,\)"),
        (PROVENANCE_OF_3 | {"source": np.ones(3, np.uint8)}, "source: uint8"),
        (PROVENANCE_OF_3 | {"source_ids": np.ones(3, np.int64)}, "source_ids: int64"),
    ],
)
def test_invalid_map_is_not_written(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(MapFileError, match=message):
        encode(replace(random_map(segments=3, frames=2), **changes))


def test_more_captures_than_uint16_use_uint32() -> None:
    frames = (1 << 16) + 1
    data = encode(random_map(segments=frames, dimension=1, frames=frames))
    assert safetensors.numpy.load(data)["frame_index"].dtype == np.uint32
    assert len(decode(data).frame_times) == frames
