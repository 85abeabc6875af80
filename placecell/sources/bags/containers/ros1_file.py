"""ROS 1 bag, format 2.0, with or without index.

`docs/decisions/0017-readers-of-bags.md` says why this is not left to `rosbags`.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

import numpy as np

from placecell.core.types import Int64
from placecell.sources.bags.containers.chunked_file import ChunkedFile
from placecell.sources.bags.containers.compression import KINDS, decompress
from placecell.sources.bags.containers.container import (
    UNCHUNKED,
    RecordError,
    read_at,
    table_of,
    unpack,
)
from placecell.sources.errors import DriveError

MAGIC = b"#ROSBAG V"
VERSION = b"#ROSBAG V2.0\n"
MESSAGE, BAG_HEADER, INDEX, CHUNK, CHUNK_INFO, CONNECTION = 2, 3, 4, 5, 6, 7
ENTRY = np.dtype([("sec", "<u4"), ("nsec", "<u4"), ("offset", "<u4")])


@dataclass(frozen=True, slots=True)
class Record:
    """Record of a bag: the fields of its header, and where its data lies."""

    fields: dict[bytes, bytes]
    start: int
    size: int

    @property
    def op(self) -> int:
        """Return the kind of the record."""
        return unpack("B", self.fields.get(b"op", b""))[0]

    @property
    def end(self) -> int:
        """Return the offset behind the record."""
        return self.start + self.size

    def number(self, name: bytes, kind: str = "I") -> int:
        """Return an integer of the header."""
        return unpack(kind, self.fields.get(name, b""))[0]

    def time_ns(self) -> int:
        """Return the time of a message, nanoseconds."""
        seconds, nanoseconds = unpack("II", self.fields.get(b"time", b""))
        return seconds * 10**9 + nanoseconds


@dataclass(frozen=True, slots=True)
class StoredChunk:
    """Chunk of a bag: compression, size of its content, and where its data lies."""

    compression: str
    content_size: int
    start: int
    size: int


def header_fields(content: bytes | memoryview) -> dict[bytes, bytes]:
    """Return the fields of a header.

    Raises:
        RecordError: it is damaged.
    """
    fields, at = {}, 0
    while at < len(content):
        (size,) = unpack("I", content, at)
        name, equals, value = bytes(content[at + 4 : at + 4 + size]).partition(b"=")
        at += 4 + size
        if not equals or at > len(content):
            raise RecordError("a header of a record is damaged")
        fields[name] = value
    return fields


def record_in(content: bytes | memoryview, at: int) -> Record:
    """Return the record at an offset of a chunk's content.

    Raises:
        RecordError: it is damaged or cut short.
    """
    (size,) = unpack("I", content, at)
    start = at + 4 + size
    if start > len(content):
        raise RecordError("a header of a record is cut short")
    fields = header_fields(content[at + 4 : start])
    (length,) = unpack("I", content, start)
    if start + 4 + length > len(content):
        raise RecordError("the data of a record is cut short")
    return Record(fields, start + 4, length)


class Ros1File(ChunkedFile):
    """A ROS 1 bag."""

    repair = "rosbag reindex"
    longest_head = 512

    def __init__(self, path: Path) -> None:
        self.chunks: dict[int, StoredChunk] = {}
        self.connections: dict[int, tuple[str, str]] = {}
        super().__init__(path)

    def first_record(self, file: BinaryIO) -> int:
        self.header = self.bag_header(file)
        return self.header.end

    def bag_header(self, file: BinaryIO) -> Record:
        """Read the first record.

        Raises:
            DriveError: the file is no bag of format 2.0.
        """
        begin = file.read(len(VERSION))
        if begin != VERSION:
            if begin.startswith(MAGIC):
                version = begin[len(MAGIC) :].decode(errors="replace").strip()
                raise DriveError(
                    f"{self.path}: a ROS bag of version {version!r}; expected 2.0. Convert it with "
                    "'rosbag fix'"
                )
            raise DriveError(
                f"{self.path}: begins with {begin!r}; expected '#ROSBAG V2.0'. The file is damaged "
                "or no ROS 1 bag"
            )
        try:
            record = self.record_at(file, len(VERSION))
            if record.op != BAG_HEADER:
                raise RecordError(f"a record of kind {record.op}")
        except RecordError as error:
            raise DriveError(
                f"{self.path}: the bag's header is damaged ({error}). Copy the file again"
            ) from error
        if record.fields.get(b"encryptor"):
            raise DriveError(f"{self.path}: the bag is encrypted. Decrypt it with 'rosbag decrypt'")
        return record

    def record_at(self, file: BinaryIO, at: int) -> Record:
        """Read the header of a record in the file.

        Raises:
            RecordError: it is damaged, or its data reaches beyond the file.
        """
        (size,) = unpack("I", read_at(file, at, 4, self.file_size))
        fields = header_fields(read_at(file, at + 4, size, self.file_size))
        start = at + 4 + size
        (length,) = unpack("I", read_at(file, start, 4, self.file_size))
        record = Record(fields, start + 4, length)
        if record.end > self.file_size and record.op != CHUNK:
            raise RecordError("the data of a record is cut short")
        return record

    def read_index(self, file: BinaryIO) -> None:
        at = self.header.number(b"index_pos", "Q")
        if at == 0:
            raise RecordError("the recording was not closed")
        if at > self.file_size:
            raise RecordError(f"the index begins at byte {at} of a file of {self.file_size} bytes")
        places = []
        while at < self.file_size:
            record = self.record_at(file, at)
            if record.op == CONNECTION:
                data = read_at(file, record.start, record.size, self.file_size)
                self.add_connection(record, data)
            elif record.op == CHUNK_INFO:
                places.append(record.number(b"chunk_pos", "Q"))
            else:
                raise RecordError(f"a record of kind {record.op} in the index")
            at = record.end
        counts = self.header.number(b"conn_count"), self.header.number(b"chunk_count")
        if (len(self.connections), len(places)) != counts:
            raise RecordError("the index is cut short")
        for number in self.connections:
            self.add(number, table_of(()))
        for place in places:
            record = self.record_at(file, place)
            self.add_chunk(place, record)
            at = record.end
            while at < self.file_size:
                record = self.record_at(file, at)
                if record.op != INDEX:
                    break
                entries = np.frombuffer(
                    read_at(file, record.start, record.size // 12 * 12, self.file_size), ENTRY
                )
                if len(entries) != record.number(b"count") or record.number(b"ver") != 1:
                    raise RecordError("the index of a chunk is damaged")
                times = entries["sec"].astype(np.int64) * 10**9 + entries["nsec"]
                chunk = np.full(len(entries), place)
                table = np.column_stack((times, chunk, entries["offset"].astype(np.int64)))
                self.add(record.number(b"conn"), table)
                at = record.end

    def index_record(self, file: BinaryIO, at: int) -> int:
        record = self.record_at(file, at)
        if record.op == CHUNK:
            self.index_chunk(file, at, record)
        elif record.op == CONNECTION:
            data = read_at(file, record.start, record.size, self.file_size)
            self.add_connection(record, data)
        elif record.op == MESSAGE:  # of a chunk that was not closed
            self.found_message(record, UNCHUNKED, at)
        elif record.op not in (BAG_HEADER, INDEX, CHUNK_INFO):
            raise RecordError(f"a record of the unknown kind {record.op}")
        return record.end

    def found_message(self, record: Record, chunk: int, offset: int) -> None:
        """Add a message that was found without the index."""
        place = (record.time_ns(), chunk, offset)
        self.found.setdefault(record.number(b"conn"), []).append(place)

    def index_chunk(self, file: BinaryIO, at: int, record: Record) -> None:
        """Find the messages of a chunk.

        Raises:
            RecordError: the chunk is cut short; the messages before the cut were found.
        """
        chunk = self.add_chunk(at, record)
        plain = chunk.compression == "none"
        there = min(chunk.size, self.file_size - chunk.start)
        if there < chunk.size and not plain:
            raise RecordError("a compressed chunk is cut short")
        content = read_at(file, chunk.start, there, self.file_size)
        if not plain:
            content = self.content_of(chunk, content)
        for offset, each in records_of(content):
            if each.op == CONNECTION:
                self.add_connection(each, content[each.start : each.end])
            elif each.op == MESSAGE:
                self.found_message(each, at, offset)
        if there < chunk.size:
            raise RecordError("a chunk is cut short")

    def add_connection(self, record: Record, data: bytes) -> None:
        """Add a connection: topic and type of messages."""
        fields = header_fields(data)
        topic = record.fields.get(b"topic") or fields.get(b"topic", b"")
        kind = fields.get(b"type", b"").decode(errors="replace")
        name = topic.decode(errors="replace")
        self.connections[record.number(b"conn")] = (name, kind)

    def add(self, number: int, places: Int64) -> None:
        if number not in self.connections:
            raise RecordError(f"a record of the unknown connection {number}")
        self.index.add(*self.connections[number], "ros1", places)

    def add_chunk(self, at: int, record: Record) -> StoredChunk:
        """Add a chunk.

        Raises:
            RecordError: the record is no chunk, or its compression is not known.
        """
        if record.op != CHUNK:
            raise RecordError(f"a record of kind {record.op} at byte {at}; expected a chunk")
        compression = record.fields.get(b"compression", b"").decode(errors="replace")
        if compression not in KINDS or not compression:
            raise RecordError(f"a chunk with the unknown compression {compression!r}")
        chunk = StoredChunk(compression, record.number(b"size"), record.start, record.size)
        self.chunks[at] = chunk
        return chunk

    def content_of(self, chunk: StoredChunk, data: bytes) -> bytes:
        """Decompress a chunk."""
        where = f"{self.path}, byte {chunk.start}"
        return decompress(data, chunk.compression, chunk.content_size, where)

    def chunk_content(self, file: BinaryIO, at: int) -> bytes:
        stored = self.chunks[at]
        return self.content_of(stored, read_at(file, stored.start, stored.size, self.file_size))

    def chunk_data(self, file: BinaryIO, at: int, length: int) -> tuple[bytes, str]:
        stored = self.chunks.get(at)
        if stored is None or stored.compression == "none":
            return b"", "none"  # `message` reads such a message alone.
        size = min(stored.size, length)
        return read_at(file, stored.start, size, self.file_size), stored.compression

    def message(self, file: BinaryIO, chunk: int, offset: int) -> bytes | memoryview:
        stored = self.chunks.get(chunk)
        if stored is None or stored.compression == "none":
            return self.message_at(file, offset + (stored.start if stored else 0))
        content = self.cached(file, chunk)
        record = record_in(content, offset)
        while record.op == CONNECTION:
            record = record_in(content, record.end)
        if record.op != MESSAGE:
            raise RecordError(f"a record of kind {record.op}; expected a message")
        return memoryview(content)[record.start : record.end]

    def message_head(self, begin: bytes, at: int, length: int) -> bytes | None:
        (size,) = unpack("I", begin, at)
        start = at + 4 + size
        if unpack("B", header_fields(begin[at + 4 : start]).get(b"op", b"")) != (MESSAGE,):
            return None
        (stored,) = unpack("I", begin, start)
        head = begin[start + 4 : start + 4 + min(length, stored)]
        return head if len(head) == min(length, stored) else None

    def message_at(self, file: BinaryIO, at: int) -> bytes:
        """Return the message at an offset of the file.

        Raises:
            RecordError: there is none.
        """
        record = self.record_at(file, at)
        while record.op == CONNECTION:
            record = self.record_at(file, record.end)
        if record.op != MESSAGE:
            raise RecordError(f"a record of kind {record.op}; expected a message")
        return read_at(file, record.start, record.size, self.file_size)


def records_of(content: bytes) -> Iterator[tuple[int, Record]]:
    """Yield offset and record of a chunk's content, up to the first damage."""
    at = 0
    while at < len(content):
        try:
            record = record_in(content, at)
        except RecordError:
            return
        yield at, record
        at = record.end
