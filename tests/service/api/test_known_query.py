"""Query parameters: unknown and repeated ones are refused on all routes, wrong numbers as well."""

from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.app import create_app
from service.core.settings import Settings
from tests.service.core.test_auth import made
from tests.service.service_builders import assert_problem, map_of, random_codes

PROBES = {"/livez", "/readyz", "/metrics"}
NUMBERS = {"integer", "number"}


def operations() -> list[tuple[str, str, dict[str, Any]]]:
    """Return method, path and description of each route, with names filled in."""
    names = {"map": "yard", "other": "yard", "anchor": "dock", "robot": "ann", "id": 100}
    found = []
    for path, methods in create_app(Settings()).openapi()["paths"].items():
        filled = path.format(**names, digest="0" * 64, version=1)
        found += [(method.upper(), filled, about) for method, about in methods.items()]
    return found


def numbers_of(about: dict[str, Any]) -> list[str]:
    """Return the names of the query parameters that are numbers."""
    found = []
    for each in about.get("parameters", []):
        schema = each["schema"]
        kinds = {one.get("type") for one in schema.get("anyOf", [schema])}
        kinds |= {schema.get("items", {}).get("type")}
        if each["in"] == "query" and kinds & NUMBERS:
            found.append(each["name"])
    return found


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    service.put("/maps/yard", content=encode(map_of(random_codes(3), manifest.model_id)))
    return service


def test_unknown_parameter_is_refused_on_all_routes(stocked: Any) -> None:
    before = stocked.get("/maps/yard").headers["ETag"]
    for method, path, about in operations():
        told = stocked.request(method, path, params={"max_false_acceptanse": 1})
        if path in PROBES:
            assert told.status_code == 200, path
            continue
        assert_problem(told, 422, "invalid-request", "/query/max_false_acceptanse")
        known = [each["name"] for each in about.get("parameters", []) if each["in"] == "query"]
        words = f"The route takes {', '.join(known)}." if known else "takes no parameters"
        assert words in told.json()["detail"], path
    assert stocked.get("/maps/yard").headers["ETag"] == before


def test_misspelled_parameter_names_the_meant_one(stocked: Any) -> None:
    told = stocked.get("/maps/yard", params={"ignor": "movable"})
    assert_problem(told, 422, "invalid-request", "Did you mean 'ignore'? The route takes version")


def test_parameter_given_twice_is_refused_unless_it_takes_a_list(stocked: Any) -> None:
    told = stocked.get("/maps/yard/versions?limit=1&limit=2")
    assert_problem(told, 422, "invalid-request", "/query/limit: 2 values are given")
    assert stocked.get("/maps/yard?ignore=vehicle&ignore=person").status_code == 200


@pytest.mark.parametrize("value", ["nan", "inf", "-inf", "1e300", "-1e300", "", "0x1", "1" * 400])
def test_numbers_that_are_none_are_refused_on_all_routes(stocked: Any, value: str) -> None:
    tried = 0
    for method, path, about in operations():
        for name in numbers_of(about):
            told = stocked.request(method, path, params={name: value})
            assert told.status_code == 422, (method, path, name, told.text)
            pointers = [each["pointer"] for each in told.json()["errors"]]
            assert any(each.startswith(f"/query/{name}") for each in pointers)
            tried += 1
    assert tried >= 15


def test_pages_ignore_the_query(service: Any) -> None:
    for path in ("/docs?theme=dark", "/openapi.json?x=1", "/?map=yard"):
        assert service.get(path).status_code in {200, 404}, path
    assert service.get("/openapi.json?x=1").status_code == 200


def test_unknown_key_is_told_before_the_query(start: Any, tmp_path: Any) -> None:
    file = tmp_path / "keys.toml"
    made(file, "ann")
    with start(keys_file=file) as service:
        assert service.get("/maps?x=1").status_code == 401
