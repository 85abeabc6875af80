"""Follower: loads what other services write to the store, at once and before it is asked for."""

import logging
import re
from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from dataclasses import replace
from math import inf
from threading import Event, Lock, Thread
from time import monotonic
from weakref import WeakValueDictionary

from placecell_client import MapFileError
from placecell_client.seen import MAP_NAME

from service.core.problems import Problem
from service.maps.following.advance import newest
from service.maps.repository import MapRepository
from service.maps.snapshot import ColdMap, MapEntry, MapSnapshot
from service.maps.store import SharedMap, SharedStore, StoreError

POLL_SECONDS = 0.5
"""Seconds between two looks at all maps. A notification can get lost; a look finds all writes."""

PAUSE_SECONDS = 0.5
"""Seconds to wait after a failure of the store."""

WAIT_SECONDS = 3.0
"""Seconds that a request waits for another thread that loads the same map."""

LATE_SECONDS = 30.0
"""Seconds behind the store after which the service is not ready."""

GONE = "-"
"""Tag of a map that was deleted, in `Placecell-Seen`."""

_SEEN = re.compile(rf"({MAP_NAME}) +\"?([0-9a-f]{{16}}-[0-9]{{1,16}}|-)\"?")

logger = logging.getLogger("placecell")


class Follower:
    """Keeps the maps of a repository level with a shared store. Safe to use from many threads."""

    def __init__(
        self,
        store: SharedStore,
        maps: MapRepository,
        on_annotations: Callable[[str], None] = lambda _: None,
        poll_seconds: float = POLL_SECONDS,
    ) -> None:
        """Create it; `running` starts it.

        Args:
            store: store of the maps.
            maps: maps in memory.
            on_annotations: is called with the uid of each map whose annotations were written.
            poll_seconds: seconds between two looks at all maps.
        """
        self._store = store
        self._maps = maps
        self._on_annotations = on_annotations
        self._poll_seconds = poll_seconds
        self._guard = Lock()
        self._locks: WeakValueDictionary[str, Lock] = WeakValueDictionary()
        self._annotated: dict[str, int] = {}
        self._looked: dict[str, float] = {}
        self._level_at = monotonic()
        self._behind_since: float | None = None
        self._failure: StoreError | None = None
        self._stopped = Event()
        maps.catch_up = self.catch_up

    @contextmanager
    def running(self) -> Iterator[None]:
        """Follow in a thread until the context ends."""
        thread = Thread(target=self._work, name="follower", daemon=True)
        thread.start()
        try:
            yield
        finally:
            self._stopped.set()
            thread.join(2 * WAIT_SECONDS)

    def lag(self) -> float:
        """Return the seconds since all maps were level with the store."""
        return monotonic() - self._level_at

    def trouble(self) -> str | None:
        """Return why requests should go to another service; None if they should not.

        A store that cannot be reached is no reason: all services lose it at once, and all of them
        can answer from memory.
        """
        since = self._behind_since
        if since is None or monotonic() - since < LATE_SECONDS:
            return None
        return f"The maps are {monotonic() - since:.0f} s behind the database."

    def warning(self) -> str | None:
        """Return what an operator should know although the service answers; None if nothing."""
        failure = self._failure
        if failure is None:
            return None
        return (
            f"The database failed, so maps are as they were {self.lag():.0f} s ago and cannot be "
            "written; see the log for the reason."
        )

    def catch_up(self, name: str, before: float | None = None) -> None:
        """Load what was written to a map before a time, if it is not in memory.

        Args:
            name: name of the map.
            before: time of `time.monotonic`; a look at the store that began later is enough. Now
                unless given.

        Raises:
            StoreError: the store cannot tell which version is the newest.
            Problem: 503 if another thread loads the map for long.
        """
        if not self._maps.serves(name):
            return
        before = monotonic() if before is None else before
        with self._alone(name):
            if self._looked.get(name, -inf) >= before:
                return
            is_level = False
            while not is_level:
                begun = monotonic()
                found = self._store.find(name)
                is_level = self._is_level(name, found)
            if found is None:
                self._looked.pop(name, None)
            else:
                self._looked[name] = begun

    def catch_up_all(self) -> None:
        """Load the newest versions of all maps; raises as `catch_up` does."""
        for name in self._outdated(self._store.shared_maps()):
            self.catch_up(name)

    def has_all(self, seen: str) -> bool:
        """Return whether all versions of a header `Placecell-Seen` are here; 422 if it is wrong."""
        return all(
            not self._maps.serves(name) or self._has(name, tag) for name, tag in seen_versions(seen)
        )

    def catch_up_with(self, seen: str) -> None:
        """Load the versions that a client has seen, as the header `Placecell-Seen` names them.

        Raises:
            Problem: 422 if the header is invalid, 503 if the versions cannot be loaded now.
        """
        for name, tag in seen_versions(seen):
            if not self._maps.serves(name) or self._has(name, tag):
                continue
            if self._failure is not None:  # do not wait for a database that is known to be away
                raise _behind(name, tag)
            try:
                self.catch_up(name)
            except StoreError as error:
                logger.warning("map %r: the version %s is not here: %s", name, tag, error)
                raise _behind(name, tag) from error

    def poll(self) -> None:
        """Look at all maps and load the outdated ones; log the maps that cannot be loaded.

        Raises:
            StoreError: the store failed.
        """
        now = monotonic()
        outdated = self._outdated(self._store.shared_maps())
        if outdated and self._behind_since is None:
            self._behind_since = now
        left = [name for name in outdated if not self._follow(name)]
        if not left:
            self._level_at, self._behind_since = now, None
        self._failure = None

    def _work(self) -> None:
        while not self._stopped.is_set():
            try:
                with self._store.listen() as wait:
                    self._listen(wait)
            except StoreError as error:
                if self._failure is None:
                    logger.error("the database failed; maps are served from memory: %s", error)
                self._failure = error
            except Exception:
                logger.exception("following the database failed")
            self._stopped.wait(PAUSE_SECONDS)

    def _listen(self, wait: Callable[[float], set[str]]) -> None:
        self.poll()  # what was written before
        polled = monotonic()
        while not self._stopped.is_set():
            left = max(0.0, polled + self._poll_seconds - monotonic())
            names = wait(left)
            if "" not in names:
                for name in sorted(names):
                    self._follow(name)
            if "" in names or monotonic() - polled >= self._poll_seconds:
                self.poll()
                polled = monotonic()

    def _follow(self, name: str) -> bool:
        try:
            self.catch_up(name)
        except Problem as problem:  # another thread loads the map
            logger.warning("map %r is not level with the database yet: %s", name, problem)
            return False
        return True

    def _outdated(self, found: Collection[SharedMap]) -> list[str]:
        """Return the names of the maps whose state in memory differs."""
        served = {each.head.name: each for each in found if self._maps.serves(each.head.name)}
        here = {each.name for each in self._maps.entries()} | {*self._maps.damaged()}
        gone = here - served.keys()
        changed = {name for name, each in served.items() if not self._is_same(name, each)}
        return sorted(gone | changed)

    def _is_same(self, name: str, found: SharedMap) -> bool:
        damaged = self._maps.damaged_head(name)
        known = damaged or self._head_of(name)
        return known == found.head and self._annotated.get(found.head.uid, 0) == found.annotated

    def _head_of(self, name: str) -> object:
        snapshot = self._maps.peek(name)
        return None if snapshot is None else snapshot.head

    def _has(self, name: str, tag: str) -> bool:
        if tag == GONE:
            return self._maps.peek(name) is None
        return self._maps.has_had(name, tag)

    @contextmanager
    def _alone(self, name: str) -> Iterator[None]:
        """Let one thread load a map; the others find it loaded."""
        with self._guard:
            lock = self._locks.setdefault(name, Lock())
        if not lock.acquire(timeout=WAIT_SECONDS):
            raise _behind(name, "")
        try:
            yield
        finally:
            lock.release()

    def _is_level(self, name: str, found: SharedMap | None) -> bool:
        """Bring a map to a state of the store; return False if it must be looked at again."""
        before = self._maps.peek(name)
        if found is None:
            if self._maps.damaged_head(name) is not None:
                self._maps.exchange_damaged(name, None)
            if before is None:
                return True
            is_gone = self._maps.exchange(before, None)
            if is_gone:
                self._annotated.pop(before.head.uid, None)
                self._maps.on_delete(before.head.uid)
            return is_gone
        uid = found.head.uid
        if not self._load(name, found):
            return False
        if self._annotated.get(uid, 0) != found.annotated:
            self._on_annotations(uid)
            self._annotated[uid] = found.annotated
        if before is not None and before.head.uid != uid:
            self._annotated.pop(before.head.uid, None)
            self._maps.on_delete(before.head.uid)
        return True

    def _load(self, name: str, found: SharedMap) -> bool:
        """Load a map that differs; return False if it was changed meanwhile."""
        before = self._maps.peek(name)
        if isinstance(before, ColdMap) and before.head.mark == found.head.mark:
            # It has the same segments, so it stays where it is.
            return self._maps.exchange(before, replace(before, head=found.head))
        if (before is not None and before.head == found.head) or (
            self._maps.damaged_head(name) == found.head
        ):
            return True
        try:
            warm = before if isinstance(before, MapSnapshot) else None
            found_now = newest(self._maps, self._store, found.head, warm)
            after: MapEntry = found_now
            if isinstance(before, ColdMap):
                after = ColdMap.of(found_now)  # no request asked for it
        except KeyError:  # it was deleted meanwhile
            return False
        except (StoreError, MapFileError) as error:
            if isinstance(error, StoreError) and error.kind != "damaged":
                raise
            logger.error("map %r is damaged and not served: %s", name, error)
            self._maps.exchange_damaged(name, found.head)
            return True
        return self._maps.exchange(before, after)


def seen_versions(header: str) -> list[tuple[str, str]]:
    """Return the maps and tags of a header `Placecell-Seen: MAP ETAG, MAP ETAG`; 422 if invalid."""
    found = []
    for part in filter(None, (each.strip() for each in header.split(","))):
        match = _SEEN.fullmatch(part)
        if match is None:
            raise Problem(
                422,
                "invalid-request",
                f"Invalid Placecell-Seen {part!r:.80}: expected the name of a map, a space, and an "
                f"ETag, or {GONE} for a deleted map; a comma separates several.",
            )
        found.append((match[1], match[2]))
    return found


def behind() -> Problem:
    """Return the problem of a request whose versions could not be loaded in time."""
    return _behind("", "")


def _behind(name: str, tag: str) -> Problem:
    version = f"version {tag}" if tag else "the newest version"
    of = f" of map {name!r:.80}" if name else "s of the maps"
    return Problem(
        503,
        "replica-behind",
        f"This service does not have {version}{of} yet. Try again soon, at this or another "
        "service.",
        headers={"Retry-After": "1"},
    )
