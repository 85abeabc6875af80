"""MCAP file of either ROS or Foxglove, with or without index.

The records are decoded by the `mcap` library. Its readers decode all messages of a chunk, in order
of time; this class finds single messages by the index, and makes one for a file that is cut.
"""

import struct
from collections.abc import Callable, Iterator
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, TypeVar

import numpy as np

from placecell.core.types import Int64
from placecell.sources.bags.containers.chunked_file import ChunkedFile
from placecell.sources.bags.containers.compression import decompress
from placecell.sources.bags.containers.container import (
    UNCHUNKED,
    RecordError,
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


class McapFile(ChunkedFile):
    """An MCAP file."""

    repair = "mcap recover"
    longest_head = HEAD + MESSAGE_HEAD

    def __init__(self, path: Path) -> None:
        self.schemas: dict[int, Schema] = {}
        self.channels: dict[int, Channel] = {}
        super().__init__(path)

    def first_record(self, file: BinaryIO) -> int:
        begin = file.read(len(MAGIC))
        if begin != MAGIC:
            raise DriveError(
                f"{self.path}: begins with {begin!r}; expected {MAGIC!r}. The file is damaged or "
                "no MCAP file"
            )
        return len(MAGIC)

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
        """Read the summary at the end of the file, and the indexes of the chunks."""
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
            self.add(number, table_of(()))
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

    def add(self, number: int, places: Int64) -> None:
        channel = self.channels.get(number)
        if channel is None:
            raise RecordError(f"messages of the unknown channel {number}")
        schema = self.schemas.get(channel.schema_id)
        kind = schema.name if schema else ""
        encoding = channel.message_encoding
        if not encoding and schema:
            encoding = ENCODINGS.get(schema.encoding, "")
        self.index.add(channel.topic, kind, encoding, places)

    def index_record(self, file: BinaryIO, at: int) -> int:
        kind, start, size = self.record_at(file, at)
        if kind in (FOOTER, DATA_END):
            return self.file_size
        if kind in (SCHEMA, CHANNEL):
            self.add_description(kind, read_at(file, start, size, self.file_size))
        elif kind == CHUNK:
            self.index_chunk(file, at)
        elif kind == MESSAGE:
            head = read_at(file, start, min(size, MESSAGE_HEAD), self.file_size)
            number, _, time, _ = unpack("HIQQ", head)
            self.found.setdefault(number, []).append((time, UNCHUNKED, at))
        return start + size

    def index_chunk(self, file: BinaryIO, at: int) -> None:
        """Find the messages of a chunk by decompressing it."""
        for kind, offset, content in records_of(self.chunk_content(file, at)):
            self.add_description(kind, content)
            if kind == MESSAGE:
                number, _, time, _ = unpack("HIQQ", content)
                self.found.setdefault(number, []).append((time, at, offset))

    def chunk_content(self, file: BinaryIO, at: int) -> bytes:
        from mcap.records import Chunk

        chunk: Chunk = decoded(Chunk.read, self.content_at(file, at, CHUNK))
        where = f"{self.path}, byte {at}"
        if chunk.compression not in COMPRESSIONS:
            raise DriveError(
                f"{where}: a chunk is compressed by {chunk.compression!r}; expected lz4 or zstd. "
                "Convert the file with 'mcap compress'"
            )
        return decompress(chunk.data, chunk.compression, chunk.uncompressed_size, where)

    def chunk_data(self, file: BinaryIO, at: int, length: int) -> tuple[bytes, str]:
        from mcap.records import Chunk

        kind, start, size = self.record_at(file, at)
        chunk: Chunk = decoded(Chunk.read, read_at(file, start, min(size, length), self.file_size))
        if kind != CHUNK or chunk.compression not in COMPRESSIONS:
            raise RecordError(f"a record of kind {kind}; expected a chunk")
        return chunk.data, chunk.compression

    def message_head(self, begin: bytes, at: int, length: int) -> bytes | None:
        data = begin[at : at + self.longest_head + length]
        if at < 0 or len(data) <= self.longest_head or data[0] != MESSAGE:
            return None
        (size,) = unpack("Q", data, 1)
        return data[self.longest_head : HEAD + size]

    def message(self, file: BinaryIO, chunk: int, offset: int) -> bytes | memoryview:
        if chunk == UNCHUNKED:
            return memoryview(self.content_at(file, offset, MESSAGE))[MESSAGE_HEAD:]
        content = self.cached(file, chunk)
        kind, size = unpack("BQ", content, max(offset, 0))
        end = offset + HEAD + size
        if kind != MESSAGE or offset < 0 or end > len(content):
            raise RecordError(f"a record of kind {kind} with {size} bytes; expected a message")
        return memoryview(content)[offset + self.longest_head : end]
