"""What both clients share: all but the sending."""

import re
from collections.abc import Callable
from typing import Any, TypeVar

import httpx

from placecell_client.http.attempts import Attempts, Policy
from placecell_client.http.connection_errors import checked_url, explained, is_loopback
from placecell_client.http.encoding import MEDIA_TYPES, Encoding
from placecell_client.http.requests import Call, Calls
from placecell_client.http.retry import Retries

T = TypeVar("T")


class Caller:
    """Knows how to call one service; its subclasses say what the arguments are."""

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
            raise ValueError(f"encoding {encoding!r} is none of {', '.join(MEDIA_TYPES)}")
        self._base_url = checked_url(base_url)
        self._calls = Calls(encoding, compress)
        self._policy = Policy(timeout, retries, jitter, clock)

    def __repr__(self) -> str:
        # httpx hides a password in the URL.
        return f"{type(self).__name__}({self._base_url!r})"

    def _explain(self, error: Exception) -> None:
        """Add what to do to the last error of a call."""
        if isinstance(error, httpx.TransportError):
            error.args = (explained(error, self._base_url),)

    def _attempts(self, call: Call[T]) -> Attempts[T]:
        return Attempts(call, self._policy)


def http_options(base_url: httpx.URL, key: str | None) -> dict[str, Any]:
    """Arguments of httpx's clients; the key is kept in their headers alone, whose repr hides it.

    Raises:
        ValueError: the key cannot stand in a header. It is not told: it may be right but for a
            line's end.
    """
    options: dict[str, Any] = {"base_url": base_url}
    if is_loopback(base_url.host):
        host = f"[{base_url.host}]" if ":" in base_url.host else base_url.host
        # No proxy can reach this machine's loopback.
        options["mounts"] = {f"all://{host}": None}
    if key is None:
        return options
    # No quotes and backslashes: escaped, they would hide the key in an error page from us.
    if not re.fullmatch(r"[!#-\[\]-~]+", key):
        raise ValueError('key: not one or more visible ASCII characters other than " and \\')
    return options | {"headers": {"Authorization": f"Bearer {key}"}}
