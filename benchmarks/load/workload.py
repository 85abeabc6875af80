"""What a service under load is asked, of real segments, and the map that it has."""

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
    """A way to ask: encoding, segments a request, and whether requests share batches."""

    media_type: str
    segments: int
    batching: bool

    @property
    def name(self) -> str:
        """For plots."""
        form = "msgpack" if self.media_type == MSGPACK else "JSON"
        return f"{form}, {self.segments} segments" + ("" if self.batching else ", no batching")


def match_requests(case: LoadCase, drawn: Segments, count: int, k: int) -> tuple[bytes, ...]:
    """So many whole requests to `/match`, each of other segments."""
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
    """Store a map: real descriptors, each again and again with some levels changed."""
    with Client(address) as client:
        some = drawn.take(np.arange(min(200, len(drawn))))
        described = client.describe([some.cloud(row) for row in range(len(some))], some.sensors)
        codes = perturbed(described.codes, count, seed)
        manifest = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
        client.put_map("bench", road_map(codes, manifest, "bench", seed=seed))


def perturbed(codes: Int8, count: int, seed: int) -> Int8:
    """So many codes: those given, in turn, a tenth of their bytes drawn from others."""
    random = np.random.default_rng(seed)
    many = codes[np.arange(count) % len(codes)]
    strangers = codes[random.integers(len(codes), size=many.shape), np.arange(codes.shape[1])]
    return np.where(random.random(many.shape) < 0.1, strangers, many).astype(np.int8)
