"""Where maps are kept: what was written is there after a crash.

The store knows nothing of segments. To it a map is a log: the file of its oldest version that is
still kept, and after it the commits, each a blob (a delta) that leads from one version to the next.
"""

import hashlib
import json
from collections.abc import Iterable, Iterator
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Literal, Protocol

NAME_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9._-]{0,63}$"

IDS = 1 << 32
"""Of segments: 0 to this, exclusive."""

Trouble = Literal["full", "read-only", "failing", "busy", "damaged", "moved"]


class StoreError(Exception):
    """Store could not carry out an operation; nothing was changed.

    Attributes:
        kind: what is in the way: a full disk, one that takes no writes, one that fails, another
            process that holds the database, bytes that are not those once written, or files that
            were moved, removed or replaced under the service.
    """

    def __init__(self, kind: Trouble, message: str) -> None:
        super().__init__(message)
        self.kind = kind


class StoreLockedError(Exception):
    """Another service owns the data directory."""


class OutOfIdsError(Exception):
    """A map has not so many ids left."""


class TooManyIdsError(Exception):
    """Key has reserved more ids than it may hold unwritten."""


@dataclass(frozen=True, slots=True)
class Note:
    """What a commit did.

    Attributes:
        time: of the service's clock, Unix seconds; told, never relied on.
        author: name of the key.
        operation: such as `put`, `edit`, `restore`, `age`.
        changed: segments added or replaced.
        removed: segments removed.
    """

    time: float
    author: str
    operation: str
    changed: int
    removed: int


@dataclass(frozen=True, slots=True)
class Commit:
    """Stored write to a map.

    Attributes:
        sequence: of the version that it led to; they grow by one.
        note: what it did.
        bytes: of its blob; 0 if the version was folded into the base.
        mark: names the version together with all that led to it, 64 hex digits.
        link: hash of the previous mark and the blob, from which the mark is made together with the
            note; empty in commits of databases of version 1, whose notes no mark covers.
    """

    sequence: int
    note: Note
    bytes: int
    mark: str
    link: str = ""


@dataclass(frozen=True, slots=True)
class MapHead:
    """Present state of a map in the store.

    Attributes:
        name: of the map.
        uid: of the map under this name; another one when the name is deleted and taken again.
        sequence: of its newest version.
        mark: of that version.
        oldest: sequence of the oldest version that is kept: the base.
        next_id: the first of the free ids: no segment ever had them, and nobody has reserved them.
        base_bytes: of the base.
        log_bytes: of the commits after it.
        author: name of the key that wrote the oldest version that is kept.
        end_id: the end of the free ids, exclusive. Ids from there on may be taken.
        commits: after the base.
        bytes: of base and commits.
    """

    name: str
    uid: str
    sequence: int
    mark: str
    oldest: int
    next_id: int
    base_bytes: int
    log_bytes: int
    author: str
    end_id: int = IDS

    @property
    def bytes(self) -> int:
        """Return the bytes that the map takes in the store, with its old versions."""
        return self.base_bytes + self.log_bytes

    @property
    def commits(self) -> int:
        """How many there are after the base."""
        return self.sequence - self.oldest


@dataclass(frozen=True, slots=True)
class Owner:
    """Last key that wrote or reserved an id.

    Attributes:
        author: name of the key; empty if it is not known.
        is_reserved: the id was reserved, and not written since.
    """

    author: str
    is_reserved: bool


@dataclass(frozen=True, slots=True)
class Ids:
    """Effect of a commit on ids, in ascending runs of first id and exclusive end.

    Attributes:
        taken: by segments that are added or replaced.
        written: those of them that are the author's from now on.
    """

    taken: tuple[tuple[int, int], ...] = ()
    written: tuple[tuple[int, int], ...] = ()

    def leave(self, next_id: int, end_id: int) -> tuple[int, int]:
        """Return the largest remaining run of free ids; of equal ones the later.

        So one id that somebody chose far from all others takes no others with it.
        """
        best, at = (next_id, next_id), next_id
        for first, until in (*self.taken, (end_id, end_id)):
            gap = at, min(first, end_id)
            if gap[1] > gap[0] and gap[1] - gap[0] >= best[1] - best[0]:
                best = gap
            at = max(at, until)
        return best


NO_IDS = Ids()


class MapHistory(Protocol):
    """One map's log as it stood at one moment, whatever is written meanwhile."""

    @property
    def head(self) -> MapHead:
        """Where the map stood."""

    def commits(self) -> list[Commit]:
        """From the base's own to the newest."""

    def mark(self, sequence: int) -> str:
        """Of one version; KeyError if it is not kept."""

    def base(self) -> bytes:
        """The oldest version's file; StoreError if it is damaged."""

    def blobs(self, after: int, until: int) -> Iterator[tuple[Commit, bytes]]:
        """The commits from `after`, exclusive, to `until`.

        Raises:
            KeyError: `after` is not kept.
            StoreError: a commit is damaged.
        """


class MapStore(Protocol):
    """The logs of all maps. A write that has returned survives SIGKILL and power loss.

    Each call is one transaction. Any may raise a StoreError; then nothing has changed.
    """

    def heads(self) -> list[MapHead]:
        """Of the maps, by name."""

    def read(self, uid: str) -> AbstractContextManager[MapHistory]:
        """A map's log; KeyError if there is none."""

    def create(
        self, name: str, file: bytes, note: Note, next_id: int, ids: Ids = NO_IDS
    ) -> MapHead:
        """Begin a map with its first version, of sequence 1; ValueError if the name is taken."""

    def append(
        self,
        head: MapHead,
        blob: bytes,
        note: Note,
        next_id: int,
        ids: Ids = NO_IDS,
        frees: bool = False,
    ) -> MapHead:
        """Add a commit.

        Args:
            head: that it follows; KeyError if the map stands elsewhere.
            blob: a delta.
            note: what it does.
            next_id: raises the map's to at least this.
            ids: that it takes.
            frees: whether it makes the map smaller, so that it may be done on a full disk.
        """

    def reserve(self, uid: str, count: int, author: str = "", most: int = IDS) -> int:
        """Reserve ids that no segment ever had; return the first of them.

        Args:
            uid: of the map; KeyError if there is none.
            count: how many.
            author: name of the key.
            most: ids that the author may have reserved lately and not written.

        Raises:
            OutOfIdsError: the map has not so many free ids.
            TooManyIdsError: the author has reserved too many.
        """

    def owners(self, uid: str, ids: Iterable[int]) -> list[Owner | None]:
        """Return the last owner of each of these ids; None for ids without an owner."""

    def free_ids(self, uid: str, used: Iterable[int]) -> MapHead:
        """Forget the owners of unused ids; free ids begin after the used ones.

        Args:
            uid: of the map; KeyError if there is none.
            used: ids that are used, ascending.
        """

    def compact(self, uid: str, sequence: int, file: bytes) -> MapHead:
        """Let go of the versions before one, whose file is given; KeyError if it is not there."""

    def delete(self, uid: str) -> None:
        """Remove a map with all its versions; KeyError if there is none."""

    def release_space(self) -> None:
        """Return the room of what was removed to the disk, if it is much."""

    def trouble(self) -> str | None:
        """Return why the store cannot take a write; None if it can."""


def link_of(before: str, sequence: int, blob: bytes) -> str:
    """Hash the mark of the version before, the sequence and the blob: 64 hex digits."""
    digest = hashlib.sha256(f"{before} {sequence}\n".encode())
    digest.update(blob)
    return digest.hexdigest()


def mark_of(link: str, note: Note) -> str:
    """Return the mark of a commit: a chain of SHA-256 over all commits that led to it.

    Two maps of one name, or a database and its backup after both were written to, count the same
    sequences, but never come to the same mark. The mark covers the note, so an altered author or
    time is noticed. In databases of version 1 the mark is the link itself.
    """
    told = [float(note.time), note.author, note.operation, note.changed, note.removed]
    return hashlib.sha256(f"{link}\n{json.dumps(told)}".encode()).hexdigest()
