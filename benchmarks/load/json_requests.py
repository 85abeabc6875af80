"""Throughput of the JSON request reader, and the time that it blocks other threads."""

import json
import os
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import Any

import numpy as np

from service.api.body.json_requests import read_json
from service.api.query_parsing import read_scan
from service.api.schemas.recognition import DescribeRequest
from service.core.settings import Limits
from service.inference.scan import Scan

BASELINE = "pydantic's parser, which makes an object of each number (earlier versions)"

Read = Callable[[bytes], Scan]


def measure_json_requests(seconds: float = 3.0, seed: int = 0) -> dict[str, Any]:
    """Measure the reader and pydantic's parser in one run.

    Args:
        seconds: duration of each measurement.
        seed: random seed of the points.
    """
    small, large = body_of(50, 800, seed), body_of(250, 1_000, seed)
    readers: dict[str, Read] = {"baseline": _plain, "compiled": _compiled}
    rows = {
        name: {
            "requests_per_second": round(measure_saturation(read, small, seconds), 2),
            "longest_pause_ms": round(measure_longest_pause(read, large), 2),
        }
        for name, read in readers.items()
    }
    before, after = (rows[name]["requests_per_second"] for name in ("baseline", "compiled"))
    return {
        "rows": rows,
        "saturation_ratio": round(after / before, 2),
        "longest_pause_ms": rows["compiled"]["longest_pause_ms"],
        "baseline": BASELINE,
        "measured": "reading a request of /describe to its scan, without model and HTTP",
        "body_bytes": {"saturation": len(small), "pause": len(large)},
        "threads": os.cpu_count() or 1,
        "seed": seed,
    }


def body_of(segments: int, points: int, seed: int) -> bytes:
    """Return a /describe request with all digits of its float32 points."""
    drawn = np.random.default_rng(seed).normal(0, 30, (segments, points, 3)).astype(np.float32)
    content = [{"points": each.tolist(), "sensor": [0.0, 0.0, 1.8]} for each in drawn]
    return json.dumps({"segments": content}).encode()


def measure_saturation(read: Read, body: bytes, seconds: float) -> float:
    """Return the requests per second that all cores together read."""
    threads = os.cpu_count() or 1
    read(body)
    began = time.perf_counter()

    def work() -> int:
        count = 0
        while time.perf_counter() < began + seconds:
            read(body)
            count += 1
        return count

    with ThreadPoolExecutor(threads) as pool:
        counts = [each.result() for each in [pool.submit(work) for _ in range(threads)]]
    return sum(counts) / (time.perf_counter() - began)


def measure_longest_pause(read: Read, body: bytes, repeats: int = 5) -> float:
    """Return the median of the longest wait of an otherwise idle thread, milliseconds."""
    worst = []
    for _ in range(repeats):
        ticks, done = [time.perf_counter()], threading.Event()

        def tick(ticks: list[float] = ticks, done: threading.Event = done) -> None:
            while not done.wait(0.001):
                ticks.append(time.perf_counter())

        thread = threading.Thread(target=tick)
        thread.start()
        read(body)
        done.set()
        thread.join()
        ticks.append(time.perf_counter())
        worst.append(1e3 * max(after - before for before, after in pairwise(ticks)))
    return float(np.median(worst))


def _plain(body: bytes) -> Scan:
    request = DescribeRequest.model_validate_json(body)
    return read_scan(request.segments, request.origin)


def _compiled(body: bytes) -> Scan:
    request = read_json(DescribeRequest, body, Limits())
    return read_scan(request.segments, request.origin)
