"""Availability: the longest time without an answer, by the fault that caused it."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from threading import Lock


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault.

    Attributes:
        cause: kind of the fault.
        start: monotonic time of its begin, seconds.
    """

    cause: str
    start: float


@dataclass(slots=True)
class AnswerTimes:
    """Times of a client's answers.

    Attributes:
        kind: what the client does, such as `write`.
        times: monotonic time of each answer, seconds, ascending.
    """

    kind: str
    times: list[float] = field(default_factory=list)

    def gaps(self) -> Iterable[tuple[float, float]]:
        """Yield begin and end of each time between two answers."""
        return zip(self.times, self.times[1:], strict=False)


class FaultLog:
    """All faults of a run, in their order. Safe to use from many threads."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._faults: list[Fault] = []

    def add(self, cause: str, start: float) -> None:
        """Note a fault."""
        with self._lock:
            self._faults.append(Fault(cause, start))

    @property
    def faults(self) -> tuple[Fault, ...]:
        """All faults so far."""
        with self._lock:
            return tuple(self._faults)

    def counts(self) -> dict[str, int]:
        """Return the number of faults of each cause."""
        causes = [each.cause for each in self.faults]
        return {cause: causes.count(cause) for cause in dict.fromkeys(causes)}


def cause_of(begin: float, end: float, faults: Sequence[Fault]) -> str:
    """Return the cause of a time without an answer.

    It is the first fault that began within that time; else the last one before it, whose replica
    or server may still be starting; else `none`.
    """
    within = [each for each in faults if begin <= each.start <= end]
    if within:
        return within[0].cause
    before = [each for each in faults if each.start < begin]
    return before[-1].cause if before else "none"


def longest_gaps(clients: Iterable[AnswerTimes], faults: Sequence[Fault]) -> dict[str, float]:
    """Return the longest time without an answer of any client by its cause, seconds."""
    longest = dict.fromkeys((each.cause for each in faults), 0.0)
    for client in clients:
        for begin, end in client.gaps():
            # Short times are many, and none of them is the longest.
            if end - begin > min(longest.values(), default=0.0) or not longest:
                cause = cause_of(begin, end, faults)
                longest[cause] = max(longest.get(cause, 0.0), end - begin)
    return {cause: round(seconds, 3) for cause, seconds in longest.items()}
