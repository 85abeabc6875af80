"""What a running service holds, in one typed object."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Annotated, ParamSpec, TypeVar

import anyio
import anyio.to_thread
from fastapi import Depends, Request

from segments.extractor import load_extractor
from segments.manifest import ModelError
from segments.pairs import PairClassifier, load_pair_classifier
from service.describer import Describer
from service.map_store import FolderMapStore, StoreLockedError
from service.maps import Maps
from service.settings import Settings

Result = TypeVar("Result")
Parameters = ParamSpec("Parameters")


class StartError(Exception):
    """The service cannot start; the message says why, for whoever starts it."""


@dataclass(frozen=True, slots=True)
class State:
    """The parts of a running service.

    Attributes:
        settings: as started.
        describer: the loaded model.
        classifier: the model's pair classifier, if it has one.
        maps: stored and searchable.
        turns: limits how many requests are computed at once.
    """

    settings: Settings
    describer: Describer
    classifier: PairClassifier | None
    maps: Maps
    turns: anyio.CapacityLimiter

    @property
    def model_id(self) -> str:
        """Of the loaded model."""
        return self.describer.manifest.model_id

    async def compute(
        self,
        work: Callable[Parameters, Result],
        *args: Parameters.args,
        **kwargs: Parameters.kwargs,
    ) -> Result:
        """Do blocking work (NumPy, ONNX Runtime, FAISS, disk) off the event loop, in turn."""
        return await anyio.to_thread.run_sync(lambda: work(*args, **kwargs), limiter=self.turns)


@contextmanager
def open_state(settings: Settings) -> Iterator[State]:
    """Load the model, take the data directory, load the maps; let go at the end.

    Raises:
        StartError: the model or the data directory cannot be used.
    """
    folder = settings.models_dir / settings.model
    try:
        extractor = load_extractor(folder, settings.threads)
        classifier = load_pair_classifier(folder, extractor.manifest)
    except ModelError as error:
        raise StartError(f"model {settings.model!r} cannot be loaded: {error}") from error
    manifest = extractor.manifest
    with ExitStack() as stack:
        try:
            store = stack.enter_context(FolderMapStore.open(settings.data_dir))
            maps = Maps(store, manifest)
        except StoreLockedError as error:
            raise StartError(f"data directory {error}") from error
        except OSError as error:
            raise StartError(f"data directory {settings.data_dir}: {error}") from error
        yield State(
            settings=settings,
            describer=Describer(extractor, settings.limits),
            classifier=classifier,
            maps=maps,
            turns=anyio.CapacityLimiter(settings.workers),
        )


def state_of(request: Request) -> State:
    """The state of the application that a request came to."""
    state = request.app.state.placecell
    assert isinstance(state, State)
    return state


StateOf = Annotated[State, Depends(state_of)]
