"""An answer of HTTP, received whole."""

from dataclasses import dataclass, field

import httpx


@dataclass(frozen=True, slots=True)
class Answer:
    """What came back of one attempt.

    Attributes:
        status: of HTTP.
        headers: of the answer.
        content: the body, with its content encoding taken off.
        request_id: of the call.
        key: that the request carried, so that no error repeats it.
    """

    status: int
    headers: httpx.Headers
    content: bytes = field(repr=False)
    request_id: str | None = None
    key: str | None = field(default=None, repr=False)

    @classmethod
    def of(cls, response: httpx.Response, content: bytes) -> "Answer":
        """From a response whose body was read apart."""
        sent = response.request.headers
        key = sent.get("Authorization", "").removeprefix("Bearer ") or None
        return cls(response.status_code, response.headers, content, sent.get("X-Request-Id"), key)

    @property
    def ok(self) -> bool:
        """Whether it says success."""
        return 200 <= self.status <= 299

    @property
    def media_type(self) -> str:
        """Without its parameters, in lower case; empty if it is not told."""
        return str(self.headers.get("Content-Type", "")).partition(";")[0].strip().lower()

    def without_key(self, text: str) -> str:
        """The text, should the key stand in it, without: some error pages show the request."""
        return text.replace(self.key, "[key]") if self.key else text
