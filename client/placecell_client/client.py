"""The HTTP client."""

import random
import time
from collections.abc import Callable, Sequence
from types import TracebackType
from typing import TypeVar

import httpx
import numpy as np
from numpy.typing import ArrayLike, NDArray

from placecell_client import map_upload
from placecell_client.http.attempts import Attempt
from placecell_client.http.encoding import Encoding
from placecell_client.http.errors import ServiceError
from placecell_client.http.requests import ALIGNMENT_SECONDS, Call
from placecell_client.http.response import Answer
from placecell_client.http.retry import USUAL, Retries
from placecell_client.http.transport import Caller, http_options
from placecell_client.maps.delta_file import Delta
from placecell_client.maps.map_file import CompactMap
from placecell_client.replica import GONE, PAGE_SEGMENTS, ChangesPage, MapCopy
from placecell_client.results.alignment import MapAlignment
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

T = TypeVar("T")
ClientT = TypeVar("ClientT", bound="Client")


class Client(Caller):
    """Talks to one Placecell service; a context manager, to be shared by threads.

    Each method raises `ServiceError` when the service refuses or cannot be understood, and
    `httpx.TransportError` when it cannot be reached or does not answer in time. Before that, what
    may pass by itself is tried again: unless the call may have been carried out, and to do so again
    could undo what others wrote since. An `if_match` that is an ETag makes every write safe to
    repeat; without it `restore_map`, `prune_map`, `merge_maps`, `compact_map`, `delete_map`, and
    what is written with `if_match="*"`, are not repeated then.

    Args:
        base_url: such as `http://127.0.0.1:8000`.
        timeout: seconds for a whole call, all attempts and the waits between them; but
            `align_maps` and `merge_maps` have their own.
        transport: instead of the network, for tests.
        encoding: of points and descriptors on the wire; `json` is larger and slower, and readable.
        key: that the service asks for, sent as `Authorization: Bearer`.
        retries: how often, and after which waits.
        compress: send maps and deltas as gzip.
        jitter: draws evenly from 0 to 1, for the waits.
        sleep: waits these seconds.
        clock: gives seconds that only grow.
    """

    def __init__(
        self,
        base_url: str,
        timeout: float = 30.0,
        transport: httpx.BaseTransport | None = None,
        encoding: Encoding = "msgpack",
        *,
        key: str | None = None,
        retries: Retries = USUAL,
        compress: bool = False,
        jitter: Callable[[], float] = random.random,
        sleep: Callable[[float], None] = time.sleep,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        super().__init__(base_url, encoding, compress, timeout, retries, jitter, clock)
        self._sleep = sleep
        self._http = httpx.Client(transport=transport, **http_options(self._base_url, key))

    def __enter__(self: ClientT) -> ClientT:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.close()

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def info(self) -> Info:
        """What the service is, and how much it takes at once."""
        return self._send(self._calls.info())

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Description:
        """Describe the segments of one scan.

        Args:
            segments: points of each, (points, 3), or structured with fields x, y and z; metres,
                all in one z-up frame. Points that are not finite are left out and counted.
            sensors: where the sensor was at capture, (segments, 3) or (3,) for all, same frame.

        Raises:
            ValueError: an array has another shape or type, or a sensor is not finite.
        """
        return self._send(self._calls.describe(segments, sensors))

    def match(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 10,
    ) -> Matches:
        """The k nearest segments of the maps to each query.

        Args:
            description: the queries, as `describe` gave them, or
            segments: the queries' points, with
            sensors: as for `describe`.
            maps: names; all maps of the service's model unless said.
            k: candidates a query, at most.

        Raises:
            ValueError: neither or both kinds of query, or arrays that do not fit.
        """
        return self._send(self._calls.match(description, segments, sensors, maps, k))

    def localize(
        self,
        description: Description | None = None,
        *,
        segments: Sequence[ArrayLike] | None = None,
        sensors: ArrayLike | None = None,
        maps: Sequence[str] | None = None,
        k: int = 25,
        motion: Motion = "yaw",
        session: str | None = None,
    ) -> Localizations:
        """Where in the maps the robot is; in each that can be said of, with how sure that is.

        Args:
            description: all segments around the robot, as `describe` gave them, or
            segments: their points, with
            sensors: as for `describe`.
            maps: names; all maps of the service's model unless said.
            k: candidates a segment, at most.
            motion: `yaw`, for gravity is known, or `se3`.
            session: an id that this robot alone uses, for requests whose segments are all in its
                one odometry frame: those of the last seconds support each other.

        Raises:
            ValueError: neither or both kinds of query, or arrays that do not fit.
        """
        return self._send(
            self._calls.localize(description, segments, sensors, maps, k, motion, session)
        )

    def maps(self) -> Maps:
        """The stored maps, by name, and which of all are damaged."""
        return self._send(self._calls.maps())

    def put_map(
        self,
        name: str,
        compact_map: CompactMap | bytes,
        *,
        if_match: str | None = None,
        create_only: bool = False,
    ) -> MapSummary:
        """Store a map whole; returns when it is safely on disk.

        A file larger than the service takes in one request is sent in parts, each a call with its
        own `timeout`; nobody sees the map before all are there. After a cut link the same call goes
        on with the part that was missing.

        Other content of that name is replaced only if you say which version of it you have seen: a
        ServiceError with status 428 else, or 412 if it is no longer at that version.

        Args:
            name: of the map.
            compact_map: the map, or its file.
            if_match: ETag of the version to replace, or `*` for any.
            create_only: replace none.

        Raises:
            MapFileError: the map is not valid.
        """
        steps = map_upload.put_map(self._calls, name, compact_map, if_match, create_only)
        return self._take(steps)

    def uploads(self, name: str) -> tuple[PartialUpload, ...]:
        """The key's uploads of map files in parts that are not complete."""
        return self._send(self._calls.uploads(name))

    def delete_upload(self, name: str, digest: str) -> None:
        """Remove an upload that is not complete; the map is unchanged."""
        self._send(self._calls.delete_upload(name, digest))

    def edit_map(
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
        """Add, replace and remove segments, all or none; returns when it is safely on disk.

        Segments of other robots are neither replaced nor removed: a ServiceError with status 409,
        whose `ids` tell which they are; with `if_match` they are.

        Args:
            name: of the map.
            delta: what to do, its `since` and `until` 0; or its file.
            robot: whose segments may be removed, beside those of the changed segments' robots.
            create: make the map if there is none.
            deduplicate: do not store again what is within half a metre of a stored segment and
                looks the same; only note that it was seen. Other views of it are stored.
            only_new: refuse to replace a segment (status 409), whoever wrote it.
            if_match: ETag of the version that the delta is for, or `*` for any.

        Raises:
            MapFileError: the delta is not valid.
        """
        call = self._calls.edit_map(name, delta, robot, create, deduplicate, only_new, if_match)
        return self._send(call)

    def reserve_ids(self, name: str, count: int) -> NDArray[np.uint32]:
        """Ids for new segments of a map, that nobody else is given: uint32 (count,), ascending."""
        return self._send(self._calls.reserve_ids(name, count))

    def reset_ids(self, name: str) -> range:
        """Make ids free again that no kept version has, and return them; for administrators."""
        return self._send(self._calls.reset_ids(name))

    def pull(self, copy: MapCopy | str, limit: int = PAGE_SEGMENTS) -> MapCopy:
        """Bring a copy of a map up to date, by what has changed since.

        Each part is a call of its own, with its own `timeout`. Should one fail, the copy is as it
        was, and the next pull of it goes on with that part.

        Args:
            copy: made by an earlier pull; or the name of a map to begin with.
            limit: segments in a part, at most.

        Returns:
            The copy, of the version that was the newest when the pull began.
        """
        if isinstance(copy, str):
            copy = MapCopy(copy)
        while True:
            since, cursor = copy.request
            try:
                if copy.take(self.changes(copy.name, since, cursor, limit)):
                    return copy
            except ServiceError as error:
                if error.status != GONE or not copy.lose_way():
                    raise

    def changes(
        self,
        name: str,
        since: int | str = 0,
        cursor: str | None = None,
        limit: int = PAGE_SEGMENTS,
    ) -> ChangesPage:
        """A part of what changed in a map; `pull` puts the parts together.

        Args:
            name: of the map.
            since: ETag of the version that is known, or its sequence; 0: none.
            cursor: of the part, from the page before it.
            limit: segments in a part, at most.
        """
        return self._send(self._calls.changes(name, since, cursor, limit))

    def get_map(self, name: str, version: int | None = None) -> CompactMap:
        """A stored map, or an earlier version of it.

        Raises:
            MapFileError: the file is of another version than this client reads.
        """
        return self._send(self._calls.get_map(name, version))

    def get_map_file(self, name: str, version: int | None = None) -> bytes:
        """A stored map's file, or that of an earlier version."""
        return self._send(self._calls.get_map_file(name, version))

    def versions(self, name: str, limit: int = 100) -> tuple[MapVersion, ...]:
        """The versions of a map that are kept, newest first, so many at most."""
        return self._send(self._calls.versions(name, limit))

    def restore_map(self, name: str, version: int, if_match: str | None = None) -> Written:
        """Make a map again what it was: a new version with the content of an old one.

        Args:
            name: of the map.
            version: the old one's sequence.
            if_match: ETag of the version that is given up; a ServiceError with status 412 if it
                is not the newest.
        """
        return self._send(self._calls.restore_map(name, version, if_match))

    def prune_map(
        self,
        name: str,
        unseen_since: float,
        dry_run: bool = False,
        *,
        if_match: str | None = None,
    ) -> Written:
        """Remove segments that were last seen before a time.

        Args:
            name: of the map.
            unseen_since: the time, seconds of the clock of the frames.
            dry_run: only tell how many they are.
            if_match: ETag of the version to do it to.
        """
        return self._send(self._calls.prune_map(name, unseen_since, dry_run, if_match))

    def align_maps(
        self,
        name: str,
        other: str,
        *,
        motion: Motion = "yaw",
        pairs: bool = False,
        timeout: float = ALIGNMENT_SECONDS,
    ) -> MapAlignment:
        """How another map lies to a map: the transform between their frames, or why none is told.

        Nothing is written. The service may need minutes for large maps.

        Args:
            name: of the map in whose frame the answer is.
            other: name of the map that is laid on it.
            motion: `yaw`, for both frames are level, or `se3`.
            pairs: tell the segments that agree, too.
            timeout: seconds, in place of the client's.
        """
        return self._send(self._calls.align_maps(name, other, motion, pairs, timeout))

    def merge_maps(
        self,
        site: str,
        maps: Sequence[str],
        *,
        dry_run: bool = False,
        deduplicate: bool = True,
        motion: Motion = "yaw",
        if_match: str | None = None,
        timeout: float = ALIGNMENT_SECONDS,
    ) -> Merge:
        """Lay maps on each other, and put their segments into a site map; it is made if need be.

        Maps that cannot be laid on the site are left out, which the result tells; if all are, that
        is a ServiceError with status 409, and nothing is written. The service may need minutes.

        Args:
            site: name of the map to put them into; a new one takes the frame of the first map.
            maps: names. Those that have grown since can be merged again.
            dry_run: only tell what would be done.
            deduplicate: leave out what another map's segment shows already.
            motion: `yaw`, for all frames are level, or `se3`.
            if_match: ETag of the site's version to do it to.
            timeout: seconds, in place of the client's.
        """
        call = self._calls.merge_maps(site, maps, dry_run, deduplicate, motion, if_match, timeout)
        return self._send(call)

    def compact_map(self, name: str, keep: int = 1) -> int:
        """Let go of all but the newest versions; the sequence of the oldest that is kept."""
        return self._send(self._calls.compact_map(name, keep))

    def delete_map(self, name: str, if_match: str | None = None) -> None:
        """Remove a map with all its versions."""
        self._send(self._calls.delete_map(name, if_match))

    def _take(self, steps: map_upload.Steps) -> MapSummary:
        """Send the calls of some steps, one after the other."""
        try:
            call = next(steps)
            while True:
                try:
                    result = self._send(call)
                except ServiceError as error:  # noqa: PERF203 -- the steps know what to do
                    call = steps.throw(error)
                else:
                    call = steps.send(result)
        except StopIteration as done:
            stored: MapSummary = done.value
            return stored

    def _send(self, call: Call[T]) -> T:
        attempts = self._attempts(call)
        while True:
            try:
                return attempts.result(self._exchange(attempts.next()))
            except (httpx.TransportError, ServiceError) as error:
                wait = attempts.wait_after(error)
                if wait is None:
                    self._explain(error)
                    raise
            self._sleep(wait)

    def _exchange(self, attempt: Attempt) -> Answer:
        with self._http.stream(**attempt.request, content=attempt.parts()) as response:
            try:
                parts = attempt.deadline.guard(response.iter_bytes(), httpx.ReadTimeout)
                return Answer.of(response, b"".join(parts))
            except httpx.DecodingError as error:
                raise ServiceError.unreadable(Answer.of(response, b""), str(error)) from error
