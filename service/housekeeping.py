"""What maps need now and then, in a thread of its own: nobody waits for it.

Layers are folded, the cache is renewed, long histories are shortened, and what was freed is given
back to the disk. At whatever point it is killed, nothing of it is missed.
"""

import ctypes
import logging
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from threading import Event, Thread

from placecell_client import encode

from service.changes import Changes
from service.map_cache import MapCache
from service.map_store import Head
from service.maps import Maps
from service.replay import version_of
from service.stored_map import StoredMap
from service.versions import history_of

logger = logging.getLogger("placecell")


@dataclass(frozen=True, slots=True)
class Bounds:
    """From where on something is done.

    Attributes:
        recent: segments above the base, or gone from it, that are folded in; or
        share: of the base, whichever is more.
        commits: since the last fold, after which a start would take long.
        log_bytes: of a map's history; or
        log_share: times its base, whichever is more.
        log_commits: in a map's history.
        seconds: between two looks.
    """

    recent: int = 4_096
    share: float = 0.05
    commits: int = 1_000
    log_bytes: int = 64 << 20
    log_share: float = 4.0
    log_commits: int = 10_000
    seconds: float = 1.0


class Housekeeper:
    """Looks after all maps."""

    def __init__(
        self, maps: Maps, changes: Changes, cache: MapCache, bounds: Bounds = Bounds()
    ) -> None:
        self._maps = maps
        self._changes = changes
        self._cache = cache
        self._bounds = bounds
        self._stopped = Event()

    @contextmanager
    def working(self) -> Iterator[None]:
        """At work until the context ends."""
        thread = Thread(target=self._work, name="housekeeping", daemon=True)
        thread.start()
        try:
            yield
        finally:
            self._stopped.set()
            thread.join()

    def look(self) -> None:
        """Do what is due, map by map; what fails is told in the log, and tried again."""
        for stored in self._maps.all():
            if self._stopped.is_set():
                return
            with _told(f"map {stored.name!r}"):
                self._care(stored)
        with _told("the data directory"):
            self._changes.forget()
            self._cache.keep_only({stored.head.uid for stored in self._maps.all()})
            self._maps.store.give_back()

    def _work(self) -> None:
        while not self._stopped.wait(self._bounds.seconds):
            self.look()

    def _care(self, stored: StoredMap) -> None:
        if self._is_to_fold(stored):
            content = self._maps.fold(stored)
            if content is not None:
                self._cache.save(stored.head, content)
            del content
            release_memory()
        if self._has_long_log(stored):
            self._shorten(stored)

    def _is_to_fold(self, stored: StoredMap) -> bool:
        layers, bounds = stored.layers, self._bounds
        most = max(bounds.recent, bounds.share * len(layers.base))
        above = max(len(layers.recent), layers.buried)
        return above > most or stored.head.sequence - stored.folded > bounds.commits

    def _has_long_log(self, stored: StoredMap) -> bool:
        head, bounds = stored.head, self._bounds
        return head.log_bytes > self._log_bytes(head) or head.commits > bounds.log_commits

    def _log_bytes(self, head: Head) -> float:
        return max(self._bounds.log_bytes, self._bounds.log_share * head.base_bytes)

    def _shorten(self, stored: StoredMap) -> None:
        """Let go of the older half of a history, so that this is not due again at once."""
        with history_of(self._maps.store, stored) as history:
            head = history.head
            left = self._log_bytes(head) / 2
            oldest = head.sequence
            for commit in reversed(history.commits()):
                left -= commit.bytes
                if left < 0 or head.sequence - oldest >= self._bounds.log_commits // 2:
                    break
                oldest = commit.sequence - 1
            oldest = max(oldest, head.oldest)
            file = encode(version_of(history, oldest).content())
        self._maps.compact(head, oldest, file)
        logger.info("map %r: versions before %d were let go", head.name, oldest)


@contextmanager
def _told(where: str) -> Iterator[None]:
    """What fails is told; a thread that ended would be missed by nobody until the disk is full."""
    try:
        yield
    except Exception:
        logger.exception("housekeeping failed at %s", where)


def release_memory() -> None:
    """Give what was freed back to the system: of a large map that was folded glibc keeps much."""
    with suppress(OSError, AttributeError):  # another system, or another library
        ctypes.CDLL("libc.so.6").malloc_trim(0)
