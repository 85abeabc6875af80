"""Error handlers of the application: every exception becomes a problem."""

import errno
import logging
from http import HTTPStatus

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from service.api.body.problem_json import response_of
from service.core.problems import Problem, invalid_values, unexpected
from service.maps.store import StoreError

logger = logging.getLogger("placecell")


def install(app: FastAPI) -> None:
    """Answer every error of the application with a problem."""

    @app.exception_handler(Problem)
    async def _(request: Request, problem: Problem) -> JSONResponse:
        return _counted(request, problem)

    @app.exception_handler(RequestValidationError)
    async def _(_: Request, error: RequestValidationError) -> JSONResponse:
        return response_of(invalid_values([dict(each) for each in error.errors()]))

    @app.exception_handler(HTTPException)
    async def _(request: Request, error: HTTPException) -> JSONResponse:
        phrase = HTTPStatus(error.status_code).phrase
        kind = phrase.lower().replace(" ", "-")
        headers = dict(error.headers) if error.headers else None
        return response_of(
            Problem(error.status_code, kind, _explain(request, error), headers=headers)
        )

    @app.exception_handler(ClientDisconnect)
    async def _(_: Request, __: ClientDisconnect) -> JSONResponse:
        return response_of(
            Problem(400, "incomplete-body", "The connection closed before the whole body arrived.")
        )

    @app.exception_handler(StoreError)
    async def _(request: Request, error: StoreError) -> JSONResponse:
        logger.error("the store failed: %s", error)
        return _counted(request, _problem_of_store(error))

    @app.exception_handler(OSError)
    async def _(_: Request, error: OSError) -> JSONResponse:
        logger.error("failed on disk", exc_info=error)
        if error.errno in {errno.ENOSPC, errno.EDQUOT}:
            return response_of(_disk_full())
        return response_of(unexpected())


def _counted(request: Request, problem: Problem) -> JSONResponse:
    request.app.state.placecell.metrics.rejected.labels(problem.kind).inc()
    return response_of(problem)


def _problem_of_store(error: StoreError) -> Problem:
    if error.kind == "full":
        return _disk_full()
    if error.kind == "moved":
        return Problem(503, "store-unavailable", f"{error}", headers={"Retry-After": "5"})
    if error.kind == "damaged":
        return Problem(
            500, "map-damaged", "Stored data is damaged. The service's log says which data."
        )
    if error.is_unsure:
        return Problem(
            503,
            "store-unavailable",
            "The database was lost during the commit, so it is not known whether the write was "
            "stored. Read the map, then repeat the write if it is not there.",
            headers={"Retry-After": "5"},
        )
    detail = {
        "busy": "Another process holds the maps' database; nothing was changed.",
        "read-only": "The disk or the database is read-only; nothing was changed.",
        "failing": "The disk or the database fails; nothing was changed.",
        "unreachable": "The database cannot be reached; nothing was changed. Try again soon.",
    }[error.kind]
    seconds = "1" if error.kind == "unreachable" else "5"
    return Problem(503, "store-unavailable", detail, headers={"Retry-After": seconds})


def _disk_full() -> Problem:
    return Problem(507, "disk-full", "The disk is full; nothing was changed.")


def _explain(request: Request, error: HTTPException) -> str:
    path = request.url.path
    if error.status_code == 404:
        where = " GET /docs lists all paths." if request.app.openapi_url else ""
        return f"Unknown path {path!r:.200}.{where} A map's name contains no slash."
    if error.status_code == 405:
        return f"Method {request.method} is not allowed on {path!r:.200}."
    return str(error.detail)
