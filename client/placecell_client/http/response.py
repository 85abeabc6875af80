"""A completely received HTTP response."""

from dataclasses import dataclass, field

import httpx


@dataclass(frozen=True, slots=True)
class HttpResponse:
    """A completely received HTTP response.

    Attributes:
        status: HTTP status.
        headers: Headers of the response.
        content: Body without its content encoding.
        request_id: Id of the call.
        key: API key of the request; error texts must not show it.
    """

    status: int
    headers: httpx.Headers
    content: bytes = field(repr=False)
    request_id: str | None = None
    key: str | None = field(default=None, repr=False)

    @classmethod
    def of(cls, response: httpx.Response, content: bytes) -> "HttpResponse":
        """Build from a response and its body."""
        sent = response.request.headers
        key = sent.get("Authorization", "").removeprefix("Bearer ") or None
        return cls(response.status_code, response.headers, content, sent.get("X-Request-Id"), key)

    @property
    def ok(self) -> bool:
        """Whether the status is a success (2xx)."""
        return 200 <= self.status <= 299

    @property
    def media_type(self) -> str:
        """Media type in lower case without parameters; empty if the header is missing."""
        return str(self.headers.get("Content-Type", "")).partition(";")[0].strip().lower()

    def without_key(self, text: str) -> str:
        """Replace the API key in a text: some error pages show the request."""
        return text.replace(self.key, "[key]") if self.key else text
