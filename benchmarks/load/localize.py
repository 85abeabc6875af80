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
from placecell_client import Client, CompactMap, Description, Localization, encode
from placecell_client.maps.edit import take

from benchmarks.load.generator import Load, encode_request, send_from_process
from benchmarks.load.serve import percentiles
from benchmarks.synthetic_maps.descriptor_sampler import VIEWS, DescriptorSampler
from benchmarks.synthetic_maps.road_map import road_map
from evaluation.machine import machine
from evaluation.poses.queries import random_frame
from placecell.localization import Pose
from placecell.segmentation.pipeline import Progress, silent
from service.api.body.body import MSGPACK
from service.child_process import address_of, running_service

MAP = "road"

SCATTER = 0.3
"""Of a thing's centroid between its views, standard deviation along each axis, metres."""


@dataclass(frozen=True, slots=True)
class LocalizePlan:
    """Sizes and rates of the measurement.

    Attributes:
        sizes: segments of the map.
        queries: segments of a request.
        k: candidates a segment.
        rate: requests a second: each finds the service idle; a quarter of it where no map is named.
        seconds: of each map.
        requests: different ones, sent in turn.
        maps: that are searched together, by requests that name none; 0: this is not measured.
        map_segments: of each of those maps.
    """

    sizes: tuple[int, ...] = (10_000,)
    queries: int = 50
    k: int = 25
    rate: float = 10.0
    seconds: float = 30.0
    requests: int = 100
    maps: int = 0
    map_segments: int = 300


def measure_localize(
    views: DescriptorSampler, plan: LocalizePlan, seed: int = 0, *, progress: Progress = silent
) -> dict[str, Any]:
    """Measure all; the report as `placecell bench localize` writes it."""
    rows: list[dict[str, Any]] = []
    together: dict[str, Any] | None = None
    with tempfile.TemporaryDirectory(prefix="placecell-bench-") as folder:
        for number in progress(range(len(plan.sizes)), len(plan.sizes), "maps"):
            size, data = plan.sizes[number], Path(folder) / str(number)
            rows.append(_row(views, size, plan, data, seed))
        if plan.maps:
            together = _together(views, plan, Path(folder) / "together", seed)
    return {
        "rows": rows,
        "together": together,
        "model_id": views.manifest.model_id,
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }


def _row(
    views: DescriptorSampler, size: int, plan: LocalizePlan, data: Path, seed: int
) -> dict[str, Any]:
    frame = random_frame(seed)
    road, asked = road_with_queries(views, size, plan, frame, seed)
    with running_service(data) as address, Client(address, timeout=120) as client:
        client.put_map(MAP, encode(road))
        right = sum(_is_right(client, each, plan.k, frame) for each in asked)
        sent = tuple(encode_request("/localize", MSGPACK, _body(each, plan.k)) for each in asked)
        load = Load(*address_of(address), sent, plan.rate, plan.seconds)
        outcome = asyncio.run(send_from_process(load, data))
    if set(outcome.statuses) != {200}:
        raise RuntimeError(f"/localize was answered {set(outcome.statuses)}")
    return {
        "segments": size,
        "requests": len(outcome.statuses),
        "localised_right": round(right / len(asked), 4),
        "milliseconds": percentiles(np.array(outcome.milliseconds)),
        "stages": {stage: percentiles(np.array(spent)) for stage, spent in outcome.stages.items()},
    }


def _together(
    views: DescriptorSampler, plan: LocalizePlan, data: Path, seed: int
) -> dict[str, Any]:
    """Measure requests without `maps` among many maps."""
    frame = random_frame(seed)
    # One road, cut into maps, no two of which hold the same things; each robot is within one.
    views_a_map = plan.map_segments // VIEWS * VIEWS
    size, things = plan.maps * views_a_map, views_a_map // VIEWS
    road, asked = road_with_queries(views, size, plan, frame, seed, things)
    with running_service(data) as address, Client(address, timeout=120) as client:
        for number in range(plan.maps):
            part = take(road, np.arange(number * views_a_map, (number + 1) * views_a_map))
            client.put_map(f"road-{number:05}", encode(part))
        told = [client.localize(each, k=plan.k).best for each in asked]
        right = sum(_is_right_pose(each, one, frame) for each, one in zip(asked, told, strict=True))
        bodies = (_body(each, plan.k, named=False) for each in asked)
        sent = tuple(encode_request("/localize", MSGPACK, body) for body in bodies)
        load = Load(*address_of(address), sent, plan.rate / 4, plan.seconds)
        outcome = asyncio.run(send_from_process(load, data))
    if set(outcome.statuses) != {200}:
        raise RuntimeError(f"/localize was answered {set(outcome.statuses)}")
    return {
        "maps": plan.maps,
        "segments": plan.maps * views_a_map,
        "requests": len(outcome.statuses),
        "localised_right": round(right / len(asked), 4),
        "milliseconds": percentiles(np.array(outcome.milliseconds)),
        "stages": {stage: percentiles(np.array(spent)) for stage, spent in outcome.stages.items()},
    }


def road_with_queries(
    views: DescriptorSampler,
    size: int,
    plan: LocalizePlan,
    frame: Pose,
    seed: int,
    step: int | None = None,
) -> tuple[CompactMap, Sequence[Description]]:
    """Return a map of `count` segments and what a robot sees of it.

    Args:
        frame: from the map's to the robot's own.
        step: things from one stretch that is asked about to the next; as many as are asked about
            unless given.
    """
    random = np.random.default_rng(seed)
    content = views.sample_map(size, size // VIEWS, seed)
    road = road_map(content.codes, views.manifest, "ann", seed=seed)
    things = road.centroids[::VIEWS]
    scatter = random.normal(scale=SCATTER, size=(size, 3))
    road = replace(road, centroids=things[content.objects] + scatter)
    # Each thing is asked about once: in their order, as they stand along the road.
    asked = content.query_codes[np.argsort(content.query_objects)]
    step = step or plan.queries
    stretches = len(asked) // step
    descriptions = []
    for stretch in random.permutation(stretches)[: plan.requests]:
        rows = stretch * step + np.arange(plan.queries)
        seen = things[rows] + random.normal(scale=SCATTER, size=(plan.queries, 3))
        nothing = np.zeros((plan.queries, 0), np.float32)
        descriptions.append(
            Description(content.model_id, asked[rows], nothing, frame.apply(seen), {})
        )
    return road, descriptions


def _is_right(client: Client, asked: Description, k: int, frame: Pose) -> bool:
    (found,) = client.localize(asked, maps=[MAP], k=k).maps
    return _is_right_pose(asked, found, frame)


def _is_right_pose(asked: Description, found: Localization | None, frame: Pose) -> bool:
    if found is None or found.pose is None:
        return False
    middle = asked.centroids.mean(axis=0)
    meters, angle = Pose.of_matrix(found.pose.matrix).difference(frame.inverse(), middle)
    return meters <= 1.0 and bool(np.degrees(angle) <= 3.0)


def _body(asked: Description, k: int, *, named: bool = True) -> bytes:
    content = {
        "model_id": asked.model_id,
        "codes": asked.codes.tobytes(),
        "centroids": asked.centroids.astype("<f8").tobytes(),
        "k": k,
    } | ({"maps": [MAP]} if named else {})
    return bytes(msgpack.packb(content))
