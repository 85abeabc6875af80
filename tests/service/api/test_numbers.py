"""Numbers in JSON bodies: NaN, infinity and huge values in each field, on all routes."""

import json
from collections.abc import Iterator
from copy import deepcopy
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.app import create_app
from service.core.settings import Settings
from tests.service.service_builders import cloud, map_of, random_codes

JSON = "application/json"
SIX = [[float(row == column) for column in range(6)] for row in range(6)]
HINTS = {
    "near": {"position": [1.0, 2.0, 0.5], "radius": 20.0},
    "yaw": {"radians": 0.1, "tolerance": 1.0},
    "last_pose": {
        "map": "yard",
        "position": [1.0, 2.0, 0.5],
        "orientation": [0.0, 0.0, 0.0, 1.0],
        "covariance": SIX,
        "yaw_tolerance": 0.5,
    },
    "geo": {"lat": 49.0, "lon": 8.4, "accuracy": 5.0},
    "sensor": {"position": [0.0, 0.0, 1.7], "yaw": 0.1},
}


def bodies(model_id: str) -> dict[str, tuple[str, str, dict[str, Any]]]:
    """Return method, path and a valid body for each schema of a body with numbers."""
    points = {"points": cloud(0, 40).tolist()[:40], "sensor": [9.0, -3.0, 1.7]}
    segments = {"segments": [points], "origin": [1.0, 2.0, 3.0]}
    codes = {
        "codes": random_codes(2).tolist(),
        "model_id": model_id,
        "centroids": [[0.0, 0.0, 1.5], [1.0, -1.0, 1.5]],
        "query_classes": [{"name": "pole", "probability": 0.9}, None],
        "k": 5,
    }
    fix = {"position": [1.0, 2.0, 0.5], "lat": 49.0, "lon": 8.4, "height": 1.0, "accuracy": 2.0}
    return {
        "DescribeRequest": ("POST", "/describe", segments),
        "MatchRequest": ("POST", "/match", codes | {"maps": ["yard"]}),
        "LocalizeRequest": (
            "POST",
            "/localize",
            codes | {"maps": ["yard"], "hints": HINTS, "max_false_acceptance": 0.01},
        ),
        "GeoAnchorIn": (
            "PUT",
            "/maps/yard/anchor",
            {"lat": 49.0, "lon": 8.4, "height": 1.0, "yaw_deg": 3.0, "accuracy": 0.5}
            | {"position": [1.0, 2.0, 0.5]},
        ),
        "FitRequest": ("POST", "/maps/yard/anchor/fit", {"fixes": [fix] * 2, "dry_run": True}),
        "NamedAnchorIn": (
            "PUT",
            "/maps/yard/anchors/dock",
            {"position": [1.0, 2.0, 0.5], "orientation": [0.0, 0.0, 0.0, 1.0]},
        ),
        "RobotReportIn": (
            "PUT",
            "/robots/ann",
            {"map": "yard", "position": [1.0, 2.0, 0.5], "orientation": [0.0, 0.0, 0.0, 1.0]}
            | {"covariance": SIX, "probability": 0.9, "time": 1.7e9},
        ),
    }


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the path to the first number of each list and to each number of an object."""
    if isinstance(value, dict):
        for name, each in value.items():
            yield from places(each, (*path, name))
    elif isinstance(value, list) and value:
        yield from places(value[0], (*path, 0))
        if len(value) > 1:
            yield from places(value[-1], (*path, len(value) - 1))
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield path


def replaced(body: dict[str, Any], path: tuple[Any, ...], number: float) -> dict[str, Any]:
    """Return a copy of the body with another number at one place."""
    changed = deepcopy(body)
    inner: Any = changed
    for each in path[:-1]:
        inner = inner[each]
    inner[path[-1]] = number
    return changed


def has_number(schema: Any, schemas: dict[str, Any], seen: set[str]) -> bool:
    """Return whether a JSON schema has a number anywhere."""
    if isinstance(schema, list):
        return any(has_number(each, schemas, seen) for each in schema)
    if not isinstance(schema, dict):
        return False
    if schema.get("type") in {"number", "integer"}:
        return True
    name = str(schema.get("$ref", "")).rpartition("/")[2]
    if name and name not in seen:
        seen.add(name)
        return has_number(schemas[name], schemas, seen)
    return any(has_number(each, schemas, seen) for each in schema.values())


def test_every_body_with_numbers_is_tried(manifest: Manifest) -> None:
    document = create_app(Settings()).openapi()
    schemas = document["components"]["schemas"]
    found = set()
    for methods in document["paths"].values():
        for about in methods.values():
            content = about.get("requestBody", {}).get("content", {})
            if JSON in content:
                found.add(content[JSON]["schema"]["$ref"].rpartition("/")[2])
    with_numbers = {each for each in found if has_number(schemas[each], schemas, set())}
    assert with_numbers == set(bodies(manifest.model_id))


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    service.put("/maps/yard", content=encode(map_of(random_codes(3), manifest.model_id)))
    return service


@pytest.mark.parametrize(
    "schema",
    [
        "DescribeRequest",
        "MatchRequest",
        "LocalizeRequest",
        "GeoAnchorIn",
        "FitRequest",
        "NamedAnchorIn",
        "RobotReportIn",
    ],
)
def test_wrong_number_in_any_field_is_refused(
    stocked: Any, manifest: Manifest, schema: str
) -> None:
    method, path, body = bodies(manifest.model_id)[schema]
    headers = {"Content-Type": JSON}
    told = stocked.request(method, path, json=body)
    assert told.status_code in {200, 201, 204} or schema == "FitRequest", told.text
    for place in places(body):
        for number in (float("nan"), float("inf"), float("-inf")):
            content = json.dumps(replaced(body, place, number))
            told = stocked.request(method, path, content=content, headers=headers)
            assert told.status_code in {400, 422}, (place, number, told.text)
        for number in (1e300, -1e300, 1e-320, -1.0, 10**400):
            content = json.dumps(replaced(body, place, number))
            told = stocked.request(method, path, content=content, headers=headers)
            assert told.status_code in {200, 201, 204, 400, 413, 422}, (place, number, told.text)
            assert "NaN" not in told.text
            assert "Infinity" not in told.text


@pytest.mark.parametrize("field", ["time", "probability"])
@pytest.mark.parametrize("number", [1e300, -1e300])
def test_huge_number_of_a_robot_is_refused(stocked: Any, field: str, number: float) -> None:
    told = stocked.put("/robots/ann", json={field: number})
    assert told.status_code == 422, told.text
