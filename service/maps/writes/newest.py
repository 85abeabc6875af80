"""Writes on the newest version of a map, also if other services write to it."""

from collections.abc import Callable
from functools import update_wrapper
from time import monotonic
from typing import Concatenate, ParamSpec, Protocol, TypeVar

from placecell.core.cancellation import current
from service.maps.repository import MapRepository, OutdatedError

TRIES = 5
"""Number of times that a write is tried which other services overtake."""

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
        before = current().begun
        for _ in range(TRIES - 1):
            self.maps.catch_up(name, before)
            try:
                return write(self, name, *args, **kwargs)
            except OutdatedError:
                before = monotonic()
        self.maps.catch_up(name, before)
        return write(self, name, *args, **kwargs)

    return update_wrapper(written, write)
