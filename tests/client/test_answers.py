"""Unreadable answers: each is a ServiceError that describes the answer."""

import contextlib
import json
import pickle
from collections.abc import Callable
from typing import Any

import httpx
import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from placecell_client import Client, Description, MapFileError, ServiceError

from tests.client.client_fakes import (
    CANDIDATE,
    DESCRIBED,
    INFO,
    LISTED,
    LOCALIZED,
    MATCHED,
    MSGPACK,
    SUMMARY,
    client_of,
    packed,
)
from tests.client.map_builders import random_map

CLOUD = np.zeros((4, 3), np.float32)
DESCRIPTION = Description(
    "m", np.array([[3, -1]], np.int8), np.zeros((1, 2), np.float32), np.zeros((1, 3)), {}
)
Call = Callable[[Client], Any]
CALLS: dict[str, tuple[Call, httpx.Response]] = {
    "info": (lambda client: client.info(), httpx.Response(200, json=INFO)),
    "describe": (lambda client: client.describe([CLOUD], np.zeros(3)), packed(DESCRIBED)),
    "match": (lambda client: client.match(DESCRIPTION), packed(MATCHED)),
    "localize": (lambda client: client.localize(DESCRIPTION), packed(LOCALIZED)),
    "maps": (lambda client: client.maps(), httpx.Response(200, json=LISTED)),
    "put_map": (
        lambda client: client.put_map("yard", random_map()),
        httpx.Response(200, json=SUMMARY),
    ),
    "get_map": (lambda client: client.get_map("yard"), httpx.Response(200)),
    "get_map_file": (lambda client: client.get_map_file("yard"), httpx.Response(200)),
    "delete_map": (lambda client: client.delete_map("yard"), httpx.Response(204)),
}
READING = ["info", "describe", "match", "localize", "maps", "put_map"]


def error_of(call: str, response: httpx.Response) -> ServiceError:
    with client_of(lambda _: response) as client, pytest.raises(ServiceError) as raised:
        CALLS[call][0](client)
    return raised.value


@pytest.mark.parametrize("call", CALLS)
def test_html_page_with_success_status_is_an_error(call: str) -> None:
    error = error_of(call, httpx.Response(200, html="<h1>Log in\n to the network</h1>"))
    assert (error.status, error.title) == (200, "Unreadable answer")
    assert error.type == "urn:placecell:problem:unreadable-answer"
    assert "text/html" in error.detail
    assert "'<h1>Log in to the network</h1>'" in error.detail
    assert error.request_id is not None


@pytest.mark.parametrize("call", CALLS)
def test_error_page_of_a_proxy_is_an_error(call: str) -> None:
    error = error_of(call, httpx.Response(502, html="<h1>nginx</h1>"))
    assert (error.status, error.title, error.type) == (502, "Bad Gateway", "about:blank")
    assert "text/html" in error.detail
    assert "<h1>nginx</h1>" in error.detail


@pytest.mark.parametrize(
    "response",
    [
        httpx.Response(500, content=b'{"title": ', headers={"Content-Type": "application/json"}),
        httpx.Response(500, json=["an", "array"]),
        httpx.Response(500, content=b"[" * 100_000, headers={"Content-Type": "application/json"}),
        httpx.Response(500, content=b"\xff\xfe", headers={"Content-Type": "text/plain"}),
        httpx.Response(500, json={"title": None, "detail": None, "type": None}),
        httpx.Response(500),
    ],
)
def test_refusal_of_any_form_is_an_error(response: httpx.Response) -> None:
    error = error_of("info", response)
    assert (error.status, error.title, error.type) == (500, "Internal Server Error", "about:blank")
    assert error.detail


def test_unknown_status_is_an_error() -> None:
    assert str(error_of("info", httpx.Response(299 + 300))).startswith("599 Unknown status")


@pytest.mark.parametrize("call", READING)
def test_truncated_answer_is_an_error(call: str) -> None:
    whole = CALLS[call][1]
    headers = {"Content-Type": whole.headers["Content-Type"]}
    for length in range(len(whole.content)):
        cut = httpx.Response(200, content=whole.content[:length], headers=headers)
        assert error_of(call, cut).title == "Unreadable answer"


@pytest.mark.parametrize("call", READING)
@pytest.mark.parametrize("body", [{}, [], None, 7, "text"])
def test_body_with_other_content_is_an_error(call: str, body: object) -> None:
    for response in (packed(body), httpx.Response(200, json=body)):
        assert error_of(call, response).title == "Unreadable answer"


def without(content: Any, path: tuple[Any, ...]) -> Any:
    copy = pickle.loads(pickle.dumps(content))
    inner = copy
    for key in path[:-1]:
        inner = inner[key]
    del inner[path[-1]]
    return copy


@pytest.mark.parametrize("key", DESCRIBED["descriptors"][0])  # type: ignore[index]
def test_error_names_a_missing_key(key: str) -> None:
    error = error_of("describe", packed(without(DESCRIBED, ("descriptors", 0, key))))
    assert f"The key '{key}' is missing" in error.detail
    assert MSGPACK in error.detail


@pytest.mark.parametrize("key", CANDIDATE)
def test_error_names_a_missing_key_of_a_candidate(key: str) -> None:
    error = error_of("match", packed(without(MATCHED, ("queries", 0, "candidates", 0, key))))
    assert f"The key '{key}' is missing" in error.detail


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"codes": b""}, ""),
        ({"codes": 7}, ""),
        ({"descriptor": b"\0\0\0\x3f"}, "same shape"),
        ({"descriptor": b"\0\0\0\x3f\0"}, ""),
        ({"descriptor": None}, ""),
        ({"centroid": [1.0, 2.0]}, ""),
        ({"centroid": 1.0}, ""),
        ({"centroid": None}, ""),
        ({"error": {"type": "t"}}, ""),
    ],
)
def test_malformed_descriptor_is_an_error(changes: dict[str, Any], message: str) -> None:
    good: dict[str, Any] = DESCRIBED["descriptors"][0]  # type: ignore[index]
    body = DESCRIBED | {"descriptors": [good, good | changes]}

    def describe(client: Client) -> Description:
        return client.describe([CLOUD, CLOUD], np.zeros(3))

    with (
        client_of(lambda _: packed(body)) as client,
        pytest.raises(ServiceError, match="Unreadable") as raised,
    ):
        describe(client)
    assert message in raised.value.detail


@pytest.mark.parametrize("dimension", [1, 10**18, -1, "2", None])
def test_wrong_dimension_is_an_error(dimension: Any) -> None:
    error = error_of("describe", packed(DESCRIBED | {"dimension": dimension}))
    assert "dimensions" in error.detail


def test_wrong_number_of_results_is_an_error() -> None:
    twice = DESCRIBED["descriptors"] * 2  # type: ignore[operator]
    assert (
        "2 results for 1" in error_of("describe", packed(DESCRIBED | {"descriptors": twice})).detail
    )
    assert "0 results for 1" in error_of("match", packed(MATCHED | {"queries": []})).detail


def test_body_in_another_encoding_is_an_error() -> None:
    response = httpx.Response(
        200,
        headers={"Content-Type": "application/json", "Content-Encoding": "gzip"},
        stream=httpx.ByteStream(json.dumps(INFO).encode()),
    )
    assert error_of("info", response).title == "Unreadable answer"


def test_other_file_instead_of_a_map_is_an_error() -> None:
    headers = {"Content-Type": "application/vnd.placecell.map"}
    broken = httpx.Response(200, content=b"broken", headers=headers)
    with client_of(lambda _: broken) as client, pytest.raises(MapFileError):
        client.get_map("yard")


@pytest.mark.slow
@given(
    st.recursive(
        st.none() | st.integers(-9, 9) | st.text(max_size=3) | st.binary(max_size=9),
        lambda inner: (
            st.lists(inner, max_size=3)
            | st.dictionaries(
                st.sampled_from(
                    [
                        "model_id",
                        "descriptors",
                        "codes",
                        "descriptor",
                        "centroid",
                        "dimension",
                        "queries",
                        "candidates",
                        "error",
                        "searched",
                        "skipped",
                        "maps",
                        "name",
                    ]
                ),
                inner,
            )
        ),
    )
)
def test_any_content_is_parsed_or_is_an_error(content: object) -> None:
    for call in READING:
        with client_of(lambda _: packed(content)) as client, contextlib.suppress(ServiceError):
            CALLS[call][0](client)


@pytest.mark.slow
@given(st.binary(max_size=50), st.sampled_from([MSGPACK, "application/json", "text/html", ""]))
def test_random_bytes_are_an_error(content: bytes, media_type: str) -> None:
    response = httpx.Response(200, content=content, headers={"Content-Type": media_type})
    for call in READING:
        error_of(call, response)


def test_unbroken_answers_of_this_file_are_parsed() -> None:
    for name in READING:
        call, response = CALLS[name]
        with client_of(lambda _, response=response: response) as client:  # type: ignore[misc]
            assert call(client)
    assert msgpack.unpackb(packed(DESCRIBED).content) == DESCRIBED
