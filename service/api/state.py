"""What a running service holds, in one typed object."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Annotated, ParamSpec, TypeVar

from fastapi import Depends, Header, Request
from fastapi.security import HTTPAuthorizationCredentials, HTTPBearer

from placecell.descriptors.manifest import ModelError
from service.api.admission.admission import Lane, admitted
from service.api.admission.receiving import BodyRules, ByteBudget, Receiver
from service.api.admission.streaming import Answers
from service.core.auth import Holder, Keys
from service.core.metrics import Metrics
from service.core.preconditions import Preconditions
from service.core.settings import Settings
from service.core.timing import Timing
from service.inference.model_registry import Models
from service.maps.cache import MapCache
from service.maps.quotas import Quotas
from service.maps.repository import MapRepository
from service.maps.sqlite.store import SqliteMapStore
from service.maps.store import StoreError, StoreLockedError
from service.maps.sync import MapSync
from service.maps.writes.maintenance import Maintenance, MaintenanceThresholds
from service.maps.writes.partial_uploads import PartialUploads
from service.maps.writes.writer import MapWriter
from service.search.sessions import Sessions
from service.warm_up import warm

READ_THREADS = 2
"""Threads that read stored maps; they hold maps whole, so more would take much memory."""

WRITE_THREADS = 4
"""Threads that edit maps."""

Result = TypeVar("Result")
Parameters = ParamSpec("Parameters")


class StartError(Exception):
    """The service cannot start; the message says why, for whoever starts it."""


@dataclass(slots=True)
class State:
    """Components of a running service.

    Attributes:
        settings: as started.
        metrics: what is counted and timed.
        models: loaded.
        maps: stored and searchable.
        partial_uploads: map files that are uploaded in parts and are not complete.
        changes: of maps, for robots that keep a copy.
        keys: who may do what.
        sessions: what robots' last requests for their place found.
        recognition: admits requests for recognition.
        reads: admits reads of stored maps.
        uploads: admits uploads of maps.
        edits: admits edits and all other small writes of maps.
        alignments: admits alignments and merges of maps.
        answers: sends large answers.
        draining: the service is about to stop; it is no longer ready.
    """

    settings: Settings
    metrics: Metrics
    models: Models
    maps: MapRepository
    partial_uploads: PartialUploads
    sync: MapSync
    keys: Keys
    sessions: Sessions
    recognition: Lane
    reads: Lane
    uploads: Lane
    edits: Lane
    alignments: Lane
    answers: Answers
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
        """Run blocking work (NumPy, FAISS, SQLite) in the threads of the request's lane, in turn.

        A request without a lane takes those of recognition.
        """
        here = admitted()
        if here is not None:
            return await here.run(lambda: work(*args, **kwargs))
        return await self.recognition.threads.run("", lambda: work(*args, **kwargs))

    async def store(
        self,
        work: Callable[Parameters, Result],
        *args: Parameters.args,
        **kwargs: Parameters.kwargs,
    ) -> Result:
        """Run blocking work as `run` does; a request without a lane takes the threads of edits."""
        here = admitted()
        if here is not None:
            return await here.run(lambda: work(*args, **kwargs))
        return await self.edits.threads.run("", lambda: work(*args, **kwargs))


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
        warm(models, settings.limits)
    except ModelError as error:
        raise StartError(f"model {settings.model!r} cannot be loaded: {error}") from error
    except ValueError as error:
        raise StartError(f"keys: {error}") from error
    with ExitStack() as stack:
        try:
            store = stack.enter_context(SqliteMapStore.owned(settings.data_dir))
            cache = MapCache(settings.data_dir)
            limits = settings.limits
            maps = MapRepository(store, models, Quotas(limits), cache)
        except (StoreLockedError, StoreError) as error:
            raise StartError(f"data directory: {error}") from error
        except OSError as error:
            raise StartError(f"data directory {settings.data_dir}: {error}") from error
        sync = MapSync(store)
        bounds = MaintenanceThresholds(
            map_bytes=limits.map_stored_bytes, all_bytes=limits.stored_bytes
        )
        partial_uploads = PartialUploads(settings.data_dir, limits)
        maintenance = Maintenance(maps, sync, cache, bounds, partial_uploads)
        stack.enter_context(maintenance.running())
        metrics.keys_file_good.set_function(lambda: float(keys.is_good()))
        metrics.maps.set_function(lambda: len(maps))
        metrics.map_segments.set_function(lambda: sum(len(each) for each in maps.all()))
        lanes = _lanes(settings, metrics)
        yield State(
            settings=settings,
            metrics=metrics,
            models=models,
            maps=maps,
            partial_uploads=partial_uploads,
            sync=sync,
            keys=keys,
            sessions=Sessions(limits.sessions),
            recognition=lanes["recognition"],
            reads=lanes["reads"],
            uploads=lanes["uploads"],
            edits=lanes["edits"],
            alignments=lanes["alignments"],
            answers=Answers(settings.data_dir, limits.answer_bytes, limits.transfer_seconds),
        )


def _lanes(settings: Settings, metrics: Metrics) -> dict[str, Lane]:
    limits = settings.limits
    share = max(limits.held_bytes // 2, limits.map_bytes, limits.body_bytes, limits.json_bytes)
    receiver = Receiver(limits.bodies, ByteBudget(max(limits.held_bytes, share), share, "bodies"))
    small = BodyRules(limits.body_seconds, limits.stall_seconds)
    large = BodyRules(limits.transfer_seconds, limits.stall_seconds)

    def lane(
        most: int, threads: int, seconds: float, body: BodyRules, body_bytes: int, name: str
    ) -> Lane:
        gauge = metrics.queue_requests if name == "recognition" else None
        return Lane(most, threads, seconds, body, body_bytes, receiver, gauge)

    most_bytes, stored = limits.body_bytes, limits.upload_seconds
    kinds = {
        "recognition": (
            *(limits.requests, settings.workers),
            *(limits.deadline, small, max(most_bytes, limits.json_bytes)),
        ),
        "reads": (limits.reads, READ_THREADS, limits.read_seconds, small, most_bytes),
        "uploads": (limits.uploads, limits.uploads, stored, large, limits.map_bytes),
        "edits": (limits.edits, WRITE_THREADS, stored, large, most_bytes),
        "alignments": (
            *(limits.alignments, limits.alignments),
            *(limits.alignment_seconds, small, most_bytes),
        ),
    }
    return {name: lane(*values, name) for name, values in kinds.items()}


async def state_of(request: Request) -> State:
    """The state of the application that a request came to."""
    state = request.app.state.placecell
    assert isinstance(state, State)
    return state


BEARER = HTTPBearer(
    auto_error=False,
    description="A key, made with `placecell keys`. A service without keys needs none.",
)
"""Security scheme of the API description; `Keys` reads the header."""


async def holder_of(
    request: Request,
    bearer: Annotated[HTTPAuthorizationCredentials | None, Depends(BEARER)] = None,
) -> Holder:
    """Who sent the request; 401 if their key is not known."""
    del bearer  # described, not used
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
) -> MapWriter:
    """Whoever sent the request, as one who writes to maps."""
    state = await state_of(request)
    conditions = Preconditions(if_match, if_none_match)
    return MapWriter(state.maps, state.models, await holder_of(request), conditions)


async def timing_of(request: Request) -> Timing:
    """The request's stopwatch."""
    timing = request.scope["state"]["timing"]
    assert isinstance(timing, Timing)
    return timing


StateOf = Annotated[State, Depends(state_of)]
HolderOf = Annotated[Holder, Depends(holder_of)]
TimingOf = Annotated[Timing, Depends(timing_of)]
WriterOf = Annotated[MapWriter, Depends(writer_of)]
