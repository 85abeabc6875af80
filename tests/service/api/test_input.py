"""Coordinates at the limits: NaN, infinity, and sums beyond the largest coordinate."""

import json
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.service.service_builders import assert_problem, cloud, packed, post_packed, request_of

LIMIT = 1e8


def unpacked(response: Any) -> Any:
    return msgpack.unpackb(response.content)


PATHS = ("/describe", "/match", "/localize")


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize("sign", [1, -1])
def test_A15_coordinate_plus_origin_beyond_the_limit_answers_422(
    service: Any, path: str, sign: int
) -> None:
    far, near = np.full((20, 3), sign * LIMIT), -sign * np.abs(cloud(0))
    body: dict[str, Any] = {
        "segments": [
            {"points": near.tolist(), "sensor": [0.0, 0.0, 0.0]},
            {"points": far.tolist(), "sensor": far[0].tolist()},
        ],
        "origin": [0.0, 0.0, sign * LIMIT],
    }
    told = service.post(path, json=body)
    assert_problem(told, 422, "invalid-request", "/segments/1/points/0/2: The coordinate plus")
    assert post_packed(service, path, packed(body)).json() == told.json()
    body["segments"][1]["points"] = near.tolist()
    told = service.post(path, json=body)
    assert_problem(told, 422, "invalid-request", "/segments/1/sensor/2: The coordinate plus")


@pytest.mark.parametrize("path", PATHS)
@pytest.mark.parametrize(
    "value", [LIMIT, -LIMIT, np.nextafter(LIMIT, 0), 1e-320, -0.0, 1e-45, 3.4e38, 1e308]
)
def test_A15_extreme_coordinates_never_answer_500(service: Any, path: str, value: float) -> None:
    for shift in (0.0, 999.0, -999.0, 1e-3):
        near = np.clip(cloud(0) * 0.01 + value, -LIMIT, LIMIT) if abs(value) <= LIMIT else cloud(0)
        segment = {"points": near.tolist(), "sensor": [value, value, value + shift]}
        for origin in (None, [0.0, 0.0, 0.0], [-value, -value, -value], [value, 0.0, 0.0]):
            body = {"segments": [segment]} | ({} if origin is None else {"origin": origin})
            told = service.post(path, content=json.dumps(body))
            assert told.status_code in (200, 422), told.text
            assert "NaN" not in told.text
            assert "Infinity" not in told.text


@pytest.mark.parametrize("path", PATHS)
def test_B10_nonfinite_points_are_dropped_and_counted(service: Any, path: str) -> None:
    clean = packed(request_of([cloud(0), cloud(1)]))
    points = cloud(1).astype("<f4")
    broken = np.insert(points, [0, 5, 5, len(points)], np.nan, axis=0)
    broken[0, 1:] = 1.0
    broken[6] = [np.inf, -np.inf, 0.0]
    body = {"segments": [clean["segments"][0], clean["segments"][1] | {"points": broken.tobytes()}]}
    wanted, found = post_packed(service, path, clean), post_packed(service, path, body)
    assert found.status_code == 200
    assert unpacked(found) == unpacked(wanted) | {"dropped_points": 4}
    assert unpacked(wanted)["dropped_points"] == 0


def test_B10_segment_without_finite_points_has_its_own_error(service: Any) -> None:
    clean = packed(request_of([cloud(0), cloud(1)]))
    nothing = np.full((40, 3), np.nan, "<f4").tobytes()
    body = {"segments": [clean["segments"][0] | {"points": nothing}, clean["segments"][1]]}
    told = post_packed(service, "/describe", body)
    assert told.status_code == 200
    error = unpacked(told)["descriptors"][0]["error"]
    assert error["type"].endswith("too-few-points")
    assert "0 points and 40 non-finite points" in error["detail"]
    assert unpacked(told)["dropped_points"] == 40
    told = post_packed(service, "/describe", {"segments": body["segments"][:1]})
    assert_problem(told, 422, "no-usable-segment", "and 40 non-finite points")


def test_B10_dropped_points_count_against_the_limit(start: Any) -> None:
    with start(limits={"points": 500}) as service:
        nothing = np.full((501, 3), np.nan, "<f4").tobytes()
        body = {"segments": [{"points": nothing, "sensor": [0.0, 0.0, 0.0]}]}
        assert_problem(post_packed(service, "/describe", body), 413, "too-many-points", "501")
