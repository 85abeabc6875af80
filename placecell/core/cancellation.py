"""Cancellation: a token that stops work whose request is late or whose client disconnected.

A token is set for a request. All code that the request runs finds it, also in other threads:

    token = current()        # outside of a request: a token that nobody cancels
    token.check()            # in Python, between steps: raises `Cancelled`
    kernel(..., token.flag)  # in compiled loops: `if is_cancelled(flag): return`, then check()
"""

import time
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from math import inf
from threading import Lock
from typing import Any, TypeVar

import numba
import numpy as np
from llvmlite import ir

from placecell.core.types import Int32

STEP_ITEMS = 4_096
"""Number of items after which a loop checks its token."""

TURN_SECONDS = 0.1
"""Interval at which work that waits for a lock checks its token, seconds."""


Item = TypeVar("Item")


class Cancelled(Exception):  # noqa: N818 -- as asyncio's CancelledError, but an ordinary exception
    """Work was stopped because its request is late or its client disconnected."""


class CancelToken:
    """Token that tells work to stop. Safe to share between threads.

    Attributes:
        flag: int32 (1,), not 0 once the work must stop. Compiled loops read it.
        deadline: time of `time.monotonic` after which the work must stop, seconds; inf for none.
            The flag does not change by itself at the deadline: the token's owner cancels it.
        begun: time of `time.monotonic` at which the work began, seconds.
    """

    __slots__ = ("begun", "deadline", "flag")

    def __init__(self, deadline: float = inf) -> None:
        self.flag: Int32 = np.zeros(1, dtype=np.int32)
        self.deadline = deadline
        self.begun = time.monotonic()

    def cancel(self) -> None:
        """Tell the work to stop at its next check."""
        self.flag[0] = 1

    @property
    def is_cancelled(self) -> bool:
        """True if the work must stop."""
        if not self.flag[0] and time.monotonic() >= self.deadline:
            self.cancel()
        return bool(self.flag[0])

    @property
    def seconds_left(self) -> float:
        """Seconds until the deadline, 0 or more; inf without a deadline."""
        return max(self.deadline - time.monotonic(), 0.0)

    def check(self) -> None:
        """Raise `Cancelled` if the work must stop.

        Raises:
            Cancelled: The token is cancelled, or its deadline has passed.
        """
        if self.is_cancelled:
            raise Cancelled


_token: ContextVar[CancelToken] = ContextVar("placecell_cancel_token")


def current() -> CancelToken:
    """Return the token of the current work; outside of a request, a token that nobody cancels."""
    return _token.get(None) or CancelToken()


@contextmanager
def cancelled_by(token: CancelToken) -> Iterator[CancelToken]:
    """Make a token current for a block and for the threads and tasks that it starts."""
    before = _token.set(token)
    try:
        yield token
    finally:
        _token.reset(before)


def checked(items: Iterable[Item]) -> Iterator[Item]:
    """Yield items, and check the token of the current work now and then.

    Raises:
        Cancelled: The request became late, or its client disconnected.
    """
    token = current()
    for index, item in enumerate(items):
        if index % STEP_ITEMS == 0:
            token.check()
        yield item


@contextmanager
def holding(lock: Lock) -> Iterator[None]:
    """Hold a lock for a block. The wait for the lock ends when the work must stop.

    Raises:
        Cancelled: The request became late, or its client disconnected, during the wait.
    """
    token = current()
    while not lock.acquire(timeout=TURN_SECONDS):
        token.check()
    try:
        token.check()
        yield
    finally:
        lock.release()


def _is_cancelled(typing_context: Any, flag: Any) -> Any:
    """Read a flag in compiled code, anew at each call: the compiler may hoist a plain read."""
    del typing_context

    def code(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        array = context.make_array(signature.args[0])(context, builder, arguments[0])
        value = builder.load_atomic(array.data, ordering="monotonic", align=4)
        return builder.icmp_signed("!=", value, ir.Constant(value.type, 0))

    return numba.types.boolean(flag), code


is_cancelled: Any = numba.extending.intrinsic(_is_cancelled)
"""Compiled function: whether a token's flag (int32 array) is set. Costs one memory read."""
