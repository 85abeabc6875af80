"""Journal of a writer: acknowledged writes, and the write whose answer is missing."""

import hashlib
from collections import Counter
from dataclasses import dataclass, field

from benchmarks.durability.map_versions import VersionFile, VersionHistory


@dataclass(frozen=True, slots=True)
class PendingWrite:
    """A write that was sent and not yet acknowledged.

    Attributes:
        operation: name of the operation.
        outcome: versions of the map after the write; None: the write deletes the map.
    """

    operation: str
    outcome: VersionHistory | None


@dataclass(frozen=True, slots=True)
class Discrepancy:
    """Difference between the versions of a map and those that the journal expects.

    Attributes:
        lost: number of acknowledged versions that are missing or changed.
        half: number of versions, or sets of versions, that never existed.
        fault: description; empty if there is no difference.
    """

    lost: int = 0
    half: int = 0
    fault: str = ""


@dataclass(slots=True)
class Journal:
    """Journal of one map with one writer.

    Attributes:
        name: name of the map.
        known: versions after the last acknowledged write; None: there is no map.
        in_flight: the write that was sent since, if any.
        acknowledged: number of acknowledged writes, by operation.
        landed: number of writes that took effect although their answer was lost.
    """

    name: str
    known: VersionHistory | None = None
    in_flight: PendingWrite | None = None
    acknowledged: Counter[str] = field(default_factory=Counter)
    landed: int = 0
    _sent: set[bytes] = field(default_factory=set)

    def begin(self, operation: str, outcome: VersionHistory | None) -> None:
        """Record a write before it is sent."""
        if outcome is not None:
            self._sent.add(hashlib.sha256(outcome.newest.file).digest())
        self.in_flight = PendingWrite(operation, outcome)

    def has_been(self, file: bytes) -> bool:
        """Return whether this file ever was, or may have become, a version of the map."""
        return hashlib.sha256(file).digest() in self._sent

    def acknowledge(self, tag: str | None = None) -> None:
        """Record that the write was acknowledged; `tag` is the ETag of the new version."""
        assert self.in_flight is not None
        outcome = self.in_flight.outcome
        self.known = outcome.tagged(tag) if outcome is not None and tag is not None else outcome
        self.acknowledged[self.in_flight.operation] += 1
        self.in_flight = None

    def settle(self, found: VersionHistory | None) -> Discrepancy:
        """Compare the versions found after a crash with the journal, and continue from them.

        The map must have the versions after the last acknowledged write, or those after the write
        in flight.
        """
        write, known = self.in_flight, self.known
        self.in_flight, self.known = None, found
        if _is_same(known, found):
            return Discrepancy()
        if write is not None and _is_same(write.outcome, found):
            self.landed += 1
            return Discrepancy()
        before, there = _versions(known), _versions(found)
        after = _versions(write.outcome) if write is not None else before
        lost = [each.sequence for each in before if each in after and not _is_in(each, there)]
        made_up = [
            each.sequence
            for each in there
            if not any(version.is_version(each) for version in (*before, *after))
        ]
        operation = write.operation if write is not None else "nothing"
        return Discrepancy(
            len(lost),
            # If all versions existed, they did not exist at one moment.
            len(made_up) or int(not lost),
            f"Map {self.name!r} has versions {[each.sequence for each in there]}: {lost} were "
            f"lost, {made_up} never existed. In flight: {operation}.",
        )


def _is_same(expected: VersionHistory | None, found: VersionHistory | None) -> bool:
    return found is None if expected is None else expected.is_past(found)


def _versions(history: VersionHistory | None) -> tuple[VersionFile, ...]:
    return history.versions if history is not None else ()


def _is_in(version: VersionFile, there: tuple[VersionFile, ...]) -> bool:
    return any(version.is_version(each) for each in there)
