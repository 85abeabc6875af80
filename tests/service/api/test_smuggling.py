"""Request smuggling: requests with an ambiguous length are refused and end the connection."""

import asyncio
from contextlib import suppress

import pytest

from tests.service.api.test_protocol import App, served

CHUNKED = b"Transfer-Encoding: chunked\r\n"
FIVE = b"Content-Length: 5\r\n"
HELLO = b"5\r\nhello\r\n0\r\n\r\n"
SMUGGLED = b"GET /smuggled HTTP/1.1\r\nHost: x\r\n\r\n"


class Noting(App):
    """Application that reads bodies and records the requested paths."""

    def __init__(self) -> None:
        super().__init__("/none")
        self.paths: list[str] = []

    async def __call__(self, scope: object, receive: object, send: object) -> None:
        self.paths.append(scope["path"])  # type: ignore[index]
        await super().__call__(scope, receive, send)


def ask(request: bytes) -> tuple[bytes, list[str], bool]:
    """Send bytes; return the answer, the requested paths, and whether the connection closed."""
    app = Noting()

    async def run() -> tuple[bytes, bool]:
        async with served(app) as (reader, writer, _):
            app.paths.clear()
            writer.write(request)
            answer, closed = b"", False
            with suppress(TimeoutError):
                async with asyncio.timeout(0.3):
                    while part := await reader.read(65536):
                        answer += part
                    closed = True
            return answer, closed

    answer, closed = asyncio.run(run())
    return answer, app.paths, closed


def post(headers: bytes, body: bytes = b"", version: bytes = b"1.1") -> bytes:
    return b"POST /a HTTP/%s\r\nHost: x\r\n%s\r\n%s" % (version, headers, body)


@pytest.mark.parametrize(
    "request_",
    [
        post(CHUNKED + FIVE, HELLO + SMUGGLED),
        post(FIVE + CHUNKED, HELLO + SMUGGLED),
        post(b"Content-Length: 0\r\n" + CHUNKED, HELLO + SMUGGLED),
        post(FIVE + b"Content-Length: 6\r\n", b"hello" + SMUGGLED),
        post(b"Content-Length: 5, 6\r\n", b"hello" + SMUGGLED),
        post(b"Content-Length: +5\r\n", b"hello" + SMUGGLED),
        post(b"Content-Length: 0x5\r\n", b"hello" + SMUGGLED),
        post(b"Content-Length: -1\r\n", b"hello" + SMUGGLED),
        post(b"Content-Length : 5\r\n", b"hello" + SMUGGLED),
        post(b"Transfer-Encoding : chunked\r\n", HELLO + SMUGGLED),
        post(b"Transfer-Encoding: chunked, identity\r\n", HELLO + SMUGGLED),
        post(b"Transfer-Encoding: gzip, chunked\r\n", HELLO + SMUGGLED),
        post(b"Transfer-Encoding: xchunked\r\n", HELLO + SMUGGLED),
        post(b"Transfer-Encoding:\x0bchunked\r\n", HELLO + SMUGGLED),
        post(CHUNKED + CHUNKED, HELLO + SMUGGLED),
        post(CHUNKED + b"Transfer-Encoding: identity\r\n", HELLO + SMUGGLED),
        post(CHUNKED, HELLO + SMUGGLED, version=b"1.0"),
        post(b"X-Folded: a\r\n b\r\n" + FIVE, b"hello" + SMUGGLED),
        post(b"Content-Length:\r\n 5\r\n", b"hello" + SMUGGLED),
        post(b"X-Bare: a\n" + FIVE, b"hello" + SMUGGLED),
        post(b"X-Return: a\rContent-Length: 9\r\n" + FIVE, b"hello" + SMUGGLED),
        post(b"X-Null: a\x00b\r\n" + FIVE, b"hello" + SMUGGLED),
        post(b"Host: y\r\n" + FIVE, b"hello" + SMUGGLED),
        b"GET /a HTTP/1.1\n\nHost: x\n\n" + SMUGGLED,
        b"GET /a HTTP/1.1\nHost: x\n\n" + SMUGGLED,
        b" GET /a HTTP/1.1\r\nHost: x\r\n\r\n" + SMUGGLED,
        b"GET /a b HTTP/1.1\r\nHost: x\r\n\r\n" + SMUGGLED,
        b"GET /a HTTP/1.1\r\n\r\n" + SMUGGLED,
    ],
)
def test_A27_ambiguous_request_is_refused_and_the_connection_ends(request_: bytes) -> None:
    answer, paths, closed = ask(request_)
    assert answer.startswith((b"HTTP/1.1 400", b"HTTP/1.1 501")), answer
    assert b"invalid-http" in answer
    assert answer.count(b"HTTP/1.1 ") == 1
    assert closed
    assert paths == []


@pytest.mark.parametrize(
    "body",
    [
        b"5\nhello\r\n0\r\n\r\n",
        b"5\r\nhello0\r\n\r\n",
        b"5\r\nhelloXX0\r\n\r\n",
        b"0x5\r\nhello\r\n0\r\n\r\n",
        b"-5\r\nhello\r\n0\r\n\r\n",
        b"5 5\r\nhello\r\n0\r\n\r\n",
        b"fffffffffffffffffffff\r\nhello\r\n0\r\n\r\n",
        b"5;a\nb\r\nhello\r\n0\r\n\r\n",
        b"0\r\nX: a\n\r\n\r\n",
        b"0\r\nX : a\r\n\r\n",
    ],
)
def test_A27_bad_chunks_end_the_connection(body: bytes) -> None:
    answer, paths, closed = ask(post(CHUNKED, body + SMUGGLED))
    assert closed
    assert "/smuggled" not in paths
    assert answer.count(b"HTTP/1.1 ") <= 1


@pytest.mark.parametrize(
    "request_",
    [
        post(CHUNKED, HELLO),
        post(CHUNKED, b"5;name=value\r\nhello\r\n0\r\nX-Trailer: a\r\n\r\n"),
        post(b"transfer-encoding: Chunked\r\n", HELLO),
        post(FIVE, b"hello"),
        post(FIVE + FIVE, b"hello"),  # RFC 9110 allows equal lengths
        post(b"Content-Length:5\r\n", b"hello"),
        post(FIVE, b"hello", version=b"1.0"),
        b"GET /a HTTP/1.1\r\nHost: x\r\nX-Empty:\r\n\r\n",
    ],
)
def test_well_formed_requests_are_answered(request_: bytes) -> None:
    answer, paths, _ = ask(request_)
    assert answer.startswith(b"HTTP/1.1 200"), answer
    assert paths == ["/a"]
