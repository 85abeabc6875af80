"""The page on the HTTP API has an example of every route, and the service answers as it says."""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import Client, CompactMap, Delta
from placecell_client.maps.edit import take

from benchmarks.synthetic_maps.road_map import road_map
from cli.reference.routes import openapi, routes_of
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.child_process import running_service
from tests.docs.http_examples import PAGE, Example, examples, prepare, run

EXAMPLES = list(examples(PAGE.read_text(encoding="utf-8")))
SEGMENTS = 600
"""Segments of a map: enough for a file of two parts."""
NAMED_FREELY = {"robots", "sources"}
"""Keys of objects whose own keys are names of robots or maps."""


def random_map(robot: str, seed: int) -> CompactMap:
    manifest = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
    codes = np.random.default_rng(seed).integers(-128, 128, (SEGMENTS, manifest.code_bytes))
    return road_map(codes.astype(np.int8), manifest, robot)


@pytest.fixture(scope="module")
def stocked(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Path]]:
    folder = tmp_path_factory.mktemp("examples")
    random = np.random.default_rng(0)
    clouds = [random.normal(size=(200, 3)) + [12, 5 * n, 0] for n in range(6)]
    yard = random_map("ann", 0)
    new = replace(
        take(yard, np.arange(20)), ids=np.arange(SEGMENTS, SEGMENTS + 20, dtype=np.uint32)
    )
    with running_service(folder / "var") as address, Client(address) as client:
        prepare(
            client,
            folder,
            yard=yard,
            newer=take(yard, np.arange(500)),
            hall=random_map("bob", 2),
            clouds=clouds,
            sensors=[[0.0, 0.0, 1.8]] * len(clouds),
            edit=Delta(new, np.zeros(0, np.uint32)),
        )
        yield address, folder


def test_every_route_has_an_example() -> None:
    assert sorted(example.route for example in EXAMPLES) == sorted(
        name for name, _ in routes_of(openapi())
    )


def test_examples_show_the_keys_that_the_service_answers(stocked: tuple[str, Path]) -> None:
    # In the order of the page: each example finds the maps as the ones before it left them.
    address, folder = stocked
    answers = {example.route: run(example, address, folder) for example in EXAMPLES}
    for example in EXAMPLES:
        if example.answer:
            compare(json.loads(example.answer), json.loads(answers[example.route]), example.route)
        elif example.route not in {"GET /metrics", "GET /events"}:  # they answer with text
            assert not answers[example.route], f"{example.route}: the page shows no answer"


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.route)
def test_shown_answers_have_the_keys_of_the_schema(example: Example) -> None:
    document = openapi()
    route = dict(routes_of(document))[example.route]
    for status in ("200", "201"):
        content = route["responses"].get(status, {}).get("content", {})
        schema = content.get("application/json", {}).get("schema", {})
        if example.answer and schema:
            check(json.loads(example.answer), schema, document, example.route)


def compare(shown: Any, answer: Any, where: str) -> None:
    """Compare the keys of an example's answer with those of a real one."""
    if isinstance(shown, dict) and isinstance(answer, dict):
        assert shown.keys() == answer.keys(), where
        for key in shown.keys() - NAMED_FREELY:
            compare(shown[key], answer[key], f"{where}/{key}")
    elif isinstance(shown, list) and isinstance(answer, list) and shown and answer:
        compare(shown[0], answer[0], f"{where}/0")


def check(shown: Any, schema: dict[str, Any], document: dict[str, Any], where: str) -> None:
    """Check that an answer has the keys that its schema requires, and no others."""
    if "$ref" in schema:
        schema = document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    for word in ("anyOf", "oneOf"):
        if word in schema:
            if shown is None:
                return
            choices = [each for each in schema[word] if each.get("type") != "null"]
            if len(choices) > 1:
                return
            schema = choices[0]
            check(shown, schema, document, where)
            return
    if isinstance(shown, dict) and "properties" in schema:
        assert set(schema.get("required", [])) <= shown.keys() <= schema["properties"].keys(), where
        for key, value in shown.items():
            check(value, schema["properties"][key], document, f"{where}/{key}")
    elif isinstance(shown, list) and shown and "items" in schema:
        check(shown[0], schema["items"], document, f"{where}/0")
