"""The way of a request through the files stays short: docs/explanation/architecture.md tells it."""

from collections.abc import Callable
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.extractor import OnnxExtractor
from placecell.descriptors.manifest import Manifest
from tests.service.request_tracing import end_at_commit, ended_by, trace_of_search, traced
from tests.service.service_builders import cloud, map_of, random_codes, request_of

pytestmark = pytest.mark.sqlite

MOST = 15
"""Largest number of files that a request for recognition passes."""

MOST_OF_UPLOAD = 14
"""Largest number of files that an upload of a new map passes."""

MOST_OF_REPLACEMENT = 17
"""Largest number of files that an upload passes that replaces a map: it is compared as well."""


@pytest.mark.parametrize("path", ["match", "localize"])
def test_search_passes_few_files_from_route_to_faiss(
    start: Callable[..., Any], models_dir: Any, monkeypatch: pytest.MonkeyPatch, path: str
) -> None:
    trace = trace_of_search(start, models_dir, monkeypatch, path)
    assert trace.has_ended
    assert "service/maps/index.py" in trace.passed
    assert len(trace.passed) <= MOST, trace.passed


def test_describe_passes_few_files_from_route_to_network(
    start: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    with traced(("service/api/routes/describe.py", "describe")) as trace:
        monkeypatch.setattr(OnnxExtractor, "_run", ended_by(trace, OnnxExtractor._run))
        with start(model="onnx") as service:
            request = request_of([cloud(seed) for seed in range(8)])
            assert service.post("/describe", json=request).status_code == 200
    assert trace.has_ended
    assert "placecell/descriptors/extractor.py" in trace.passed
    assert len(trace.passed) <= MOST, trace.passed


@pytest.mark.parametrize("replaces", [False, True])
def test_upload_passes_few_files_from_route_to_sqlite(
    start: Callable[..., Any],
    manifest: Manifest,
    monkeypatch: pytest.MonkeyPatch,
    replaces: bool,
) -> None:
    with traced(("service/api/routes/maps.py", "put_map")) as trace:
        end_at_commit(trace, monkeypatch)
        with start() as service:
            for seed in range(1 + replaces):
                trace.has_ended, trace.passed, trace.files = False, [], []
                yard = encode(map_of(random_codes(20, seed), manifest.model_id))
                answer = service.put(
                    "/maps/yard", content=yard, headers={"If-Match": "*"} if seed else {}
                )
                assert answer.status_code == (200 if seed else 201)
    assert trace.has_ended
    assert "service/maps/sqlite/store.py" in trace.passed
    most = MOST_OF_REPLACEMENT if replaces else MOST_OF_UPLOAD
    assert len(trace.passed) <= most, trace.passed
