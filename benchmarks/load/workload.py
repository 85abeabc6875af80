"""Requests of real segments for a service under load, and the map that it searches."""

import json
from dataclasses import dataclass

import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Client

from benchmarks.load.generator import encode_request
from benchmarks.synthetic_maps.road_map import road_map
from placecell.core.segments import Segments
from placecell.core.types import Int8
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.api.body.body import MSGPACK


@dataclass(frozen=True, slots=True)
class LoadCase:
    """Kind of request.

    Attributes:
        media_type: encoding of the request.
        segments: segments per request.
        batching: whether the service batches across requests.
    """

    media_type: str
    segments: int
    batching: bool

    @property
    def name(self) -> str:
        """Return the name of the case in the report and the plot."""
        form = "msgpack" if self.media_type == MSGPACK else "JSON"
        return f"{form}, {self.segments} segments" + ("" if self.batching else ", no batching")


def match_requests(case: LoadCase, drawn: Segments, count: int, k: int) -> tuple[bytes, ...]:
    """Return `count` encoded `/match` requests, each with other segments.

    Args:
        case: kind of request.
        drawn: segments to send.
        count: number of requests.
        k: candidates per segment.
    """
    bodies = []
    for number in range(count):
        rows = (number * case.segments + np.arange(case.segments)) % len(drawn)
        packed = case.media_type == MSGPACK
        segments = [
            {
                "points": cloud.astype("<f4").tobytes() if packed else cloud.tolist(),
                "sensor": drawn.sensors[row].tolist(),
            }
            for row in rows
            for cloud in [drawn.cloud(int(row))]
        ]
        content = {"segments": segments, "k": k}
        body = msgpack.packb(content) if packed else json.dumps(content).encode()
        bodies.append(encode_request("/match", case.media_type, body))
    return tuple(bodies)


def store_map(address: str, drawn: Segments, count: int, seed: int) -> None:
    """Store a map of `count` segments: real descriptors, repeated with random changes."""
    with Client(address) as client:
        some = drawn.take(np.arange(min(200, len(drawn))))
        described = client.describe([some.cloud(row) for row in range(len(some))], some.sensors)
        codes = perturbed(described.codes, count, seed)
        manifest = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
        client.put_map("bench", road_map(codes, manifest, "bench", seed=seed))


def perturbed(codes: Int8, count: int, seed: int) -> Int8:
    """Return `count` codes: the given codes in turn, with a tenth of the bytes from other codes."""
    random = np.random.default_rng(seed)
    many = codes[np.arange(count) % len(codes)]
    strangers = codes[random.integers(len(codes), size=many.shape), np.arange(codes.shape[1])]
    return np.where(random.random(many.shape) < 0.1, strangers, many).astype(np.int8)
