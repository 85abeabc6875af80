"""What maps need now and then, in a thread of its own: nobody waits for it.

Layers are folded, the cache is renewed, long histories are shortened, and what was freed is given
back to the disk. At whatever point it is killed, nothing of it is missed.
"""

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from threading import Event, Thread

from placecell_client import encode

from service.core.memory import release
from service.maps.cache import MapCache
from service.maps.history import history_of, replay
from service.maps.repository import MapRepository
from service.maps.snapshot import MapSnapshot
from service.maps.store import MapHead
from service.maps.sync import MapSync
from service.maps.writes.partial_uploads import PartialUploads

logger = logging.getLogger("placecell")

ALL_SHARE = 0.75
"""Share of the quota of all maps above which histories are shortened, the longest first."""

WORTH = 0.25
"""Smallest history that is shortened for this, as a share of the oldest version's bytes."""


@dataclass(frozen=True, slots=True)
class MaintenanceThresholds:
    """Thresholds of maintenance work.

    Attributes:
        recent: segments above the base, or gone from it, that are folded in; or
        share: of the base, whichever is more.
        commits: since the last fold, after which a start would take long.
        log_bytes: of a map's history; or
        log_share: times its base, whichever is more.
        log_commits: in a map's history.
        map_bytes: the quota of a map, with its history.
        all_bytes: the quota of all maps, with their histories.
        handled: segments that writes copied, after which free memory goes back to the system.
        seconds: between two looks.
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
    """Looks after all maps."""

    def __init__(
        self,
        maps: MapRepository,
        sync: MapSync,
        cache: MapCache,
        bounds: MaintenanceThresholds = MaintenanceThresholds(),
        partial_uploads: PartialUploads | None = None,
    ) -> None:
        self._maps = maps
        self._sync = sync
        self._cache = cache
        self._bounds = bounds
        self._partial_uploads = partial_uploads
        self._released = 0
        self._good: dict[str, MapHead] = {}
        self._stopped = Event()

    @contextmanager
    def running(self) -> Iterator[None]:
        """At work until the context ends."""
        thread = Thread(target=self._work, name="housekeeping", daemon=True)
        thread.start()
        try:
            yield
        finally:
            self._stopped.set()
            thread.join()

    def run_once(self) -> None:
        """Do what is due, map by map; what fails is told in the log, and tried again."""
        # By name: who holds all maps holds the memory of what is folded meanwhile.
        due = {
            stored.name: stored.head
            for stored in self._maps.all()
            if self._good.get(stored.name) is not stored.head
        }
        for name, head in due.items():
            if self._stopped.is_set():
                return
            with _told(f"map {name!r}"):
                self._care(name)
                # Until it is written to again: of many maps few change between two looks.
                self._good[name] = head
        if len(self._good) > 2 * len(self._maps) + 1_000:
            self._good.clear()
        with _told("histories"):
            self._make_room()
        if self._maps.copied_segments - self._released > self._bounds.handled:
            self._release()
        with _told("the data directory"):
            self._sync.expire()
            if self._partial_uploads is not None:
                self._partial_uploads.forget_old()
            self._cache.keep_only({stored.head.uid for stored in self._maps.all()})
            self._maps.store.release_space()

    def _work(self) -> None:
        while not self._stopped.wait(self._bounds.seconds):
            self.run_once()

    def _care(self, name: str) -> None:
        stored = self._maps.find(name)
        if stored is not None and self._is_to_fold(stored):
            head, content = stored.head, self._maps.flatten(stored)
            stored = None  # what it was before need not be in memory while the file is made
            if content is not None:
                self._cache.save(head, content)
            del content
            self._release()
            stored = self._maps.find(name)
        if stored is not None and self._has_long_log(stored):
            self._shorten(stored, self._log_bytes(stored.head))

    def _release(self) -> None:
        self._released = self._maps.copied_segments
        release()

    def _make_room(self) -> None:
        """Drop history if a write was refused for lack of space, or all maps together are large."""
        for name in self._maps.take_refused():
            stored = self._maps.find(name)
            if stored is not None and stored.head.commits:
                self._shorten(stored, stored.head.log_bytes)
        enough = ALL_SHARE * self._bounds.all_bytes
        if self._maps.stored_bytes <= enough:
            return
        for stored in sorted(self._maps.all(), key=lambda stored: -stored.head.log_bytes):
            head = stored.head
            # To shorten a history the oldest version is written anew: not for a few bytes.
            if self._maps.stored_bytes <= enough or head.log_bytes <= WORTH * head.base_bytes:
                break
            with _told(f"map {stored.name!r}"):
                self._shorten(stored, head.log_bytes)

    def _is_to_fold(self, stored: MapSnapshot) -> bool:
        layers, bounds = stored.layers, self._bounds
        most = max(bounds.recent, bounds.share * len(layers.base))
        above = max(len(layers.recent), layers.gone_count)
        return above > most or stored.head.sequence - stored.base_sequence > bounds.commits

    def _has_long_log(self, stored: MapSnapshot) -> bool:
        head, bounds = stored.head, self._bounds
        return head.log_bytes > self._log_bytes(head) or head.commits > bounds.log_commits

    def _log_bytes(self, head: MapHead) -> float:
        wanted = max(self._bounds.log_bytes, self._bounds.log_share * head.base_bytes)
        return min(wanted, max(0, self._bounds.map_bytes - head.base_bytes) / 2)

    def _shorten(self, stored: MapSnapshot, most: float) -> None:
        """Drop old versions until half of the allowed bytes are left.

        So this is not due again at once.
        """
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
        logger.info("map %r: versions before %d were let go", head.name, oldest)


@contextmanager
def _told(where: str) -> Iterator[None]:
    """What fails is told; a thread that ended would be missed by nobody until the disk is full."""
    try:
        yield
    except Exception:
        logger.exception("housekeeping failed at %s", where)
