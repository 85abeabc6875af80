"""SQLite database of a ROS 2 bag."""

import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing, suppress
from pathlib import Path

from placecell.core.types import Int64
from placecell.sources.bags.containers.container import (
    Container,
    TopicIndex,
    cannot_read,
    table_of,
)
from placecell.sources.errors import DriveError

MAGIC = b"SQLite format 3\0"


class SqliteFile(Container):
    """A `.db3` file of a ROS 2 bag.

    Raises:
        DriveError: the file is no such database, or it is damaged.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.remarks = []
        try:
            self.file_size = path.stat().st_size
        except OSError as error:
            raise cannot_read(path, error) from error
        log = path.with_name(path.name + "-wal")
        self.has_log = log.is_file() and log.stat().st_size > 0
        index = TopicIndex()
        topics = {}
        for number, name, kind, encoding in self.rows(
            "SELECT id, name, type, serialization_format FROM topics", ()
        ):
            topics[number] = (str(name), str(kind), str(encoding))
            index.add(*topics[number], table_of(()))
        places: dict[object, list[tuple[int, int, int]]] = {number: [] for number in topics}
        for topic, time, number in self.rows("SELECT topic_id, timestamp, id FROM messages", ()):
            if topic in places and isinstance(time, int) and isinstance(number, int):
                places[topic].append((time, 0, number))
        for topic, rows in places.items():
            index.add(*topics[topic], table_of(rows))
        self.topics = index.topics()

    def connect(self) -> sqlite3.Connection:
        """Open the database; a write-ahead log that was not merged needs the slower mode."""
        mode = "mode=ro" if self.has_log else "mode=ro&immutable=1"
        connection = sqlite3.connect(f"{self.path.absolute().as_uri()}?{mode}", uri=True)
        connection.text_factory = lambda text: text.decode(errors="replace")
        return connection

    def rows(self, query: str, values: Sequence[int]) -> Iterator[tuple[object, ...]]:
        """Yield the rows of a query.

        Raises:
            DriveError: the database is damaged.
        """
        try:
            with closing(self.connect()) as connection:
                for count, row in enumerate(connection.execute(query, values)):
                    if count > self.file_size:  # Each row takes some bytes.
                        raise sqlite3.DatabaseError("its tables repeat themselves")
                    yield row
        except (sqlite3.Error, UnicodeDecodeError, OverflowError) as error:
            # The module `sqlite3` fails to decode messages that quote damaged text.
            raise DriveError(
                f"{self.path}: the database of the ROS 2 bag cannot be read ({error}). Copy the "
                "file again, or repair it with 'sqlite3 FILE .recover'"
            ) from error

    def read(self, place: Sequence[int]) -> bytes:
        number = place[2]
        for (data,) in self.rows("SELECT data FROM messages WHERE id = ?", (number,)):
            if isinstance(data, bytes):
                return data
        raise DriveError(
            f"{self.path}: message {number} cannot be read. The database is damaged; copy it again"
        )

    def contents(
        self, places: Int64, length: int | None = None
    ) -> Iterator[bytes | memoryview | None]:
        part = "data" if length is None else f"substr(data, 1, {length})"
        query = f"SELECT {part} FROM messages WHERE id = ?"
        try:
            connection = self.connect()
        except sqlite3.Error:
            yield from [None] * len(places)
            return
        with closing(connection):
            for number in places[:, 2].tolist():
                data = None
                with suppress(sqlite3.Error, UnicodeDecodeError):
                    (data,) = connection.execute(query, (number,)).fetchone() or (None,)
                yield data if isinstance(data, bytes) else None
