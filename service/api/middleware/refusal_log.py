"""Refusal log: log lines about refused requests, limited in number per minute."""

import ipaddress
import logging
from collections import Counter
from collections.abc import Callable
from http import HTTPStatus
from time import monotonic

from starlette.types import Scope

logger = logging.getLogger("placecell.refusals")

LOGGED_STATUSES = frozenset({401, 403, 429})
"""Statuses that are logged: no key, no permission, too many requests."""

WINDOW_SECONDS = 60.0
"""Period of the line limits, seconds."""

ADDRESS_LINES = 10
"""Largest number of lines per period and client address; further refusals are only counted."""

ALL_LINES = 100
"""Largest number of lines per period over all addresses."""


class RefusalLog:
    """Logger of refused requests with a limit of lines per minute."""

    def __init__(self, clock: Callable[[], float] = monotonic) -> None:
        """Create an empty log.

        Args:
            clock: function that returns a monotonic time, seconds.
        """
        self._clock = clock
        self._begun = clock()
        self._lines: Counter[str] = Counter()
        self._unlogged = 0

    def add(
        self, status: int, method: str, route: str, address: str, key: str | None, request_id: str
    ) -> None:
        """Log a refusal, or only count it once the limit of lines is reached.

        Args:
            status: HTTP status of the answer.
            method: HTTP method of the request.
            route: path of the route, with the names of its parameters instead of their values.
            address: network address of the client.
            key: name of the API key; None if it is unknown.
            request_id: id of the request.
        """
        now = self._clock()
        if now - self._begun >= WINDOW_SECONDS:
            if self._unlogged:
                logger.warning(
                    "%d further requests were refused and not logged",
                    self._unlogged,
                    extra={"unlogged": self._unlogged},
                )
            self._begun, self._unlogged = now, 0
            self._lines.clear()
        if self._lines[address] >= ADDRESS_LINES or self._lines.total() >= ALL_LINES:
            self._unlogged += 1
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
    """Return the client's address for the log, in a form that cannot forge log lines.

    Behind a proxy of the setting `forwarded_allow_ips` this is the address in X-Forwarded-For.
    """
    client = scope.get("client")
    if not client:
        return "a local socket"
    try:
        return str(ipaddress.ip_address(client[0]))
    except ValueError:
        return ascii(str(client[0])[:40])
