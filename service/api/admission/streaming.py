"""Streaming: answers sent in pieces as the client takes them, from disk if they are large.

A large answer is written once to a file without a name, is shared by all that ask for it meanwhile,
and is gone with the last of them, or with the process.
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

from service.api.admission.receiving import ByteBudget
from service.core.problems import Problem

Result = TypeVar("Result")

SMALL_BYTES = 64 << 10
"""Largest size of an answer that is sent at once, bytes."""

PIECE_BYTES = 128 << 10
"""Bytes of an answer in memory beside those in the socket."""

MEMORY_BYTES = 32 << 20
"""Bytes of all answers in memory; more go to disk. One client has half of it."""

READERS = 4
"""Number of threads that read answers from disk."""

Piece = Callable[[int], Awaitable[bytes]]
Run = Callable[[Callable[[], bytes]], Awaitable[bytes]]


class Answers:
    """Sender of answers that bounds their bytes in progress. Belongs to one event loop."""

    def __init__(self, folder: Path, total: int, seconds: float) -> None:
        """Create the sender.

        Args:
            folder: where files are made, of no name.
            total: bytes of answers in progress, over all clients; each may have half.
            seconds: that an answer may take to be sent.
        """
        self._folder = folder
        self._seconds = seconds
        self._memory = ByteBudget(MEMORY_BYTES, MEMORY_BYTES // 2, "answers in memory")
        self._disk = ByteBudget(total, total, "answers")
        self._own = ByteBudget(1 << 62, max(total // 2, 1), "answers")
        self._shared: dict[str, _File] = {}
        self._locks: dict[str, _Making] = {}
        self._readers = anyio.CapacityLimiter(READERS)

    @property
    def under_way(self) -> int:
        """Return the bytes of large answers being sent; shared content counts once."""
        return self._memory.bytes + self._disk.bytes

    async def respond(
        self,
        content: bytes,
        client: str,
        media_type: str,
        headers: Mapping[str, str] | None = None,
    ) -> Response:
        """Answer with the content of one client; 429 if too many bytes are in progress."""
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
    ) -> Response:
        """Answer with named content, which is made once for all concurrent requests.

        Args:
            name: of the content; the same name is the same content.
            make: makes it.
            run: runs `make` off the event loop.
            client: that asked.
            media_type: of the content.
            headers: of the answer.

        Raises:
            Problem: 429 if too many bytes are in progress, and what `make` raises.
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
                        return Response(content, media_type=media_type, headers=headers)
                    file = await self._written(content, name)
        finally:
            making.users -= 1
            if not making.users:
                del self._locks[name]
        return Streamed(_OnDisk(self, file, client), self._seconds, media_type, headers)

    async def read(self, file: "_File", offset: int) -> bytes:
        """Read a piece of a file."""
        descriptor = file.handle.fileno()
        return await anyio.to_thread.run_sync(
            os.pread, descriptor, PIECE_BYTES, offset, limiter=self._readers
        )

    def use(self, file: "_File", client: str) -> None:
        """Count one more answer of a file; 429 if its client has too many bytes in progress."""
        if not file.users[client]:
            self._own.take(client, file.size)
        file.users[client] += 1

    def unuse(self, file: "_File", client: str) -> None:
        """Count one answer less; drop a file without answers."""
        file.users[client] -= 1
        if not file.users[client]:
            del file.users[client]
            self._own.give_back(client, file.size)
        self.drop_unused(file)

    def drop_unused(self, file: "_File") -> None:
        """Close a file that no answer uses."""
        if not file.users and not file.handle.closed:
            if file.name is not None and self._shared.get(file.name) is file:
                del self._shared[file.name]
            self._disk.give_back("", file.size)
            file.handle.close()

    async def _written(self, content: bytes, name: str | None = None) -> "_File":
        size = len(content)
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
                "The answer is too large for memory and cannot be written to disk. Free disk "
                "space, or try again later.",
                headers={"Retry-After": "5"},
            ) from error
        raise error


@dataclass(slots=True, eq=False)
class _File:
    handle: BinaryIO
    size: int
    name: str | None
    users: Counter[str]


class _Making:
    """Requests for the same content: one makes it, the others wait."""

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

    async def piece(self, offset: int) -> bytes:
        return await self._answers.read(self._file, offset)

    def release(self) -> None:
        self._answers.unuse(self._file, self._client)


class Streamed(Response):
    """Answer in pieces: the next one is read when the socket has space."""

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
        """Send the answer; release what it holds, however sending ends."""
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
                raise EOFError("the answer's file is shorter than it was")
            offset += len(piece)
            await send({"type": "http.response.body", "body": piece, "more_body": True})
        await send({"type": "http.response.body", "body": b"", "more_body": False})

    def release(self) -> None:
        """Release what the answer holds."""
        source, self._source = self._source, None
        if source is not None:
            source.release()

    def __del__(self) -> None:
        # An answer that was made, but whose client left before it was sent.
        self.release()
