"""Log of refused requests, with a bounded number of lines."""

import ipaddress
import logging
from collections import Counter
from collections.abc import Callable
from http import HTTPStatus
from time import monotonic

from starlette.types import Scope

logger = logging.getLogger("placecell.refusals")

TOLD = frozenset({401, 403, 429})
"""Statuses that are logged: no key, no permission, too many requests."""

WINDOW_SECONDS = 60.0

ADDRESS_LINES = 10
"""Lines per window and address; further refusals are counted and reported with the next line."""

ALL_LINES = 100
"""Lines per window over all addresses."""


class RefusalLog:
    """Logger of refused requests, with a limit of lines per minute."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        """Create an empty log.

        Args:
            clock: gives seconds that only grow.
        """
        self._clock = clock
        self._begun = clock()
        self._lines: Counter[str] = Counter()
        self._untold = 0

    def tell(
        self, status: int, method: str, route: str, address: str, key: str | None, request_id: str
    ) -> None:
        """Log a refusal, or count it.

        Args:
            status: of the answer.
            method: of the request.
            route: its path, with names of parameters in place of their values.
            address: of the client.
            key: name of the key that it came with, if that is known.
            request_id: of the request.
        """
        now = self._clock()
        if now - self._begun >= WINDOW_SECONDS:
            if self._untold:
                logger.warning(
                    "%d further requests were refused and not logged",
                    self._untold,
                    extra={"untold": self._untold},
                )
            self._begun, self._untold = now, 0
            self._lines.clear()
        if self._lines[address] >= ADDRESS_LINES or self._lines.total() >= ALL_LINES:
            self._untold += 1
            return
        self._lines[address] += 1
        logger.warning(
            "%d %s: %s %s from %s, key %s",
            status,
            HTTPStatus(status).phrase,
            method,
            route,
            address,
            key or "unknown",
            extra={
                "status": status,
                "method": method,
                "route": route,
                "client": address,
                "key": key,
                "request_id": request_id,
            },
        )


def address_of(scope: Scope) -> str:
    """Return the client's address for the log, safe against forged lines.

    Behind a proxy of `forwarded_allow_ips` it is the one that the proxy states (X-Forwarded-For).
    """
    client = scope.get("client")
    if not client:
        return "a local socket"
    try:
        return str(ipaddress.ip_address(client[0]))
    except ValueError:
        return ascii(str(client[0])[:40])
