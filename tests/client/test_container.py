"""Invalid map and delta files are refused before memory is allocated."""

import tracemalloc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
import safetensors.numpy
from hypothesis import given
from hypothesis import strategies as st
from placecell_client import Delta, MapFileError, decode, decode_delta, encode, encode_delta
from placecell_client.maps import container
from placecell_client.maps.compact_map import OPTIONAL
from placecell_client.maps.container import HEADER_LIMIT, Content

from tests.client.file_surgery import header_length, outer_header, with_outer_header
from tests.client.map_builders import PROVENANCE, random_map


@dataclass(frozen=True)
class Kind:
    """Kind of file with an example, its reader and its writer."""

    data: bytes
    decode: Callable[[bytes], Any]
    encode: Callable[[Any], bytes]


BARE = random_map(segments=3, frames=2)
FULL = random_map(segments=3, frames=2, optional=OPTIONAL)
GONE = np.array([100, 200], np.uint32)
KINDS = {
    "map": Kind(encode(BARE), decode, encode),
    "map-all-columns": Kind(encode(FULL), decode, encode),
    "delta": Kind(encode_delta(Delta(BARE, GONE, 3, 4)), decode_delta, encode_delta),
    "delta-all-columns": Kind(encode_delta(Delta(FULL, GONE)), decode_delta, encode_delta),
}
each_kind = pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)


def content_of(data: bytes) -> Content:
    """Return the content of a file without checks."""
    inner = container._json(outer_header(data)["__metadata__"]["placecell"].encode(), NOTHING)
    inner.pop("sha256")
    return Content(inner, safetensors.numpy.load(data))


TYPES = {
    "F64": "<f8", "F32": "<f4", "U32": "<u4", "U16": "<u2", "I16": "<i2", "U8": "u1", "I8": "i1"
}  # fmt: skip
NOTHING = container.FileFormat("x", "x", 0, frozenset(), frozenset())


@contextmanager
def little_memory() -> Iterator[None]:
    """Check that less than a megabyte is allocated."""
    tracemalloc.start()
    try:
        yield
        assert tracemalloc.get_traced_memory()[1] < 1 << 20
    finally:
        tracemalloc.stop()


@pytest.mark.slow
@each_kind
def test_flipped_bit_is_refused(kind: Kind) -> None:
    for bit in range(len(kind.data) * 8):
        damaged = bytearray(kind.data)
        damaged[bit // 8] ^= 1 << bit % 8
        with pytest.raises(MapFileError):
            kind.decode(bytes(damaged))


@each_kind
def test_altered_code_fails_the_checksum(kind: Kind) -> None:
    with pytest.raises(MapFileError, match="SHA-256"):
        kind.decode(kind.data[:-1] + bytes([kind.data[-1] ^ 1]))


@each_kind
def test_truncated_file_is_refused(kind: Kind) -> None:
    for length in range(len(kind.data)):
        with pytest.raises(MapFileError):
            kind.decode(kind.data[:length])


@each_kind
def test_trailing_bytes_are_refused(kind: Kind) -> None:
    with pytest.raises(MapFileError, match="too long"):
        kind.decode(kind.data + b"\0")


@each_kind
def test_header_with_a_huge_table_allocates_nothing(kind: Kind) -> None:
    huge = {"dtype": "I8", "shape": [1 << 40, 4], "data_offsets": [0, 1 << 42]}
    claims = with_outer_header(kind.data, outer_header(kind.data) | {"codes": huge})
    with little_memory():
        with pytest.raises(MapFileError, match="is cut"):
            kind.decode(claims)
        with pytest.raises(MapFileError, match="is cut"):
            kind.decode((1 << 62).to_bytes(8, "little") + kind.data[8:])


@each_kind
def test_too_long_header_is_not_parsed(kind: Kind) -> None:
    long = b"[" + b"{}," * (HEADER_LIMIT // 3) + b"{}]"
    data = len(long).to_bytes(8, "little") + long
    with little_memory(), pytest.raises(MapFileError, match="the limit is 1048576"):
        kind.decode(data)


def test_header_with_too_many_sources_is_not_written() -> None:
    n = 6000
    crowd = replace(
        random_map(segments=n, optional=PROVENANCE),
        sources=tuple(f"{number:0200}" for number in range(n)),
        source=np.arange(1, n + 1, dtype=np.uint16),
    )
    with pytest.raises(MapFileError, match="names of maps and robots; the limit is 1048576"):
        encode(crowd)


def test_too_long_header_is_not_written() -> None:
    names = tuple(f"{number:0200}" for number in range(6000))
    crowd = random_map(segments=6000, robots=names)
    with pytest.raises(MapFileError, match="robots; the limit is 1048576"):
        encode(crowd)


@each_kind
@pytest.mark.parametrize(
    ("name", "dtype"), [("codes", np.uint8), ("ids", np.int64), ("centroids", np.float16)]
)
def test_columns_of_a_wrong_type_are_refused(kind: Kind, name: str, dtype: type) -> None:
    columns = safetensors.numpy.load(kind.data)
    metadata = outer_header(kind.data)["__metadata__"]
    wrong = columns | {name: columns[name].astype(dtype)}
    with pytest.raises(MapFileError, match=name):
        kind.decode(safetensors.numpy.save(wrong, metadata))
    del wrong[name]
    with pytest.raises(MapFileError, match="columns"):
        kind.decode(safetensors.numpy.save(wrong, metadata))
    with pytest.raises(MapFileError, match="columns"):
        kind.decode(safetensors.numpy.save(columns | {"more": columns["ids"]}, metadata))


@each_kind
@pytest.mark.parametrize(
    ("name", "shape"),
    [
        ("frame_positions", (2, 1, 1)),  # NumPy would broadcast it to all pairs of segments
        ("frame_positions", (2,)),
        ("frame_positions", (2, 4)),
        ("frame_positions", ()),
        ("frame_times", (3,)),
        ("frame_orientations", (2, 3)),
        ("ids", (1,)),
        ("ids", ()),
        ("ids", (3, 1)),
        ("frame_index", ()),
        ("frame_index", (1,)),
        ("frame_index", (3, 3)),
        ("centroids", (3, 2)),
        ("centroids", (1, 3)),
        ("centroids", (3,)),
        ("robot", (3, 1)),
        ("robot", (4,)),
        ("codes", (3,)),
        ("codes", (3, 0)),
        ("codes", (3, 4, 1)),
        ("codes", (3, 65_536)),
    ],
)
def test_columns_of_a_wrong_shape_are_refused(
    kind: Kind, name: str, shape: tuple[int, ...]
) -> None:
    content = content_of(kind.data)
    column = np.zeros(shape, content.columns[name].dtype)
    with pytest.raises(MapFileError):
        kind.decode(container.write(Content(content.header, content.columns | {name: column})))


@each_kind
@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("frame_positions", np.nan),
        ("frame_positions", np.inf),
        ("frame_positions", 1e308),
        ("frame_times", -np.inf),
        ("frame_orientations", np.nan),
        ("frame_index", 2),
        ("robot", 2),
        ("centroids", -32_768),
    ],
)
def test_impossible_values_are_refused(kind: Kind, name: str, value: float) -> None:
    content = content_of(kind.data)
    column = np.full_like(content.columns[name], value)
    with pytest.raises(MapFileError, match=name):
        kind.decode(container.write(Content(content.header, content.columns | {name: column})))


@pytest.mark.parametrize("kind", [KINDS["map-all-columns"], KINDS["delta-all-columns"]])
def test_impossible_sources_are_refused(kind: Kind) -> None:
    content = content_of(kind.data)
    source, ids = content.columns["source"], content.columns["source_ids"]
    for changed, message in [
        ({"source": np.full_like(source, 65_535)}, "source: 65535, but there are 2 names"),
        ({"source": np.zeros_like(source)}, "source_ids: expected the segment's own id"),
        ({"source": source.astype("u1")}, "source: expected type U16"),
        ({"source_ids": ids.astype("<f4")}, "source_ids: expected type U32"),
    ]:
        data = container.write(Content(content.header, content.columns | changed))
        with pytest.raises(MapFileError, match=message):
            kind.decode(data)
    for name in ("source", "source_ids"):
        columns = {key: column for key, column in content.columns.items() if key != name}
        with pytest.raises(MapFileError, match="expected both columns or neither"):
            kind.decode(container.write(Content(content.header, columns)))


@each_kind
@pytest.mark.parametrize("name", ["ids", "frame_times", "frame_orientations"])
def test_files_in_another_form_are_refused(kind: Kind, name: str) -> None:
    content = content_of(kind.data)
    column = content.columns[name]
    other = -column if name == "frame_orientations" else column[::-1]
    with pytest.raises(MapFileError, match=r"canonical|source_ids: expected the segment's own id"):
        kind.decode(container.write(Content(content.header, content.columns | {name: other})))


@pytest.mark.parametrize("name", OPTIONAL)
def test_optional_columns_of_a_wrong_shape_are_refused(name: str) -> None:
    content = content_of(KINDS["map-all-columns"].data)
    column = content.columns[name]
    for wrong in (column[:2], column[..., None], column.reshape(-1)[:1]):
        with pytest.raises(MapFileError, match=name):
            decode(container.write(Content(content.header, content.columns | {name: wrong})))


SHAPES = st.lists(st.integers(0, 4), max_size=3).map(tuple)


@pytest.mark.slow
@each_kind
@given(
    changes=st.dictionaries(
        st.sampled_from(sorted(container.DTYPES)),
        st.tuples(SHAPES, st.binary(min_size=8, max_size=64), st.booleans()),
        min_size=1,
        max_size=3,
    )
)
def test_columns_of_any_shape_are_read_or_refused(
    kind: Kind, changes: dict[str, tuple[tuple[int, ...], bytes, bool]]
) -> None:
    content = content_of(kind.data)
    columns = dict(content.columns)
    for name, (shape, values, is_wide) in changes.items():
        dtype = np.dtype(TYPES[container.DTYPES[name][-1 if is_wide else 0]])
        size = int(np.prod(shape)) * dtype.itemsize
        columns[name] = np.frombuffer((values * size)[:size], dtype).reshape(shape)
    data = container.write(Content(content.header, columns))
    try:
        read = kind.decode(data)
    except MapFileError:
        return
    assert kind.encode(read) == data


def test_empty_map_with_huge_codes_is_refused() -> None:
    data = encode(random_map(segments=0))
    outer = outer_header(data)
    outer["codes"]["shape"] = [0, 1 << 60]
    with pytest.raises(MapFileError):
        decode(with_outer_header(data, outer))


def test_map_file_is_not_read_as_delta_nor_delta_file_as_map() -> None:
    with pytest.raises(MapFileError, match="not a delta file: the format in its header"):
        decode_delta(KINDS["map"].data)
    with pytest.raises(MapFileError, match="not a map file: the format in its header"):
        decode(KINDS["delta"].data)


@each_kind
@given(data=st.binary(max_size=300))
def test_random_bytes_are_refused(kind: Kind, data: bytes) -> None:
    with pytest.raises(MapFileError):
        kind.decode(data)


@each_kind
@given(place=st.integers(0, 1 << 12), cut=st.integers(0, 12), insert=st.binary(max_size=12))
def test_mutated_files_are_refused(kind: Kind, place: int, cut: int, insert: bytes) -> None:
    place %= len(kind.data)
    mutated = kind.data[:place] + insert + kind.data[place + cut :]
    if mutated == kind.data:
        assert kind.encode(kind.decode(mutated)) == kind.data
    else:
        with pytest.raises(MapFileError):
            kind.decode(mutated)


@each_kind
@given(text=st.text(max_size=40) | st.just("[" * 100_000) | st.just("9" * 5_000))
def test_headers_of_any_text_are_refused(kind: Kind, text: str) -> None:
    header = text.encode(errors="replace")
    with pytest.raises(MapFileError):
        kind.decode(
            len(header).to_bytes(8, "little") + header + kind.data[header_length(kind.data) :]
        )
