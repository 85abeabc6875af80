"""What a running service holds, in one typed object."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Annotated, ParamSpec, TypeVar

import anyio
import anyio.to_thread
from fastapi import Depends, Header, Request

from segments.manifest import ModelError
from service.changes import Changes
from service.desk import Desk
from service.housekeeping import Bounds, Housekeeper
from service.keys import Holder, Keys
from service.map_cache import MapCache
from service.map_store import StoreError, StoreLockedError
from service.maps import Maps
from service.metrics import Metrics
from service.models import Models
from service.preconditions import Preconditions
from service.quotas import Quotas
from service.sessions import Sessions
from service.settings import Settings
from service.sqlite_store import SqliteMapStore
from service.timing import Timing
from service.writer import Writer

Result = TypeVar("Result")
Parameters = ParamSpec("Parameters")


class StartError(Exception):
    """The service cannot start; the message says why, for whoever starts it."""


@dataclass(slots=True)
class State:
    """The parts of a running service.

    Attributes:
        settings: as started.
        metrics: what is counted and timed.
        models: loaded.
        maps: stored and searchable.
        changes: of maps, for robots that keep a copy.
        keys: who may do what.
        sessions: what robots' last requests for their place found.
        desk: takes in requests for recognition.
        uploads: takes in maps.
        edits: takes in edits of maps.
        alignments: takes in alignments and merges of maps.
        turns: limits how many requests are computed at once.
        hands: limits how many work on stored maps at once.
        draining: the service is about to stop; it is no longer ready.
    """

    settings: Settings
    metrics: Metrics
    models: Models
    maps: Maps
    changes: Changes
    keys: Keys
    sessions: Sessions
    desk: Desk
    uploads: Desk
    edits: Desk
    alignments: Desk
    turns: anyio.CapacityLimiter
    hands: anyio.CapacityLimiter
    draining: bool = False

    @property
    def model_id(self) -> str:
        """Of the default model."""
        return self.models.default.id

    async def compute(
        self,
        work: Callable[Parameters, Result],
        *args: Parameters.args,
        **kwargs: Parameters.kwargs,
    ) -> Result:
        """Do blocking work of recognition (NumPy, FAISS) off the event loop, in turn."""
        return await anyio.to_thread.run_sync(lambda: work(*args, **kwargs), limiter=self.turns)

    async def store(
        self,
        work: Callable[Parameters, Result],
        *args: Parameters.args,
        **kwargs: Parameters.kwargs,
    ) -> Result:
        """Do blocking work on stored maps off the event loop; recognition does not wait for it."""
        return await anyio.to_thread.run_sync(lambda: work(*args, **kwargs), limiter=self.hands)


@contextmanager
def open_state(settings: Settings) -> Iterator[State]:
    """Load the models, take the data directory, load the maps; let go at the end.

    Raises:
        StartError: a model, the keys or the data directory cannot be used.
    """
    metrics = Metrics()
    try:
        keys = Keys(settings.keys_file)
        models = Models(settings, metrics)
    except ModelError as error:
        raise StartError(f"model {settings.model!r} cannot be loaded: {error}") from error
    except ValueError as error:
        raise StartError(f"keys: {error}") from error
    with ExitStack() as stack:
        try:
            store = stack.enter_context(SqliteMapStore.owned(settings.data_dir))
            cache = MapCache(settings.data_dir)
            limits, gauge = settings.limits, metrics.queue_requests
            maps = Maps(store, models, Quotas(limits), cache)
        except (StoreLockedError, StoreError) as error:
            raise StartError(f"data directory: {error}") from error
        except OSError as error:
            raise StartError(f"data directory {settings.data_dir}: {error}") from error
        changes = Changes(store)
        bounds = Bounds(map_bytes=limits.map_stored_bytes, all_bytes=limits.stored_bytes)
        stack.enter_context(Housekeeper(maps, changes, cache, bounds).working())
        metrics.maps.set_function(lambda: len(maps))
        metrics.map_segments.set_function(lambda: sum(len(each) for each in maps.all()))
        seconds = limits.upload_seconds
        yield State(
            settings=settings,
            metrics=metrics,
            models=models,
            maps=maps,
            changes=changes,
            keys=keys,
            sessions=Sessions(limits.sessions),
            desk=Desk(
                limits.requests, limits.deadline, limits.body_seconds, limits.body_bytes, gauge
            ),
            uploads=Desk(limits.uploads, seconds, seconds, limits.map_bytes),
            edits=Desk(limits.edits, seconds, seconds, limits.body_bytes),
            alignments=Desk(
                limits.alignments, limits.alignment_seconds, limits.body_seconds, limits.body_bytes
            ),
            turns=anyio.CapacityLimiter(settings.workers),
            hands=anyio.CapacityLimiter(limits.uploads + limits.alignments),
        )


async def state_of(request: Request) -> State:
    """The state of the application that a request came to."""
    state = request.app.state.placecell
    assert isinstance(state, State)
    return state


async def holder_of(request: Request) -> Holder:
    """Who sent the request; 401 if their key is not known."""
    state = await state_of(request)
    holder = state.keys.holder(request.headers.get("authorization"))
    request.scope["state"]["key"] = holder.name
    return holder


async def writer_of(
    request: Request,
    if_match: Annotated[
        str | None, Header(description="ETags of the versions that this is meant for, or *.")
    ] = None,
    if_none_match: Annotated[
        str | None, Header(description="ETags of the versions that this is not for, or *.")
    ] = None,
) -> Writer:
    """Whoever sent the request, as one who writes to maps."""
    state = await state_of(request)
    conditions = Preconditions(if_match, if_none_match)
    return Writer(state.maps, state.models, await holder_of(request), conditions)


async def timing_of(request: Request) -> Timing:
    """The request's stopwatch."""
    timing = request.scope["state"]["timing"]
    assert isinstance(timing, Timing)
    return timing


StateOf = Annotated[State, Depends(state_of)]
HolderOf = Annotated[Holder, Depends(holder_of)]
TimingOf = Annotated[Timing, Depends(timing_of)]
WriterOf = Annotated[Writer, Depends(writer_of)]
