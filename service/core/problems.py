"""Errors as the client sees them: problem+json (RFC 9457), every one of them."""

import errno
import logging
from http import HTTPStatus
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field, ValidationError
from starlette.exceptions import HTTPException
from starlette.requests import ClientDisconnect

from service.maps.store import StoreError

MEDIA_TYPE = "application/problem+json"
SHOWN_ERRORS = 20
"""Of the values that are wrong in one request."""
SHOWN_IDS = 10_000

logger = logging.getLogger("placecell")


class ProblemError(BaseModel):
    """One value that is wrong."""

    pointer: str = Field(description="JSON pointer to the value (RFC 6901).")
    detail: str = Field(description="What is wrong with it.")


class ProblemBody(BaseModel):
    """A refusal or a failure, as of RFC 9457."""

    type: str = Field(
        description="The kind of problem, a URI.", examples=["urn:placecell:problem:unknown-map"]
    )
    title: str = Field(description="The kind of problem in words.", examples=["Unknown map"])
    status: int = Field(description="The HTTP status.", examples=[404])
    detail: str = Field(description="What is wrong here.", examples=["No map is named 'yard'."])
    errors: list[ProblemError] | None = Field(None, description="The values that are wrong.")
    ids: list[int] | None = Field(None, description="Of the segments in question.")


class Problem(Exception):  # noqa: N818 -- RFC 9457's own word
    """Raised anywhere below a route; becomes the response.

    Args:
        status: of HTTP.
        kind: its name in the problem's URI, such as `unknown-map`; the title is made of it.
        detail: what is wrong, and what would be right.
        errors: the values that are wrong.
        headers: of the response.
        ids: of the segments in question.
    """

    def __init__(
        self,
        status: int,
        kind: str,
        detail: str,
        errors: list[ProblemError] | None = None,
        headers: dict[str, str] | None = None,
        ids: list[int] | None = None,
    ) -> None:
        super().__init__(detail)
        self.status = status
        self.kind = kind
        self.detail = detail
        self.errors = errors
        self.headers = headers
        self.ids = ids

    @property
    def response(self) -> JSONResponse:
        """As problem+json."""
        body = ProblemBody(
            type=type_of(self.kind),
            title=title_of(self.kind),
            status=self.status,
            detail=self.detail,
            errors=self.errors[:SHOWN_ERRORS] if self.errors else None,
            ids=self.ids[:SHOWN_IDS] if self.ids else None,
        )
        return JSONResponse(
            body.model_dump(exclude_none=True),
            status_code=self.status,
            headers=self.headers,
            media_type=MEDIA_TYPE,
        )


def type_of(kind: str) -> str:
    """The URI of a kind of problem."""
    return f"urn:placecell:problem:{kind}"


def title_of(kind: str) -> str:
    """`unknown-map` -> `Unknown map`."""
    return kind.replace("-", " ").capitalize()


def errors_of(error: ValidationError | RequestValidationError) -> list[dict[str, Any]]:
    """Return the errors of a request, each with its place."""
    if isinstance(error, RequestValidationError):
        return list(error.errors())
    found = error.errors(include_url=False, include_context=False, include_input=False)
    return [dict(each) for each in found]


def invalid(
    error: ValidationError | RequestValidationError, found: list[dict[str, Any]] | None = None
) -> Problem:
    """Return the problem of a request that does not fit its schema; 400 if it is not JSON.

    Args:
        error: what the schema says.
        found: its errors, if they were changed since.
    """
    found = errors_of(error) if found is None else found
    errors = [
        ProblemError(pointer=_pointer(item["loc"]), detail=_plain(str(item["msg"])))
        for item in found[:SHOWN_ERRORS]
    ]
    first = errors[0]
    if any(item["type"] == "json_invalid" for item in found[:SHOWN_ERRORS]):
        return Problem(400, "not-json", f"The body is not JSON: {first.detail}.")
    where = first.pointer or "The body"
    return Problem(422, "invalid-request", f"{where}: {first.detail}.", errors)


def documented(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """The problems that a route may answer, for OpenAPI."""
    return {
        status: {
            "description": HTTPStatus(status).phrase,
            "content": {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/ProblemBody"}}},
        }
        for status in statuses
    }


def install(app: FastAPI) -> None:
    """Make every error of the application a problem."""

    @app.exception_handler(Problem)
    async def _(request: Request, problem: Problem) -> JSONResponse:
        request.app.state.placecell.metrics.rejected.labels(problem.kind).inc()
        return problem.response

    @app.exception_handler(RequestValidationError)
    async def _(_: Request, error: RequestValidationError) -> JSONResponse:
        return invalid(error).response

    @app.exception_handler(HTTPException)
    async def _(request: Request, error: HTTPException) -> JSONResponse:
        phrase = HTTPStatus(error.status_code).phrase
        kind = phrase.lower().replace(" ", "-")
        headers = dict(error.headers) if error.headers else None
        return Problem(error.status_code, kind, _explain(request, error), headers=headers).response

    @app.exception_handler(ClientDisconnect)
    async def _(_: Request, __: ClientDisconnect) -> JSONResponse:
        return Problem(400, "incomplete-body", "The body ended too early.").response

    @app.exception_handler(StoreError)
    async def _(request: Request, error: StoreError) -> JSONResponse:
        logger.error("the store failed: %s", error)
        problem = _of_store(error)
        request.app.state.placecell.metrics.rejected.labels(problem.kind).inc()
        return problem.response

    @app.exception_handler(OSError)
    async def _(_: Request, error: OSError) -> JSONResponse:
        logger.error("failed on disk", exc_info=error)
        if error.errno in {errno.ENOSPC, errno.EDQUOT}:
            return _disk_full().response
        return unexpected().response


def unexpected() -> Problem:
    """A fault of the service itself: the log has its trace, the client gets none of it."""
    return Problem(500, "internal-error", "The service failed; its log says why.")


def _of_store(error: StoreError) -> Problem:
    if error.kind == "full":
        return _disk_full()
    if error.kind == "moved":
        return Problem(503, "store-unavailable", f"{error}", headers={"Retry-After": "5"})
    if error.kind == "damaged":
        return Problem(
            500, "map-damaged", "What is stored was damaged; the service's log says where."
        )
    detail = {
        "busy": "Another process holds the maps' database; nothing was changed.",
        "read-only": "The disk takes no writes; nothing was changed.",
        "failing": "The disk fails; nothing was changed.",
    }[error.kind]
    return Problem(503, "store-unavailable", detail, headers={"Retry-After": "5"})


def _disk_full() -> Problem:
    return Problem(507, "disk-full", "The disk is full; nothing was changed.")


def _explain(request: Request, error: HTTPException) -> str:
    path = request.url.path
    if error.status_code == 404:
        where = " GET /docs lists all." if request.app.openapi_url else ""
        return f"No such path: {path!r:.200}.{where} A map's name holds no slash."
    if error.status_code == 405:
        return f"{request.method} is not possible on {path!r:.200}."
    return str(error.detail)


def _plain(message: str) -> str:
    """Without the words that pydantic puts before its parser's and our own messages."""
    return message.removeprefix("Value error, ").removeprefix("Invalid JSON: ")


def _pointer(location: tuple[int | str, ...]) -> str:
    return "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in location)
