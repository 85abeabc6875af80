"""Base of both clients: everything except sending."""

import re
from collections.abc import Callable
from typing import Any, TypeVar

import httpx

from placecell_client.http.attempts import Attempts, Policy
from placecell_client.http.connection_errors import checked_url, explained, is_loopback
from placecell_client.http.encoding import MEDIA_TYPES, Encoding
from placecell_client.http.requests import Call, Calls
from placecell_client.http.retry import Retries
from placecell_client.seen import SeenVersions

T = TypeVar("T")


class BaseClient:
    """Base of both clients: address, encoding and retry policy of one service."""

    def __init__(
        self,
        base_url: str,
        encoding: Encoding,
        compress: bool,
        timeout: float,
        retries: Retries,
        jitter: Callable[[], float],
        clock: Callable[[], float],
    ) -> None:
        if encoding not in MEDIA_TYPES:
            raise ValueError(
                f"Invalid encoding {encoding!r}: expected one of {', '.join(MEDIA_TYPES)}."
            )
        self._base_url = checked_url(base_url)
        self._calls = Calls(encoding, compress)
        self._policy = Policy(timeout, retries, jitter, clock)
        self._seen = SeenVersions()

    def __repr__(self) -> str:
        # httpx hides a password in the URL.
        return f"{type(self).__name__}({self._base_url!r})"

    def _explain(self, error: Exception, request_id: str) -> None:
        """Add a hint and the request id to the last connection error of a call."""
        if isinstance(error, httpx.TransportError):
            error.args = (f"{explained(error, self._base_url)} (request {request_id})",)

    def _attempts(self, call: Call[T]) -> Attempts[T]:
        return Attempts(call, self._policy, self._seen)


def http_options(
    base_url: httpx.URL, key: str | None, mirrors: str | None = None
) -> dict[str, Any]:
    """Return the arguments of httpx's clients; only their headers hold the key, hidden in repr.

    Raises:
        ValueError: The key has characters that a header cannot hold. The message does not show the
            key, which may be right except for a line break.
    """
    options: dict[str, Any] = {"base_url": base_url}
    if is_loopback(base_url.host):
        host = f"[{base_url.host}]" if ":" in base_url.host else base_url.host
        # A proxy cannot reach the loopback interface of this machine.
        options["mounts"] = {f"all://{host}": None}
    headers = {} if mirrors is None else {"Placecell-Mirror": mirrors}
    if key is None:
        return options | {"headers": headers} if headers else options
    # Quotes and backslashes are refused: escaped in an error page, the key could not be found.
    if not re.fullmatch(r"[!#-\[\]-~]+", key):
        raise ValueError(
            'Invalid key: expected one or more visible ASCII characters other than " and \\.'
        )
    return options | {"headers": headers | {"Authorization": f"Bearer {key}"}}
