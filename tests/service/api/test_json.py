"""JSON bodies parsed by compiled code: the plain schemas accept the same bodies and values."""

import json
import sys
import threading
import time
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from pydantic import BaseModel, ValidationError

from service.api.body.json_arrays import cut_arrays
from service.api.body.json_requests import CUT, read_json
from service.api.schemas.localization import LocalizeRequest
from service.api.schemas.recognition import DescribeRequest, MatchRequest
from service.core.problems import Problem, invalid
from service.core.settings import Limits
from tests.service.service_builders import assert_problem, cloud, request_of

LIMITS = Limits()
SCHEMAS: tuple[type[BaseModel], ...] = (DescribeRequest, MatchRequest, LocalizeRequest)
BODIES = (
    '{"segments": [{"points": [[1.5, -2, 3e-2], [4, 5, 6]], "sensor": [0, 0, 1.8]}],'
    ' "origin": [1,2,3]}',
    '{"model_id": "m", "codes": [[1, -128], [127, 0]], "k": 3}',
    '{"model_id":"m","codes":[[1],[2,3]],"centroids":[[1,2,3],[-0.0,5.5,1e-320]],"motion":"se3"}',
    '{"segments":[{"points":[],"sensor":[0,0,0]},{"sensor":[1,1,1],"points":[[0.1,0.2,0.3]]}]}',
)


def plain(value: Any) -> Any:
    """Convert a value's arrays to lists."""
    if isinstance(value, BaseModel):
        return {key: plain(getattr(value, key)) for key in type(value).model_fields}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return value


def read(schema: type[BaseModel], body: bytes) -> Any:
    """Return the parsed request, or the status and the positions of its errors."""
    try:
        return plain(read_json(schema, body, LIMITS))
    except Problem as problem:
        return problem.status, [(error.pointer, error.detail) for error in problem.errors or []]


def expected(schema: type[BaseModel], body: bytes) -> Any:
    """Return the result of `read` for the plain schema."""
    try:
        return plain(schema.model_validate_json(body))
    except ValidationError as error:
        problem = invalid(error)
        return problem.status, [(error.pointer, error.detail) for error in problem.errors or []]


PIECES = [
    '"points"', '"codes"', '"centroids"', '"sensor"', '"k"', "[", "]", "{", "}", ",", ":", " ",
    "\n", "0", "1", "-1", "-0", "00", "1.", ".5", "1e5", "1E-400", "1e400", "NaN",
    "Infinity",
    "-Infinity", "null", "true", '"x"', '"\\ud800"', '"\\u0000"', "\x00", "100000000.00000001",
    "128", "-129", "1.0",
    "123456789012345678901234567890", "0.1234567890123456789012345", "[[1,2,3]]", "[1,2]", "[[[]]]",
]  # fmt: skip


@pytest.mark.slow
@settings(max_examples=400, deadline=None)
@given(
    body=st.sampled_from(BODIES),
    changes=st.lists(
        st.tuples(st.floats(0, 1), st.integers(0, 6), st.sampled_from(PIECES)), max_size=2
    ),
    schema=st.sampled_from(SCHEMAS),
)
def test_compiled_parser_agrees_with_the_schema(
    body: str, changes: list[tuple[float, int, str]], schema: type[BaseModel]
) -> None:
    for where, removed, piece in changes:
        place = int(where * len(body))
        body = body[:place] + piece + body[place + removed :]
    found, wanted = read(schema, body.encode()), expected(schema, body.encode())
    if isinstance(wanted, tuple):
        assert isinstance(found, tuple), body
        if len(changes) == 1:
            assert found == wanted, body
    else:
        assert found == wanted, body


@settings(max_examples=200, deadline=None)
@given(
    st.lists(st.floats(-1e8, 1e8), min_size=3, max_size=3), st.sampled_from(["r", "f", "e", "d"])
)
@example([5e-324, 2.2250738585072014e-308, 1e-308], "r")
@example([1e8, -1e8, 99999999.99999999], "r")
@example([9007199254740993.0 / 1e9, 0.1 + 0.2, 1 / 3], "r")
def test_numbers_are_parsed_to_the_last_bit(values: list[float], form: str) -> None:
    texts = {
        "r": [repr(value) for value in values],
        "f": [f"{value:.25f}" for value in values],
        "e": [f"{value:.18e}" for value in values],
        "d": [f"{value:.40f}" + "1" for value in values],
    }[form]
    wanted = [float(text) for text in texts]
    # Short and long bodies are parsed by different code.
    for padding in ("", " " * 200):
        body = '{"points":[[' + ",".join(texts) + "]]}" + padding
        found = cut_arrays(body.encode(), points=9, segments=9, values=9)
        if max(map(abs, wanted)) <= 1e8:
            assert found.floats[0].tobytes() == np.array(wanted).tobytes()
        else:
            assert found.spans[0, 5] == 1


@pytest.mark.parametrize(
    ("points", "pointer", "detail"),
    [
        ("[[1,2,3],[4,NaN,6]]", "/1/1", "finite"),
        ("[[1,2,3],[4,5,null]]", "/1/2", "valid number"),
        ("[[1,2,3],[4,5,true]]", "/1/2", "valid number"),
        ('[[1,2,3],["4",5,6]]', "/1/0", "valid number"),
        ("[[1,2,3],[4,5,1e9]]", "/1/2", "less than or equal"),
        ("[[1,2,3],[4,5,-1e999]]", "/1/2", "finite"),
        ("[[1,2,3],[4,5]]", "/1/2", "required"),
        ("[[1,2,3],[4,5,6,7]]", "/1", "at most 3"),
        ("[[1,2,3],4]", "/1", "valid array"),
        ("[[1,2,3],{}]", "/1", "valid array"),
        ("[[1,2,3],[[4],5,6]]", "/1/0", "valid number"),
        ('"abc"', "", "valid array"),
        ("null", "", "valid array"),
        ("[[100000000.000000016,0,0]]", "/0/0", "less than or equal"),
    ],
)
def test_invalid_point_error_names_its_position(
    service: Any, points: str, pointer: str, detail: str
) -> None:
    good = json.dumps(request_of([cloud(0)])["segments"][0])
    body = f'{{"segments": [{good}, {{"points": {points}, "sensor": [0, 0, 0]}}, {good}]}}'
    response = service.post("/describe", content=body)
    assert_problem(response, 422, "invalid-request", f"/segments/1/points{pointer}: ")
    assert detail in response.json()["detail"]
    assert response.json()["errors"][0]["pointer"] == f"/segments/1/points{pointer}"


def test_syntax_error_names_its_position_in_the_body(service: Any) -> None:
    good = json.dumps(request_of([cloud(0)])["segments"][0])
    bodies = [
        f'{{"segments": [{good},\n {good} {good}]}}',
        f'{{"segments": [{good}, {{"points": [[1, 2, 3], [4, +5, 6]]}}]}}',
        f'{{"segments": [{good}, {{"points": [[1, 2, 3]\n [4, 5, 6]]}}]}}',
        f'{{"segments": [{good}, {{"points": [[1, 2, 3],]}}]}}',
    ]
    for body in bodies:
        with pytest.raises(ValidationError) as caught:
            DescribeRequest.model_validate_json(body)
        told = service.post("/describe", content=body)
        assert_problem(told, 400, "not-json", str(invalid(caught.value).detail))


def test_escaped_and_repeated_keys_are_accepted() -> None:
    body = (
        b'{"segments":[{"points":[[9,9,9]],"p\\u006fint\\u0073":[[1,2,3]],"sensor":[0,0,0]}],'
        b'"model":"points","origin":[0,0,0]}'
    )
    arrays = cut_arrays(body, points=9, segments=9, values=9)
    assert len(arrays.spans) == 2
    assert read(DescribeRequest, body) == expected(DescribeRequest, body)


def test_body_cannot_refer_to_cut_arrays() -> None:
    for value in ('"0"', '":0"', '"0000000000000000:0"', "0", "[0]"):
        body = f'{{"segments":[{{"points":{value},"sensor":[0,0,0]}}]}}'.encode()
        assert read(DescribeRequest, body) == expected(DescribeRequest, body)
        assert read(DescribeRequest, body)[0] == 422


@pytest.mark.parametrize("length", range(30))
def test_truncated_bodies_are_refused(length: int) -> None:
    body = b'{"points":[[1.25,-2,3]],"codes":[[1]]}'[:length]
    assert read(DescribeRequest, body)[0] in (400, 422)


@pytest.mark.slow
def test_B18_json_accepts_as_many_points_as_info_states(start: Any) -> None:
    with start(limits={"segments": 4000}) as service:
        limit = service.get("/info").json()["limits"]["points"]
        random = np.random.default_rng(0)
        points = random.normal(0, 40, (limit, 3))
        clouds = [each.tolist() for each in np.split(points, 2_000)]
        segments = [{"points": each, "sensor": [0.0, 0.0, 1.8]} for each in clouds]
        body = json.dumps({"segments": segments}).encode()
        assert len(body) < service.get("/info").json()["limits"]["json_bytes"]
        assert len(cut_arrays(body, points=limit, segments=4000, values=1).spans) == 2_000
        segments.append({"points": [[0, 0, 0]], "sensor": [0.0, 0.0, 1.8]})
        body = json.dumps({"segments": segments}).encode()
        told = service.post("/describe", content=body)
        assert_problem(told, 413, "too-many-points", f"{limit + 1} points in a request; the limit")


def test_B18_too_many_segments_error_states_their_number(service: Any) -> None:
    segments = [{"points": [[0, 0, 0]], "sensor": [0, 0, 0]}] * 5_000
    told = service.post("/describe", json={"segments": segments})
    assert_problem(told, 413, "too-many-segments", "5000 segments in a request; the limit is 1000")
    told = service.post("/match", json={"model_id": "x", "codes": [[0]] * 5_000})
    assert_problem(told, 413, "too-many-segments", "5000 queries in a request; the limit is 1000")


@pytest.mark.slow
def test_other_threads_run_while_a_body_is_parsed() -> None:
    points = np.random.default_rng(0).normal(0, 40, (200_000, 3)).tolist()
    body = json.dumps({"segments": [{"points": points, "sensor": [0, 0, 0]}]}).encode()
    del points
    read_json(DescribeRequest, body, LIMITS)
    ticks: list[float] = []
    done = threading.Event()

    def tick() -> None:
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0)

    ticker = threading.Thread(target=tick)
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-4)
    try:
        ticker.start()
        while len(ticks) < 10:
            time.sleep(0.001)
        began = time.perf_counter()
        read_json(DescribeRequest, body, LIMITS)
        ended = time.perf_counter()
    finally:
        done.set()
        ticker.join()
        sys.setswitchinterval(before)
    within = [at for at in ticks if began <= at <= ended]
    # The other thread ran many times during the whole parse. The clock is not used.
    assert len(within) > 20
    assert max(after - before for before, after in pairwise(within)) < 0.9 * (ended - began)


def test_cut_schemas_have_the_fields_of_their_schemas() -> None:
    assert set(CUT) == set(SCHEMAS)
    for schema, cut in CUT.items():
        assert set(cut.model_fields) == set(schema.model_fields)
