"""Base of ROS 1 bags and MCAP files: records, chunks of records, and an index."""

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from contextlib import suppress
from pathlib import Path
from typing import BinaryIO, ClassVar

from placecell.core.types import Int64
from placecell.sources.bags.containers.compression import BLOCK, begin_of
from placecell.sources.bags.containers.container import (
    UNCHUNKED,
    Container,
    RecordError,
    TopicIndex,
    cannot_read,
    table_of,
)
from placecell.sources.errors import DriveError


class ChunkedFile(Container):
    """A file of records, some of them in compressed chunks.

    A file that was not closed, or that is cut, has no index at its end: then all chunks are read
    once to make one, up to the first damage.

    Raises:
        DriveError: the file has another format.
    """

    repair: ClassVar[str]
    """Command that repairs a damaged file."""
    longest_head: ClassVar[int]
    """Bytes of a message's record before its data; if there are more, the whole chunk is read."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.remarks = []
        self.cache: tuple[int, bytes] = (UNCHUNKED, b"")
        self.found: dict[int, list[tuple[int, int, int]]] = {}
        self.index = TopicIndex()
        try:
            self.file_size = path.stat().st_size
            with path.open("rb") as file:
                first = self.first_record(file)
                try:
                    self.read_index(file)
                except RecordError as error:
                    self.make_index(file, first, str(error))
        except OSError as error:
            raise cannot_read(path, error) from error
        self.topics = self.index.topics()

    @abstractmethod
    def first_record(self, file: BinaryIO) -> int:
        """Check the begin of the file and return the offset of its records.

        Raises:
            DriveError: the file has another format.
        """

    @abstractmethod
    def read_index(self, file: BinaryIO) -> None:
        """Read the index at the end of the file.

        Raises:
            RecordError: there is none, or it is damaged.
        """

    @abstractmethod
    def index_record(self, file: BinaryIO, at: int) -> int:
        """Add the messages of a record to `found`, and return the offset of the next record.

        Raises:
            RecordError: the record is damaged.
            DriveError: its chunk cannot be decompressed.
        """

    @abstractmethod
    def add(self, number: int, places: Int64) -> None:
        """Add messages of a connection or channel: time, chunk and offset of each.

        Raises:
            RecordError: its number is not known.
        """

    @abstractmethod
    def chunk_content(self, file: BinaryIO, at: int) -> bytes:
        """Return the decompressed content of a chunk.

        Raises:
            RecordError: there is none.
            DriveError: it cannot be decompressed.
        """

    @abstractmethod
    def chunk_data(self, file: BinaryIO, at: int, length: int) -> tuple[bytes, str]:
        """Return the first compressed bytes of a chunk, and its compression.

        Raises:
            RecordError: there is none.
        """

    @abstractmethod
    def message(self, file: BinaryIO, chunk: int, offset: int) -> bytes | memoryview:
        """Return the message at an offset of a chunk.

        Raises:
            RecordError: there is none.
        """

    @abstractmethod
    def message_head(self, begin: bytes, at: int, length: int) -> bytes | None:
        """Return the first bytes of the message at an offset of a chunk's begin, if they are there.

        Raises:
            RecordError: the message is damaged.
        """

    def make_index(self, file: BinaryIO, at: int, reason: str) -> None:
        """Read the whole file to find its messages, up to the first damage."""
        self.index = TopicIndex()
        self.found.clear()
        damage = ""
        while at < self.file_size:
            try:
                at = self.index_record(file, at)
            except (RecordError, DriveError) as error:
                damage = f"; {self.file_size - at} bytes from byte {at} on are left out ({error})"
                break
        total = self.add_found()
        self.remarks.append(
            f"{self.path}: the file has no usable index ({reason}); {total} messages were found by "
            f"reading all of it{damage}. Repair it with '{self.repair}'"
        )

    def add_found(self) -> int:
        """Add the messages that were found in chunks; return their number."""
        total = 0
        for number, rows in self.found.items():
            with suppress(RecordError):  # Nothing tells the topic of these messages.
                self.add(number, table_of(rows))
                total += len(rows)
        self.found.clear()
        return total

    def cached(self, file: BinaryIO, at: int) -> bytes:
        """Return the content of a chunk; that of the last one is kept."""
        if self.cache[0] != at:
            self.cache = (at, self.chunk_content(file, at))
        return self.cache[1]

    def read(self, place: Sequence[int]) -> bytes | memoryview:
        _, chunk, offset = place
        try:
            with self.path.open("rb") as file:
                return self.message(file, chunk, offset)
        except OSError as error:
            raise cannot_read(self.path, error) from error
        except RecordError as error:
            raise DriveError(
                f"{self.path}: the message at offset {offset} is damaged ({error}). Copy the file "
                f"again, or repair it with '{self.repair}'"
            ) from error

    def heads(
        self, chunk: int, offsets: Sequence[int], length: int
    ) -> Iterator[bytes | memoryview | None]:
        """Yield the first bytes of messages; the rest of the chunk is not decompressed."""
        begin = b""
        if chunk not in (UNCHUNKED, self.cache[0]):
            begin = self.chunk_begin(chunk, max(offsets) + self.longest_head + length)
        for offset in offsets:
            head = None
            with suppress(RecordError):
                head = self.message_head(begin, offset, length)
            if head is not None:
                yield head
            else:
                yield from super().heads(chunk, [offset], length)

    def chunk_begin(self, at: int, length: int) -> bytes:
        """Return the first bytes of a chunk's content; fewer if it is damaged."""
        try:
            with self.path.open("rb") as file:
                data, compression = self.chunk_data(file, at, length + BLOCK)
            return begin_of(data, compression, length, str(self.path))
        except (OSError, RecordError, DriveError):
            return b""
