"""How quick `/localize` is on an idle service: the real server over loopback, maps of any size.

Descriptors are those of `map_content`: real segments, each view of a thing with the difference that
two real ones have. Here the views of a thing also lie where it stands, within some decimetres, and
what is asked about are the things along a stretch of the road, in a frame of the robot's own.
"""

import asyncio
import tempfile
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Client, CompactMap, Description, encode

from bench.load import Load, request_of, sent_by_process
from bench.map_content import VIEWS, Views, map_of
from bench.pose_queries import random_frame
from bench.serve import percentiles
from bench.server import address_of, running_service
from segments.extraction import Progress, silent
from segments.localisation import Pose
from service.bodies import MSGPACK
from training.evaluation import machine

MAP = "road"

SCATTER = 0.3
"""Of a thing's centroid between its views, standard deviation along each axis, metres."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What is measured.

    Attributes:
        sizes: segments of the map.
        queries: segments of a request.
        k: candidates a segment.
        rate: requests a second: each finds the service idle.
        seconds: of each map.
        requests: different ones, sent in turn.
    """

    sizes: tuple[int, ...] = (10_000,)
    queries: int = 50
    k: int = 25
    rate: float = 10.0
    seconds: float = 30.0
    requests: int = 100


def bench(
    views: Views, plan: Plan, seed: int = 0, *, progress: Progress = silent
) -> dict[str, Any]:
    """Measure all; the report as `placecell bench localize` writes it."""
    rows = []
    with tempfile.TemporaryDirectory(prefix="placecell-bench-") as folder:
        for number in progress(range(len(plan.sizes)), len(plan.sizes), "maps"):
            size, data = plan.sizes[number], Path(folder) / str(number)
            rows.append(_row(views, size, plan, data, seed))
    return {
        "rows": rows,
        "model_id": views.manifest.model_id,
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }


def _row(views: Views, size: int, plan: Plan, data: Path, seed: int) -> dict[str, Any]:
    frame = random_frame(seed)
    road, asked = road_with_queries(views, size, plan, frame, seed)
    with running_service(data) as address, Client(address, timeout=120) as client:
        client.put_map(MAP, encode(road))
        right = sum(_is_right(client, each, plan.k, frame) for each in asked)
        sent = tuple(request_of("/localize", MSGPACK, _body(each, plan.k)) for each in asked)
        load = Load(*address_of(address), sent, plan.rate, plan.seconds)
        outcome = asyncio.run(sent_by_process(load, data))
    if set(outcome.statuses) != {200}:
        raise RuntimeError(f"/localize was answered {set(outcome.statuses)}")
    return {
        "segments": size,
        "requests": len(outcome.statuses),
        "localised_right": round(right / len(asked), 4),
        "milliseconds": percentiles(np.array(outcome.milliseconds)),
        "stages": {stage: percentiles(np.array(spent)) for stage, spent in outcome.stages.items()},
    }


def road_with_queries(
    views: Views, size: int, plan: Plan, frame: Pose, seed: int
) -> tuple[CompactMap, Sequence[Description]]:
    """A map of so many segments, and what a robot sees of it.

    Args:
        frame: from the map's to the robot's own.
    """
    random = np.random.default_rng(seed)
    content = views.draw(size, size // VIEWS, seed)
    road = map_of(content.codes, views.manifest, "ann", seed=seed)
    things = road.centroids[::VIEWS]
    scatter = random.normal(scale=SCATTER, size=(size, 3))
    road = replace(road, centroids=things[content.things] + scatter)
    # Each thing is asked about once: in their order, as they stand along the road.
    asked = content.asked[np.argsort(content.asked_things)]
    stretches = len(asked) // plan.queries
    descriptions = []
    for stretch in random.permutation(stretches)[: plan.requests]:
        rows = stretch * plan.queries + np.arange(plan.queries)
        seen = things[rows] + random.normal(scale=SCATTER, size=(plan.queries, 3))
        nothing = np.zeros((plan.queries, 0), np.float32)
        descriptions.append(
            Description(content.model_id, asked[rows], nothing, frame.apply(seen), {})
        )
    return road, descriptions


def _is_right(client: Client, asked: Description, k: int, frame: Pose) -> bool:
    (found,) = client.localize(asked, maps=[MAP], k=k).maps
    if found.pose is None:
        return False
    middle = asked.centroids.mean(axis=0)
    metres, angle = Pose.of_matrix(found.pose.matrix).difference(frame.inverse(), middle)
    return metres <= 1.0 and bool(np.degrees(angle) <= 3.0)


def _body(asked: Description, k: int) -> bytes:
    content = {
        "model_id": asked.model_id,
        "codes": asked.codes.tobytes(),
        "centroids": asked.centroids.astype("<f8").tobytes(),
        "maps": [MAP],
        "k": k,
    }
    return bytes(msgpack.packb(content))
