"""HTTP client for asyncio: `AsyncClient`."""

import asyncio
import random
import time
from collections.abc import AsyncIterator, Awaitable, Callable, Sequence
from types import TracebackType
from typing import TypeVar

import anyio
import httpx
import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client import transfers
from placecell_client.hints import Hints
from placecell_client.http.attempts import Attempt
from placecell_client.http.encoding import Encoding
from placecell_client.http.errors import ServiceError
from placecell_client.http.events import (
    EventLines,
    Reconnection,
    ServerEvent,
    is_stream,
    refused,
)
from placecell_client.http.requests import ALIGNMENT_SECONDS, Call, PointCloudFile
from placecell_client.http.response import HttpResponse
from placecell_client.http.retry import USUAL, Retries
from placecell_client.http.transport import BaseClient, http_options
from placecell_client.maps.delta_file import Delta
from placecell_client.maps.map_file import CompactMap
from placecell_client.replica import PAGE_SEGMENTS, ChangesPage, MapCopy
from placecell_client.results.alignment import MapAlignment
from placecell_client.results.anchors import (
    AnchorPose,
    Coverage,
    MapAnchor,
    MapAnchorFit,
    MapMirror,
)
from placecell_client.results.core import (
    Description,
    Info,
    Maps,
    MapSummary,
    MapVersion,
    Matches,
    PartialUpload,
    Written,
)
from placecell_client.results.localization import Localizations, Motion
from placecell_client.results.merge import Merge
from placecell_client.results.optimization import Optimization
from placecell_client.results.robots import RobotState
from placecell_client.results.scans import AddedScan, KeyScope, ScannedFile
from placecell_client.results.shapes import SegmentShape

T = TypeVar("T")
AsyncClientT = TypeVar("AsyncClientT", bound="AsyncClient")


class AsyncClient(BaseClient):
    """Client of one Placecell service for asyncio: `Client` with coroutine methods.

    The arguments, results and errors are those of `Client`. The tasks of one event loop may share
    it. Use it as an asynchronous context manager, or await `close`:

        async with AsyncClient("http://127.0.0.1:8000") as client:
            found = await client.localize(segments=segments, sensors=sensor, maps=["yard"])

    Arrays and maps are encoded and decoded on the event loop's thread. For large maps, run `encode`
    in another thread and pass the bytes to `put_map`, or await `get_map_file` and run `decode` in
    another thread.
    """

    def __init__(
        self,
        base_url: str,
        timeout: float = 30.0,
        transport: httpx.AsyncBaseTransport | None = None,
        encoding: Encoding = "msgpack",
        *,
        key: str | None = None,
        retries: Retries = USUAL,
        compress: bool = False,
        jitter: Callable[[], float] = random.random,
        sleep: Callable[[float], Awaitable[None]] = asyncio.sleep,
        clock: Callable[[], float] = time.monotonic,
        mirrors: str | None = None,
    ) -> None:
        super().__init__(base_url, encoding, compress, timeout, retries, jitter, clock)
        self._sleep = sleep
        self._http = httpx.AsyncClient(
            transport=transport, **http_options(self._base_url, key, mirrors)
        )

    async def __aenter__(self: AsyncClientT) -> AsyncClientT:
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        await self.close()

    async def close(self) -> None:
        """Close the connections."""
        await self._http.aclose()

    async def info(self) -> Info:
        """See `Client.info`."""
        return await self._send(self._calls.info())

    async def key(self) -> KeyScope:
        """See `Client.key`."""
        return await self._send(self._calls.key())

    async def scan_file(self, file: PointCloudFile, *, file_name: str | None = None) -> ScannedFile:
        """See `Client.scan_file`."""
        return await self._send(self._calls.scan_file(file, file_name))

    async def add_scan(
        self,
        name: str,
        file: PointCloudFile,
        *,
        robot: str | None = None,
        position: ArrayLike = (0.0, 0.0, 0.0),
        yaw: float = 0.0,
        time: float | None = None,
        create: bool = False,
        deduplicate: bool = False,
        file_name: str | None = None,
        if_match: str | None = None,
    ) -> AddedScan:
        """See `Client.add_scan`."""
        call = self._calls.add_scan(
            name, file, file_name, robot, position, yaw, time, create, deduplicate, if_match
        )
        return await self._send(call)

    async def version_changes(self, name: str, version: int) -> Delta:
        """See `Client.version_changes`."""
        return await self._send(self._calls.version_changes(name, version))

    async def export(
        self,
        name: str,
        to: str,
        *,
        color: str = "id",
        anchor: str | None = None,
        version: int | None = None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> bytes:
        """See `Client.export`."""
        call = self._calls.export(name, to, color, anchor, version, classes, ignore)
        return await self._send(call)

    async def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Description:
        """See `Client.describe`."""
        return await self._send(self._calls.describe(segments, sensors))

    async def match(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 10,
        rerank: bool = True,
        tags: Sequence[str] | None = None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Matches:
        """See `Client.match`."""
        return await self._send(
            self._calls.match(
                description, segments, sensors, maps, k, rerank, tags, classes, ignore
            )
        )

    async def localize(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 25,
        motion: Motion = "yaw",
        session: str | None = None,
        max_false_acceptance: float | None = None,
        hints: Hints | None = None,
        robot: str | None = None,
        tags: Sequence[str] | None = None,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> Localizations:
        """See `Client.localize`."""
        return await self._send(
            self._calls.localize(
                description,
                segments,
                sensors,
                maps,
                k,
                motion,
                session,
                max_false_acceptance,
                hints,
                robot,
                tags,
                classes,
                ignore,
            )
        )

    async def maps(self) -> Maps:
        """See `Client.maps`."""
        return await self._send(self._calls.maps())

    async def put_map(
        self,
        name: str,
        compact_map: CompactMap | bytes,
        *,
        if_match: str | None = None,
        create_only: bool = False,
    ) -> MapSummary:
        """See `Client.put_map`."""
        steps = transfers.put_map(self._calls, name, compact_map, if_match, create_only)
        return await self._run(steps)

    async def uploads(self, name: str) -> tuple[PartialUpload, ...]:
        """See `Client.uploads`."""
        return await self._send(self._calls.uploads(name))

    async def delete_upload(self, name: str, digest: str) -> None:
        """See `Client.delete_upload`."""
        await self._send(self._calls.delete_upload(name, digest))

    async def edit_map(
        self,
        name: str,
        delta: Delta | bytes,
        *,
        robot: str | None = None,
        create: bool = False,
        deduplicate: bool = False,
        only_new: bool = False,
        if_match: str | None = None,
    ) -> Written:
        """See `Client.edit_map`."""
        return await self._send(
            self._calls.edit_map(name, delta, robot, create, deduplicate, only_new, if_match)
        )

    async def reserve_ids(self, name: str, count: int) -> NDArray[np.uint32]:
        """See `Client.reserve_ids`."""
        return await self._send(self._calls.reserve_ids(name, count))

    async def reset_ids(self, name: str) -> range:
        """See `Client.reset_ids`."""
        return await self._send(self._calls.reset_ids(name))

    async def pull(self, copy: MapCopy | str, limit: int = PAGE_SEGMENTS) -> MapCopy:
        """See `Client.pull`."""
        return await self._run(transfers.pull(self._calls, copy, limit))

    async def changes(
        self,
        name: str,
        since: int | str = 0,
        cursor: str | None = None,
        limit: int = PAGE_SEGMENTS,
        *,
        moved: bool = False,
    ) -> ChangesPage:
        """See `Client.changes`."""
        return await self._send(self._calls.changes(name, since, cursor, limit, moved))

    async def get_map(
        self,
        name: str,
        version: int | None = None,
        *,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> CompactMap:
        """See `Client.get_map`."""
        return await self._send(self._calls.get_map(name, version, classes, ignore))

    async def get_map_file(
        self,
        name: str,
        version: int | None = None,
        *,
        classes: Sequence[str] | None = None,
        ignore: str | Sequence[str] | None = None,
    ) -> bytes:
        """See `Client.get_map_file`."""
        return await self._send(self._calls.get_map_file(name, version, classes, ignore))

    async def versions(self, name: str, limit: int = 100) -> tuple[MapVersion, ...]:
        """See `Client.versions`."""
        return await self._send(self._calls.versions(name, limit))

    async def restore_map(
        self, name: str, version: int, if_match: str | None = None, *, dry_run: bool = False
    ) -> Written:
        """See `Client.restore_map`."""
        return await self._send(self._calls.restore_map(name, version, if_match, dry_run))

    async def prune_map(
        self,
        name: str,
        unseen_since: float,
        dry_run: bool = False,
        *,
        if_match: str | None = None,
    ) -> Written:
        """See `Client.prune_map`."""
        return await self._send(self._calls.prune_map(name, unseen_since, dry_run, if_match))

    async def align_maps(
        self,
        name: str,
        other: str,
        *,
        motion: Motion = "yaw",
        pairs: bool = False,
        timeout: float = ALIGNMENT_SECONDS,
    ) -> MapAlignment:
        """See `Client.align_maps`."""
        return await self._send(self._calls.align_maps(name, other, motion, pairs, timeout))

    async def merge_maps(
        self,
        merged_map: str,
        maps: Sequence[str],
        *,
        dry_run: bool = False,
        deduplicate: bool = True,
        motion: Motion = "yaw",
        rigid: bool = True,
        if_match: str | None = None,
        timeout: float = ALIGNMENT_SECONDS,
    ) -> Merge:
        """See `Client.merge_maps`."""
        call = self._calls.merge_maps(
            merged_map, maps, dry_run, deduplicate, motion, if_match, timeout, rigid
        )
        return await self._send(call)

    async def optimize_map(
        self,
        name: str,
        *,
        dry_run: bool = False,
        frames: bool = False,
        if_match: str | None = None,
        timeout: float = ALIGNMENT_SECONDS,
    ) -> Optimization:
        """See `Client.optimize_map`."""
        call = self._calls.optimize_map(name, dry_run, frames, if_match, timeout)
        return await self._send(call)

    async def segment_shape(self, name: str, segment: int) -> SegmentShape:
        """See `Client.segment_shape`."""
        return await self._send(self._calls.segment_shape(name, segment))

    async def segment_shapes(self, name: str, segments: Sequence[int]) -> list[SegmentShape]:
        """See `Client.segment_shapes`."""
        return await self._send(self._calls.segment_shapes(name, segments))

    async def compact_map(self, name: str, keep: int = 1) -> int:
        """See `Client.compact_map`."""
        return await self._send(self._calls.compact_map(name, keep))

    async def delete_map(self, name: str, if_match: str | None = None) -> None:
        """See `Client.delete_map`."""
        await self._send(self._calls.delete_map(name, if_match))

    async def coverage(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        tags: Sequence[str] | None = None,
    ) -> tuple[Coverage, ...]:
        """See `Client.coverage`."""
        return await self._send(self._calls.coverage(description, segments, sensors, maps, tags))

    async def tags(self, name: str) -> tuple[str, ...]:
        """See `Client.tags`."""
        return await self._send(self._calls.tags(name))

    async def set_tags(self, name: str, tags: Sequence[str]) -> tuple[str, ...]:
        """See `Client.set_tags`."""
        return await self._send(self._calls.set_tags(name, tags))

    async def anchor(self, name: str) -> MapAnchor:
        """See `Client.anchor`."""
        return await self._send(self._calls.anchor(name))

    async def set_anchor(
        self,
        name: str,
        lat: float,
        lon: float,
        *,
        height: float = 0.0,
        yaw_deg: float = 0.0,
        accuracy: float = 0.0,
        position: ArrayLike = (0.0, 0.0, 0.0),
    ) -> MapAnchor:
        """See `Client.set_anchor`."""
        call = self._calls.set_anchor(name, lat, lon, height, yaw_deg, accuracy, position)
        return await self._send(call)

    async def delete_anchor(self, name: str) -> None:
        """See `Client.delete_anchor`."""
        await self._send(self._calls.delete_anchor(name))

    async def fit_anchor(
        self,
        name: str,
        positions: ArrayLike,
        lats: ArrayLike,
        lons: ArrayLike,
        *,
        accuracies: ArrayLike,
        heights: ArrayLike | None = None,
        dry_run: bool = False,
    ) -> MapAnchorFit:
        """See `Client.fit_anchor`."""
        return await self._send(
            self._calls.fit_anchor(name, positions, lats, lons, heights, accuracies, dry_run)
        )

    async def anchors(self, name: str) -> tuple[AnchorPose, ...]:
        """See `Client.anchors`."""
        found, after = await self._send(self._calls.anchors(name))
        while after is not None:
            more, after = await self._send(self._calls.anchors(name, after))
            found += more
        return found

    async def named_anchor(self, name: str, anchor: str) -> AnchorPose:
        """See `Client.named_anchor`."""
        return await self._send(self._calls.named_anchor(name, anchor))

    async def set_named_anchor(
        self,
        name: str,
        anchor: str,
        position: ArrayLike,
        orientation: ArrayLike = (0.0, 0.0, 0.0, 1.0),
    ) -> AnchorPose:
        """See `Client.set_named_anchor`."""
        return await self._send(self._calls.set_named_anchor(name, anchor, position, orientation))

    async def delete_named_anchor(self, name: str, anchor: str) -> None:
        """See `Client.delete_named_anchor`."""
        await self._send(self._calls.delete_named_anchor(name, anchor))

    async def mirror(self, name: str) -> MapMirror | None:
        """See `Client.mirror`."""
        return await self._send(self._calls.mirror(name))

    async def set_mirror(self, name: str, source: str, etag: str = "") -> MapMirror:
        """See `Client.set_mirror`."""
        return await self._send(self._calls.set_mirror(name, source, etag))

    async def delete_mirror(self, name: str) -> None:
        """See `Client.delete_mirror`."""
        await self._send(self._calls.delete_mirror(name))

    async def report_pose(
        self,
        robot: str,
        map_name: str | None = None,
        position: ArrayLike | None = None,
        orientation: ArrayLike | None = None,
        covariance: ArrayLike | None = None,
        *,
        probability: float | None = None,
        state: str = "localized",
        reason: str = "",
        time: float | None = None,
    ) -> RobotState:
        """See `Client.report_pose`."""
        return await self._send(
            self._calls.report_pose(
                robot,
                map_name,
                position,
                orientation,
                covariance,
                probability,
                state,
                reason,
                time,
            )
        )

    async def robots(self) -> tuple[RobotState, ...]:
        """See `Client.robots`."""
        found, after = await self._send(self._calls.robots())
        while after is not None:
            more, after = await self._send(self._calls.robots(after))
            found += more
        return found

    async def robot(self, robot: str) -> RobotState:
        """See `Client.robot`."""
        return await self._send(self._calls.robot(robot))

    async def events(self, last_event_id: str = "") -> AsyncIterator[ServerEvent]:
        """See `Client.events`."""
        lines = EventLines(last_event_id)
        again = Reconnection(self._policy.retries)
        while True:
            failed: Exception | None = None
            try:
                async for event in self._listen(lines, again):
                    yield event
            except (httpx.TransportError, ServiceError) as error:
                failed = error
            await self._sleep(again.wait_after(failed, self._policy.jitter()))

    async def _listen(self, lines: EventLines, again: Reconnection) -> AsyncIterator[ServerEvent]:
        headers = again.headers(lines)
        async with self._http.stream(
            "GET", "/events", headers=headers, timeout=again.timeout
        ) as response:
            if not is_stream(response):
                raise refused(response, await response.aread())
            async for line in response.aiter_lines():
                event = lines.read(line)
                if event is not None:
                    again.failures = 0
                    yield event

    async def _run(self, steps: transfers.Steps[T]) -> T:
        """Send the calls of a transfer one after the other and return its result."""
        try:
            call = next(steps)
            while True:
                try:
                    result = await self._send(call)
                except ServiceError as error:  # noqa: PERF203 -- the steps handle it
                    call = steps.throw(error)
                else:
                    call = steps.send(result)
        except StopIteration as done:
            value: T = done.value
            return value

    async def _send(self, call: Call[T]) -> T:
        attempts = self._attempts(call)
        while True:
            try:
                return attempts.result(await self._exchange(attempts.next()))
            except (httpx.TransportError, ServiceError) as error:
                wait = attempts.wait_after(error)
                if wait is None:
                    self._explain(error, attempts.request_id)
                    raise
            await self._sleep(wait)

    async def _exchange(self, attempt: Attempt) -> HttpResponse:
        try:
            # Python 3.10 has no asyncio.timeout.
            with anyio.fail_after(attempt.deadline.remaining()):
                return await self._receive(attempt)
        except TimeoutError as error:
            raise httpx.ReadTimeout("The call exceeded its timeout.") from error

    async def _receive(self, attempt: Attempt) -> HttpResponse:
        async with self._http.stream(**attempt.request, content=attempt.content) as response:
            try:
                parts = [part async for part in response.aiter_bytes()]
                return HttpResponse.of(response, b"".join(parts))
            except httpx.DecodingError as error:
                raise ServiceError.unreadable(HttpResponse.of(response, b""), str(error)) from error
