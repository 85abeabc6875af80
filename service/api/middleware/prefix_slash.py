"""Trailing slash of a path prefix: `/prefix` is redirected to `/prefix/`."""

from starlette.responses import RedirectResponse
from starlette.types import ASGIApp, Receive, Scope, Send


class PrefixSlash:
    """ASGI middleware that redirects the bare path prefix to the page.

    The target is the configured prefix and has no host, so it leads to the host that was asked.
    """

    def __init__(self, app: ASGIApp, prefix: str) -> None:
        self._app = app
        self._prefix = prefix

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Redirect the bare prefix; pass every other request on."""
        if scope["type"] == "http" and scope["path"] == self._prefix:
            await RedirectResponse(f"{self._prefix}/", 308)(scope, receive, send)
            return
        await self._app(scope, receive, send)
