"""Tiny models, clouds and maps for a service under test."""

import asyncio
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
import onnx
from onnx import TensorProto, helper
from placecell_client import CompactMap, Delta, encode_delta

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float64, Int8
from placecell.descriptors.manifest import Manifest, preprocessing_of
from placecell.descriptors.quantizer import Quantizer

STEP = 0.02
PROBLEM = "application/problem+json"
MSGPACK = "application/msgpack"


def write_eigenvalue_model(
    models_dir: Path, name: str = "tiny", step: float = STEP, pair_threshold: float = 0.0
) -> Manifest:
    """A model that needs no network: seven standardised features."""
    manifest = Manifest(
        name=name,
        method="eigenvalue",
        network="",
        dimension=7,
        quantizer=Quantizer(step),
        preprocessing=preprocessing_of(PROTOCOL_V1),
        standardization={"mean": [0.3] * 7, "deviation": [0.2] * 7},
        pair_threshold=pair_threshold,
    )
    (models_dir / name).mkdir(parents=True)
    manifest.save(models_dir / name)
    return manifest


def write_onnx_model(models_dir: Path, name: str = "onnx") -> Manifest:
    """A model with a network: mean occupancy of each layer of the grid, and the extents."""
    grid = PROTOCOL_V1.grid
    graph = helper.make_graph(
        [
            helper.make_node("Cast", ["occupancy"], ["grid"], to=TensorProto.FLOAT),
            helper.make_node("ReduceMean", ["grid", "axes"], ["layers"], keepdims=0),
            helper.make_node("Concat", ["layers", "extents"], ["descriptor"], axis=1),
        ],
        "layers",
        [
            helper.make_tensor_value_info("occupancy", TensorProto.UINT8, ["N", *grid]),
            helper.make_tensor_value_info("extents", TensorProto.FLOAT, ["N", 3]),
        ],
        [helper.make_tensor_value_info("descriptor", TensorProto.FLOAT, ["N", grid[2] + 3])],
        [helper.make_tensor("axes", TensorProto.INT64, [2], [1, 2])],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 18)], ir_version=9)
    folder = models_dir / name
    folder.mkdir(parents=True)
    onnx.save(model, folder / "model.onnx")
    manifest = Manifest(
        name=name,
        method="group",
        network="layers",
        dimension=grid[2] + 3,
        quantizer=Quantizer(0.05),
        preprocessing=preprocessing_of(PROTOCOL_V1),
    ).with_files(folder, ["model.onnx"])
    manifest.save(folder)
    return manifest


def cloud(seed: int, points: int = 200) -> Float64:
    """Points of a segment, float64 (points, 3), meters, at most some 20 m from the origin."""
    random = np.random.default_rng(seed)
    spread = random.uniform(0.1, 2.0, 3)
    return np.asarray(random.normal(size=(points, 3)) * spread + random.uniform(-8, 8, 3))


def request_of(clouds: list[Float64], sensor: tuple[float, ...] = (9.0, -3.0, 1.7)) -> Any:
    """The body of a `/describe`."""
    return {"segments": [{"points": item.tolist(), "sensor": sensor} for item in clouds]}


def random_codes(rows: int, seed: int = 0, dimension: int = 7) -> Int8:
    return np.random.default_rng(seed).integers(-127, 128, (rows, dimension)).astype(np.int8)


def map_of(
    codes: Int8, model_id: str, first_id: int = 100, robot: str = "ann", frame: str = "town"
) -> CompactMap:
    """A map with these descriptors; ids rise with the rows."""
    n = len(codes)
    meters = np.arange(n) % 300
    return CompactMap(
        model_id=model_id,
        preprocessing="1",
        frame=frame,
        codes=codes,
        centroids=np.stack([meters, -meters, np.full(n, 1.5)], axis=1).astype(float),
        ids=np.arange(first_id, first_id + n, dtype=np.uint32),
        robots=(robot,),
        robot=np.zeros(n, np.uint16),
        frame_index=np.zeros(n, np.uint32),
        frame_times=np.array([1.7e9]),
        frame_positions=np.zeros((1, 3)),
        frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
    )


def edit_of(
    codes: Int8, model_id: str, first_id: int = 100, robot: str = "ann", removed: Iterable[int] = ()
) -> bytes:
    """A delta file that puts these descriptors under ids that rise, and removes some."""
    changed = map_of(codes, model_id, first_id, robot)
    return encode_delta(Delta(changed, np.array([*removed], np.uint32)))


def assert_problem(response: Any, status: int, kind: str, detail: str = "") -> None:
    """The response is this problem, and its detail holds these words."""
    assert response.status_code == status, response.text
    assert response.headers["content-type"] == PROBLEM
    body = response.json()
    assert body["type"] == f"urn:placecell:problem:{kind}"
    assert body["status"] == status
    assert body["title"]
    assert detail in body["detail"], body


def packed(body: dict[str, Any]) -> dict[str, Any]:
    """The same request with the blobs of msgpack in place of lists."""
    content = dict(body)
    if body.get("segments") is not None:
        content["segments"] = [
            each | {"points": np.array(each["points"], "<f4").tobytes()}
            for each in body["segments"]
        ]
    if body.get("codes") is not None:
        content["codes"] = np.array(body["codes"], np.int8).tobytes()
    if isinstance(body.get("centroids"), list):
        content["centroids"] = np.array(body["centroids"], "<f8").tobytes()
    return content


def post_packed(service: Any, path: str, body: Any, accept: str = MSGPACK) -> Any:
    """Send a body as msgpack; bytes are sent as they are."""
    content = body if isinstance(body, bytes) else msgpack.packb(body)
    return service.post(path, content=content, headers={"Content-Type": MSGPACK, "Accept": accept})


async def ask_app(app: Any, body: Any, leave_after: float = 60.0) -> list[dict[str, Any]]:
    """Return what an application sends for a `/describe` whose client leaves after some seconds."""
    sent: list[dict[str, Any]] = []
    messages = [{"type": "http.request", "body": json.dumps(body).encode(), "more_body": False}]

    async def receive() -> dict[str, Any]:
        if messages:
            return messages.pop(0)
        await asyncio.sleep(leave_after)
        return {"type": "http.disconnect"}

    async def send(message: Any) -> None:
        sent.append(message)

    scope = {
        "type": "http", "method": "POST", "path": "/describe", "raw_path": b"/describe",
        "query_string": b"", "headers": [(b"content-type", b"application/json")],
        "http_version": "1.1", "scheme": "http", "server": ("x", 80), "client": ("y", 1),
        "root_path": "",
    }  # fmt: skip
    await app(scope, receive, send)
    return sent
