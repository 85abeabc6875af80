"""Reads a backup: every object is checked against its hash, and every commit against its mark."""

from collections.abc import Callable, Iterator
from functools import cached_property

from service.backup.format import BackupError, MapLog, decode_log, name_of
from service.backup.targets import BackupTarget, existing_manifest_of
from service.maps.store import (
    Annotation,
    Commit,
    MapHead,
    OwnedIds,
    StoreError,
    follows,
    is_own_mark,
)


class BackupSnapshot:
    """All maps of a backup."""

    def __init__(self, target: BackupTarget) -> None:
        """Read the manifest; BackupError if there is none, or if it is damaged."""
        self.manifest = existing_manifest_of(target)
        self._objects = _Objects(target, self.manifest.objects)
        self._logs = {each.uid: each.log for each in self.manifest.maps}

    def heads(self) -> list[MapHead]:
        """Return the heads of all maps, by name."""
        return sorted((head for head, _ in self._all), key=lambda head: head.name)

    def history(self, uid: str) -> "BackupHistory":
        """Return a map's log; KeyError if there is no such map."""
        return BackupHistory(self._log(uid), self._objects)

    def owned_ids(self, uid: str) -> list[OwnedIds]:
        """Return the ascending runs of owned ids; KeyError if there is no such map."""
        return self._log(uid).owned

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return the annotations of all maps, by uid."""
        return {head.uid: rows for head, rows in self._all if rows}

    def faults(self, on_bytes: Callable[[int], None] = lambda _: None) -> list[str]:
        """Read all of the backup and return its errors."""
        found = []
        for entry in self.manifest.maps:
            try:
                history = self.history(entry.uid)
                head = history.head
                if (head.name, head.uid) != (entry.name, entry.uid):
                    raise BackupError("its log is the log of another map")
                history.commits()
                on_bytes(len(history.base()))
                for _, blob in history.blobs(head.oldest, head.sequence):
                    on_bytes(len(blob))
            except (BackupError, StoreError) as error:
                found.append(f"map {entry.name!r}: {error}")
        return found

    @cached_property
    def _all(self) -> list[tuple[MapHead, list[Annotation]]]:
        """Head and annotations of each map; the rest of a log may be large."""
        return [(log.head, log.annotations) for log in map(self._log, self._logs)]

    def _log(self, uid: str) -> MapLog:
        name = self._logs[uid]
        return decode_log(self._objects.read(name), f"the log {name}")


class BackupHistory:
    """Log of one map in a backup."""

    def __init__(self, log: MapLog, objects: "_Objects") -> None:
        self._log = log
        self._objects = objects

    @property
    def head(self) -> MapHead:
        """Head of the map."""
        return self._log.head

    def commits(self) -> list[Commit]:
        """Return the commits from the base to the newest version; StoreError if one is wrong."""
        head, found = self.head, self._log.commits
        sequences = [commit.sequence for commit in found]
        if (
            sequences != list(range(head.oldest, head.sequence + 1))
            or not all(map(is_own_mark, found))
            or found[-1].mark != head.mark
            or sum(commit.bytes for commit in found) != head.log_bytes
        ):
            raise self._damaged("list of versions")
        return found

    def mark(self, sequence: int) -> str:
        """Return the mark of one version; KeyError if it is not kept."""
        for commit in self._log.commits:
            if commit.sequence == sequence:
                return commit.mark
        raise KeyError(sequence)

    def base(self) -> bytes:
        """Return the file of the oldest version; BackupError or StoreError if it is damaged."""
        data = b"".join(map(self._objects.read, self._log.base))
        if len(data) != self.head.base_bytes:
            raise self._damaged("base")
        return data

    def blobs(self, after: int, until: int) -> Iterator[tuple[Commit, bytes]]:
        """Yield the commits from `after`, exclusive, to `until`; StoreError if one is damaged."""
        before = self.mark(after)
        self.mark(until)
        packs = iter(self._log.packs)
        pack, at = b"", 0
        for commit in self.commits()[1:]:
            if commit.sequence > until:
                return
            while at + commit.bytes > len(pack):
                # Each pack begins and ends with a whole blob.
                name = next(packs, None)
                if name is None or at < len(pack):
                    raise self._damaged(f"version {commit.sequence}")
                pack, at = self._objects.read(name), 0
            blob = pack[at : at + commit.bytes]
            at += commit.bytes
            if commit.sequence > after:
                if not follows(before, commit, blob):
                    raise self._damaged(f"version {commit.sequence}")
                yield commit, blob
                before = commit.mark

    def _damaged(self, part: str) -> StoreError:
        return StoreError(
            "damaged",
            f"map {self.head.name!r}: its {part} in the backup is wrong. Use another backup",
        )


class _Objects:
    """Objects of a backup, checked against their names."""

    def __init__(self, target: BackupTarget, sizes: dict[str, int]) -> None:
        self._target = target
        self._sizes = sizes

    def read(self, name: str) -> bytes:
        """Return an object; BackupError if it is missing or was altered."""
        if name not in self._sizes:
            raise BackupError(f"the object {name} is not in the manifest. Use another backup.")
        data = self._target.read(name)
        if name_of(data) != name:
            raise BackupError(
                f"the object {name} in {self._target} was altered. Delete it and back up again, or "
                "use another backup."
            )
        return data
