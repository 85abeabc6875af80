"""Latency of `/localize` on an idle service: the real server over loopback, maps of any size.

The descriptors are sampled (`descriptor_sampler`). The views of an object also lie at its position,
within some decimeters. A query holds the objects along a stretch of road, in the frame of the
robot.

The latency is that of an idle service. So requests that take long are sent less often than others:
the service is busy for at most half of the time. If it refuses a request all the same, all are sent
again at half the rate. Each row states its rate, and all its requests were answered.
"""

import asyncio
import tempfile
import time
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Client, CompactMap, Description, Localization, encode
from placecell_client.maps.edit import take

from benchmarks.load.generator import Load, LoadResult, encode_request, send_from_process
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

BUSY = 0.5
"""Largest share of the time for which requests keep the service busy."""

HALVED = 4
"""Largest number of times that the rate is halved because a request was refused."""

CENTROID_SCATTER_M = 0.3
"""Standard deviation of an object's centroid between views, along each axis, meters."""


@dataclass(frozen=True, slots=True)
class LocalizePlan:
    """Sizes and rates of the measurement.

    Attributes:
        sizes: map sizes, in segments.
        descriptors: sizes of a request, in segments; each is measured in each map.
        queries: segments per request that names no map.
        k: candidates per segment.
        rate: largest number of requests per second; a quarter of it for requests that name no map.
        seconds: duration per map size at this rate. At a lower rate, as many requests are sent.
        requests: number of different requests, sent in turn.
        maps: number of maps that requests without `maps` search; 0: not measured.
        map_segments: segments of each of those maps.
    """

    sizes: tuple[int, ...] = (10_000,)
    descriptors: tuple[int, ...] = (50, 120)
    queries: int = 50
    k: int = 25
    rate: float = 10.0
    seconds: float = 30.0
    requests: int = 100
    maps: int = 0
    map_segments: int = 300


def measure_localize(
    sampler: DescriptorSampler, plan: LocalizePlan, seed: int = 0, *, progress: Progress = silent
) -> dict[str, Any]:
    """Measure `/localize`; return the report that `placecell bench localize` writes."""
    rows: list[dict[str, Any]] = []
    together: dict[str, Any] | None = None
    with tempfile.TemporaryDirectory(prefix="placecell-bench-") as folder:
        for number in progress(range(len(plan.sizes)), len(plan.sizes), "maps"):
            size, data = plan.sizes[number], Path(folder) / str(number)
            rows += _rows(sampler, size, plan, data, seed)
        if plan.maps:
            together = _together(sampler, plan, Path(folder) / "together", seed)
    return {
        "rows": rows,
        "together": together,
        "model_id": sampler.manifest.model_id,
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }


def _rows(
    sampler: DescriptorSampler, size: int, plan: LocalizePlan, data: Path, seed: int
) -> list[dict[str, Any]]:
    """Measure requests of each size in one map; return a row for each size."""
    frame = random_frame(seed)
    rows = []
    with running_service(data) as address, Client(address, timeout=120) as client:
        for number, count in enumerate(plan.descriptors):
            of_size = replace(plan, queries=count)
            road, asked = road_with_queries(sampler, size, of_size, frame, seed)
            if not number:  # the map is the same for each size of a request
                client.put_map(MAP, encode(road))
            answers, alone = _answers(client, asked, plan.k, [MAP])
            right = sum(map(_is_right_pose, asked, answers, [frame] * len(asked)))
            bodies = tuple(_body(each, plan.k) for each in asked)
            outcome, rate = _answered(bodies, address, plan, min(plan.rate, BUSY / alone), data)
            rows.append(
                {"segments": size, "descriptors": count}
                | _figures(outcome, rate, right / len(asked))
            )
    return rows


def _answers(
    client: Client, asked: Sequence[Description], k: int, maps: Sequence[str] | None = None
) -> tuple[list[Localization | None], float]:
    """Localize one query after the other; return the best answers and the median time, seconds."""
    answers, seconds = [], []
    for each in asked:
        started = time.perf_counter()
        answers.append(client.localize(each, maps=maps, k=k).best)
        seconds.append(time.perf_counter() - started)
    return answers, float(np.median(seconds))


def _answered(
    bodies: Sequence[bytes], address: str, plan: LocalizePlan, rate: float, data: Path
) -> tuple[LoadResult, float]:
    """Send requests until all of them are answered; return the answers and the rate.

    Args:
        bodies: the requests, sent in turn.
        address: address of the service.
        plan: number of the requests.
        rate: requests per second of the first try; halved if the service refuses a request.
        data: folder for the load generator's file.

    Raises:
        RuntimeError: the service failed, or it refused requests at the smallest rate.
    """
    sent = tuple(encode_request("/localize", MSGPACK, body) for body in bodies)
    for each in rate / 2.0 ** np.arange(HALVED + 1):
        load = Load(*address_of(address), sent, float(each), plan.rate * plan.seconds / float(each))
        outcome = asyncio.run(send_from_process(load, data))
        statuses = set(outcome.statuses)
        if statuses == {200}:
            return outcome, float(each)
        if statuses - {200, 429}:
            break
    raise RuntimeError(
        f"/localize returned statuses {sorted(statuses)} at {each:.2g} requests per second; "
        "expected 200. Use a machine with nothing else to do."
    )


def _figures(outcome: LoadResult, rate: float, right: float) -> dict[str, Any]:
    """Return the figures of requests that were all answered.

    Args:
        outcome: the answers and their times.
        rate: requests per second.
        right: share of the queries that were localized correctly.
    """
    return {
        "requests": len(outcome.statuses),
        "rate": round(rate, 3),
        "localised_right": round(right, 4),
        "milliseconds": percentiles(np.array(outcome.milliseconds)),
        "stages": {stage: percentiles(np.array(spent)) for stage, spent in outcome.stages.items()},
    }


def _together(
    sampler: DescriptorSampler, plan: LocalizePlan, data: Path, seed: int
) -> dict[str, Any]:
    """Measure requests without `maps`, which search all maps."""
    frame = random_frame(seed)
    # The road is cut into maps that share no object. Each query lies within one map.
    map_size = plan.map_segments // VIEWS * VIEWS
    size, objects = plan.maps * map_size, map_size // VIEWS
    road, asked = road_with_queries(sampler, size, plan, frame, seed, objects)
    with running_service(data) as address, Client(address, timeout=120) as client:
        for number in range(plan.maps):
            part = take(road, np.arange(number * map_size, (number + 1) * map_size))
            client.put_map(f"road-{number:05}", encode(part))
        answers, alone = _answers(client, asked, plan.k)
        right = sum(map(_is_right_pose, asked, answers, [frame] * len(asked)))
        bodies = tuple(_body(each, plan.k, named=False) for each in asked)
        slower = replace(plan, rate=plan.rate / 4)
        rate = min(slower.rate, BUSY / alone)
        outcome, rate = _answered(bodies, address, slower, rate, data)
    of_all = {"maps": plan.maps, "segments": plan.maps * map_size, "descriptors": plan.queries}
    return of_all | _figures(outcome, rate, right / len(asked))


def road_with_queries(
    sampler: DescriptorSampler,
    size: int,
    plan: LocalizePlan,
    frame: Pose,
    seed: int,
    step: int | None = None,
) -> tuple[CompactMap, Sequence[Description]]:
    """Return a map of `size` segments, and queries along its road.

    Args:
        sampler: samples the descriptors.
        size: segments of the map.
        plan: sizes of the measurement.
        frame: transform from the frame of the map to that of the robot.
        seed: random seed.
        step: objects from the begin of a query to the begin of the next; None: as many as a query
            has segments.
    """
    random = np.random.default_rng(seed)
    content = sampler.sample_map(size, size // VIEWS, seed)
    road = road_map(content.codes, sampler.manifest, "ann", seed=seed)
    objects = road.centroids[::VIEWS]
    scatter = random.normal(scale=CENTROID_SCATTER_M, size=(size, 3))
    road = replace(road, centroids=objects[content.objects] + scatter)
    # The queries hold each object once, in the order of the road.
    asked = content.query_codes[np.argsort(content.query_objects)]
    step = step or plan.queries
    stretches = len(asked) // step
    descriptions = []
    for stretch in random.permutation(stretches)[: plan.requests]:
        rows = stretch * step + np.arange(plan.queries)
        seen = objects[rows] + random.normal(scale=CENTROID_SCATTER_M, size=(plan.queries, 3))
        nothing = np.zeros((plan.queries, 0), np.float32)
        descriptions.append(
            Description(content.model_id, asked[rows], nothing, frame.apply(seen), {})
        )
    return road, descriptions


def _is_right_pose(asked: Description, found: Localization | None, frame: Pose) -> bool:
    if found is None or found.pose is None:
        return False
    middle = asked.centroids.mean(axis=0)
    distance, angle = Pose.of_matrix(found.pose.matrix).difference(frame.inverse(), middle)
    return distance <= 1.0 and bool(np.degrees(angle) <= 3.0)


def _body(asked: Description, k: int, *, named: bool = True) -> bytes:
    content = {
        "model_id": asked.model_id,
        "codes": asked.codes.tobytes(),
        "centroids": asked.centroids.astype("<f8").tobytes(),
        "k": k,
        # As a robot does, so that its viewpoint counts.
        "hints": {"sensor": {"position": asked.centroids.mean(axis=0).tolist()}},
    } | ({"maps": [MAP]} if named else {})
    return bytes(msgpack.packb(content))
