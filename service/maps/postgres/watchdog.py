"""Watchdog: ends waits for a server that does not answer, such as a stopped one."""

import os
import socket
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from threading import Event, Lock, Thread
from time import monotonic
from typing import Any

import psycopg

TICK_SECONDS = 0.5


class Watchdog:
    """Cuts connections that wait longer than they may. Safe to use from many threads.

    The driver waits for an answer without a limit. If the connection is cut, it raises an error.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._waits: dict[int, tuple[float, psycopg.Connection[Any]]] = {}
        self._numbers = count()
        self._stopped = Event()
        self._thread = Thread(target=self._watch, name="postgres-watchdog", daemon=True)
        self._thread.start()

    @contextmanager
    def limit(self, connection: psycopg.Connection[Any], seconds: float) -> Iterator[None]:
        """Limit the waits within a block."""
        with self._lock:
            number = next(self._numbers)
            self._waits[number] = monotonic() + seconds, connection
        try:
            yield
        finally:
            with self._lock:
                del self._waits[number]

    def close(self) -> None:
        """Stop watching."""
        self._stopped.set()
        self._thread.join(10 * TICK_SECONDS)

    def _watch(self) -> None:
        while not self._stopped.wait(TICK_SECONDS):
            now = monotonic()
            # Under the lock, so that the connection is not one that has returned to the pool.
            with self._lock:
                for until, connection in self._waits.values():
                    if until < now:
                        cut(connection)


def cut(connection: psycopg.Connection[Any]) -> None:
    """End a connection that another thread uses: its present wait fails."""
    try:
        with socket.socket(fileno=os.dup(connection.fileno())) as own:
            own.shutdown(socket.SHUT_RDWR)
    except (OSError, psycopg.Error):
        pass  # it has ended already
