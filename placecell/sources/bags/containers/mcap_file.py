"""MCAP file of either ROS or Foxglove, with or without index.

The records are decoded by the `mcap` library. Its readers decode all messages of a chunk, in order
of time; this class finds single messages by the index, and makes one for a file that is cut.
"""

import struct
from collections.abc import Callable, Iterator, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar

import numpy as np

from placecell.sources.bags.containers.compression import BLOCK, begin_of, decompress
from placecell.sources.bags.containers.container import (
    UNCHUNKED,
    Container,
    RecordError,
    TopicIndex,
    read_at,
    table_of,
    unpack,
)
from placecell.sources.errors import DriveError

if TYPE_CHECKING:
    from mcap.records import Channel, ChunkIndex, Schema

MAGIC = b"\x89MCAP0\r\n"
FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, INDEX, CHUNK_INDEX = 2, 3, 4, 5, 6, 7, 8
DATA_END = 15
HEAD, MESSAGE_HEAD, FOOTER_BYTES = 9, 22, 29
ENCODINGS = {"ros1msg": "ros1", "ros2msg": "cdr", "ros2idl": "cdr"}
"""Encoding of messages, by that of the schema, where a channel does not state it."""
COMPRESSIONS = ("", "lz4", "zstd")


T = TypeVar("T")


def decoded(read: Callable[[Any], T], content: bytes | memoryview) -> T:
    """Decode a record by the `mcap` library.

    Raises:
        RecordError: it is damaged.
    """
    from mcap.data_stream import ReadDataStream
    from mcap.exceptions import McapError

    try:
        return read(ReadDataStream(BytesIO(content)))
    except (McapError, struct.error, UnicodeDecodeError, OverflowError) as error:
        raise RecordError(f"a record is damaged ({error})") from error


def records_of(content: bytes | memoryview) -> Iterator[tuple[int, int, memoryview]]:
    """Yield kind, offset and content of each record.

    Raises:
        RecordError: the last one is cut short.
    """
    view, at = memoryview(content), 0
    while at < len(view):
        kind, size = unpack("BQ", view, at)
        end = at + HEAD + size
        if end > len(view):
            raise RecordError(f"a record of {size} bytes is cut short")
        yield kind, at, view[at + HEAD : end]
        at = end


class McapFile(Container):
    """An MCAP file.

    Raises:
        DriveError: the file is no MCAP file.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.remarks = []
        self.cache: tuple[int, bytes] = (UNCHUNKED, b"")
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        self.found: dict[int, list[tuple[int, int, int]]] = {}
        self.index = TopicIndex()
        try:
            self.file_size = path.stat().st_size
            with path.open("rb") as file:
                begin = file.read(len(MAGIC))
                if begin != MAGIC:
                    raise DriveError(
                        f"{path}: begins with {begin!r}; expected {MAGIC!r}. The file is damaged "
                        "or no MCAP file"
                    )
                try:
                    self.read_index(file)
                except RecordError as error:
                    self.make_index(file, str(error))
        except OSError as error:
            raise DriveError(f"{path}: cannot be read ({error.strerror})") from error
        self.topics = self.index.topics()

    def record_at(self, file: BinaryIO, at: int) -> tuple[int, int, int]:
        """Return kind of a record in the file, and offset and size of its content.

        Raises:
            RecordError: it reaches beyond the file.
        """
        kind, size = unpack("BQ", read_at(file, at, HEAD, self.file_size))
        if at + HEAD + size > self.file_size:
            raise RecordError(f"a record of {size} bytes at byte {at} is cut short")
        return kind, at + HEAD, size

    def content_at(self, file: BinaryIO, at: int, kind: int) -> bytes:
        """Read the content of a record in the file.

        Raises:
            RecordError: there is no record of this kind.
        """
        found, start, size = self.record_at(file, at)
        if found != kind:
            raise RecordError(f"a record of kind {found} at byte {at}; expected kind {kind}")
        return read_at(file, start, size, self.file_size)

    def read_index(self, file: BinaryIO) -> None:
        """Read the summary at the end of the file, and the indexes of the chunks.

        Raises:
            RecordError: there is none, or it is damaged.
        """
        from mcap.records import ChunkIndex, Footer

        end = self.file_size - len(MAGIC)
        if read_at(file, end, len(MAGIC), self.file_size) != MAGIC:
            raise RecordError("the recording was not closed")
        footer_at = end - FOOTER_BYTES
        footer = decoded(Footer.read, self.content_at(file, footer_at, FOOTER))
        if not footer.summary_start:
            raise RecordError("it has no summary")
        size = footer_at - footer.summary_start
        chunks: list[ChunkIndex] = []
        for kind, _, content in records_of(
            read_at(file, footer.summary_start, size, self.file_size)
        ):
            self.add_description(kind, content)
            if kind == CHUNK_INDEX:
                chunks.append(decoded(ChunkIndex.read, content))
        if not chunks:
            raise RecordError("it has no index")
        for number in self.channels:
            self.add(number, ())
        for chunk in chunks:
            self.read_chunk_index(file, chunk)
        self.add_found()

    def add_description(self, kind: int, content: bytes | memoryview) -> None:
        """Add a schema or a channel; other records are passed over."""
        from mcap.records import Channel, Schema

        if kind == SCHEMA:
            schema = decoded(Schema.read, content)
            self.schemas[schema.id] = schema
        elif kind == CHANNEL:
            channel = decoded(Channel.read, content)
            self.channels[channel.id] = channel

    def read_chunk_index(self, file: BinaryIO, chunk: "ChunkIndex") -> None:
        """Add the messages of a chunk; they are listed behind it.

        Raises:
            RecordError: the list is damaged, or a channel is not known.
        """
        at = chunk.chunk_start_offset
        if not chunk.message_index_offsets:
            self.index_chunk(file, at)
            return
        listed = read_at(file, at + chunk.chunk_length, chunk.message_index_length, self.file_size)
        for kind, _, content in records_of(listed):
            if kind != INDEX:
                continue
            number, size = unpack("HI", content)
            if 6 + size > len(content):
                raise RecordError("the index of a chunk is cut short")
            entries = np.frombuffer(content[6 : 6 + size // 16 * 16], "<i8").reshape(-1, 2)
            self.add(
                number,
                np.column_stack((entries[:, 0], np.full(len(entries), at), entries[:, 1])),
            )

    def add(self, number: int, places: Any) -> None:
        """Add messages of a channel: time, chunk and offset of each.

        Raises:
            RecordError: the channel is not known.
        """
        channel = self.channels.get(number)
        if channel is None:
            raise RecordError(f"messages of the unknown channel {number}")
        schema = self.schemas.get(channel.schema_id)
        table = places if isinstance(places, np.ndarray) else table_of(places)
        kind = schema.name if schema else ""
        encoding = channel.message_encoding
        if not encoding and schema:
            encoding = ENCODINGS.get(schema.encoding, "")
        self.index.add(channel.topic, kind, encoding, table)

    def make_index(self, file: BinaryIO, reason: str) -> None:
        """Read the whole file to find its messages, up to the first damage."""
        self.index = TopicIndex()
        self.found.clear()
        at, damage = len(MAGIC), ""
        while at < self.file_size:
            try:
                kind, start, size = self.record_at(file, at)
                if kind in (FOOTER, DATA_END):
                    break
                if kind in (SCHEMA, CHANNEL):
                    self.add_description(kind, read_at(file, start, size, self.file_size))
                elif kind == CHUNK:
                    self.index_chunk(file, at)
                elif kind == MESSAGE:
                    head = read_at(file, start, min(size, MESSAGE_HEAD), self.file_size)
                    number, _, time, _ = unpack("HIQQ", head)
                    self.found.setdefault(number, []).append((time, UNCHUNKED, at))
            except (RecordError, DriveError) as error:
                damage = f"; {self.file_size - at} bytes from byte {at} on are left out ({error})"
                break
            at = start + size
        total = self.add_found()
        self.remarks.append(
            f"{self.path}: the file has no usable index ({reason}); {total} messages were found by "
            f"reading all of it{damage}. Repair it with 'mcap recover'"
        )

    def add_found(self) -> int:
        """Add the messages that were found in chunks; return their number."""
        total = 0
        for number, rows in self.found.items():
            if number in self.channels:
                self.add(number, rows)
                total += len(rows)
        self.found.clear()
        return total

    def index_chunk(self, file: BinaryIO, at: int) -> None:
        """Find the messages of a chunk by decompressing it."""
        for kind, offset, content in records_of(self.chunk_content(file, at)):
            self.add_description(kind, content)
            if kind == MESSAGE:
                number, _, time, _ = unpack("HIQQ", content)
                self.found.setdefault(number, []).append((time, at, offset))

    def chunk_content(self, file: BinaryIO, at: int) -> bytes:
        """Return the content of a chunk.

        Raises:
            RecordError: there is none.
            DriveError: it cannot be decompressed.
        """
        from mcap.records import Chunk

        chunk: Chunk = decoded(Chunk.read, self.content_at(file, at, CHUNK))
        where = f"{self.path}, byte {at}"
        if chunk.compression not in COMPRESSIONS:
            raise DriveError(
                f"{where}: a chunk is compressed by {chunk.compression!r}; expected lz4 or zstd. "
                "Convert the file with 'mcap compress'"
            )
        return decompress(chunk.data, chunk.compression, chunk.uncompressed_size, where)

    def heads(
        self, chunk: int, offsets: Sequence[int], length: int
    ) -> Iterator[bytes | memoryview | None]:
        """Yield the first bytes of messages; the rest of the chunk is not decompressed."""
        begin = b""
        if chunk != UNCHUNKED and self.cache[0] != chunk:
            begin = self.chunk_begin(chunk, max(offsets) + HEAD + MESSAGE_HEAD + length)
        for offset in offsets:
            data = begin[offset : offset + HEAD + MESSAGE_HEAD + length]
            if offset >= 0 and len(data) > HEAD + MESSAGE_HEAD and data[0] == MESSAGE:
                (size,) = unpack("Q", data, 1)
                yield data[HEAD + MESSAGE_HEAD : HEAD + size]
            else:
                yield from super().heads(chunk, [offset], length)

    def chunk_begin(self, at: int, length: int) -> bytes:
        """Return the first bytes of a chunk's content; fewer if it is damaged."""
        from mcap.records import Chunk

        try:
            with self.path.open("rb") as file:
                kind, start, size = self.record_at(file, at)
                there = read_at(file, start, min(size, length + BLOCK), self.file_size)
            chunk: Chunk = decoded(Chunk.read, there)
            if kind != CHUNK or chunk.compression not in COMPRESSIONS:
                return b""
            return begin_of(chunk.data, chunk.compression, length, str(self.path))
        except (OSError, RecordError, DriveError):
            return b""

    def read(self, place: Sequence[int]) -> bytes | memoryview:
        _, chunk, offset = place
        try:
            with self.path.open("rb") as file:
                if chunk == UNCHUNKED:
                    return memoryview(self.content_at(file, offset, MESSAGE))[MESSAGE_HEAD:]
                at, content = self.cache
                if at != chunk:
                    content = self.chunk_content(file, chunk)
                    self.cache = (chunk, content)
            kind, size = unpack("BQ", content, max(offset, 0))
            end = offset + HEAD + size
            if kind != MESSAGE or offset < 0 or end > len(content):
                raise RecordError(f"a record of kind {kind} with {size} bytes; expected a message")
        except OSError as error:
            raise DriveError(f"{self.path}: cannot be read ({error.strerror})") from error
        except RecordError as error:
            raise DriveError(
                f"{self.path}: the message at offset {offset} is damaged ({error}). Copy the file "
                "again, or repair it with 'mcap recover'"
            ) from error
        return memoryview(content)[offset + HEAD + MESSAGE_HEAD : end]
