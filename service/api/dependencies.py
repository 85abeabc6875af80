"""Dependencies of the routes: the service's state, the key's holder, the writer, the stopwatch."""

from typing import Annotated

from fastapi import Depends, Header, Request
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer

from service.api.state import State
from service.core.auth import Holder
from service.core.preconditions import Preconditions
from service.core.timing import Timing
from service.maps.writes.writer import MapWriter

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


async def holder_of(
    request: Request,
    bearer: Annotated[HTTPAuthorizationCredentials | None, Depends(BEARER)] = None,
) -> Holder:
    """Return the holder of the request's key; 401 if the key is unknown."""
    del bearer  # described, not used
    state = await state_of(request)
    holder = state.keys.holder(request.headers.get("authorization"))
    request.scope["state"]["key"] = holder.name
    return holder


async def writer_of(
    request: Request,
    if_match: Annotated[
        str | None,
        Header(description="ETags of the versions that this request is for, or *."),
    ] = None,
    if_none_match: Annotated[
        str | None,
        Header(description="ETags of the versions that this request is not for, or *."),
    ] = None,
) -> MapWriter:
    """Return the writer of the request, with the rights of its key and its conditions."""
    state = await state_of(request)
    holder = await holder_of(request)
    return state.engine.writer(holder, Preconditions(if_match, if_none_match))


async def timing_of(request: Request) -> Timing:
    """Return the stopwatch of the request."""
    timing = request.scope["state"]["timing"]
    assert isinstance(timing, Timing)
    return timing


StateOf = Annotated[State, Depends(state_of)]
HolderOf = Annotated[Holder, Depends(holder_of)]
TimingOf = Annotated[Timing, Depends(timing_of)]
WriterOf = Annotated[MapWriter, Depends(writer_of)]
