"""HTTP application: routes, middleware and API description."""

from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from fastapi import Depends, FastAPI
from starlette.middleware.cors import CORSMiddleware

from service.api import error_handlers, openapi
from service.api.body.problem_json import documented
from service.api.dependencies import caught_up, principal_of
from service.api.known_query import known_query
from service.api.middleware.body_limit import BodyLimit
from service.api.middleware.head import Head
from service.api.middleware.origin_guard import OriginGuard
from service.api.middleware.prefix_slash import PrefixSlash
from service.api.middleware.request_log import RequestLog
from service.api.pages import docs_pages, page
from service.api.routes import (
    align,
    coverage,
    describe,
    health,
    localize,
    maps,
    match,
    models,
    optimize,
    segments,
    uploads,
    versions,
)
from service.api.routes.annotations import anchors, mirrors
from service.api.routes.clouds import exports, scans, shapes
from service.api.routes.live import events, robots
from service.api.state import State, open_state
from service.core.settings import Settings
from service.core.version import version

EXPOSED_HEADERS = (
    "Accept-Ranges",
    "Content-Disposition",
    "Content-Range",
    "ETag",
    "Location",
    "Placecell-Model",
    "Placecell-Next",
    "Placecell-Since",
    "Placecell-Until",
    "Retry-After",
    "Server-Timing",
    "Traceresponse",
    "X-Request-Id",
)
"""Response headers that web pages of `cors_origins` may read."""

ROUTES = (
    describe,
    match,
    localize,
    scans,
    coverage,
    maps,
    exports,
    shapes,
    uploads,
    segments,
    versions,
    align,
    optimize,
    anchors,
    mirrors,
    robots,
    events,
    models,
    health,
)
"""Modules of the routes, in the order of the API description."""

WITHOUT_MAPS = (describe, robots, events, models, health)
"""Modules whose routes need no version of a map that another service may have written."""

DESCRIPTION = """Place recognition for robot teams: learned descriptors of 3D segments.

Send the segments of a scan. The answer holds their descriptors, the nearest segments of stored
maps, or the robot's pose in a map. Coordinates are meters in a z-up frame.

`/describe`, `/match`, `/localize` and `/coverage` accept JSON and `application/msgpack`. Both have
the same fields; msgpack holds arrays as blobs. Every error is `application/problem+json`
(RFC 9457).

If the service has API keys, routes with a lock need `Authorization: Bearer KEY`. All other routes,
and this description, need no key.
"""


def create_app(settings: Settings, state: State | None = None) -> FastAPI:
    """Create the application.

    Args:
        settings: settings of the service.
        state: open state, which the caller closes; None: the application opens and closes its own.
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
        redirect_slashes=False,  # a redirect would lead to any host that the request names
        openapi_url="/openapi.json" if settings.docs else None,
        docs_url=None,
        redoc_url=None,
    )
    # FastAPI deprecates the argument, as servers set the path; but not every server does.
    app.root_path = settings.root_path
    app.add_middleware(BodyLimit, limits=settings.limits)
    if settings.root_path:
        app.add_middleware(PrefixSlash, prefix=settings.root_path)
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
    app.add_middleware(RequestLog)
    error_handlers.install(app)
    openapi.install(app)
    if settings.docs:
        docs_pages.install(app)
    page.install(app, settings.page)
    checks = [Depends(principal_of), Depends(known_query)]
    for module in ROUTES:
        if module is health:  # its probes ignore what a balancer or a browser adds to the query
            app.include_router(module.router)
        elif module in WITHOUT_MAPS:
            app.include_router(module.router, dependencies=checks, responses=documented(422))
        else:
            app.include_router(
                module.router,
                dependencies=[*checks, Depends(caught_up)],
                responses=documented(422, 503),
            )
    return app
