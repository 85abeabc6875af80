"""What a service answers when it refuses: problem+json (RFC 9457)."""

import re
from http import HTTPStatus
from typing import Any

from placecell_client.http.encoding import MEDIA_TYPES, loads
from placecell_client.http.response import Answer
from placecell_client.http.retry_after import retry_after

UNREADABLE = "urn:placecell:problem:unreadable-answer"
"""The type of an answer that says success, yet is none of a Placecell service."""


class ServiceError(Exception):
    """The service refused a request, or failed, or something else answered in its place.

    Attributes:
        status: of HTTP; of success if the answer could not be read.
        title: the kind of problem in a few words.
        detail: what is wrong with this request.
        type: the kind of problem as a URI, the same for every release.
        request_id: of the call, sent as `X-Request-Id` in each of its attempts.
        retry_after: seconds after which the service asks to be called again, if it said so.
        ids: of the segments in question, if it told them; not all where they are very many.
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
    def of(cls, answer: Answer) -> "ServiceError":
        """From an answer that is no success, whether Placecell or a proxy on the way made it."""
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
    def unreadable(cls, answer: Answer, reason: str) -> "ServiceError":
        """From an answer that says success, and is not what was asked for."""
        return cls(
            status=answer.status,
            title="Unreadable answer",
            detail=answer.without_key(f"{reason}; {_excerpt(answer)}"),
            type=UNREADABLE,
            request_id=answer.request_id,
            retry_after=retry_after(answer.headers),
        )


def _problem(answer: Answer) -> dict[str, Any]:
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


def _excerpt(answer: Answer) -> str:
    """What came instead, for a person to guess who sent it."""
    kind = answer.media_type or "no content type"
    if not answer.content:
        return f"the answer is empty, of {kind}"
    told = f"the answer is of {kind}, {len(answer.content)} bytes"
    if not re.search("^text/|json|xml", kind):
        return told
    # The key goes before anything is cut: a half of it would stay.
    text = " ".join(answer.without_key(answer.content.decode(errors="replace")).split())
    return f"{told}, and starts with {text[:100]!r}"
