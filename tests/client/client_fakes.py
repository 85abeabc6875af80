"""Fakes: a clock without waiting, and clients whose transport is a function."""

import asyncio
from collections.abc import Callable
from typing import Any

import httpx
import msgpack  # type: ignore[import-untyped]
from placecell_client import AsyncClient, Client

Handler = Callable[[httpx.Request], httpx.Response]

MSGPACK = "application/msgpack"
INFO = {
    "version": "1.0",
    "model": {"model_id": "m", "dimension": 2},
    "limits": {"k": 100},
    "map_file": {"version": 1},
}
SUMMARY = {
    "name": "yard", "segments": 20, "sequence": 3, "etag": "e-3", "bytes": 1, "model_id": "m",
    "frame": "f", "robots": {"ann": 20}, "time_span": [0, 1], "optional": [], "later": "field",
}  # fmt: skip
LISTED = {"model_id": "m", "maps": [SUMMARY], "damaged": ["hall", "shed"], "later": "field"}
WRITTEN = {
    "map": "yard", "sequence": 4, "etag": "e-4", "segments": 20, "changed": 2, "removed": 1,
    "repeats": 0,
    "later": "field",
}  # fmt: skip
VERSION = {
    "sequence": 4, "etag": "e-4", "time": 1.5, "author": "ann", "operation": "edit",
    "changed": 2, "removed": 1, "later": "field",
}  # fmt: skip
DESCRIBED = {
    "model_id": "m",
    "dimension": 2,
    "descriptors": [
        {
            "codes": b"\x03\xff",
            "descriptor": b"\0\0\0\x3f\0\0\x80\xbf",
            "centroid": [1.0, 2.0, 3.0],
        }
    ],
}
CANDIDATE = {
    "map": "yard", "id": 9, "robot": "r", "distance": 0.5, "probability": None,
    "centroid": [1, 2, 3], "frame": "f",
}  # fmt: skip
MATCHED = {
    "model_id": "m",
    "queries": [{"candidates": [CANDIDATE]}],
    "searched": ["yard"],
    "skipped": [],
}
POSE = {"translation": [10.0, 20.0, 1.0], "rotation": [0.0, 0.0, 0.6, 0.8], "yaw": 1.287}
PLACE = {
    "map": "yard", "frame": "f", "localized": True, "reason": None, "detail": "",
    "probability": 0.97, "pose": POSE, "covariance": [[0.01, 0, 0, 0]] * 4, "score": 7.5,
    "inliers": [{"query": 0, "id": 9, "residual": 0.25}],
    "others": [{"pose": POSE, "score": 2.5, "inliers": 3}], "rival": None, "later": "field",
}  # fmt: skip
LOCALIZED = {"model_id": "m", "localizations": [PLACE], "unusable": [], "skipped": []}

ALIGNED = {
    "map": "yard", "etag": "e-3", "frame": "f", "other": "hall", "other_etag": "h-1",
    "other_frame": "g", "aligned": True, "reason": None, "detail": "", "pose": POSE,
    "covariance": [[0.01, 0, 0, 0]] * 4, "overlap": {"of_map": 0.5, "of_other": 0.75},
    "score": 40.5, "agreement": 0.625, "pairs": 2,
    "inliers": [
        {"id": 9, "other_id": 4, "residual": 0.25}, {"id": 7, "other_id": 5, "residual": 0.125},
    ],
    "others": [{"pose": POSE, "score": 2.5, "agreement": 0.0625, "pairs": 13}], "later": "field",
}  # fmt: skip
LAID = {
    name: ALIGNED[name]
    for name in (
        "map", "other", "aligned", "reason", "detail", "pose", "overlap", "score", "agreement",
        "pairs",
    )
}  # fmt: skip
PART = {
    "map": "yard", "etag": "e-3", "merged": True, "pose": POSE, "added": 12, "known": 5,
    "repeats": 3, "removed": 1, "later": "field",
}  # fmt: skip
MERGED = {
    "map": "site", "frame": "f", "dry_run": False, "sequence": 4, "etag": "s-4", "previous": 3,
    "segments": 32, "changed": 14, "removed": 1,
    "parts": [PART, PART | {"map": "shed", "merged": False, "pose": None, "added": 0}],
    "alignments": [
        LAID | {"map": "site", "other": "yard", "rejected": False, "proven": True},
        LAID | {
            "map": "site", "other": "shed", "aligned": False, "reason": "inconsistent",
            "detail": "Little agrees.", "pose": None, "overlap": None, "rejected": False,
            "proven": False,
        },
    ],
    "loops": [
        {"maps": ["site", "yard", "hall"], "meters": 0.5, "degrees": 0.25, "closes": True}
    ],
    "later": "field",
}  # fmt: skip


def packed(content: object) -> httpx.Response:
    headers = {"Content-Type": MSGPACK}
    return httpx.Response(200, content=msgpack.packb(content), headers=headers)


class Time:
    """Clock that advances only by sleeping; keeps the sleeps, seconds."""

    def __init__(self) -> None:
        self.now = 1000.0
        self.slept: list[float] = []

    def clock(self) -> float:
        return self.now

    def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.now += seconds

    async def async_sleep(self, seconds: float) -> None:
        self.sleep(seconds)


def client_of(handler: Handler, time: Time | None = None, **options: Any) -> Client:
    """Return the largest jitter."""
    time = time or Time()
    options = {"jitter": lambda: 1.0, "sleep": time.sleep, "clock": time.clock} | options
    return Client("http://service", transport=_transport(handler), **options)


def async_client_of(handler: Handler, time: Time | None = None, **options: Any) -> AsyncClient:
    time = time or Time()
    options = {"jitter": lambda: 1.0, "sleep": time.async_sleep, "clock": time.clock} | options
    return AsyncClient("http://service", transport=_transport(handler), **options)


def _transport(handler: Handler) -> httpx.MockTransport:
    """Copy a response for each request, so that tests may use the same one twice."""

    def answer(request: httpx.Request) -> httpx.Response:
        given = handler(request)
        try:
            content = given.content
        except httpx.ResponseNotRead:
            return given
        return httpx.Response(given.status_code, headers=given.headers, content=content)

    return httpx.MockTransport(answer)


class Blocking:
    """`AsyncClient` with synchronous methods, so that tests run with both clients."""

    def __init__(self, handler: Handler, time: Time | None = None, **options: Any) -> None:
        self._arguments = (handler, time)
        self._options = options

    def __getattr__(self, name: str) -> Callable[..., Any]:
        def method(*arguments: Any, **options: Any) -> Any:
            async def call() -> Any:
                async with async_client_of(*self._arguments, **self._options) as client:
                    return await getattr(client, name)(*arguments, **options)

            return asyncio.run(call())

        return method
