import hashlib
import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
import safetensors.numpy
from hypothesis import given
from hypothesis import strategies as st
from placecell_client import CompactMap, MapFileError, decode, encode
from placecell_client.compact_map import OPTIONAL

from tests.client.map_builders import random_map

SMALL = encode(random_map(segments=3, frames=2))


def header_length(data: bytes) -> int:
    return 8 + int.from_bytes(data[:8], "little")


def inner_header(data: bytes) -> dict[str, Any]:
    outer = json.loads(data[8 : header_length(data)])
    inner: dict[str, Any] = json.loads(outer["__metadata__"]["placecell"])
    return inner


def with_inner_header(data: bytes, **changes: object) -> bytes:
    """The file with other values in its header, and a checksum that fits them."""
    length = header_length(data)
    outer = json.loads(data[8:length])
    header = json.loads(outer["__metadata__"]["placecell"]) | changes
    header.pop("sha256")
    digest = hashlib.sha256(json.dumps(header, sort_keys=True, separators=(",", ":")).encode())
    for name in sorted(set(outer) - {"__metadata__"}):
        entry = outer[name]
        shape = ",".join(map(str, entry["shape"]))
        digest.update(f"\n{name} {entry['dtype']} {shape}\n".encode())
        begin, end = entry["data_offsets"]
        digest.update(data[length + begin : length + end])
    header["sha256"] = digest.hexdigest()
    outer["__metadata__"]["placecell"] = json.dumps(header, sort_keys=True, separators=(",", ":"))
    text = json.dumps(outer, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    return len(text).to_bytes(8, "little") + text + data[length:]


def test_a_map_comes_back_sorted_by_id() -> None:
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
    tables = np.array([4, 2, 0, 1, 3, 4])  # another order, and a frame twice
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
    optional=st.sets(st.sampled_from(list(OPTIONAL))),
)
def test_encoding_what_was_decoded_changes_nothing(
    segments: int, dimension: int, frames: int, extent: float, seed: int, optional: set[str]
) -> None:
    data = encode(random_map(segments, dimension, frames, extent, seed, optional=optional))
    assert encode(decode(data)) == data


@pytest.mark.parametrize("extent", [0.0, 600.0, 1e6, 1.9e8])
def test_a_map_of_any_extent_keeps_centimetres(extent: float) -> None:
    given_map = random_map(segments=50, extent=extent)
    back = decode(encode(given_map))
    expected = np.rint(given_map.centroids[np.argsort(given_map.ids)] * 100) / 100
    np.testing.assert_array_equal(back.centroids, expected)


@pytest.mark.parametrize("axis", [0, 1, 2])
@pytest.mark.parametrize("sign", [1, -1])
def test_segments_at_the_limit_from_their_sensor(axis: int, sign: int) -> None:
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


def test_a_map_that_loses_segments_is_not_rounded_again() -> None:
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


def test_the_bytes_are_those_of_the_first_release() -> None:
    # Fixed values, no random ones: maps stored today must be readable for ever.
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


def test_other_readers_of_safetensors_can_read_it() -> None:
    given_map = random_map(segments=9)
    columns = safetensors.numpy.load(encode(given_map))
    np.testing.assert_array_equal(columns["codes"], given_map.codes[np.argsort(given_map.ids)])
    assert columns["centroids"].dtype == np.int16
    header = inner_header(encode(given_map))
    sensors = np.rint(columns["frame_positions"] * 100)[columns["frame_index"]]
    metres = (sensors + columns["centroids"]) / 100
    np.testing.assert_allclose(metres, given_map.centroids[np.argsort(given_map.ids)], atol=0.0051)
    assert (header["count"], header["version"], header["scale_cm"]) == (9, 1, 1)


def test_every_flipped_bit_is_found() -> None:
    for bit in range(len(SMALL) * 8):
        damaged = bytearray(SMALL)
        damaged[bit // 8] ^= 1 << bit % 8
        with pytest.raises(MapFileError):
            decode(bytes(damaged))


def test_an_altered_code_is_told_by_the_checksum() -> None:
    with pytest.raises(MapFileError, match="SHA-256"):
        decode(SMALL[:-1] + bytes([SMALL[-1] ^ 1]))


def test_every_cut_is_found() -> None:
    for length in range(len(SMALL)):
        with pytest.raises(MapFileError):
            decode(SMALL[:length])


def test_trailing_bytes_are_refused() -> None:
    with pytest.raises(MapFileError, match="too long"):
        decode(SMALL + b"\0")


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": "other"}, "format"),
        ({"version": 0}, "version 0; this program reads 1"),
        ({"version": 2}, "version 2; this program reads 1"),
        ({"version": False}, "version False"),
        ({"count": 4}, "canonical"),
        ({"extra": 1}, "canonical"),
        ({"robots": ["zoe", "ann"]}, "canonical"),
        ({"robots": ["ann"]}, "robot: index 1 in a table of 1"),
        ({"robots": ["ann", "ann"]}, "twice"),
        ({"robots": 7}, "wrong type"),
        ({"robots": [1, 2]}, "not a text"),
        ({"model_id": ""}, "model_id"),
        ({"model_id": None}, "not a text"),
        ({"frame": "a\nb"}, "printable"),
        ({"scale_cm": 0}, "scale_cm"),
        ({"scale_cm": "x"}, "scale_cm"),
        ({"scale_cm": True}, "scale_cm"),
        ({"scale_cm": 2}, "scale_cm is 2; this program reads 1"),
        ({"time_span_us": [0, 1]}, "canonical"),
    ],
)
def test_a_header_that_lies_is_refused(changes: dict[str, object], message: str) -> None:
    assert with_inner_header(SMALL) == SMALL
    with pytest.raises(MapFileError, match=message):
        decode(with_inner_header(SMALL, **changes))


def test_a_header_that_claims_a_huge_table_allocates_nothing() -> None:
    length = header_length(SMALL)
    outer = json.loads(SMALL[8:length])
    outer["codes"] = {"dtype": "I8", "shape": [1 << 40, 4], "data_offsets": [0, 1 << 42]}
    text = json.dumps(outer).encode()
    with pytest.raises(MapFileError, match="cut short"):
        decode(len(text).to_bytes(8, "little") + text + SMALL[length:])
    with pytest.raises(MapFileError, match="cut short"):
        decode((1 << 62).to_bytes(8, "little") + SMALL[8:])


@pytest.mark.parametrize(
    ("name", "dtype"), [("codes", np.uint8), ("ids", np.int64), ("centroids", np.float16)]
)
def test_columns_of_a_wrong_type_are_refused(name: str, dtype: type) -> None:
    columns = safetensors.numpy.load(SMALL)
    metadata = json.loads(SMALL[8 : header_length(SMALL)])["__metadata__"]
    wrong = columns | {name: columns[name].astype(dtype)}
    with pytest.raises(MapFileError, match=name):
        decode(safetensors.numpy.save(wrong, metadata))
    del wrong[name]
    with pytest.raises(MapFileError, match="columns"):
        decode(safetensors.numpy.save(wrong, metadata))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"ids": np.array([1, 1, 2], np.uint32)}, "ids"),
        ({"ids": np.array([1, 2, 3], np.int64)}, "ids"),
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
    ],
)
def test_maps_that_are_not_valid_are_not_written(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(MapFileError, match=message):
        encode(replace(random_map(segments=3, frames=2), **changes))


def test_more_frames_than_an_uint16_counts() -> None:
    frames = (1 << 16) + 1
    data = encode(random_map(segments=frames, dimension=1, frames=frames))
    assert safetensors.numpy.load(data)["frame_index"].dtype == np.uint32
    assert len(decode(data).frame_times) == frames


@given(st.binary(max_size=300))
def test_random_bytes_are_refused(data: bytes) -> None:
    with pytest.raises(MapFileError):
        decode(data)


@given(
    place=st.integers(0, len(SMALL) - 1),
    cut=st.integers(0, 12),
    insert=st.binary(max_size=12),
)
def test_mutated_files_are_refused(place: int, cut: int, insert: bytes) -> None:
    mutated = SMALL[:place] + insert + SMALL[place + cut :]
    if mutated == SMALL:
        assert encode(decode(mutated)) == SMALL
    else:
        with pytest.raises(MapFileError):
            decode(mutated)


@given(st.text(max_size=40) | st.just("[" * 100_000) | st.just("9" * 5_000))
def test_headers_of_any_text_are_refused(text: str) -> None:
    header = text.encode(errors="replace")
    with pytest.raises(MapFileError):
        decode(len(header).to_bytes(8, "little") + header + SMALL[header_length(SMALL) :])
