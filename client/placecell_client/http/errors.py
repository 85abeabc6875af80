"""Error responses: problem+json (RFC 9457), Retry-After, unreadable answers."""

import re
from collections.abc import Mapping
from datetime import datetime, timezone
from email.utils import parsedate_to_datetime
from http import HTTPStatus
from typing import Any

from placecell_client.http.encoding import MEDIA_TYPES, loads
from placecell_client.http.response import HttpResponse

UNREADABLE = "urn:placecell:problem:unreadable-answer"
"""Problem type of a successful answer that is not a Placecell service's."""


class ServiceError(Exception):
    """Error: the service refused or failed, or another server answered in its place.

    Attributes:
        status: HTTP status; a success status (2xx) if the answer was unreadable.
        title: Kind of problem in a few words.
        detail: Fault of this request.
        type: Kind of problem as a URI that does not change between releases.
        request_id: Id of the call, sent as `X-Request-Id` in every attempt; the service's log has
            it.
        retry_after: Seconds after which to repeat the call; None if the service gave none.
        ids: Ids of the segments that caused the problem, if the service lists them; very long lists
            are cut.
    """

    def __init__(
        self,
        status: int,
        title: str,
        detail: str,
        type: str,  # noqa: A002
        request_id: str | None = None,
        retry_after: float | None = None,
        ids: tuple[int, ...] = (),
    ) -> None:
        super().__init__(status, title, detail, type, request_id, retry_after, ids)
        self.status = status
        self.title = title
        self.detail = detail
        self.type = type
        self.request_id = request_id
        self.retry_after = retry_after
        self.ids = ids

    def __str__(self) -> str:
        text = f"{self.status} {self.title}"
        text += f": {self.detail}" if self.detail else ""
        return text + (f" (request {self.request_id})" if self.request_id else "")

    @classmethod
    def of(cls, answer: HttpResponse) -> "ServiceError":
        """Build from an error response of the service or of a proxy."""
        problem = _problem(answer)
        return cls(
            status=answer.status,
            title=answer.without_key(str(problem.get("title") or _phrase(answer.status))),
            detail=answer.without_key(str(problem.get("detail") or _excerpt(answer))),
            type=answer.without_key(str(problem.get("type") or "about:blank")),
            request_id=answer.request_id,
            retry_after=retry_after(answer.headers),
            ids=_ids(problem),
        )

    @classmethod
    def unreadable(cls, answer: HttpResponse, reason: str) -> "ServiceError":
        """Build from a successful response whose content is not the expected one."""
        return cls(
            status=answer.status,
            title="Unreadable answer",
            detail=answer.without_key(f"{reason}; {_excerpt(answer)}"),
            type=UNREADABLE,
            request_id=answer.request_id,
            retry_after=retry_after(answer.headers),
        )


def retry_after(headers: Mapping[str, str]) -> float | None:
    """Read the header Retry-After (RFC 9110, 10.2.3): seconds from now; None if it is unusable."""
    value = headers.get("Retry-After", "").strip()
    if re.fullmatch("[0-9]{1,9}", value):
        return float(value)
    then = _date(value)
    if then is None:
        return None
    # Prefer the service's clock, in the header Date: the robot's clock may be hours off.
    now = _date(headers.get("Date", "")) or datetime.now(timezone.utc)
    return max(0.0, (then - now).total_seconds())


def _date(text: str) -> datetime | None:
    try:
        date = parsedate_to_datetime(text)
    except (ValueError, OverflowError):
        return None
    return date if date.tzinfo is not None else date.replace(tzinfo=timezone.utc)


def _problem(answer: HttpResponse) -> dict[str, Any]:
    if answer.media_type not in {"application/problem+json", MEDIA_TYPES["json"]}:
        return {}
    try:
        return loads(MEDIA_TYPES["json"], answer.content)
    except (ValueError, RecursionError):
        return {}


def _ids(problem: dict[str, Any]) -> tuple[int, ...]:
    ids = problem.get("ids")
    return tuple(one for one in ids if isinstance(one, int)) if isinstance(ids, list) else ()


def _phrase(status: int) -> str:
    try:
        return HTTPStatus(status).phrase
    except ValueError:
        return "Unknown status"


def _excerpt(answer: HttpResponse) -> str:
    """Describe an unexpected response, so that a person can identify its sender."""
    kind = answer.media_type or "no content type"
    if not answer.content:
        return f"the answer is empty (type {kind})"
    found = f"the answer has type {kind} and {len(answer.content)} bytes"
    if not re.search("^text/|json|xml", kind):
        return found
    # Remove the key before the text is cut; otherwise a part of it could remain.
    text = " ".join(answer.without_key(answer.content.decode(errors="replace")).split())
    return f"{found}; it starts with {text[:100]!r}"
