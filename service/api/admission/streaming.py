"""Streaming: sends answers in pieces at the client's pace, and large answers from disk.

A large answer is written once to an unnamed temporary file. All concurrent requests for the answer
share the file. The file disappears with the last of these requests, or with the process. A file
that was read in parts stays a few seconds longer, for the next part.
"""

import asyncio
import errno
import os
import tempfile
from collections import Counter
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, TypeVar

import anyio
import anyio.to_thread
from starlette.responses import Response
from starlette.types import Receive, Scope, Send

from service.api.admission.byte_range import ByteRange, range_of
from service.api.admission.receiving import ByteBudget
from service.core.problems import Problem

Result = TypeVar("Result")

SMALL_BYTES = 64 << 10
"""Largest size of an answer that is sent in one piece, bytes."""

PIECE_BYTES = 128 << 10
"""Size of a piece of an answer, bytes. One piece is in memory, besides the socket's buffer."""

MEMORY_BYTES = 32 << 20
"""Largest size of all answers in memory, bytes. Further answers go to disk.

One client may have half of it.
"""

LINGER_SECONDS = 10.0
"""Time that a file stays after the last request for a part of it, seconds.

A client that reads a file in parts asks for the next part at once.
"""

READERS = 4
"""Number of threads that read answers from disk."""

Piece = Callable[[int], Awaitable[bytes]]
Run = Callable[[Callable[[], bytes]], Awaitable[bytes]]


class Answers:
    """Sender of answers that limits the bytes in progress. It belongs to one event loop."""

    def __init__(self, folder: Path, total: int, seconds: float) -> None:
        """Create the sender.

        Args:
            folder: folder of the unnamed temporary files.
            total: largest size of all answers in progress, bytes. One client may have half of it.
            seconds: longest time to send an answer, seconds.
        """
        self._folder = folder
        self._seconds = seconds
        self._memory = ByteBudget(MEMORY_BYTES, MEMORY_BYTES // 2, "answers in memory")
        self._disk = ByteBudget(total, total, "answers")
        self._own = ByteBudget(1 << 62, max(total // 2, 1), "answers")
        self._shared: dict[str, _File] = {}
        self._locks: dict[str, _Making] = {}
        self._readers = anyio.CapacityLimiter(READERS)
        self._lingering: dict[_File, asyncio.TimerHandle] = {}

    def close(self) -> None:
        """Close the files that wait for a further request."""
        for file in [*self._lingering]:
            self._end_lingering(file)

    @property
    def under_way(self) -> int:
        """Return the bytes of the large answers in progress; count shared content once."""
        return self._memory.bytes + self._disk.bytes

    async def respond(
        self,
        content: bytes,
        client: str,
        media_type: str,
        headers: Mapping[str, str] | None = None,
    ) -> Response:
        """Answer one client with content.

        Raises:
            Problem: 429 if too many bytes are in progress.
        """
        if len(content) <= SMALL_BYTES:
            return Response(content, media_type=media_type, headers=headers)
        if self._memory.has_room(client, len(content)):
            source: _Source = _Memory(content, self._memory, client)
        else:
            file = await self._written(content)
            source = _OnDisk(self, file, client)
        return Streamed(source, self._seconds, media_type, headers)

    async def respond_shared(
        self,
        name: str,
        make: Callable[[], bytes],
        run: Run,
        client: str,
        media_type: str,
        headers: Mapping[str, str] | None = None,
        asked: str | None = None,
    ) -> Response:
        """Answer with named content, which is made once for all concurrent requests.

        Args:
            name: name of the content. Equal names mean equal content.
            make: function that returns the content.
            run: function that runs `make` outside the event loop.
            client: client of the request.
            media_type: media type of the content.
            headers: headers of the answer.
            asked: header Range, if the request asks for a part of the content.

        Raises:
            Problem: 429 if too many bytes are in progress, 416 if the content does not have the
                part; also the problems that `make` raises.
        """
        making = self._locks.setdefault(name, _Making())
        making.users += 1
        try:
            async with making.lock:
                file = self._shared.get(name)
                if file is None:
                    content = making.small
                    if content is None:
                        content = await run(make)
                    if len(content) <= SMALL_BYTES:
                        making.small = content
                        part = range_of(asked, len(content)) if asked else None
                        if part is not None:
                            content = content[part.first : part.first + part.size]
                        return _as_part(Response(content, 200, headers, media_type), part)
                    file = await self._written(content, name)
        finally:
            making.users -= 1
            if not making.users:
                del self._locks[name]
        source = _OnDisk(self, file, client)
        try:
            part = range_of(asked, file.size) if asked else None
        except Problem:
            source.release()
            raise
        if part is not None:
            file.is_read_in_parts = True
            source.restrict(part)
        return _as_part(Streamed(source, self._seconds, media_type, headers), part)

    async def read(self, file: "_File", offset: int, size: int) -> bytes:
        """Read a piece of a file."""
        descriptor = file.handle.fileno()
        return await anyio.to_thread.run_sync(
            os.pread, descriptor, size, offset, limiter=self._readers
        )

    def use(self, file: "_File", client: str) -> None:
        """Count one more answer that uses a file.

        Raises:
            Problem: 429 if the client has too many bytes in progress.
        """
        if not file.users[client]:
            self._own.take(client, file.size)
        file.users[client] += 1
        if timer := self._lingering.pop(file, None):
            timer.cancel()

    def unuse(self, file: "_File", client: str) -> None:
        """Count one answer less; close the file if no answer uses it any longer."""
        file.users[client] -= 1
        if not file.users[client]:
            del file.users[client]
            self._own.give_back(client, file.size)
        self.drop_unused(file)

    def drop_unused(self, file: "_File") -> None:
        """Close a file that no answer uses, at once or, if it is read in parts, a little later."""
        if file.users or file.handle.closed or file in self._lingering:
            return
        loop = _running_loop() if file.is_read_in_parts else None
        if loop is not None:
            file.is_read_in_parts = False
            self._lingering[file] = loop.call_later(LINGER_SECONDS, self._end_lingering, file)
        else:
            if file.name is not None and self._shared.get(file.name) is file:
                del self._shared[file.name]
            self._disk.give_back("", file.size)
            file.handle.close()

    def _end_lingering(self, file: "_File") -> None:
        self._lingering.pop(file).cancel()
        self.drop_unused(file)

    async def _written(self, content: bytes, name: str | None = None) -> "_File":
        size = len(content)
        while self._lingering and not self._disk.has_room("", size):
            self._end_lingering(next(iter(self._lingering)))
        self._disk.take("", size)
        try:
            handle = await anyio.to_thread.run_sync(self._write, content, limiter=self._readers)
        except BaseException:
            self._disk.give_back("", size)
            raise
        file = _File(handle, size, name, Counter())
        if name is not None:
            self._shared[name] = file
        return file

    def _write(self, content: bytes) -> BinaryIO:
        error: OSError | None = None
        for folder in (self._folder, None):
            try:
                handle = tempfile.TemporaryFile(dir=folder, buffering=0)  # noqa: SIM115 -- kept
            except OSError as failed:
                error = failed
                continue
            try:
                view = memoryview(content)
                while view:
                    view = view[handle.write(view) :]
            except OSError as failed:
                handle.close()
                error = failed
                continue
            return handle
        assert error is not None
        if error.errno in {errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EACCES}:
            raise Problem(
                503,
                "no-room-for-answer",
                "The answer is too large for memory, and writing it to disk failed. Free disk "
                "space or try again later.",
                headers={"Retry-After": "5"},
            ) from error
        raise error


@dataclass(slots=True, eq=False)
class _File:
    handle: BinaryIO
    size: int
    name: str | None
    users: Counter[str]
    is_read_in_parts: bool = False


def _running_loop() -> asyncio.AbstractEventLoop | None:
    """Return the event loop of this thread; None at the end of the process."""
    try:
        return asyncio.get_running_loop()
    except RuntimeError:
        return None


class _Making:
    """Content in the making: one request makes it, and the others wait."""

    def __init__(self) -> None:
        self.lock = asyncio.Lock()
        self.users = 0
        self.small: bytes | None = None


class _Source:
    """Source of an answer's pieces."""

    size: int

    async def piece(self, offset: int) -> bytes:
        raise NotImplementedError

    def release(self) -> None:
        raise NotImplementedError


class _Memory(_Source):
    def __init__(self, content: bytes, budget: ByteBudget, client: str) -> None:
        self.size = len(content)
        self._content = content
        self._budget = budget
        self._client = client
        budget.take(client, self.size)

    async def piece(self, offset: int) -> bytes:
        return self._content[offset : offset + PIECE_BYTES]

    def release(self) -> None:
        self._budget.give_back(self._client, self.size)
        self._content = b""


class _OnDisk(_Source):
    def __init__(self, answers: Answers, file: _File, client: str) -> None:
        self.size = file.size
        self._answers = answers
        self._file = file
        self._client = client
        try:
            answers.use(file, client)
        except Problem:
            answers.drop_unused(file)
            raise
        self._first = 0

    def restrict(self, part: ByteRange) -> None:
        """Send only a part of the file."""
        self._first, self.size = part.first, part.size

    async def piece(self, offset: int) -> bytes:
        size = min(PIECE_BYTES, self.size - offset)
        return await self._answers.read(self._file, self._first + offset, size)

    def release(self) -> None:
        self._answers.unuse(self._file, self._client)


def _as_part(response: Response, part: ByteRange | None) -> Response:
    """Mark a response as a part of the content; None for the whole content."""
    if part is not None:
        response.status_code = 206
        response.headers["Content-Range"] = part.content_range
    return response


class Streamed(Response):
    """Answer in pieces; each piece is read when the socket has space."""

    def __init__(
        self,
        source: _Source,
        seconds: float,
        media_type: str,
        headers: Mapping[str, str] | None = None,
    ) -> None:
        super().__init__(None, media_type=media_type, headers=headers)
        self.headers["content-length"] = str(source.size)
        self._source: _Source | None = source
        self._seconds = seconds

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Send the answer; release its bytes and its file at the end, even after an error."""
        try:
            with anyio.fail_after(self._seconds), anyio.CancelScope() as gone:

                async def listen() -> None:
                    while (await receive())["type"] != "http.disconnect":
                        pass
                    gone.cancel()

                listener = asyncio.create_task(listen())
                try:
                    await self._send(scope, send)
                finally:
                    listener.cancel()
        finally:
            self.release()

    async def _send(self, scope: Scope, send: Send) -> None:
        assert self._source is not None
        await send(
            {"type": "http.response.start", "status": self.status_code, "headers": self.raw_headers}
        )
        offset, size = 0, self._source.size
        if scope["state"].get("is_head"):
            size = 0
        while offset < size:
            piece = await self._source.piece(offset)
            if not piece:
                raise EOFError("the file of the answer ends too early")
            offset += len(piece)
            await send({"type": "http.response.body", "body": piece, "more_body": True})
        await send({"type": "http.response.body", "body": b"", "more_body": False})

    def release(self) -> None:
        """Release the bytes and the file of the answer."""
        source, self._source = self._source, None
        if source is not None:
            source.release()

    def __del__(self) -> None:
        # For an answer whose client disconnected before it was sent.
        self.release()
