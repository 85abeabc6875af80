"""Problems as responses: `application/problem+json` (RFC 9457)."""

from http import HTTPStatus
from typing import Any

from fastapi.responses import JSONResponse
from pydantic import BaseModel, Field

from service.core.problems import (
    SHOWN_ERRORS,
    SHOWN_IDS,
    Problem,
    ProblemError,
    title_of,
    type_of,
)

MEDIA_TYPE = "application/problem+json"


class ProblemBody(BaseModel):
    """Problem: a refused or failed request (RFC 9457)."""

    type: str = Field(
        description="Kind of problem, a URI.", examples=["urn:placecell:problem:unknown-map"]
    )
    title: str = Field(description="Kind of problem in words.", examples=["Unknown map"])
    status: int = Field(description="HTTP status.", examples=[404])
    detail: str = Field(
        description="Error of this request, and the way to correct it.",
        examples=["No map is named 'yard'."],
    )
    errors: list[ProblemError] | None = Field(None, description="Wrong values of the request.")
    ids: list[int] | None = Field(None, description="Ids of the segments in question.")


def response_of(problem: Problem) -> JSONResponse:
    """Return the response of a problem."""
    body = ProblemBody(
        type=type_of(problem.kind),
        title=title_of(problem.kind),
        status=problem.status,
        detail=problem.detail,
        errors=problem.errors[:SHOWN_ERRORS] if problem.errors else None,
        ids=problem.ids[:SHOWN_IDS] if problem.ids else None,
    )
    return JSONResponse(
        body.model_dump(exclude_none=True),
        status_code=problem.status,
        headers=problem.headers,
        media_type=MEDIA_TYPE,
    )


def documented(*statuses: int) -> dict[int | str, dict[str, Any]]:
    """Return OpenAPI descriptions of the problems that a route may answer with."""
    return {
        status: {
            "description": HTTPStatus(status).phrase,
            "content": {MEDIA_TYPE: {"schema": {"$ref": "#/components/schemas/ProblemBody"}}},
        }
        for status in statuses
    }
