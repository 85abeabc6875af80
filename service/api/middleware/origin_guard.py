"""Origin guard: protects a service without keys from web pages, by `Host` and `Origin`.

A page that a user opens can send requests to any service on the user's machine. If the page's name
resolves to 127.0.0.1 (DNS rebinding), the page can also read the answers. API keys prevent both,
because no page knows a key. Without keys this guard checks the names in `Host` and `Origin`.
"""

import ipaddress
import socket
from collections.abc import Collection
from urllib.parse import urlsplit

from starlette.types import ASGIApp, Receive, Scope, Send

from service.api.body.problem_json import response_of
from service.core.problems import Problem
from service.core.settings import Settings

DEFAULT_PORTS = {"http": 80, "https": 443}

Address = ipaddress.IPv4Address | ipaddress.IPv6Address


class OriginGuard:
    """ASGI middleware: answers 403 to foreign hosts and origins while the service has no keys."""

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self._app = app
        self._has_keys = settings.keys_file is not None
        self._hosts = [name.lower().rstrip(".") for name in settings.allowed_hosts]
        self._origins = {origin.lower().rstrip("/") for origin in settings.cors_origins}
        own = socket.gethostname().lower()
        # Names of this machine, for clients on other machines.
        self._names = {settings.host.lower(), own, f"{own}.local"}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass the request on if its host and origin are allowed."""
        if scope["type"] == "http" and not self._has_keys:
            problem = self._problem(scope)
            if problem is not None:
                scope["app"].state.placecell.metrics.rejected.labels(problem.kind).inc()
                await response_of(problem)(scope, receive, send)
                return
        await self._app(scope, receive, send)

    def _problem(self, scope: Scope) -> Problem | None:
        named = _values(scope, b"host")
        # A request without Host is HTTP/1.0 or comes from this process. No browser sends it.
        host = _host(named[0]) if named else None
        if len(named) > 1 or (named and (host is None or not self._is_known(host[0], scope))):
            return _refusal(
                "foreign-host",
                f"Host {named[0]!r:.80} is not allowed. A service without keys accepts loopback "
                "names only. Add the name to PLACECELL_ALLOWED_HOSTS, or make keys (placecell "
                "keys).",
            )
        for origin in _values(scope, b"origin"):
            if not self._is_own(origin, host):
                return _foreign_origin(origin)
        # A page of an allowed origin sends Origin. A request that a link opens has no Origin.
        if not (_values(scope, b"origin") and self._origins):
            for site in _values(scope, b"sec-fetch-site"):
                if site.strip().lower() not in {"same-origin", "none"}:
                    return _foreign_origin(f"of a page ({site:.20})")
        return None

    def _is_known(self, name: str, scope: Scope) -> bool:
        """Return whether a name in `Host` belongs to this service."""
        if _fits(name, self._hosts) or name == "localhost" or name.endswith(".localhost"):
            return True
        address, here = _address(name), (scope.get("server") or ("", 0))[0]
        if address is not None and address.is_loopback:
            return True
        reached = _address(here)
        if reached is None:
            # Not an Internet socket: either a Unix socket, named by its path, or a caller in this
            # process, such as a test, that uses a name without dots.
            return name == here.lower() and "." not in name and "/" not in name
        # The service listens on other addresses only if the operator configured that. DNS
        # rebinding needs a name, so addresses are safe.
        return not reached.is_loopback and (address is not None or name in self._names)

    def _is_own(self, origin: str, host: tuple[str, int | None] | None) -> bool:
        """Return whether a page's origin is the service itself or is allowed by the settings."""
        origin = origin.strip().lower()
        if origin in self._origins or "*" in self._origins:
            return True
        try:
            parts = urlsplit(origin)
            default = DEFAULT_PORTS[parts.scheme]
            named = (parts.hostname or "").rstrip("."), parts.port or default
        except (ValueError, KeyError):
            return False
        return host is not None and named == (host[0], host[1] or default)


def _values(scope: Scope, name: bytes) -> list[str]:
    return [value.decode("latin-1") for key, value in scope["headers"] if key == name]


def _host(header: str) -> tuple[str, int | None] | None:
    """Return name and port of a `Host` header; None if it is invalid."""
    try:
        parts = urlsplit(f"//{header.strip()}")
        name, port = parts.hostname, parts.port
    except ValueError:
        return None
    if not name or parts.path or parts.query or parts.fragment or "@" in header:
        return None
    return name.lower().rstrip("."), port


def _address(name: str) -> Address | None:
    try:
        address = ipaddress.ip_address(name.partition("%")[0])
    except ValueError:
        return None
    mapped = address.ipv4_mapped if isinstance(address, ipaddress.IPv6Address) else None
    return mapped or address


def _fits(name: str, patterns: Collection[str]) -> bool:
    """Return whether a name matches a pattern; `*.example` matches all names below it."""
    below = [pattern[1:] for pattern in patterns if pattern.startswith("*.")]
    return "*" in patterns or name in patterns or any(name.endswith(each) for each in below)


def _foreign_origin(origin: str) -> Problem:
    return _refusal(
        "foreign-origin",
        f"The request comes from a web page of another origin: {origin!r:.80}. A service without "
        "keys answers only its own pages. Add the origin to PLACECELL_CORS_ORIGINS.",
    )


def _refusal(kind: str, detail: str) -> Problem:
    # Otherwise the rest of the body would be read as the next request.
    return Problem(403, kind, detail, headers={"Connection": "close"})
