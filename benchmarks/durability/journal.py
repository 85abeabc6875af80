"""What a writer knows of its map: what was acknowledged, and what may have happened since."""

import hashlib
from collections import Counter
from dataclasses import dataclass, field

from benchmarks.durability.map_versions import MapVersion, VersionHistory


@dataclass(frozen=True, slots=True)
class PendingWrite:
    """A write whose answer has not come.

    Attributes:
        operation: what it does.
        outcome: the map after it; None: there is none.
    """

    operation: str
    outcome: VersionHistory | None


@dataclass(frozen=True, slots=True)
class Discrepancy:
    """How a map that was found is other than it must be.

    Attributes:
        lost: versions that were acknowledged, and are not there or not as they were.
        half: versions, or sets of versions, that never were.
        told: which; empty if all is well.
    """

    lost: int = 0
    half: int = 0
    told: str = ""


@dataclass(slots=True)
class Journal:
    """Of one map that has one writer.

    Attributes:
        name: of the map.
        known: the map after the last write that was acknowledged; None: there is none.
        in_flight: the write after that, if one was sent.
        acknowledged: how many were, by operation.
        landed: how many writes were done whose answer never came.
    """

    name: str
    known: VersionHistory | None = None
    in_flight: PendingWrite | None = None
    acknowledged: Counter[str] = field(default_factory=Counter)
    landed: int = 0
    _sent: set[bytes] = field(default_factory=set)

    def begin(self, operation: str, outcome: VersionHistory | None) -> None:
        """A write is about to be sent."""
        if outcome is not None:
            self._sent.add(hashlib.sha256(outcome.newest.file).digest())
        self.in_flight = PendingWrite(operation, outcome)

    def has_been(self, file: bytes) -> bool:
        """Whether the map ever was, or might have become, this file."""
        return hashlib.sha256(file).digest() in self._sent

    def acknowledge(self, tag: str | None = None) -> None:
        """The write was answered with success; the map is at the version of this tag."""
        assert self.in_flight is not None
        outcome = self.in_flight.outcome
        self.known = outcome.told(tag) if outcome is not None and tag is not None else outcome
        self.acknowledged[self.in_flight.operation] += 1
        self.in_flight = None

    def settle(self, found: VersionHistory | None) -> Discrepancy:
        """Hold what is there after a crash against what was acknowledged, and go on from there.

        The map must be as after the last write that was acknowledged, or as after the one in
        flight, version by version.
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
            # If all versions are real, they are not all of one moment.
            len(made_up) or int(not lost),
            f"map {self.name!r}: versions {lost} lost, {made_up} never were; "
            f"{[each.sequence for each in there]} found; {operation} was in flight",
        )


def _is_same(expected: VersionHistory | None, found: VersionHistory | None) -> bool:
    return found is None if expected is None else expected.is_past(found)


def _versions(past: VersionHistory | None) -> tuple[MapVersion, ...]:
    return past.versions if past is not None else ()


def _is_in(version: MapVersion, there: tuple[MapVersion, ...]) -> bool:
    return any(version.is_version(each) for each in there)
