"""Interface of the files that hold messages: ROS 1 bags, SQLite databases, MCAP files."""

import struct
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import BinaryIO

import numpy as np

from placecell.core.types import Int64
from placecell.sources.errors import DriveError

UNCHUNKED = -1
"""Chunk of a message that lies in the file itself."""


class RecordError(ValueError):
    """Record of a container that is cut short or damaged; the message says what was found."""


@dataclass(frozen=True, slots=True, eq=False)
class BagTopic:
    """A topic of a bag, with the place of each message.

    Attributes:
        name: name of the topic.
        type: type of its messages, such as sensor_msgs/PointCloud2, without "msg/".
        encoding: serialization: `ros1`, `cdr`, `protobuf`, `json` or another.
        times: time at which each message was recorded, int64 (messages,), nanoseconds, ascending.
        places: file, chunk and offset of each message, int64 (messages, 3).
    """

    name: str
    type: str
    encoding: str
    times: Int64
    places: Int64

    def __len__(self) -> int:
        return len(self.times)

    @property
    def rate_hz(self) -> float:
        """Return messages a second; 0 for fewer than two."""
        seconds = (int(self.times[-1]) - int(self.times[0])) * 1e-9 if len(self) > 1 else 0.0
        return (len(self) - 1) / seconds if seconds > 0 else 0.0


class Container(ABC):
    """A file with messages.

    Opening reads the index only. Files are opened for each access and never kept open, so a
    container can be used by several threads and processes.

    Attributes:
        path: the file.
        topics: topics of the file; the first column of their places is 0.
        remarks: what was odd about the file.
    """

    path: Path
    topics: list[BagTopic]
    remarks: list[str]

    @abstractmethod
    def __init__(self, path: Path) -> None: ...

    @abstractmethod
    def read(self, place: Sequence[int]) -> bytes | memoryview:
        """Return a message, by a row of `BagTopic.places`.

        Raises:
            DriveError: the file is damaged there.
        """

    def contents(
        self, places: Int64, length: int | None = None
    ) -> Iterator[bytes | memoryview | None]:
        """Yield messages by rows of `BagTopic.places`; None for a damaged one.

        Args:
            places: int64 (n, 3).
            length: bytes of each that are needed, from its begin; None: all.
        """
        chunks = places[:, 1]
        for begin, end in pairwise(runs(chunks)):
            if length is not None and end > begin:
                yield from self.heads(int(chunks[begin]), places[begin:end, 2].tolist(), length)
                continue
            for place in places[begin:end].tolist():
                try:
                    yield self.read(place)
                except DriveError:
                    yield None

    def heads(
        self, chunk: int, offsets: Sequence[int], length: int
    ) -> Iterator[bytes | memoryview | None]:
        """Yield the first bytes of messages in a chunk; None for a damaged one."""
        for offset in offsets:
            try:
                yield self.read((0, chunk, offset))[:length]
            except DriveError:
                yield None


def runs(values: Int64) -> list[int]:
    """Return where each run of equal values begins, and the number of values."""
    return [*np.flatnonzero(np.diff(values, prepend=values[:1] - 1)).tolist(), len(values)]


class TopicIndex:
    """Collects the places of messages while a container is opened."""

    def __init__(self) -> None:
        self.kinds: dict[tuple[str, str, str], list[Int64]] = {}

    def add(self, name: str, kind: str, encoding: str, places: Int64) -> None:
        """Add messages: time, chunk and offset of each, int64 (n, 3)."""
        self.kinds.setdefault((name, plain_type(kind), encoding), []).append(places)

    def topics(self) -> list[BagTopic]:
        """Return all topics, ordered by name."""
        topics = []
        for (name, kind, encoding), parts in sorted(self.kinds.items()):
            table = np.concatenate(parts) if parts else np.empty((0, 3), np.int64)
            table = table[np.argsort(table[:, 0], kind="stable")]
            places = table.copy()
            places[:, 0] = 0
            topics.append(BagTopic(name, kind, encoding, table[:, 0].copy(), places))
        return topics


def plain_type(name: str) -> str:
    """Return a type as package/Name: `sensor_msgs/msg/PointCloud2` and IDL's names become one."""
    name = name.replace("::", "/").replace("/msg/", "/").replace("/dds_/", "/")
    return name.rstrip("_")


def table_of(rows: Iterable[tuple[int, int, int]]) -> Int64:
    """Return times, chunks and offsets as a table; values beyond int64 become 0."""
    return np.array(
        [[value if abs(value) < 1 << 63 else 0 for value in row] for row in rows], np.int64
    ).reshape(-1, 3)


def cannot_read(path: Path, error: OSError) -> DriveError:
    """Return the error for a file that the system does not let us read."""
    return DriveError(f"{path}: cannot be read ({error.strerror}). Check its path and permissions")


def read_at(file: BinaryIO, at: int, size: int, file_size: int) -> bytes:
    """Read bytes of a file.

    Raises:
        RecordError: the file ends before them.
    """
    if at < 0 or size < 0 or at + size > file_size:
        raise RecordError(f"{size} bytes at byte {at} of a file of {file_size} bytes")
    file.seek(at)
    content = file.read(size)
    if len(content) != size:
        raise RecordError(f"{size} bytes at byte {at}, but {len(content)} could be read")
    return content


def unpack(kind: str, content: bytes | memoryview, at: int = 0) -> tuple[int, ...]:
    """Unpack little-endian integers.

    Raises:
        RecordError: the content ends before them.
    """
    try:
        return struct.unpack_from("<" + kind, content, at)
    except struct.error as error:
        raise RecordError(f"a record ends too early ({error})") from error
