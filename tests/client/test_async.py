"""`AsyncClient` behaves like `Client`."""

import asyncio
import gzip
import inspect
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import (
    AsyncClient,
    Client,
    Delta,
    Description,
    Localizations,
    MapAlignment,
    Merge,
    ScannedFile,
    encode,
    encode_delta,
)

from tests.client.client_fakes import (
    ALIGNED,
    DESCRIBED,
    INFO,
    LISTED,
    LOCALIZED,
    MATCHED,
    MERGED,
    SUMMARY,
    VERSION,
    WRITTEN,
    Blocking,
    async_client_of,
    client_of,
    packed,
)
from tests.client.map_builders import random_map

CLOUD = np.arange(12, dtype=np.float64).reshape(4, 3)
MAP = random_map()
OWN = {"x-request-id", "placecell-timeout", "placecell-seen"}
"""Headers that differ: `Blocking` makes a client for each call, which has seen nothing."""

PATIENCE = 10
"""Silence of the server, seconds; no test waits for its end."""


def public(kind: type) -> dict[str, list[tuple[str, Any, Any]]]:
    """Return the methods with names, kinds and defaults of their arguments."""
    return {
        name: [(part.name, part.kind, part.default) for part in signature.parameters.values()]
        for name, method in inspect.getmembers(kind, inspect.isfunction)
        if not name.startswith("_")
        for signature in [inspect.signature(method)]
    }


def test_both_clients_have_the_same_methods() -> None:
    assert public(Client) == public(AsyncClient)
    constructors = [list(inspect.signature(kind).parameters) for kind in (Client, AsyncClient)]
    assert constructors[0] == constructors[1]
    assert set(public(Client)) == {
        "close", "info", "describe", "match", "localize", "maps", "put_map", "edit_map",
        "reserve_ids", "pull", "changes", "get_map", "get_map_file", "versions", "restore_map",
        "prune_map", "align_maps", "merge_maps", "compact_map", "delete_map", "uploads",
        "delete_upload", "reset_ids", "report_pose", "robots", "robot",
        "key", "scan_file", "add_scan", "version_changes", "export",
        "coverage", "tags", "set_tags", "anchor", "set_anchor", "delete_anchor", "fit_anchor",
        "anchors", "named_anchor", "set_named_anchor", "delete_named_anchor", "events",
        "mirror", "set_mirror", "delete_mirror", "optimize_map", "segment_shape",
            "segment_shapes",
    }  # fmt: skip


DELTA = Delta(MAP, np.zeros(0, np.uint32), 0, 4)
FILE = httpx.Response(
    200, content=encode(MAP), headers={"Content-Type": "application/vnd.placecell.map"}
)
SCANNED = {
    "format": "PCD",
    "points": 3,
    "dropped_points": 1,
    "segments": [
        {"points": [[1, 2, 3], [2, 3, 4]], "centroid": [1.5, 2.5, 3.5], "extents": [1, 1, 1]}
    ],
    "sensors": [[0, 0, 0]],
    "cloud": {"points": [[1, 2, 3]], "labels": [0]},
    "transform": np.eye(4).tolist(),
    "sensor_height": None,
    "problems": ["odd"],
    "later": "field",
}
KEY = {
    "name": "ann", "role": "write", "may_write": True, "maps": ["*"], "robot": None, "open": False,
    "later": "field",
}  # fmt: skip
ANSWERS = {
    ("GET", "/key"): httpx.Response(200, json=KEY),
    ("POST", "/scans"): httpx.Response(200, json=SCANNED),
    ("POST", "/maps/yard/scans"): httpx.Response(
        200, json=WRITTEN | {"ids": [7, 8], "unusable": 1, "problems": []}
    ),
    ("GET", "/maps/yard/export"): httpx.Response(
        200, content=b"ply", headers={"Content-Disposition": 'attachment; filename="yard.ply"'}
    ),
    ("GET", "/maps/yard/versions/4/changes"): httpx.Response(
        200,
        content=encode_delta(DELTA),
        headers={"Content-Type": "application/vnd.placecell.delta", "ETag": '"e-4"'},
    ),
    ("GET", "/info"): httpx.Response(200, json=INFO),
    ("POST", "/describe"): packed(DESCRIBED),
    ("POST", "/match"): packed(MATCHED),
    ("POST", "/localize"): packed(LOCALIZED),
    ("GET", "/maps"): httpx.Response(200, json=LISTED),
    ("PUT", "/maps/yard"): httpx.Response(201, json=SUMMARY),
    ("GET", "/maps/yard"): FILE,
    ("DELETE", "/maps/yard"): httpx.Response(204),
    ("POST", "/maps/yard/segments"): httpx.Response(200, json=WRITTEN),
    ("POST", "/maps/yard/versions/3/restore"): httpx.Response(200, json=WRITTEN),
    ("POST", "/maps/yard/age"): httpx.Response(200, json=WRITTEN),
    ("POST", "/maps/yard/ids"): httpx.Response(200, json={"first": 7, "count": 2}),
    ("POST", "/maps/yard/compact"): httpx.Response(200, json={"oldest": 3}),
    ("POST", "/maps/yard/align/hall"): httpx.Response(200, json=ALIGNED),
    ("POST", "/maps/site/merge"): httpx.Response(200, json=MERGED),
    ("GET", "/maps/yard/versions"): httpx.Response(200, json={"versions": [VERSION]}),
    ("GET", "/maps/yard/changes"): httpx.Response(
        200,
        content=encode_delta(DELTA),
        headers={"Content-Type": "application/vnd.placecell.delta", "ETag": '"e-4"'},
    ),
}


def answer(request: httpx.Request) -> httpx.Response:
    return ANSWERS[request.method, request.url.path]


def plain(result: Any) -> Any:
    """Convert a result to values that can be compared."""
    if isinstance(result, Description):
        return [
            result.model_id, result.codes.tolist(), result.descriptors.tolist(),
            result.centroids.tolist(), result.errors,
        ]  # fmt: skip
    if isinstance(result, Localizations):
        (found,) = result.maps
        assert found.pose is not None
        return [found.map, found.pose.matrix.tolist(), found.inliers.ids.tolist(), result.skipped]
    if isinstance(result, MapAlignment):
        assert result.pose is not None
        return [result.map, result.pose.matrix.tolist(), result.inliers.ids.tolist(), result.pairs]
    if isinstance(result, Merge):
        return [result.etag, [part.map for part in result.parts], result.loops]
    if isinstance(result, ScannedFile):
        arrays: list[Any] = [
            result.sensors,
            result.centroids,
            result.extents,
            result.cloud,
            result.labels,
        ]
        return [result.format, result.problems, *(each.tolist() for each in arrays)]
    return encode(result) if hasattr(result, "frame_times") else result


@pytest.mark.parametrize("options", [{}, {"compress": True, "key": "k", "encoding": "json"}])
def test_both_clients_send_and_return_the_same(options: dict[str, Any]) -> None:
    told: list[Any] = []
    for make in (client_of, Blocking):
        seen: list[Any] = []

        def keep(request: httpx.Request, seen: list[Any] = seen) -> httpx.Response:
            headers = {k: v for k, v in request.headers.items() if k not in OWN}
            seen.append((request.method, request.url.raw_path, headers, request.content))
            return answer(request)

        client: Any = make(keep, **options)
        described = client.describe([CLOUD], [1.0, 2.0, 3.0])
        assert described.codes.tolist() == [[3, -1]]
        results = [
            described,
            client.info(),
            client.match(described, maps=["yard"], k=3),
            client.match(segments=[CLOUD], sensors=[1.0, 2.0, 3.0]),
            client.localize(described, maps=["yard"], motion="se3", session="s"),
            client.localize(segments=[CLOUD], sensors=[1.0, 2.0, 3.0], k=7),
            client.maps(),
            client.put_map("yard", MAP),
            client.get_map("yard"),
            client.get_map_file("yard"),
            client.delete_map("yard"),
            client.edit_map("yard", Delta(MAP, np.zeros(0, np.uint32)), robot="ann", create=True),
            client.restore_map("yard", 3, if_match="e-3"),
            client.prune_map("yard", 1.5, dry_run=True),
            client.align_maps("yard", "hall", motion="se3", pairs=True),
            client.merge_maps("site", ["yard", "shed"], deduplicate=False, if_match="s-3"),
            client.reserve_ids("yard", 2).tolist(),
            client.compact_map("yard", keep=2),
            client.versions("yard"),
            client.changes("yard", "e-3", limit=5).delta.changed,
            client.pull("yard").content,
            client.key(),
            client.scan_file(b"pcd", file_name="a.pcd"),
            client.add_scan("yard", b"pcd", robot="ann", position=[1, 2, 3], yaw=0.5, create=True),
            client.version_changes("yard", 4).changed,
            client.export("yard", "ply", color="robot", version=3),
        ]
        told.append(([plain(result) for result in results], seen))
    assert told[0] == told[1]
    assert len(told[0][1]) == 26


def test_option_compress_sends_maps_as_gzip() -> None:
    for make, large in ((client_of, True), (Blocking, True), (client_of, False)):
        sent: list[httpx.Request] = []

        def keep(request: httpx.Request, sent: list[httpx.Request] = sent) -> httpx.Response:
            sent.append(request)
            return answer(request)

        data = encode(MAP) if large else b"m" * 1024
        client: Any = make(keep, compress=True)
        client.put_map("yard", data)
        client.info()
        if large:
            assert sent[0].headers["Content-Encoding"] == "gzip"
            assert gzip.decompress(sent[0].content) == data
            # The gzip header holds no time, so equal maps are equal uploads.
            assert sent[0].content[4:8] == bytes(4)
        else:
            assert "Content-Encoding" not in sent[0].headers
            assert sent[0].content == data
        assert "Content-Encoding" not in sent[1].headers


def test_tasks_share_a_client() -> None:
    async def calls() -> list[Any]:
        async with async_client_of(answer) as client:
            return await asyncio.gather(*(client.info() for _ in range(20)))

    assert len(asyncio.run(calls())) == 20


async def silent(request: httpx.Request) -> httpx.Response:
    await asyncio.sleep(PATIENCE)
    return answer(request)


def test_a_call_can_be_cancelled() -> None:
    async def call() -> None:
        async with (
            AsyncClient("http://service", transport=httpx.MockTransport(silent)) as client,
            asyncio.timeout(0.05),
        ):
            await client.info()

    with pytest.raises(TimeoutError):
        asyncio.run(call())


def test_call_without_an_answer_times_out() -> None:
    async def call() -> None:
        transport = httpx.MockTransport(silent)
        async with AsyncClient("http://service", 0.05, transport=transport) as client:
            await client.info()

    with pytest.raises(httpx.ReadTimeout):
        asyncio.run(call())
