"""The application."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from importlib import metadata

from fastapi import FastAPI
from starlette.middleware.cors import CORSMiddleware

from service.api import docs_pages, error_handlers, openapi
from service.api.middleware.body_limit import BodyLimit
from service.api.middleware.head import Head
from service.api.middleware.origin_guard import OriginGuard
from service.api.middleware.request_log import Account
from service.api.routes import (
    align,
    describe,
    health,
    localize,
    maps,
    match,
    models,
    segments,
    uploads,
    versions,
)
from service.api.state import State, open_state
from service.core.settings import Settings

EXPOSED_HEADERS = (
    "ETag",
    "Location",
    "Placecell-Model",
    "Placecell-Next",
    "Placecell-Since",
    "Placecell-Until",
    "Retry-After",
    "Server-Timing",
    "X-Request-Id",
)
"""Response headers that web pages of `cors_origins` may read."""

DESCRIPTION = """Place recognition for robot teams: learned descriptors of 3D segments.

Send the segments of a scan, get their descriptors, the segments of stored maps that look like them,
or the robot's place in a map. Coordinates are metres in a z-up frame. `/describe`, `/match` and
`/localize` speak JSON and, with the same meaning and arrays as blobs, `application/msgpack`. Every
error is `application/problem+json` (RFC 9457).

Routes with a lock need `Authorization: Bearer KEY` where the service has keys; all others, and this
description, need none.
"""


def create_app(settings: Settings, state: State | None = None) -> FastAPI:
    """The application.

    Args:
        settings: limits, and what to open when the application starts.
        state: already open, and closed by whoever opened it.
    """

    @asynccontextmanager
    async def lifespan(app: FastAPI) -> AsyncIterator[None]:
        if state is not None:
            app.state.placecell = state
            yield
            return
        with open_state(settings) as opened:
            app.state.placecell = opened
            yield

    app = FastAPI(
        title="Placecell",
        version=version(),
        description=DESCRIPTION,
        lifespan=lifespan,
        redirect_slashes=False,  # they would lead to whatever host the request names
        openapi_url="/openapi.json" if settings.docs else None,
        docs_url=None,
        redoc_url=None,
    )
    # As an argument it is deprecated, for it is the server's; but any server will do.
    app.root_path = settings.root_path
    app.add_middleware(BodyLimit, limits=settings.limits)
    app.add_middleware(Head)
    if settings.cors_origins:
        app.add_middleware(
            CORSMiddleware,
            allow_origins=settings.cors_origins,
            allow_methods=["GET", "HEAD", "POST", "PUT", "DELETE"],
            allow_headers=["*"],
            expose_headers=EXPOSED_HEADERS,
        )
    app.add_middleware(OriginGuard, settings=settings)
    app.add_middleware(Account)
    error_handlers.install(app)
    openapi.install(app)
    if settings.docs:
        docs_pages.install(app)
    for module in (
        *(describe, match, localize, maps, uploads, segments, versions, align, models, health),
    ):
        app.include_router(module.router)
    return app


def version() -> str:
    """Of the installed Placecell; a checkout that is not installed has none."""
    try:
        return metadata.version("placecell")
    except metadata.PackageNotFoundError:
        return "unknown"
