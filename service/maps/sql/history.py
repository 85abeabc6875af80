"""History of one map, read and checked against its marks."""

import hashlib
from collections.abc import Iterable, Iterator
from typing import Any

from service.maps.sql.rows import Rows
from service.maps.sql.tables import COMMIT, commit_from
from service.maps.store import Commit, MapHead, StoreError, follows, is_own_mark


class SqlHistory:
    """Log of one map at one moment."""

    def __init__(self, rows: Rows, row: int, head: MapHead) -> None:
        self._rows = rows
        self._row = row
        self._head = head

    @property
    def head(self) -> MapHead:
        """Head of the map at that moment."""
        return self._head

    def commits(self) -> list[Commit]:
        """Return the commits from the base to the newest version."""
        rows = self._rows.execute(
            f"{COMMIT} FROM commits WHERE map = ? ORDER BY sequence", (self._row,)
        )
        found = [commit_from(row) for row in rows]
        head = self._head
        for sequence, commit in enumerate(found, head.oldest):
            if commit.sequence != sequence or not is_own_mark(commit):
                raise self._damaged(f"version {sequence}")
        if not found or (found[-1].sequence, found[-1].mark) != (head.sequence, head.mark):
            raise self._damaged(f"version {head.sequence}")
        if found[0].bytes or sum(commit.bytes for commit in found) != head.log_bytes:
            raise self._damaged("list of versions")
        return found

    def mark(self, sequence: int) -> str:
        """Return the mark of one version; KeyError if it is not kept."""
        found = self._rows.execute(
            f"{COMMIT} FROM commits WHERE map = ? AND sequence = ?", (self._row, sequence)
        ).fetchone()
        if not self._head.oldest <= sequence <= self._head.sequence:
            raise KeyError(sequence)
        if found is None or not is_own_mark(commit_from(found)):
            raise self._damaged(f"version {sequence}")
        return str(commit_from(found).mark)

    def base(self) -> bytes:
        """Return the file of the oldest version; StoreError if it is damaged."""
        parts: list[bytes] = []
        for part, sha256, data in self._rows.execute(
            "SELECT part, sha256, data FROM bases WHERE map = ? ORDER BY part", (self._row,)
        ):
            is_next = part == len(parts) and isinstance(data, bytes)
            if not is_next or hashlib.sha256(data).hexdigest() != sha256:
                raise self._damaged("base")
            parts.append(data)
        if sum(map(len, parts)) != self._head.base_bytes:
            raise self._damaged("base")
        return b"".join(parts)

    def blobs(self, after: int, until: int) -> Iterator[tuple[Commit, bytes]]:
        """Yield the commits from `after`, exclusive, to `until`; StoreError if one is damaged."""
        before, sequence = self.mark(after), after
        rows = self._rows.execute(
            f"{COMMIT}, delta FROM commits "
            "WHERE map = ? AND sequence > ? AND sequence <= ? ORDER BY sequence",
            (self._row, after, until),
        )
        try:
            for commit, blob in _linked(rows, sequence, before):
                yield commit, blob
                sequence, before = commit.sequence, commit.mark
        except _UnlinkedError as error:
            raise self._damaged(f"version {error.sequence}") from error
        if sequence != until or (until == self._head.sequence and before != self._head.mark):
            raise self._damaged(f"version {until}")

    def _damaged(self, part: str) -> StoreError:
        return StoreError("damaged", f"map {self._head.name!r}: its {part} was altered or lost")


def commits_since(rows: Rows, before: MapHead, head: MapHead) -> list[tuple[Commit, bytes]]:
    """Return the commits after one version of a map, up to a newer one, by one statement at most.

    The marks prove that each version follows the one before it.

    Raises:
        KeyError: the later version does not follow the other, or not all commits are kept.
    """
    if before.uid != head.uid:
        raise KeyError(before.uid)
    found: list[tuple[Commit, bytes]] = []
    sequence, mark = before.sequence, before.mark
    if sequence < head.sequence:
        later = rows.execute(
            f"{COMMIT}, delta FROM commits WHERE map = (SELECT map FROM maps WHERE uid = ?) "
            "AND sequence > ? AND sequence <= ? ORDER BY sequence",
            (head.uid, sequence, head.sequence),
        )
        found.extend(_linked(later, sequence, mark))
    if found:
        sequence, mark = found[-1][0].sequence, found[-1][0].mark
    if (sequence, mark) != (head.sequence, head.mark):
        raise KeyError(head.sequence)
    return found


class _UnlinkedError(KeyError):
    """A commit is missing, or does not follow the one before it.

    Attributes:
        sequence: the sequence that it has or should have.
    """

    def __init__(self, sequence: int) -> None:
        super().__init__(sequence)
        self.sequence = sequence


def _linked(rows: Iterable[Any], sequence: int, mark: str) -> Iterator[tuple[Commit, bytes]]:
    """Yield the commits after the version with this mark, each once it is proved to follow."""
    for *columns, blob in rows:
        commit, sequence = commit_from(columns), sequence + 1
        is_next = commit.sequence == sequence and isinstance(blob, bytes)
        if not is_next or not follows(mark, commit, blob):
            raise _UnlinkedError(sequence)
        yield commit, blob
        mark = commit.mark
