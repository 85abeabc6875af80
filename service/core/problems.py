"""Problems: the errors that clients see (RFC 9457), as exceptions without any HTTP library."""

from typing import Any

from pydantic import BaseModel, Field, ValidationError

SHOWN_ERRORS = 20
"""Largest number of wrong values that a problem lists."""

SHOWN_IDS = 10_000
"""Largest number of segment ids that a problem lists."""


class ProblemError(BaseModel):
    """Invalid value of a request."""

    pointer: str = Field(description="JSON pointer to the value (RFC 6901).")
    detail: str = Field(description="Error of the value.")


class Problem(Exception):  # noqa: N818 -- RFC 9457's own word
    """Refusal or failure; raised anywhere below a route, which answers with it.

    Args:
        status: HTTP status.
        kind: name of the kind of problem in its URI, such as `unknown-map`; gives the title too.
        detail: what was found, what was expected, and what to do.
        errors: the wrong values.
        headers: headers of the response.
        ids: ids of the segments in question.
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


def type_of(kind: str) -> str:
    """Return the URI of a kind of problem."""
    return f"urn:placecell:problem:{kind}"


def title_of(kind: str) -> str:
    """Return the title of a kind of problem: `unknown-map` becomes `Unknown map`."""
    return kind.replace("-", " ").capitalize()


def errors_of(error: ValidationError) -> list[dict[str, Any]]:
    """Return the errors of a request, each with its location."""
    found = error.errors(include_url=False, include_context=False, include_input=False)
    return [dict(each) for each in found]


def invalid(error: ValidationError) -> Problem:
    """Return the problem of a request that does not fit its schema; see `invalid_values`."""
    return invalid_values(errors_of(error))


def invalid_values(found: list[dict[str, Any]]) -> Problem:
    """Return the problem of wrong values: 422, or 400 if the request is not JSON.

    Args:
        found: errors as pydantic gives them, each with `loc`, `msg` and `type`.
    """
    errors = [
        ProblemError(pointer=_pointer(item["loc"]), detail=_plain(str(item["msg"])))
        for item in found[:SHOWN_ERRORS]
    ]
    first = errors[0]
    if any(item["type"] == "json_invalid" for item in found[:SHOWN_ERRORS]):
        return Problem(400, "not-json", f"The body is not JSON: {first.detail}.")
    where = first.pointer or "The body"
    return Problem(422, "invalid-request", f"{where}: {first.detail}.", errors)


def invalid_value(pointer: str, detail: str) -> Problem:
    """Return the problem of one wrong value: 422 with a JSON pointer to it, "" for the body."""
    return Problem(
        422,
        "invalid-request",
        f"{pointer or 'The body'}: {detail}",
        [ProblemError(pointer=pointer, detail=detail)],
    )


def unexpected() -> Problem:
    """Return the problem of a fault in the service: its trace is in the log, not in the answer."""
    return Problem(500, "internal-error", "The service failed. Its log has the reason.")


def _plain(message: str) -> str:
    """Remove the words that pydantic puts before its parser's and the validators' messages."""
    return message.removeprefix("Value error, ").removeprefix("Invalid JSON: ").removesuffix(".")


def _pointer(location: tuple[int | str, ...]) -> str:
    return "".join(f"/{str(part).replace('~', '~0').replace('/', '~1')}" for part in location)
