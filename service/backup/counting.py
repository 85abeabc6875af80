"""Counts the bytes of maps while a store or a backup reads them, for a progress bar."""

from collections.abc import Callable, Iterator

from service.maps.store import Annotation, Commit, MapHead, MapHistory, OwnedIds, StoreSnapshot


class CountedSnapshot:
    """Snapshot that reports the bytes of maps that are read from it."""

    def __init__(self, source: StoreSnapshot, on_bytes: Callable[[int], None]) -> None:
        self._source = source
        self._on_bytes = on_bytes

    def heads(self) -> list[MapHead]:
        """Return the heads of all maps, by name."""
        return self._source.heads()

    def history(self, uid: str) -> "CountedHistory":
        """Return a map's log; KeyError if there is no such map."""
        return CountedHistory(self._source.history(uid), self._on_bytes)

    def owned_ids(self, uid: str) -> list[OwnedIds]:
        """Return the ascending runs of owned ids; KeyError if there is no such map."""
        return self._source.owned_ids(uid)

    def annotations(self) -> dict[str, list[Annotation]]:
        """Return the annotations of all maps, by uid."""
        return self._source.annotations()


class CountedHistory:
    """Log of one map that reports the bytes that are read from it."""

    def __init__(self, history: MapHistory, on_bytes: Callable[[int], None]) -> None:
        self._history = history
        self._on_bytes = on_bytes

    @property
    def head(self) -> MapHead:
        """Head of the map."""
        return self._history.head

    def commits(self) -> list[Commit]:
        """Return the commits from the base to the newest version."""
        return self._history.commits()

    def mark(self, sequence: int) -> str:
        """Return the mark of one version; KeyError if it is not kept."""
        return self._history.mark(sequence)

    def base(self) -> bytes:
        """Return the file of the oldest version."""
        data = self._history.base()
        self._on_bytes(len(data))
        return data

    def blobs(self, after: int, until: int) -> Iterator[tuple[Commit, bytes]]:
        """Yield the commits from `after`, exclusive, to `until`."""
        for commit, blob in self._history.blobs(after, until):
            yield commit, blob
            self._on_bytes(len(blob))
