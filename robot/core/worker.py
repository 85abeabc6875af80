"""Worker: one thread that makes blocking calls, so that scans never wait for the link."""

from collections.abc import Callable
from functools import partial
from queue import SimpleQueue
from threading import Event, Thread
from typing import Any, Generic, TypeVar

T = TypeVar("T")


class Worker(Generic[T]):
    """One thread that makes one call at a time; the agent polls for the result."""

    def __init__(self, name: str) -> None:
        self._jobs: SimpleQueue[Callable[[], T] | None] = SimpleQueue()
        self._done = Event()
        self._result: T | None = None
        self._error: BaseException | None = None
        self.is_busy = False
        self._thread = Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    def submit(self, call: Callable[[], T]) -> bool:
        """Start a call; return False if the worker is busy. `take` gets the result."""
        if self.is_busy:
            return False
        self.is_busy = True
        self._done.clear()
        self._jobs.put(call)
        return True

    def take(self) -> T | None:
        """Return the result of a finished call, once; None if there is none.

        Raises:
            BaseException: what the call raised.
        """
        if not self.is_busy or not self._done.is_set():
            return None
        self.is_busy = False
        result, error = self._result, self._error
        self._result = self._error = None
        if error is not None:
            raise error
        return result

    def wait(self, seconds: float) -> bool:
        """Wait until the call has finished; return whether it has, or there is none."""
        return not self.is_busy or self._done.wait(seconds)

    def close(self, seconds: float = 1.0) -> None:
        """Stop the thread after its call; a call that takes longer is abandoned."""
        self._jobs.put(None)
        self._thread.join(seconds)

    def _run(self) -> None:
        while (call := self._jobs.get()) is not None:
            result: Any = None
            try:
                result, self._error = call(), None
            except BaseException as error:  # `take` raises it in the agent's thread.
                self._error = error
            self._result = result
            self._done.set()


class InlineWorker(Worker[T]):
    """Worker without a thread: a call is made at once. For tests and single-threaded programs."""

    def __init__(self, name: str) -> None:
        self._name = name
        self._outcome: Callable[[], T] | None = None
        self.is_busy = False

    def submit(self, call: Callable[[], T]) -> bool:
        """Make a call; return False if the last result was not taken."""
        if self.is_busy:
            return False
        self.is_busy = True
        try:
            result = call()
            self._outcome = lambda: result
        except BaseException as error:
            self._outcome = partial(_raise, error)
        return True

    def take(self) -> T | None:
        """Return the result of the call, once."""
        if self._outcome is None:
            return None
        outcome, self._outcome, self.is_busy = self._outcome, None, False
        return outcome()

    def wait(self, seconds: float) -> bool:  # noqa: ARG002
        """Return at once: the call has finished."""
        return True

    def close(self, seconds: float = 1.0) -> None:
        """Do nothing."""


def _raise(error: BaseException) -> Any:
    raise error
