from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from placecell_client import Delta, MapFileError, decode_delta, encode, encode_delta
from placecell_client.maps.compact_map import OPTIONAL

from tests.client.file_surgery import inner_header, with_inner_header
from tests.client.map_builders import deltas, random_map

GONE = np.array([100, 200], np.uint32)
SMALL = encode_delta(Delta(random_map(segments=3, frames=2), GONE, 3, 9))


def test_decoded_delta_equals_the_encoded_one() -> None:
    given_delta = Delta(random_map(optional=("seen", "views")), GONE, 3, 9)
    back = decode_delta(encode_delta(given_delta))
    assert encode(back.changed) == encode(given_delta.changed)
    assert (back.since, back.until, back.removed.tolist()) == (3, 9, [100, 200])
    assert back.removed.dtype == np.uint32
    assert len(back) == 22


@pytest.mark.slow
@given(deltas())
def test_encoding_a_decoded_delta_gives_the_same_bytes(given_delta: Delta) -> None:
    data = encode_delta(given_delta)
    assert encode_delta(decode_delta(data)) == data


def test_delta_without_segments_keeps_its_optional_columns() -> None:
    nothing = random_map(segments=0, optional=OPTIONAL)
    back = decode_delta(encode_delta(Delta(nothing, np.zeros(0, np.uint32))))
    assert len(back) == 0
    assert back.changed.optional == tuple(OPTIONAL)


def test_header_has_the_documented_fields() -> None:
    header = inner_header(SMALL)
    assert {key: header[key] for key in ("format", "version", "count", "removed")} == {
        "format": "placecell-delta",
        "version": 1,
        "count": 3,
        "removed": 2,
    }
    assert (header["since"], header["until"]) == (3, 9)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"version": 2}, "delta file has version 2; this program reads version 1"),
        ({"since": None}, "expected integers"),
        ({"since": 3.0}, "expected integers"),
        ({"until": True}, "expected integers"),
        ({"until": "9"}, "expected integers"),
        ({"since": 10}, "since <= until"),
        ({"since": -1}, "since <= until"),
        ({"until": 1 << 53}, "since <= until"),
        ({"since": 0}, "holds the whole map"),
        ({"removed": 3}, "canonical"),
        ({"count": 2}, "canonical"),
        ({"extra": 2}, "canonical"),
        ({"scale_cm": 2}, "scale_cm"),
    ],
)
def test_wrong_header_is_refused(changes: dict[str, object], message: str) -> None:
    assert with_inner_header(SMALL) == SMALL
    with pytest.raises(MapFileError, match=message):
        decode_delta(with_inner_header(SMALL, **changes))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"removed": np.array([5, 3], np.uint32)}, "ascend"),
        ({"removed": np.array([3, 3], np.uint32)}, "ascend"),
        ({"removed": np.array([3, 5])}, "removed: int64"),
        ({"removed": np.array([[3, 5]], np.uint32)}, "removed"),
        ({"removed": random_map(segments=3).ids[:1]}, "also in changed"),
        ({"since": 0, "until": 4}, "holds the whole map"),
        ({"since": 5, "until": 4}, "since <= until"),
        ({"since": np.int64(2)}, "expected integers"),
        ({"changed": replace(random_map(segments=3), frame="")}, "frame"),
    ],
)
def test_invalid_delta_is_not_written(changes: dict[str, Any], message: str) -> None:
    valid = Delta(random_map(segments=3), GONE, 3, 9)
    with pytest.raises(MapFileError, match=message):
        encode_delta(replace(valid, **changes))


@pytest.mark.parametrize(
    ("since", "until", "is_whole"), [(0, 0, False), (0, 1, True), (1, 1, False), (1, 2, False)]
)
def test_delta_since_zero_holds_the_whole_map(since: int, until: int, is_whole: bool) -> None:
    nothing = np.zeros(0, np.uint32)
    assert Delta(random_map(), nothing, since, until).is_whole is is_whole
