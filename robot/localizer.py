"""Localizer: asks the service for the robot's pose, or the pulled map if there is no link."""

from collections.abc import Callable
from dataclasses import dataclass

from robot.core.backoff import Backoff
from robot.core.link import FixAnswer, FixRequest, Link, LinkError, RefusedError
from robot.core.link_monitor import LinkMonitor
from robot.core.worker import Worker
from robot.localization.local_engine import LocalEngine


@dataclass(frozen=True, slots=True)
class _Asked:
    """Outcome of a request: the answer, and how the service did."""

    answer: FixAnswer
    was_reached: bool | None
    failed: bool = False
    retry_after: float | None = None


class Localizer:
    """One request at a time, in a worker, so that scans never wait."""

    def __init__(
        self,
        link: Link | None,
        engine: LocalEngine,
        monitor: LinkMonitor,
        clock: Callable[[], float],
        worker: Worker[_Asked],
    ) -> None:
        self._link = link
        self._engine = engine
        self._monitor = monitor
        self._backoff = Backoff(clock)
        self._worker = worker

    @property
    def is_busy(self) -> bool:
        """Whether a request has no answer yet."""
        return self._worker.is_busy

    def ask(self, request: FixRequest) -> bool:
        """Send a request; return False if the one before has no answer yet."""
        use_link = self._link is not None and self._backoff.is_over and not self._monitor.is_offline
        return self._worker.submit(lambda: self._ask(request, use_link))

    def answer(self) -> FixAnswer | None:
        """Return the answer that has arrived, once; None if there is none."""
        asked = self._worker.take()
        if asked is None:
            return None
        if asked.was_reached is not None:
            self._monitor.note(asked.was_reached)
        if asked.failed:
            self._backoff.failed(asked.retry_after)
        elif asked.was_reached:
            self._backoff.succeeded()
        return asked.answer

    def wait(self, seconds: float) -> bool:
        """Wait for the answer; return whether no request is without one."""
        return self._worker.wait(seconds)

    def close(self) -> None:
        """Stop the worker."""
        self._worker.close()

    def _ask(self, request: FixRequest, use_link: bool) -> _Asked:
        if self._link is None or not use_link:
            return _Asked(self._engine.localize(request), None)
        try:
            return _Asked(self._link.localize(request), True)
        except LinkError as error:
            reached, wait, reason = error.was_reached, error.retry_after, str(error)
        except RefusedError as error:
            # The pulled map would give an answer of a map that the service does not have.
            return _Asked(FixAnswer(request, "service", None, None, 0.0, str(error)), True)
        if self._engine.has_map:
            return _Asked(self._engine.localize(request), reached, True, wait)
        answer = FixAnswer(request, "service", None, None, 0.0, reason)
        return _Asked(answer, reached, True, wait)
