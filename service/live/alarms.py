"""Alarms: conditions that an operator must see, as events."""

from collections import Counter
from collections.abc import Callable, Collection
from threading import Lock
from time import monotonic

from service.live.events import EventRing

CHECK_SECONDS = 10.0
"""Seconds between two looks at the disk."""

REFUSED_STATUSES = frozenset({401, 403, 429, 503, 507})
"""Statuses of refusals that operators are told of."""

REFUSAL_SECONDS = 60.0
"""Seconds of refusals that one event counts."""


class StoreWatch:
    """Raises alarms when the store cannot be written (`store`), and for maps that are damaged."""

    def __init__(
        self,
        events: EventRing,
        trouble: Callable[[], str | None],
        damaged: Callable[[], Collection[str]],
        clock: Callable[[], float] = monotonic,
    ) -> None:
        """Create it.

        Args:
            events: log of the events.
            trouble: returns why no map can be stored; None if maps can be stored.
            damaged: returns the names of the maps that cannot be read.
            clock: monotonic clock, seconds.
        """
        self._events = events
        self._trouble = trouble
        self._damaged = damaged
        self._clock = clock
        self._next = 0.0
        self._known: set[str] = set()

    def check(self) -> None:
        """Look again, if it was some time ago."""
        now = self._clock()
        if now < self._next:
            return
        self._next = now + CHECK_SECONDS
        self._events.set_alarm("store", self._trouble())
        damaged = {*self._damaged()}
        for name in sorted(damaged | self._known):
            told = "The map is damaged on disk and not served." if name in damaged else None
            self._events.set_alarm("map-damaged", told, name)
        self._known = damaged


class RefusalCounter:
    """Counts refused requests, and publishes an alarm with their number at most once a minute."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        self._clock = clock
        self._lock = Lock()
        self._counts: Counter[int] = Counter()
        self._next = 0.0

    def add(self, status: int, events: EventRing) -> None:
        """Count a refusal; publish the counts if the last event was some time ago."""
        if status not in REFUSED_STATUSES:
            return
        with self._lock:
            self._counts[status] += 1
            now = self._clock()
            if now < self._next:
                return
            self._next = now + REFUSAL_SECONDS
            counts, self._counts = self._counts, Counter()
        told = {str(each): count for each, count in sorted(counts.items())}
        events.publish(
            "alarm",
            {
                "alarm": "refusals",
                "raised": True,
                "detail": f"{counts.total()} requests were refused. The log and the metric "
                "placecell_rejected have the reasons.",
                "counts": told,
            },
        )
