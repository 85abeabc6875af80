"""Compressed bodies: equal answers, and limits on their decompressed size."""

import gzip
import json
from typing import Any

import pytest
import zstandard
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import assert_problem, cloud, map_of, random_codes, request_of

CODERS: dict[str, Any] = {"gzip": gzip.compress, "zstd": zstandard.compress}


@pytest.mark.parametrize("coding", CODERS)
def test_compressed_body_gives_the_same_answer(
    service: Any, coding: str, manifest: Manifest
) -> None:
    body = json.dumps(request_of([cloud(0)])).encode()
    headers = {"Content-Encoding": coding}
    answer = service.post("/describe", content=CODERS[coding](body), headers=headers)
    assert answer.json() == service.post("/describe", content=body).json()
    data = encode(map_of(random_codes(5), manifest.model_id))
    stored = service.put("/maps/yard", content=CODERS[coding](data), headers=headers)
    assert stored.status_code == 201
    assert service.get("/maps/yard").content == data


@pytest.mark.slow
@pytest.mark.parametrize("coding", CODERS)
def test_body_that_expands_beyond_the_limit_answers_413(start: Any, coding: str) -> None:
    headers = {"Content-Encoding": coding}
    with start(
        limits={"body_bytes": 100_000, "json_bytes": 100_000, "map_bytes": 200_000}
    ) as service:
        bomb = CODERS[coding](bytes(300_000_000))
        refused = service.post("/describe", content=bomb[:99_000], headers=headers)
        assert_problem(refused, 413, "body-too-large")
        just = CODERS[coding](b" " * 100_001)
        assert_problem(
            service.post("/describe", content=just, headers=headers), 413, "body-too-large"
        )
        larger = CODERS[coding](bytes(200_001))
        response = service.put("/maps/yard", content=larger, headers=headers)
        assert_problem(response, 413, "body-too-large", "200000")


@pytest.mark.parametrize("coding", CODERS)
def test_invalid_compressed_body_answers_400(service: Any, coding: str) -> None:
    response = service.post("/describe", content=b"{}", headers={"Content-Encoding": coding})
    assert_problem(response, 400, f"not-{coding}")
    whole = CODERS[coding](json.dumps(request_of([cloud(0)])).encode())
    response = service.post("/describe", content=whole[:-20], headers={"Content-Encoding": coding})
    assert response.status_code == 400


def test_unknown_coding_answers_415(service: Any) -> None:
    response = service.post("/describe", content=b"", headers={"Content-Encoding": "br"})
    assert_problem(response, 415, "unsupported-content-encoding", "gzip or zstd")
    assert response.headers["accept-encoding"] == "gzip, zstd"
