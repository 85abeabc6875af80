"""Writes on the newest version of a map, also if other services write to it."""

from collections.abc import Callable
from functools import update_wrapper
from time import monotonic
from typing import Concatenate, ParamSpec, Protocol, TypeVar

from placecell.core.cancellation import current
from service.maps.repository import MapRepository, OutdatedError

TRY_SECONDS = 10.0
"""Seconds for which a write is tried that other services overtake, if its request waits as long.
Each try that fails is one in which another write succeeded."""

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


class _Writer(Protocol):
    @property
    def maps(self) -> MapRepository: ...


Writer = TypeVar("Writer", bound=_Writer)


def on_newest(
    write: Callable[Concatenate[Writer, str, Parameters], Result],
) -> Callable[Concatenate[Writer, str, Parameters], Result]:
    """Load what was written before a request, write, and repeat a write that was overtaken.

    Each try checks rights and preconditions against the version that it follows.
    """

    def written(
        self: Writer, name: str, /, *args: Parameters.args, **kwargs: Parameters.kwargs
    ) -> Result:
        before, until = current().begun, monotonic() + TRY_SECONDS
        while True:
            self.maps.catch_up(name, before)
            try:
                return write(self, name, *args, **kwargs)
            except OutdatedError:
                before = monotonic()
                if before > until:
                    raise

    return update_wrapper(written, write)
