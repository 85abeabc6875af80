"""Events: what happens in the service, in memory, for clients that listen.

All listeners read one ring of the last events, each from its own position. So a listener takes no
memory for events, and one that falls behind the ring has missed events.
"""

import asyncio
import json
import secrets
import time
from collections import Counter, deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Lock
from typing import Any, Literal

from service.core.auth import Principal
from service.core.problems import Problem

Kind = Literal["fix", "no-fix", "robot", "upload", "merge", "write", "alarm"]

EVENT_BYTES = 8 << 10
"""Largest size of an event's data, bytes; a longer event is not published."""


@dataclass(frozen=True, slots=True)
class ServiceEvent:
    """Event of the service.

    Attributes:
        number: position in the order of all events since the start of the process.
        kind: kind of the event.
        map: name of the map that it is about; None if it is about none.
        author: name of the key that caused it; empty for the service itself.
        data: its data as JSON.
    """

    number: int
    kind: Kind
    map: str | None
    author: str
    data: str

    def is_visible_to(self, principal: Principal) -> bool:
        """Return whether a key may see the event: it reads the map, or it caused the event."""
        if principal.covers_all or (self.author and self.author == principal.name):
            return True
        return self.map is not None and principal.covers(self.map)


class EventRing:
    """Ring of the last events. Safe to use from many threads; listeners belong to event loops."""

    def __init__(self, most: int, listeners: int, clock: Callable[[], float] = time.time) -> None:
        """Create an empty log.

        Args:
            most: number of events that are kept.
            listeners: largest number of listeners; one client may have a quarter.
            clock: returns Unix seconds.
        """
        self.epoch = secrets.token_hex(4)
        self.is_closed = False
        self._clock = clock
        self._lock = Lock()
        self._ring: deque[ServiceEvent] = deque(maxlen=most)
        self._count = 0
        self._alarms: dict[tuple[str, str | None], ServiceEvent] = {}
        self._most_listeners = listeners
        self._listeners: dict[Listener, str] = {}

    def __len__(self) -> int:
        return len(self._listeners)

    def publish(
        self, kind: Kind, data: dict[str, Any], map_name: str | None = None, author: str = ""
    ) -> ServiceEvent | None:
        """Add an event and wake the listeners; None if its data is too long."""
        text = json.dumps({"time": self._clock(), "map": map_name} | data, allow_nan=False)
        if len(text) > EVENT_BYTES:
            return None
        with self._lock:
            self._count += 1
            event = ServiceEvent(self._count, kind, map_name, author, text)
            self._ring.append(event)
            listeners = [*self._listeners]
        for each in listeners:
            each.wake()
        return event

    def set_alarm(
        self, alarm: str, detail: str | None, map_name: str | None = None
    ) -> ServiceEvent | None:
        """Raise an alarm, or clear it if there is no detail; nothing happens if it stands so.

        Args:
            alarm: name of the alarm.
            detail: what is wrong; None if nothing is any more.
            map_name: name of the map that it is about.
        """
        with self._lock:
            standing = self._alarms.get((alarm, map_name))
        if (standing is None) == (detail is None):
            return None
        state = {"alarm": alarm, "raised": detail is not None, "detail": detail or ""}
        event = self.publish("alarm", state, map_name)
        with self._lock:
            if detail is None or event is None:
                self._alarms.pop((alarm, map_name), None)
            else:
                self._alarms[alarm, map_name] = event
        return event

    def alarms(self) -> list[ServiceEvent]:
        """Return the alarms that stand, oldest first."""
        with self._lock:
            return sorted(self._alarms.values(), key=lambda event: event.number)

    @property
    def last(self) -> int:
        """Return the number of the newest event; 0 if there is none."""
        return self._count

    def after(self, number: int) -> tuple[list[ServiceEvent], int]:
        """Return the events after one, oldest first, and how many of them are lost."""
        with self._lock:
            first = self._ring[0].number if self._ring else self._count + 1
            lost = max(first - number - 1, 0)
            start = max(number + 1 - first, 0)
            return [self._ring[index] for index in range(start, len(self._ring))], lost

    def id_of(self, number: int) -> str:
        """Return the id of an event, for `Last-Event-ID`."""
        return f"{self.epoch}-{number}"

    def number_of(self, event_id: str) -> int | None:
        """Return the number of an id; None if it is not of this process."""
        epoch, _, number = event_id.partition("-")
        if epoch != self.epoch or not number.isascii() or not number.isdigit():
            return None
        return min(int(number[:18]), self._count)

    @contextmanager
    def listening(self, client: str) -> Iterator["Listener"]:
        """Register a listener of the running event loop for a block.

        Raises:
            Problem: 429 if there are too many listeners.
        """
        with self._lock:
            own, share = (
                Counter(self._listeners.values())[client],
                max(self._most_listeners // 4, 1),
            )
            if own >= share or len(self._listeners) >= self._most_listeners:
                raise Problem(
                    429,
                    "busy",
                    f"This client listens to events {own} times, all clients "
                    f"{len(self._listeners)} times; the limits are {share} and "
                    f"{self._most_listeners}. Close other streams of events.",
                    headers={"Retry-After": "5"},
                )
            listener = Listener(asyncio.get_running_loop())
            self._listeners[listener] = client
        try:
            yield listener
        finally:
            with self._lock:
                self._listeners.pop(listener, None)

    def close(self) -> None:
        """End all streams; no listener is left waiting."""
        self.is_closed = True
        with self._lock:
            listeners = [*self._listeners]
        for each in listeners:
            each.wake()


class Listener:
    """Listener that waits for the next event, in its event loop."""

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self._loop = loop
        self._woken = asyncio.Event()

    def wake(self) -> None:
        """Wake the listener, from any thread."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._woken.set)

    async def wait(self, seconds: float) -> bool:
        """Wait for an event; return false if none came in time."""
        try:
            async with asyncio.timeout(max(seconds, 0.0)):
                await self._woken.wait()
        except TimeoutError:
            return False
        self._woken.clear()
        return True
