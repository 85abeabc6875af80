"""Quotas: limits on stored maps, segments, robots and bytes."""

from collections import Counter
from dataclasses import dataclass, field

from service.core.problems import Problem
from service.core.settings import Limits
from service.maps.snapshot import MapEntry, MapSnapshot
from service.maps.store import MapHead

ADVICE = (
    "Delete maps, or drop old versions (POST /maps/MAP/compact); both are always possible. "
    "The service also drops old versions by itself within seconds."
)


class OverQuotaError(Problem):
    """The write would exceed a quota.

    Attributes:
        whole: the detail for a key of all maps; the detail of the problem itself reveals
            nothing about maps outside the scope of the key.
    """

    def __init__(self, detail: str, whole: str | None = None) -> None:
        super().__init__(507, "quota-exceeded", detail)
        self.whole = whole or detail


class NoRoomError(OverQuotaError):
    """The write would exceed the stored bytes of a map or of all maps."""


@dataclass(slots=True)
class Usage:
    """Usage counters, updated by each write, so that no write reads all maps.

    Attributes:
        maps: number of maps.
        bytes: bytes of all maps in the store, with their old versions.
        by_key: number of maps that each key has created, by the key's name. A map counts for the
            key that wrote its oldest kept version.
        robots: number of segments that each robot has in the newest versions of all maps.
    """

    maps: int = 0
    bytes: int = 0
    by_key: Counter[str] = field(default_factory=Counter)
    robots: Counter[str] = field(default_factory=Counter)

    def add(self, head: MapHead, snapshot: MapEntry | None = None) -> None:
        """Count a map; a damaged map has a head only."""
        self._count(head, snapshot, 1)

    def remove(self, head: MapHead, snapshot: MapEntry | None = None) -> None:
        """Stop counting a map."""
        self._count(head, snapshot, -1)

    def _count(self, head: MapHead, snapshot: MapEntry | None, sign: int) -> None:
        self.maps += sign
        self.bytes += sign * head.bytes
        _add(self.by_key, head.author, sign)
        for robot, segments in (snapshot.robots if snapshot is not None else {}).items():
            _add(self.robots, robot, sign * segments)


@dataclass(frozen=True, slots=True)
class Quotas:
    """Quotas from the settings.

    Attributes:
        limits: limits of the settings.
    """

    limits: Limits

    def check_new(self, usage: Usage, author: str, robots: Counter[str], size: int) -> None:
        """Check that a map may be created.

        Args:
            usage: usage before the write.
            author: name of the key that creates the map.
            robots: number of segments that each robot will have in the map.
            size: bytes of the map file.

        Raises:
            OverQuotaError: a quota would be exceeded.
        """
        limits = self.limits
        if usage.maps >= limits.maps:
            raise OverQuotaError(
                f"The service holds {usage.maps} maps; the limit is {limits.maps}. Delete maps."
            )
        if usage.by_key[author] >= limits.key_maps:
            raise OverQuotaError(
                f"This key has created {usage.by_key[author]} maps; the limit is "
                f"{limits.key_maps}. Delete some, or write to an existing map."
            )
        self._check_robots(usage, Counter(), robots)
        self._check_bytes(usage, 0, size)

    def check_write(
        self, usage: Usage, old: MapSnapshot, robots: Counter[str], sources: int, size: int
    ) -> None:
        """Check that a version may be added; removal of segments is never refused.

        Args:
            usage: usage before the write.
            old: the map before the write.
            robots: number of segments that each robot will have in the map.
            sources: number of source maps that the map will name.
            size: bytes of the commit; 0 if it only removes segments.

        Raises:
            OverQuotaError: a quota would be exceeded.
        """
        self._check_robots(usage, old.layers.robots, robots)
        self._check_names("sources", len(old.layers.sources), sources)
        if size:
            self._check_bytes(usage, old.head.bytes, size)

    def _check_robots(self, usage: Usage, before: Counter[str], new: Counter[str]) -> None:
        limits = self.limits
        if new.total() > max(limits.map_segments, before.total()):
            raise OverQuotaError(
                f"The map would have {new.total()} segments; the limit is {limits.map_segments}. "
                "Remove segments, or write to another map."
            )
        self._check_names("robots", len(before), len(new))
        for robot in new:
            if new[robot] <= before[robot]:
                continue
            total = usage.robots[robot] - before[robot] + new[robot]
            if total > limits.robot_segments:
                limit = f"the limit is {limits.robot_segments}. Remove segments of this robot."
                raise OverQuotaError(
                    f"Robot {robot!r:.80} would have too many segments in all maps; {limit}",
                    f"Robot {robot!r:.80} would have {total} segments in all maps; {limit}",
                )

    def _check_names(self, kind: str, before: int, new: int) -> None:
        limit = self.limits.map_robots
        if new > max(limit, before):
            raise OverQuotaError(
                f"The map would name {new} {kind}; the limit is {limit}. Write to another map."
            )

    def _check_bytes(self, usage: Usage, before: int, size: int) -> None:
        limits = self.limits
        if before + size > limits.map_stored_bytes:
            raise NoRoomError(
                f"The map would take {before + size} bytes in the store, with its old versions; "
                f"the limit is {limits.map_stored_bytes}. {ADVICE}"
            )
        if usage.bytes + size > limits.stored_bytes:
            limit = f"the limit is {limits.stored_bytes} bytes. {ADVICE}"
            raise NoRoomError(
                f"The store would hold too much, with old versions; {limit}",
                f"The store would hold {usage.bytes + size} bytes, with old versions; {limit}",
            )


def _add(counts: Counter[str], name: str, number: int) -> None:
    """Add to a count; drop names whose count is zero."""
    counts[name] += number
    if not counts[name]:
        del counts[name]
