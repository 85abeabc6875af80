"""Cost limits: the cost of a request is estimated first, and too much work answers 413."""

import json
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client.http.parsing import info
from placecell_client.http.response import HttpResponse

from placecell.core.parameters import NEIGHBORHOOD_V1
from placecell.core.segments import Segments
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.neighborhood import voxels_by_owner
from placecell.map_alignment import AlignmentParameters
from placecell.pose_graph import PoseGraphParameters
from service.core.cost import (
    RATES,
    Cost,
    check_cost,
    cost_of_aligning,
    cost_of_describing,
    cost_of_search,
    near_voxels,
)
from service.core.problems import Problem
from service.core.settings import Limits
from service.merging.bending import cost_of_loops
from tests.service.merging.merged_map_builders import driven, merge, models_that_judge, put
from tests.service.service_builders import assert_problem, cloud, request_of


@pytest.fixture(scope="module")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "tiny")


def scan(segments: int, points: int, extent: float, size: float, seed: int = 0) -> Segments:
    """Return the segments of a scan, spread over a square."""
    random = np.random.default_rng(seed)
    middles = np.column_stack([random.uniform(-extent, extent, (segments, 2)), np.zeros(segments)])
    clouds = random.normal(0, size, (segments, points, 3)) + middles[:, None]
    return Segments.of(list(clouds.astype(np.float32)), np.zeros((segments, 3)))


def test_ordinary_and_largest_requests_are_not_refused() -> None:
    limits = Limits()
    for size in (0.8, 10.0, 100.0):
        whole = scan(limits.segments, limits.points // limits.segments, 40.0, size)
        cost = cost_of_describing(whole.points, whole.counts, NEIGHBORHOOD_V1)
        check_cost(cost + cost_of_search(1_000, 1_000_000, 25, 1), limits.cost_seconds)
    check_cost(cost_of_search(113, 20_000_000, 25, 1), limits.cost_seconds)
    sizes = [160_000, 160_000]
    check_cost(cost_of_aligning(sizes, 25, AlignmentParameters()), limits.alignment_seconds)


@pytest.mark.parametrize(("extent", "size"), [(40.0, 0.8), (500.0, 0.8), (60.0, 15.0)])
def test_near_voxels_estimate_is_within_a_factor(extent: float, size: float) -> None:
    segments = scan(80, 60, extent, size)
    voxels, owners = voxels_by_owner(segments, NEIGHBORHOOD_V1.voxel)
    away = np.linalg.norm(voxels[:, None, :2] - segments.centroids()[None, :, :2], axis=2)
    truly = int(np.count_nonzero(away < 40.0))
    told = near_voxels(segments.points, segments.counts, NEIGHBORHOOD_V1)
    assert 0.8 * truly <= told
    assert told <= min(len(segments) * len(segments.points), max(4 * truly, len(owners) * 20))


def test_costs_grow_with_the_work() -> None:
    small, large = scan(20, 50, 40.0, 2.0), scan(40, 50, 40.0, 2.0)
    one, other = (
        cost_of_describing(each.points, each.counts, NEIGHBORHOOD_V1) for each in (small, large)
    )
    assert other.points == pytest.approx(2 * one.points)
    assert other.network == pytest.approx(2 * one.network)
    assert 3 * one.neighborhoods < other.neighborhoods < 5 * one.neighborhoods
    assert cost_of_describing(small.points, small.counts, None).neighborhoods == 0.0
    assert cost_of_search(10, 1_000, 5, 1).search == pytest.approx(
        10 * 1_000 * (RATES.compared + 5 * RATES.compared_k)
    )
    # At most as many candidates as segments, and none without a map.
    assert cost_of_search(10, 3, 5, 1).candidates == pytest.approx(30 * RATES.candidate)
    assert cost_of_search(10, 0, 5, 0).seconds == 0.0
    # Re-ranking compares each candidate with at most 10 of 32 neighbors.
    for queries, pairs in ((1, 0), (2, 2 * 5 * 5), (1_000, 1_000 * 5 * 32 * 5)):
        plain, reranked = (
            cost_of_search(queries, 1_000, 5, 1, is_reranked) for is_reranked in (False, True)
        )
        assert reranked.candidates - plain.candidates == pytest.approx(pairs * RATES.supported)
        assert reranked.search == plain.search
    two, three = (cost_of_aligning([5_000] * maps, 25, AlignmentParameters()) for maps in (2, 3))
    assert three.seconds == pytest.approx(3 * two.seconds)


def test_no_segments_cost_nothing() -> None:
    nothing = scan(1, 5, 1.0, 1.0).take([])
    assert cost_of_describing(nothing.points, nothing.counts, NEIGHBORHOOD_V1) == Cost()


def test_refusal_states_cost_limit_and_remedy() -> None:
    with pytest.raises(Problem) as caught:
        check_cost(Cost(search=9.0, network=0.5), 8.0)
    assert (caught.value.status, caught.value.kind) == (413, "too-much-work")
    assert caught.value.detail == (
        "The request would cost 9.5 s of one core, most of it for search; the limit is 8 s. "
        "Name fewer maps, or send fewer segments."
    )


def test_describe_with_too_much_work_answers_413(start: Any) -> None:
    segments = request_of([cloud(seed) for seed in range(8)])
    for path in ("/describe", "/match", "/localize"):
        with start(limits={"cost_seconds": 9 * RATES.segment}) as service:
            assert service.post(path, json=segments).status_code == 200
        with start(limits={"cost_seconds": 7 * RATES.segment}) as service:
            response = service.post(path, json=segments)
            assert_problem(response, 413, "too-much-work", "Send fewer segments.")


def test_search_with_too_much_work_answers_413(start: Any, manifest: Manifest) -> None:
    content = driven(manifest.model_id, "east", 0, 150)
    asked = {"model_id": manifest.model_id, "codes": [[1] * content.code_bytes] * 50, "k": 10}
    cost = cost_of_search(50, len(content), 10, 1).seconds
    with start(limits={"cost_seconds": 1.01 * cost}) as service:
        put(service, "east", content)
        assert service.post("/match", json=asked).status_code == 200
        put(service, "again", content)
        assert service.post("/match", json=asked | {"maps": ["east"]}).status_code == 200
        assert_problem(service.post("/match", json=asked), 413, "too-much-work", "the limit is")


def test_alignment_with_too_much_work_answers_413(start: Any, manifest: Manifest) -> None:
    maps = {
        "east": driven(manifest.model_id, "east", 0, 150),
        "west": driven(manifest.model_id, "west", 60, 200),
    }
    sizes = [len(each) for each in maps.values()]
    seconds = 0.9 * cost_of_aligning(sizes, 25, AlignmentParameters()).seconds
    with start(limits={"alignment_seconds": seconds}) as service:
        for name, content in maps.items():
            put(service, name, content)
        response = service.post("/maps/east/align/west")
        assert_problem(response, 413, "too-much-work", "Align smaller maps")
        response = merge(service, "site", ["east", "west"])
        assert_problem(response, 413, "too-much-work", "Merge fewer or smaller maps")


def test_merge_that_bends_with_too_much_work_answers_413_before_it_begins(
    start: Any, manifest: Manifest
) -> None:
    maps = {
        "east": driven(manifest.model_id, "east", 0, 150),
        "west": driven(manifest.model_id, "west", 60, 200),
    }
    limit = 0.9 * cost_of_loops(list(maps.values()), PoseGraphParameters()).seconds
    sizes = [len(each) for each in maps.values()]
    assert limit > cost_of_aligning(sizes, 25, AlignmentParameters()).seconds
    with start(limits={"alignment_seconds": limit}) as service:
        for name, content in maps.items():
            put(service, name, content)
        response = merge(service, "site", ["east", "west"], rigid=False)
        assert_problem(response, 413, "too-much-work", "or with rigid: true")
        assert service.get("/maps/site").status_code == 404


def test_info_shows_rates_and_limits(service: Any) -> None:
    told = service.get("/info").json()
    assert told["limits"]["cost_seconds"] == Limits().cost_seconds
    assert told["costs"]["segment"] == RATES.segment
    assert told["costs"]["machine"]


@pytest.mark.parametrize("costs", [{"segment": 2.3e-4, "machine": "a core"}, None])
def test_client_parses_the_rates(costs: dict[str, Any] | None) -> None:
    content: dict[str, Any] = {
        "version": "1",
        "model": {"model_id": "m"},
        "limits": {"cost_seconds": 8.0},
        "map_file": {"version": 1},
    } | ({} if costs is None else {"costs": costs})
    headers = httpx.Headers({"content-type": "application/json"})
    assert info(HttpResponse(200, headers, json.dumps(content).encode())).costs == (costs or {})
