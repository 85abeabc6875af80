"""Invalid msgpack bodies give problems that name the position of the error."""

import json
import struct
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from placecell.descriptors.manifest import Manifest
from service.api.body import body as bodies
from service.api.body.problem_json import response_of
from service.api.schemas.msgpack import PackedDescribeRequest, PackedMatchRequest
from service.api.schemas.recognition import DescribeRequest, MatchRequest
from service.core.problems import Problem
from service.core.settings import Limits
from tests.service.service_builders import (
    assert_problem,
    cloud,
    packed,
    post_packed,
    random_codes,
    request_of,
)

GOOD = packed(request_of([cloud(0), cloud(1)]))
BYTES = msgpack.packb(GOOD)
PAIRS = b"\x82\xa6points\xc4\x00\xa6sensor\x93\x01\x02\x03"
TWICE = b"\x81\xa8segments\x92" + PAIRS + b"\x83" + PAIRS[1:] + PAIRS[1:10]


def with_value(value: float, place: int = 61) -> dict[str, Any]:
    """Return a request that is valid except for one value of its second segment."""
    points = cloud(1).astype("<f4")
    points.flat[place] = value
    return {"segments": [GOOD["segments"][0], GOOD["segments"][1] | {"points": points.tobytes()}]}


def segment(**changes: Any) -> dict[str, Any]:
    return {"segments": [GOOD["segments"][0], GOOD["segments"][1] | changes]}


INVALID = "invalid-request"
BAD: dict[str, tuple[Any, int, str, str]] = {
    "nothing": (b"", 400, "not-msgpack", "incomplete"),
    "JSON": (b'{"segments": []}', 400, "not-msgpack", "extra data"),
    "no type": (b"\xc1", 400, "not-msgpack", "FormatError"),
    "cut short": (BYTES[:-1], 400, "not-msgpack", "incomplete"),
    "trailing bytes": (BYTES + b"\x00", 400, "not-msgpack", "extra data"),
    "not text": (b"\x81\xa1\xff\x01", 400, "not-msgpack", "utf-8"),
    "deep lists": (b"\x91" * 5000, 400, "not-msgpack", "StackError"),
    "deep maps": (b"\x81\xa1a" * 5000, 400, "not-msgpack", "StackError"),
    "many keys": ({str(key): 0 for key in range(17)}, 400, "not-msgpack", "max_map_len"),
    "a long bin": (b"\xc6\xff\xff\xff\xff", 400, "not-msgpack", "incomplete"),
    "a long array": (b"\xdd\xff\xff\xff\xff", 413, "too-many-values",
                     "a list of 4294967295 items; the limit is 1000"),
    "many lists": ([[[]] * 1500] * 30, 413, "too-many-values", "17000"),
    "many maps": ([{"a": [0] * 1000}] * 30, 413, "too-many-values", "17000"),
    "a number as key": (b"\x81\x01\x01", 400, "not-msgpack", "map key"),
    "a bin as key": (b"\x81\xc4\x01a\x01", 422, INVALID, "expected strings as keys"),
    "a list": ([], 422, INVALID, "The body: expected a map"),
    "nil": (None, 422, INVALID, "expected a map"),
    "no field": ({}, 422, INVALID, "segments"),
    "no segments": ({"segments": []}, 422, INVALID, "/segments"),
    "a map for a list": ({"segments": {}}, 422, INVALID, "/segments"),
    "an unknown key": (segment(up="y"), 422, INVALID, "/segments/1/up"),
    "a key twice": (TWICE, 422, INVALID, "/segments/1: found the key 'points' twice"),
    "no map": ({"segments": [GOOD["segments"][0], 7]}, 422, INVALID, "/segments/1: expected a map"),
    "no points": ({"segments": [{"sensor": [0, 0, 0]}]}, 422, INVALID, "/segments/0/points"),
    "points as list": (segment(points=[1.0, 2.0, 3.0]), 422, INVALID, "points: expected binary"),
    "points as text": (segment(points="abcdefghijkl"), 422, INVALID, "points: expected binary"),
    "an extension": (segment(points=msgpack.ExtType(5, b"a" * 12)), 422, INVALID, "binary"),
    "a timestamp": (segment(points=msgpack.Timestamp(1)), 422, INVALID, "expected binary"),
    "13 bytes": (segment(points=b"a" * 13), 422, INVALID, "/segments/1/points: found 13 bytes"),
    "too far": (with_value(1.1e8), 422, INVALID, "points/20/1: Input should be less than or eq"),
    "too far back": (with_value(-1e30), 422, INVALID, "points/20/1: Input should be greater than"),
    "NaN sensor": (segment(sensor=[0.0, np.nan, 0.0]), 422, INVALID, "/segments/1/sensor/1"),
    "far sensor": (segment(sensor=[0, 0, 2**63]), 422, INVALID, "/segments/1/sensor/2"),
    "boolean sensor": (segment(sensor=[True, 0, 0]), 422, INVALID, "/segments/1/sensor/0"),
    "sensor as bin": (segment(sensor=b"a" * 12), 422, INVALID, "/segments/1/sensor"),
    "two coordinates": (segment(sensor=[0, 0]), 422, INVALID, "/segments/1/sensor"),
    "NaN origin": (GOOD | {"origin": [0, 0, np.nan]}, 422, INVALID, "/origin/2"),
    "flat origin": (GOOD | {"origin": [0, 0]}, 422, INVALID, "/origin"),
    "nothing usable": ({"segments": [{"points": b"", "sensor": [0, 0, 0]}]}, 422,
                       "no-usable-segment", "0 points"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
@pytest.mark.parametrize("path", ["/describe", "/match"])
def test_invalid_msgpack_error_names_its_position(service: Any, case: str, path: str) -> None:
    body, status, kind, detail = BAD[case]
    response = post_packed(service, path, body)
    assert_problem(response, status, kind, detail)
    assert len(response.content) < 5_000
    assert post_packed(service, "/describe", GOOD).status_code == 200


@pytest.mark.parametrize("path", ["/describe", "/match"])
def test_value_out_of_range_gives_the_error_of_json(service: Any, path: str) -> None:
    for value in (2.0**30, -(2.0**30)):
        body = with_value(value)
        lists = [
            each | {"points": np.frombuffer(each["points"], "<f4").reshape(-1, 3).tolist()}
            for each in body["segments"]
        ]
        told = service.post(path, content=json.dumps({"segments": lists}))
        assert told.status_code == 422
        assert post_packed(service, path, body).json() == told.json()


@pytest.mark.parametrize(
    ("changes", "status", "kind", "detail"),
    [
        ({"k": 0}, 422, INVALID, "/k"),
        ({"k": 101}, 422, INVALID, "the limit is 100"),
        ({"k": 2**64 - 1}, 422, INVALID, "the limit is 100"),
        ({"k": 5.0}, 422, INVALID, "/k"),
        ({"k": True}, 422, INVALID, "/k"),
        ({"maps": ["nowhere"]}, 404, "unknown-map", "'nowhere'"),
        ({"maps": [b"nowhere"]}, 422, INVALID, "/maps/0"),
        ({"maps": []}, 422, INVALID, "/maps"),
        ({"codes": b""}, 422, INVALID, "/codes: expected at least one code"),
        ({"codes": b"\x01" * 13}, 422, INVALID, "/codes: 13 bytes"),
        ({"codes": [[1] * 7]}, 422, INVALID, "/codes: expected binary data"),
        ({"codes": b"\x01" * 7007}, 413, "too-many-segments", "1001"),
        ({"model_id": "other-1"}, 409, "other-model", "other-1"),
        ({"model_id": None}, 422, INVALID, "either"),
        (GOOD, 422, INVALID, "either"),
    ],
)
def test_invalid_queries_are_refused_with_the_reason(
    service: Any, manifest: Manifest, changes: dict[str, Any], status: int, kind: str, detail: str
) -> None:
    codes = random_codes(2).tobytes()
    body = {"model_id": manifest.model_id, "codes": codes} | changes
    assert_problem(post_packed(service, "/match", body), status, kind, detail)


def test_limits_apply_to_msgpack_requests(start: Any) -> None:
    with start(limits={"segments": 3, "points": 500, "body_bytes": 20_000}) as service:
        clouds = [cloud(seed, 125) for seed in range(4)]

        def post(clouds: list[Any]) -> Any:
            return post_packed(service, "/describe", packed(request_of(clouds)))

        assert post(clouds[:3]).status_code == 200
        assert_problem(post(clouds), 413, "too-many-segments", "the limit is 3")
        assert_problem(post([cloud(0, 501)]), 413, "too-many-points", "the limit is 500")
        assert_problem(post([cloud(0, 2_000)]), 413, "body-too-large")


def read(body: bytes) -> None:
    """Decode both kinds of requests; let only schemas and problems of the client pass."""
    for schema, twin in (
        (DescribeRequest, PackedDescribeRequest),
        (MatchRequest, PackedMatchRequest),
    ):
        outcome: object
        try:
            outcome = bodies.parse(
                schema, twin, bodies.Body(bodies.MSGPACK, body), Limits(segments=50)
            )
        except Problem as problem:
            outcome = problem
        if isinstance(outcome, Problem):
            assert outcome.status in {400, 413, 422}
            assert len(bytes(response_of(outcome).body)) < 10_000
        else:
            assert isinstance(outcome, twin)


LEAVES = (
    st.none() | st.booleans() | st.integers(-(2**63), 2**64 - 1) | st.floats() | st.text()
    | st.binary() | st.builds(msgpack.ExtType, st.integers(0, 127), st.binary(max_size=9))
    | st.floats(width=32).map(lambda value: struct.pack("<3f", value, 1, 2))
)  # fmt: skip
KEYS = st.sampled_from(
    ["segments", "points", "sensor", "origin", "codes", "model_id", "maps", "k"]
) | st.text(max_size=3)
VALUES = st.recursive(
    LEAVES, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS, inner, max_size=5)
)
SEGMENT = st.fixed_dictionaries(
    {"points": VALUES, "sensor": st.lists(st.floats() | st.integers(-5, 5), max_size=4)}
)
REQUESTS = st.dictionaries(KEYS, VALUES) | st.fixed_dictionaries(
    {"segments": st.lists(SEGMENT, max_size=3)}, optional={"origin": VALUES, "k": VALUES}
)


@given(st.binary(max_size=200))
@settings(max_examples=300, deadline=None)
def test_random_bytes_give_a_value_or_a_problem(body: bytes) -> None:
    read(body)


@pytest.mark.slow
@given(REQUESTS.map(msgpack.packb))
@settings(max_examples=300, deadline=None)
def test_random_values_give_a_value_or_a_problem(body: bytes) -> None:
    read(body)


@pytest.mark.slow
@given(st.data())
@settings(max_examples=300, deadline=None)
def test_damaged_bodies_give_a_value_or_a_problem(data: st.DataObject) -> None:
    small = packed(request_of([cloud(0, 10)]) | {"maps": ["yard"], "k": 3})
    body = bytearray(msgpack.packb(small))
    for _ in range(data.draw(st.integers(1, 4))):
        body[data.draw(st.integers(0, len(body) - 1))] = data.draw(st.integers(0, 255))
    read(bytes(body[: data.draw(st.integers(0, len(body)))]))
    read(bytes(body))
