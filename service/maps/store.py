"""Map store: interface of the durable log of each map.

The store knows nothing about segments. A map is a log: the file of its oldest kept version, and the
commits after it. Each commit has a blob (a delta) that leads from one version to the next.
"""

import hashlib
import json
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass
from typing import Literal, Protocol, runtime_checkable

from placecell_client.seen import MAP_NAME

NAME_PATTERN = rf"^{MAP_NAME}$"

IDS = 1 << 32
"""Number of ids of a map: 0 to this, exclusive."""

Trouble = Literal["full", "read-only", "failing", "busy", "damaged", "moved", "unreachable"]


class StoreError(Exception):
    """The store could not carry out an operation; nothing was changed.

    Attributes:
        kind: the cause: a full disk (`full`), a read-only disk (`read-only`), a failing disk
            (`failing`), another process that locks the database (`busy`), altered bytes
            (`damaged`), files moved, removed or replaced while the service ran (`moved`), or a
            server of the database that does not answer (`unreachable`).
        is_unsure: whether the operation may have been carried out nevertheless.
    """

    def __init__(self, kind: Trouble, message: str, is_unsure: bool = False) -> None:
        super().__init__(message)
        self.kind = kind
        self.is_unsure = is_unsure


class StoreLockedError(Exception):
    """Another service owns the data directory."""


class OutOfIdsError(Exception):
    """The map has too few free ids."""


class TooManyIdsError(Exception):
    """The key would hold too many reserved, unwritten ids."""


@dataclass(frozen=True, slots=True)
class Note:
    """Description of a commit.

    Attributes:
        time: time of the service's clock, Unix seconds; for display only.
        author: name of the key.
        operation: name of the operation, such as `put`, `edit`, `restore`, `age`.
        changed: number of segments added or replaced.
        removed: number of segments removed.
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
        sequence: sequence of the version that it led to; sequences grow by one.
        note: description of the commit.
        bytes: bytes of its blob; 0 for the commit of the oldest kept version.
        mark: hash of the version and its whole history, 64 hex digits.
        link: hash of the previous mark and the blob; the mark is the hash of link and note. Empty
            in commits of databases of version 1, whose marks do not cover notes.
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
        name: name of the map.
        uid: unique id of the map; a map that is deleted and created again has another one.
        sequence: sequence of the newest version.
        mark: mark of the newest version.
        oldest: sequence of the oldest kept version, the base.
        next_id: first free id: no segment ever had it, and no key has reserved it.
        base_bytes: bytes of the base.
        log_bytes: bytes of the commits after the base.
        author: name of the key that wrote the base.
        end_id: end of the free ids, exclusive; ids from there on may be in use.
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
        """Bytes of the map in the store, with its old versions."""
        return self.base_bytes + self.log_bytes

    @property
    def commits(self) -> int:
        """Number of commits after the base."""
        return self.sequence - self.oldest


@dataclass(frozen=True, slots=True)
class Annotation:
    """Fact about a map that is no segment: a tag, its place on the Earth, or a named pose.

    It belongs to the map and not to a version, so every later version keeps it.

    Attributes:
        kind: kind of the fact, such as `tag`.
        name: name of the fact, unique among those of its kind and map.
        value: value as JSON.
        author: name of the key that wrote it.
        time: time of the service's clock, Unix seconds.
    """

    kind: str
    name: str
    value: str
    author: str
    time: float


@dataclass(frozen=True, slots=True)
class Owner:
    """Last key that wrote or reserved an id.

    Attributes:
        author: name of the key; empty if it is not known.
        is_reserved: whether the id was reserved and not written since.
    """

    author: str
    is_reserved: bool


@dataclass(frozen=True, slots=True)
class Ids:
    """Effect of a commit on ids, in ascending runs of first id and exclusive end.

    Attributes:
        taken: ids of segments that are added or replaced.
        written: those of them that become the author's.
    """

    taken: tuple[tuple[int, int], ...] = ()
    written: tuple[tuple[int, int], ...] = ()

    def leave(self, next_id: int, end_id: int) -> tuple[int, int]:
        """Return the largest remaining run of free ids; the later one of equal runs.

        So a single id far from all others does not use up the ids in between.
        """
        best, at = (next_id, next_id), next_id
        for first, until in (*self.taken, (end_id, end_id)):
            gap = at, min(first, end_id)
            if gap[1] > gap[0] and gap[1] - gap[0] >= best[1] - best[0]:
                best = gap
            at = max(at, until)
        return best


NO_IDS = Ids()


@dataclass(frozen=True, slots=True)
class OwnedIds:
    """Run of ids with one owner.

    Attributes:
        first: first id.
        until: end of the run, exclusive.
        author: name of the key; empty if it is not known.
        reserved: time of the reservation, Unix seconds; None: the ids were written since.
    """

    first: int
    until: int
    author: str
    reserved: float | None


class MapHistory(Protocol):
    """Log of one map at one moment, unaffected by later writes."""

    @property
    def head(self) -> MapHead:
        """Head of the map at that moment."""

    def commits(self) -> list[Commit]:
        """Return the commits from the base to the newest version."""

    def mark(self, sequence: int) -> str:
        """Return the mark of one version; KeyError if it is not kept."""

    def base(self) -> bytes:
        """Return the file of the oldest version; StoreError if it is damaged."""

    def blobs(self, after: int, until: int) -> Iterator[tuple[Commit, bytes]]:
        """Yield the commits from `after`, exclusive, to `until`.

        Raises:
            KeyError: the version `after` is not kept.
            StoreError: a commit is damaged.
        """


class StoreSnapshot(Protocol):
    """All maps of a store, or of a backup, at one moment."""

    def heads(self) -> list[MapHead]:
        """Return the heads of all maps, by name."""

    def history(self, uid: str) -> MapHistory:
        """Return a map's log, valid as long as the snapshot; KeyError if there is no such map."""

    def owned_ids(self, uid: str) -> list[OwnedIds]:
        """Return the ascending runs of owned ids; KeyError if there is no such map."""

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return the annotations of all maps, by uid; StoreError if one was altered."""


class MapStore(Protocol):
    """Logs of all maps. A write that has returned survives SIGKILL and power loss.

    Each call is one transaction. If it raises a StoreError, nothing has changed.
    """

    def heads(self) -> list[MapHead]:
        """Return the heads of all maps, by name."""

    def read(self, uid: str) -> AbstractContextManager[MapHistory]:
        """Read a map's log; KeyError if there is no such map."""

    def create(
        self, name: str, file: bytes, note: Note, next_id: int, ids: Ids = NO_IDS
    ) -> MapHead:
        """Create a map with its first version, sequence 1; ValueError if the name is in use."""

    def append(
        self,
        head: MapHead,
        blob: bytes,
        note: Note,
        next_id: int,
        ids: Ids = NO_IDS,
        frees: bool = False,
        annotations: Sequence[Annotation] = (),
    ) -> MapHead:
        """Add a commit.

        Args:
            head: head that the commit follows; KeyError if the map has another head.
            blob: the delta.
            note: description of the commit.
            next_id: smallest `next_id` of the map after the commit.
            ids: ids that the commit takes.
            frees: whether the commit makes the map smaller, so that a full disk accepts it.
            annotations: annotations of the map to add or replace in the same transaction.
        """

    def reserve(self, uid: str, count: int, author: str = "", most: int = IDS) -> int:
        """Reserve ids that no segment ever had; return the first of them.

        Args:
            uid: uid of the map; KeyError if there is no such map.
            count: number of ids.
            author: name of the key.
            most: largest number of ids that the author may hold reserved and unwritten.

        Raises:
            OutOfIdsError: the map has too few free ids.
            TooManyIdsError: the author would hold too many.
        """

    def owners(self, uid: str, ids: Iterable[int]) -> list[Owner | None]:
        """Return the last owner of each of these ids; None for ids without an owner."""

    def free_ids(self, uid: str, used: Iterable[int], mark: str | None = None) -> MapHead:
        """Forget the owners of unused ids; free ids begin after the used ones.

        Args:
            uid: uid of the map; KeyError if there is no such map.
            used: ids in use, ascending.
            mark: mark of the newest version; KeyError if the map has another. None: any.
        """

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return the annotations of all maps, by uid; altered ones are left out."""

    def annotate(
        self, uid: str, put: Sequence[Annotation], removed: Collection[tuple[str, str]] = ()
    ) -> None:
        """Add or replace annotations of a map, and remove some.

        Args:
            uid: uid of the map; KeyError if there is no such map.
            put: annotations to add or replace.
            removed: kind and name of each annotation to remove.
        """

    def compact(self, uid: str, sequence: int, file: bytes) -> MapHead:
        """Drop the versions before one, whose file is given; KeyError if it is not kept."""

    def delete(self, uid: str, mark: str | None = None) -> None:
        """Remove a map with all its versions.

        Args:
            uid: uid of the map; KeyError if there is no such map.
            mark: mark of the newest version; KeyError if the map has another. None: any.
        """

    def snapshot(self) -> AbstractContextManager[StoreSnapshot]:
        """Read all maps at one moment, without blocking writers."""

    def import_maps(
        self, source: StoreSnapshot, skipped: int = 0, replaces: bool = False
    ) -> list[MapHead]:
        """Store all maps of a snapshot with uids, versions, marks, owners and annotations.

        Args:
            source: the maps to store.
            skipped: number of ids of each map that are not given out again, because the source
                may not know them; less if the store knows which ids it gave out.
            replaces: whether the present maps are removed; otherwise a ValueError if there are any.
        """

    def release_space(self) -> None:
        """Return the space of removed data to the disk, if it is large."""

    def trouble(self) -> str | None:
        """Return why the store accepts no writes; None if it accepts them."""


@dataclass(frozen=True, slots=True)
class SharedMap:
    """State of a map in a store that several services write to.

    Attributes:
        head: head of the map.
        annotated: number of writes of its annotations.
    """

    head: MapHead
    annotated: int


@runtime_checkable
class SharedStore(MapStore, Protocol):
    """Store that several services write to, each of which follows the writes of the others."""

    def find(self, name: str) -> SharedMap | None:
        """Return the newest state of a map; None if there is no such map."""

    def shared_maps(self) -> list[SharedMap]:
        """Return the newest states of all maps, by name."""

    def commits_since(self, before: MapHead, head: MapHead) -> list[tuple[Commit, bytes]]:
        """Return the commits after one version of a map, up to a newer one, with their deltas.

        Raises:
            KeyError: the later version does not follow the other, or not all commits are kept.
        """

    def annotations_of(self, uid: str) -> list[Annotation]:
        """Return the annotations of a map; none if there is no such map."""

    def listen(self) -> AbstractContextManager[Callable[[float], set[str]]]:
        """Listen to writes; yield a function that waits some seconds for the names of written maps.

        A name can be missing, and the empty name stands for all maps.
        """

    def alone(self) -> AbstractContextManager[bool]:
        """Yield whether this service may do maintenance, which one service does at a time."""


def skipped_ids(head: MapHead, given_out: int, count: int) -> int:
    """Return the first id of a map that may be given out after `count` ids are skipped.

    Args:
        head: head of the map.
        given_out: end of the ids that are known to have been given out.
        count: number of ids to skip after them; at most half of the free ids are skipped.
    """
    first = min(max(head.next_id, given_out), head.end_id)
    return max(first, min(first + count, (first + head.end_id) // 2))


def link_of(before: str, sequence: int, blob: bytes) -> str:
    """Hash the mark of the version before, the sequence and the blob: 64 hex digits."""
    digest = hashlib.sha256(f"{before} {sequence}\n".encode())
    digest.update(blob)
    return digest.hexdigest()


def mark_of(link: str, note: Note) -> str:
    """Return the mark of a commit: a chain of SHA-256 over all commits that led to it.

    Two maps of one name, or a database and its backup after both were written to, have the same
    sequences but never the same mark. The mark covers the note, so an altered author or time is
    noticed. In databases of version 1 the mark is the link itself.
    """
    fields = [float(note.time), note.author, note.operation, note.changed, note.removed]
    return hashlib.sha256(f"{link}\n{json.dumps(fields)}".encode()).hexdigest()


def commit_after(before: str, sequence: int, note: Note, blob: bytes, size: int) -> Commit:
    """Build the commit that follows the version with this mark."""
    # With the number type that the database returns.
    note = Note(float(note.time), note.author, note.operation, note.changed, note.removed)
    link = link_of(before, sequence, blob)
    return Commit(sequence, note, size, mark_of(link, note), link)


def is_own_mark(commit: Commit) -> bool:
    """Check a commit's note and link against its mark; true for commits of version 1."""
    return not commit.link or mark_of(commit.link, commit.note) == commit.mark


def follows(before: str, commit: Commit, blob: bytes) -> bool:
    """Check that a commit with this blob follows the version with this mark."""
    link = link_of(before, commit.sequence, blob)
    known = commit.link or commit.mark
    return link == known and is_own_mark(commit) and commit.bytes == len(blob)
