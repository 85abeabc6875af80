"""What a service answers when it refuses: problem+json (RFC 9457)."""

import httpx


class ServiceError(Exception):
    """The service refused a request, or failed.

    Attributes:
        status: of HTTP.
        title: the kind of problem in a few words.
        detail: what is wrong with this request.
        type: the kind of problem as a URI, the same for every release.
    """

    def __init__(self, status: int, title: str, detail: str, type: str) -> None:  # noqa: A002
        super().__init__(f"{status} {title}: {detail}" if detail else f"{status} {title}")
        self.status = status
        self.title = title
        self.detail = detail
        self.type = type

    @classmethod
    def of(cls, response: httpx.Response) -> "ServiceError":
        """From a response that is no success, whether Placecell or a proxy on the way made it."""
        try:
            body = response.json()
        except ValueError:
            body = None
        if not isinstance(body, dict):
            body = {}
        return cls(
            status=response.status_code,
            title=str(body.get("title", response.reason_phrase)),
            detail=str(body.get("detail", "")),
            type=str(body.get("type", "about:blank")),
        )
