"""State of the running service: the engine, and the parts that only the HTTP API needs."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager
from dataclasses import dataclass, field
from typing import ParamSpec, TypeVar

from anyio import CapacityLimiter

from service.api.admission.admission import Lane, admitted
from service.api.admission.receiving import BodyRules, ByteBudget, Receiver
from service.api.admission.streaming import Answers
from service.api.body import json_arrays
from service.core.auth import Keys
from service.core.metrics import Metrics
from service.core.settings import Settings
from service.core.tracing import Tracing, TracingError, open_tracing
from service.core.version import version
from service.engine import Engine, StartError

READ_THREADS = 2
"""Threads that read stored maps; each may hold a whole map in memory."""

WRITE_THREADS = 4
"""Threads that edit maps."""

CATCH_UP_THREADS = 8
"""Threads that load versions of maps that a client has seen at another service."""

Result = TypeVar("Result")
Parameters = ParamSpec("Parameters")


@dataclass(frozen=True, slots=True)
class Lanes:
    """Admission control of each kind of request.

    Attributes:
        recognition: descriptions, matches and localizations.
        reads: reads of stored maps.
        uploads: uploads of maps.
        edits: edits and all other small writes of maps.
        alignments: alignments and merges of maps.
    """

    recognition: Lane
    reads: Lane
    uploads: Lane
    edits: Lane
    alignments: Lane

    @classmethod
    def of(cls, settings: Settings, metrics: Metrics) -> "Lanes":
        """Create the lanes; all of them share the memory for bodies."""
        limits = settings.limits
        largest = max(limits.map_bytes, limits.body_bytes, limits.json_bytes, limits.scan_bytes)
        share = max(limits.held_bytes // 2, largest)
        budget = ByteBudget(max(limits.held_bytes, share), share, "bodies")
        receiver = Receiver(limits.bodies, budget)
        small = BodyRules(limits.body_seconds, limits.stall_seconds)
        large = BodyRules(limits.transfer_seconds, limits.stall_seconds)
        return cls(
            recognition=Lane(
                most=limits.requests,
                threads=settings.workers,
                seconds=limits.deadline,
                body=small,
                body_bytes=max(limits.body_bytes, limits.json_bytes),
                receiver=receiver,
                gauge=metrics.queue_requests,
            ),
            reads=Lane(
                most=limits.reads,
                threads=READ_THREADS,
                seconds=limits.read_seconds,
                body=small,
                body_bytes=limits.body_bytes,
                receiver=receiver,
            ),
            uploads=Lane(
                most=limits.uploads,
                threads=limits.uploads,
                seconds=limits.upload_seconds,
                body=large,
                body_bytes=limits.map_bytes,
                receiver=receiver,
            ),
            edits=Lane(
                most=limits.edits,
                threads=WRITE_THREADS,
                seconds=limits.upload_seconds,
                body=large,
                body_bytes=limits.body_bytes,
                receiver=receiver,
            ),
            alignments=Lane(
                most=limits.alignments,
                threads=limits.alignments,
                seconds=limits.alignment_seconds,
                body=small,
                body_bytes=limits.body_bytes,
                receiver=receiver,
            ),
        )


@dataclass(slots=True)
class State:
    """State of the running service.

    Attributes:
        engine: models and maps.
        keys: API keys, and the maps that they open.
        lanes: admission control.
        answers: sends large answers.
        tracing: source of the spans of requests; None without traces.
        draining: whether the service is about to stop; it is then no longer ready.
        catching_up: limits the threads that load maps for requests.
    """

    engine: Engine
    keys: Keys
    lanes: Lanes
    answers: Answers
    tracing: Tracing | None = None
    draining: bool = False
    catching_up: CapacityLimiter = field(default_factory=lambda: CapacityLimiter(CATCH_UP_THREADS))

    @property
    def settings(self) -> Settings:
        """Return the settings that the service was started with."""
        return self.engine.settings

    @property
    def metrics(self) -> Metrics:
        """Return the counters and times."""
        return self.engine.metrics

    @property
    def model_id(self) -> str:
        """Return the id of the default model."""
        return self.engine.model.id

    async def run(
        self,
        work: Callable[Parameters, Result],
        *args: Parameters.args,
        **kwargs: Parameters.kwargs,
    ) -> Result:
        """Run blocking work in a thread of the request's lane, in the client's turn.

        A request that is in no lane takes a thread of recognition.
        """
        request = admitted()
        if request is not None:
            return await request.run(lambda: work(*args, **kwargs))
        return await self.lanes.recognition.threads.run("", lambda: work(*args, **kwargs))


@contextmanager
def open_state(settings: Settings) -> Iterator[State]:
    """Open keys and engine for a block.

    Raises:
        StartError: a model, the keys, the data directory or the traces cannot be used.
    """
    try:
        keys = Keys(settings.keys_file)
    except ValueError as error:
        raise StartError(f"keys: {error}") from error
    json_arrays.warm()
    metrics = Metrics()
    metrics.keys_file_good.set_function(lambda: float(keys.is_good()))
    limits = settings.limits
    with ExitStack() as opened:
        try:
            tracing = opened.enter_context(open_tracing(version()))
        except TracingError as error:
            raise StartError(str(error)) from error
        engine = opened.enter_context(Engine.open(settings, metrics, lambda: keys.patterns))
        answers = Answers(settings.data_dir, limits.answer_bytes, limits.transfer_seconds)
        opened.enter_context(closing(answers))
        yield State(engine, keys, Lanes.of(settings, metrics), answers, tracing)
