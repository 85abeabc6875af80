"""Maintenance of maps in a background thread.

It flattens layers, renews the cache, compacts long histories, and returns freed space to the disk.
A kill at any point loses nothing.
"""

import logging
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from threading import Event, Thread

from placecell_client import encode

from service.core.memory import release
from service.maps.cache import MapCache
from service.maps.history import history_of, replay
from service.maps.repository import MapRepository
from service.maps.snapshot import MapEntry, MapSnapshot
from service.maps.store import MapHead
from service.maps.sync import MapSync
from service.maps.writes.partial_uploads import PartialUploads

logger = logging.getLogger("placecell")

ALL_SHARE = 0.75
"""Share of the quota of all maps above which histories are compacted, the longest first."""

WORTH = 0.25
"""Smallest history that is compacted for this, as a share of the oldest version's bytes."""


@dataclass(frozen=True, slots=True)
class MaintenanceThresholds:
    """Thresholds of maintenance work.

    Attributes:
        recent: number of segments above the base, or gone from it, that triggers flattening; or
        share: this share of the base, whichever is more.
        commits: number of commits since the base that triggers flattening, for a fast start.
        log_bytes: bytes of a map's history that trigger compaction; or
        log_share: this multiple of its base, whichever is more.
        log_commits: number of commits in a map's history that triggers compaction.
        map_bytes: quota of a map, with its history.
        all_bytes: quota of all maps, with their histories.
        handled: number of copied segments after which free memory returns to the system.
        seconds: seconds between two runs.
    """

    recent: int = 4_096
    share: float = 0.05
    commits: int = 1_000
    log_bytes: int = 64 << 20
    log_share: float = 4.0
    log_commits: int = 10_000
    map_bytes: int = 4 << 30
    all_bytes: int = 64 << 30
    handled: int = 50_000
    seconds: float = 1.0


class Maintenance:
    """Background maintenance of all maps."""

    def __init__(
        self,
        maps: MapRepository,
        sync: MapSync,
        cache: MapCache,
        bounds: MaintenanceThresholds = MaintenanceThresholds(),
        partial_uploads: PartialUploads | None = None,
        watch: Callable[[], None] = lambda: None,
        alone: Callable[[], AbstractContextManager[bool]] = lambda: nullcontext(True),
    ) -> None:
        self._alone = alone
        self._watch = watch
        self._maps = maps
        self._sync = sync
        self._cache = cache
        self._bounds = bounds
        self._partial_uploads = partial_uploads
        self._released = 0
        self._done: dict[str, MapHead] = {}
        self._stopped = Event()

    @contextmanager
    def running(self) -> Iterator[None]:
        """Run in a thread until the context ends."""
        thread = Thread(target=self._work, name="maintenance", daemon=True)
        thread.start()
        try:
            yield
        finally:
            self._stopped.set()
            thread.join()

    def run_once(self) -> None:
        """Do the work that is due, map by map; log failures, and retry them in the next run."""
        # By name: references to all snapshots would keep flattened ones in memory.
        due = {
            stored.name: stored.head
            for stored in self._maps.all()
            if self._done.get(stored.name) is not stored.head
        }
        for name, head in due.items():
            if self._stopped.is_set():
                return
            with _logged(f"map {name!r}"):
                self._maintain(name)
                # Until the next write: few of many maps change between two runs.
                self._done[name] = head
        if len(self._done) > 2 * len(self._maps) + 1_000:
            self._done.clear()
        with _logged("histories"):
            self._free_space()
        if self._maps.copied_segments - self._released > self._bounds.handled:
            self._release()
        with _logged("the watch of the store"):
            self._watch()
        with _logged("the data directory"):
            self._sync.expire()
            if self._partial_uploads is not None:
                self._partial_uploads.forget_old()
            self._cache.keep_only({stored.head.uid for stored in self._maps.entries()})
            self._maps.store.release_space()

    def _work(self) -> None:
        while not self._stopped.wait(self._bounds.seconds):
            self.run_once()

    def _maintain(self, name: str) -> None:
        stored = self._maps.peek(name)
        if isinstance(stored, MapSnapshot) and self._needs_flattening(stored):
            head, content = stored.head, self._maps.flatten(stored)
            stored = None  # free the old layers before the file is made
            if content is not None:
                self._cache.save(head, content)
            del content
            self._release()
            stored = self._maps.peek(name)
        if stored is not None and self._has_long_log(stored):
            self._compact(stored, self._log_bytes(stored.head))

    def _release(self) -> None:
        self._released = self._maps.copied_segments
        release()

    def _free_space(self) -> None:
        """Drop history if a write was refused for lack of space, or all maps are large together."""
        for name in self._maps.take_refused():
            stored = self._maps.peek(name)
            if stored is not None and stored.head.commits:
                self._compact(stored, stored.head.log_bytes)
        enough = ALL_SHARE * self._bounds.all_bytes
        if self._maps.stored_bytes <= enough:
            return
        for stored in sorted(self._maps.entries(), key=lambda stored: -stored.head.log_bytes):
            head = stored.head
            # Compaction writes the oldest version anew, which does not pay for a few bytes.
            if self._maps.stored_bytes <= enough or head.log_bytes <= WORTH * head.base_bytes:
                break
            with _logged(f"map {stored.name!r}"):
                self._compact(stored, head.log_bytes)

    def _needs_flattening(self, stored: MapSnapshot) -> bool:
        layers, bounds = stored.layers, self._bounds
        most = max(bounds.recent, bounds.share * len(layers.base))
        above = max(len(layers.recent), layers.gone_count)
        return above > most or stored.head.sequence - stored.base_sequence > bounds.commits

    def _has_long_log(self, stored: MapEntry) -> bool:
        head, bounds = stored.head, self._bounds
        return head.log_bytes > self._log_bytes(head) or head.commits > bounds.log_commits

    def _log_bytes(self, head: MapHead) -> float:
        wanted = max(self._bounds.log_bytes, self._bounds.log_share * head.base_bytes)
        return min(wanted, max(0, self._bounds.map_bytes - head.base_bytes) / 2)

    def _compact(self, stored: MapEntry, most: float) -> None:
        """Drop old versions until half of the allowed bytes are left, so that it lasts a while.

        Of several services with one database, one does so.
        """
        with self._alone() as is_own:
            if is_own:
                self._compact_alone(stored, most)

    def _compact_alone(self, stored: MapEntry, most: float) -> None:
        with history_of(self._maps.store, stored) as history:
            head = history.head
            left = most / 2
            oldest = head.sequence
            for commit in reversed(history.commits()):
                left -= commit.bytes
                if left < 0 or head.sequence - oldest >= self._bounds.log_commits // 2:
                    break
                oldest = commit.sequence - 1
            oldest = max(oldest, head.oldest)
            file = encode(replay(history, oldest).content())
        self._maps.compact(head, oldest, file)
        logger.info("map %r: dropped the versions before %d", head.name, oldest)


@contextmanager
def _logged(where: str) -> Iterator[None]:
    """Log an exception; it must not end the thread, or the disk would fill up unnoticed."""
    try:
        yield
    except Exception:
        logger.exception("maintenance failed at %s", where)
