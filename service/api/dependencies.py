"""Dependencies of the routes: state, principal, preconditions, stopwatch, and writes of maps."""

from collections.abc import AsyncIterator, Callable, Collection
from contextlib import asynccontextmanager
from dataclasses import dataclass
from functools import partial
from typing import Annotated, ParamSpec, TypeVar

import anyio
import anyio.to_thread
from fastapi import Depends, Header, Request
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer

from placecell.core.cancellation import current
from service.annotations.annotations import MirrorMark
from service.api.admission.admission import Lane, admitted
from service.api.audit import record, record_write
from service.api.path_parameters import Name
from service.api.state import State
from service.core.auth import Principal
from service.core.preconditions import Preconditions
from service.core.problems import Problem, invalid_value
from service.core.timing import Timing
from service.maps.following.follower import behind
from service.maps.repository import MapRepository
from service.maps.snapshot import ColdMap
from service.maps.writes.writer import MapWriter, WriteResult

MIRROR_HEADER = "Placecell-Mirror"
"""Header with the source of the mirrors that a client writes."""

Result = TypeVar("Result")
Parameters = ParamSpec("Parameters")

SEEN_HEADER = "Placecell-Seen"

CATCH_UP_SECONDS = 8.0
"""Seconds within which the versions that a request needs must be loaded."""

BEARER = HTTPBearer(
    auto_error=False,
    description="API key, made with `placecell keys`. A service without keys needs none.",
)
"""Security scheme of the API description; `Keys` reads the header."""


async def state_of(request: Request) -> State:
    """Return the state of the application."""
    state = request.app.state.placecell
    assert isinstance(state, State)
    return state


async def principal_of(
    request: Request,
    bearer: Annotated[HTTPAuthorizationCredentials | None, Depends(BEARER)] = None,
) -> Principal:
    """Return the principal of the request; 401 if the key is unknown."""
    del bearer  # described, not used
    state = await state_of(request)
    principal = state.keys.principal(request.headers.get("authorization"))
    request.scope["state"]["key"] = principal.name
    return principal


StateOf = Annotated[State, Depends(state_of)]
PrincipalOf = Annotated[Principal, Depends(principal_of)]


async def caught_up(
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    seen: Annotated[
        str | None,
        Header(
            alias=SEEN_HEADER,
            description="Versions of maps that the client has written or read, as MAP ETAG, "
            "separated by commas. A service that shares a database loads them before it answers.",
        ),
    ] = None,
) -> None:
    """Load the maps and versions that the request needs and that are not here; 503 if it cannot."""
    maps, follower = state.engine.maps, state.engine.follower
    needs: list[Callable[[], object]] = []
    if seen is not None:
        # Several lines of one header mean the same as one with commas.
        seen = ",".join(request.headers.getlist(SEEN_HEADER))
    if follower is not None and seen is not None and not follower.has_all(seen):
        needs.append(partial(follower.catch_up_with, seen))
    if follower is not None and state.settings.reads == "latest":
        needs.append(follower.catch_up_all)
    if maps.most_segments:
        # Only maps that the key opens. The routes tell what is wrong with the others.
        named = [request.path_params.get(each, "") for each in ("map", "other")]
        needs += [partial(maps.find, each) for each in named if _is_cold(maps, principal, each)]
    for load in needs:
        with anyio.move_on_after(CATCH_UP_SECONDS) as scope:
            await anyio.to_thread.run_sync(load, abandon_on_cancel=True, limiter=state.catching_up)
        if scope.cancelled_caught:
            raise behind()


def _is_cold(maps: MapRepository, principal: Principal, name: str) -> bool:
    return principal.covers(name) and isinstance(maps.peek(name), ColdMap)


async def preconditions_of(
    if_match: Annotated[
        str | None,
        Header(description="ETags of the versions that this request is for, or *."),
    ] = None,
    if_none_match: Annotated[
        str | None,
        Header(description="ETags of the versions that this request is not for, or *."),
    ] = None,
) -> Preconditions:
    """Return the preconditions of the request."""
    return Preconditions(if_match, if_none_match)


async def timing_of(request: Request) -> Timing:
    """Return the stopwatch of the request."""
    timing = request.scope["state"]["timing"]
    assert isinstance(timing, Timing)
    return timing


TimingOf = Annotated[Timing, Depends(timing_of)]
ConditionsOf = Annotated[Preconditions, Depends(preconditions_of)]


@dataclass(frozen=True, slots=True)
class MapWrite:
    """Request that writes to a map: admission, the writer, and the audit log.

    Attributes:
        name: name of the map.
        request: the HTTP request.
        state: state of the service.
        principal: principal of the request.
        writer: writes under the principal's scope and the request's preconditions.
        timing: stopwatch of the request.
        mirror: mark of a map that is a copy of another service's; None for other maps.
    """

    name: str
    request: Request
    state: State
    principal: Principal
    writer: MapWriter
    timing: Timing
    mirror: MirrorMark | None

    @asynccontextmanager
    async def receive(
        self, lane: Lane, media_types: Collection[str], body_bytes: int | None = None
    ) -> AsyncIterator[bytes]:
        """Check the key's scope, enter a lane and receive the body; see `Lane.admit`."""
        self.check_writable()
        async with lane.admit(self.request, media_types, self.timing, body_bytes) as body:
            await self._check_newest()
            yield body.content

    @asynccontextmanager
    async def enter(self, lane: Lane) -> AsyncIterator[None]:
        """Check the key's scope and enter a lane, for a request without a body.

        Raises:
            Problem: 422 if it has one: options in it, such as `dry_run`, would be ignored.
        """
        self.check_writable()
        if _has_body(self.request):
            raise invalid_value(
                "", "This route takes its options in the query (?NAME=VALUE), not in a body."
            )
        async with lane.enter(self.request):
            await self._check_newest()
            yield

    def check_writable(self) -> None:
        """Check the key's scope, and that a mirror is written by the program that copies it only.

        Raises:
            Problem: 403 if the key may not write the map, 409 if it is a mirror.
        """
        self.principal.check_write(self.name)
        self._check_mirror(self.mirror)

    async def _check_newest(self) -> None:
        """Check the mark that another service of the same database may have set just now."""
        engine = self.state.engine
        if engine.follower is not None:
            request = admitted()
            assert request is not None  # `receive` or `enter` has entered a lane
            await request.run(lambda: engine.maps.catch_up(self.name, current().begun))
            self._check_mirror(engine.mirror(self.name))

    def _check_mirror(self, mirror: MirrorMark | None) -> None:
        if mirror is not None and self.request.headers.get(MIRROR_HEADER) != mirror.source:
            raise Problem(
                409,
                "mirrored-map",
                f"Map {self.name!r:.80} is a read-only mirror of {mirror.source}. Write to that "
                f"map, or end the mirror (DELETE /maps/{self.name}/mirror).",
            )

    async def run(
        self,
        work: Callable[Parameters, Result],
        *args: Parameters.args,
        **kwargs: Parameters.kwargs,
    ) -> Result:
        """Run a write in the threads of the lane."""
        request = admitted()
        assert request is not None  # `receive` or `enter` has entered a lane
        result = await request.run(lambda: work(*args, **kwargs))
        self.timing.lap("commit")
        return result

    async def commit(
        self,
        operation: str,
        work: Callable[Parameters, WriteResult],
        *args: Parameters.args,
        **kwargs: Parameters.kwargs,
    ) -> WriteResult:
        """Run a write of segments in the threads of the lane, and record it in the audit log."""
        result = await self.run(work, *args, **kwargs)
        self.record_result(operation, result)
        return result

    def record_result(self, operation: str, result: WriteResult) -> None:
        """Record a write of segments in the audit log."""
        record_write(self.request, self.state, operation, result)

    def record(self, operation: str, effect: str, segments: int = 0) -> None:
        """Record any other write in the audit log."""
        record(self.request, self.state, operation, self.name, effect, segments)


def _has_body(request: Request) -> bool:
    """Return whether a request has a body that may hold options: more than `{}`."""
    stated = request.headers.get("content-length", "")
    return stated.isdigit() and int(stated) > len("{}")


async def map_write_of(
    name: Name,
    request: Request,
    state: StateOf,
    principal: PrincipalOf,
    conditions: ConditionsOf,
    timing: TimingOf,
) -> MapWrite:
    """Return the write request to the map in the path."""
    writer = state.engine.writer(principal, conditions)
    return MapWrite(name, request, state, principal, writer, timing, state.engine.mirror(name))


async def upload_write_of(
    name: Name, request: Request, state: StateOf, principal: PrincipalOf, timing: TimingOf
) -> MapWrite:
    """Return the write request to an incomplete upload, which has no version and no conditions."""
    writer, mirror = state.engine.writer(principal), state.engine.mirror(name)
    return MapWrite(name, request, state, principal, writer, timing, mirror)


MapWriteOf = Annotated[MapWrite, Depends(map_write_of)]
UploadWriteOf = Annotated[MapWrite, Depends(upload_write_of)]
