"""No loop is compiled in a request: all are compiled at the start."""

from collections.abc import Callable
from typing import Any

from placecell_client import encode

from placecell.core import nearest
from placecell.descriptors import reranking
from placecell.localization import clique, consistency, correspondences, refinement, voting
from placecell.segmentation import ground, region_growing
from service.api.body import json_arrays
from tests.service.clouds.scan_files import scan_file
from tests.service.service_builders import cloud, map_of, random_codes, request_of


def test_no_loop_is_compiled_in_a_request(start: Callable[..., Any], manifest: Any) -> None:
    loops = {
        each
        for module in (
            json_arrays,
            nearest,
            clique,
            consistency,
            correspondences,
            refinement,
            region_growing,
            reranking,
            ground,
            voting,
        )
        for each in vars(module).values()
        if hasattr(each, "nopython_signatures")
    }
    with start() as client:
        before = {each: len(each.nopython_signatures) for each in loops}
        assert before[consistency.count_votes]
        assert before[correspondences._lead]
        assert before[voting._vote]
        assert before[region_growing._label]
        assert before[reranking.count_supports]
        yard = encode(map_of(random_codes(50), manifest.model_id))
        for name in ("a", "b", "c"):
            assert client.put(f"/maps/{name}", content=yard).status_code == 201
        clouds = [cloud(seed) + 10 * seed for seed in range(8)]
        assert client.post("/localize", json=request_of(clouds)).status_code == 200
        assert client.post("/match", json=request_of(clouds)).status_code == 200
        assert client.post("/scans", content=scan_file("ply")[2]).status_code == 200
        assert {each: len(each.nopython_signatures) for each in loops} == before


def test_limits_that_refuse_the_scan_do_not_prevent_the_start(start: Callable[..., Any]) -> None:
    with start(limits={"segments": 1, "points": 10}) as client:
        assert client.get("/readyz").status_code == 200
