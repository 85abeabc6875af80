"""Ownership of ids: which key wrote or reserved each run of ids of a map last."""

import hashlib
import json
from collections.abc import Iterable, Sequence

import numpy as np

from service.maps.sql.rows import Rows
from service.maps.store import IDS, OwnedIds, Owner, StoreError

CLOSED = 16_384
"""Largest gap of unowned ids between two written ids that becomes the writer's. Without it, a map
with scattered ids would have one run per id."""

Run = tuple[int, int]
"""First id and exclusive end of a run."""


class Owners:
    """Owners of one map's ids, within a transaction."""

    def __init__(self, rows: Rows, row: int) -> None:
        self._rows = rows
        self._row = row

    def write(self, runs: Sequence[Run], author: str) -> None:
        """Note that a key wrote these ids; runs ascend and do not overlap."""
        self._paint(runs, author, None)

    def reserve(self, first: int, until: int, author: str, now: float) -> None:
        """Note that a key reserved ids."""
        self._paint([(first, until)], author, now)

    def reserved(self, author: str, since: float) -> int:
        """Count the ids that a key has reserved since a time and not written."""
        (count,) = self._rows.execute(
            "SELECT coalesce(sum(until - first), 0) FROM owners "
            "WHERE map = ? AND author = ? AND reserved > ?",
            (self._row, author, since),
        ).fetchone()
        return int(count)

    def of(self, ids: Iterable[int]) -> list[Owner | None]:
        """Return the owner of each of these ascending ids."""
        wanted = np.fromiter(ids, np.int64)
        if not len(wanted):
            return []
        owned = self._within(int(wanted[0]), int(wanted[-1]) + 1)
        if not owned:
            return [None] * len(wanted)
        places = np.searchsorted([each.first for each in owned], wanted, "right") - 1
        found: list[Owner | None] = []
        for id_, place in zip(wanted.tolist(), places.tolist(), strict=True):
            each = owned[place] if place >= 0 else None
            is_in = each is not None and id_ < each.until
            found.append(Owner(each.author, each.reserved is not None) if each and is_in else None)
        return found

    def largest_gap(self) -> Run:
        """Return the largest run of ids that were never written or reserved; it may be empty."""
        best, at = (0, 0), 0
        for each in self._within(0, IDS):
            best = max(best, (at, each.first), key=_length)
            at = max(at, each.until)
        return max(best, (at, IDS), key=_length)

    def keep_only(self, used: Iterable[int]) -> None:
        """Forget reservations, and owners of ids outside `used`, which ascends."""
        ids = np.fromiter(used, np.int64)
        kept = []
        for each in self._within(0, IDS):
            begin, end = np.searchsorted(ids, [each.first, each.until])
            if end > begin:
                kept.append(OwnedIds(int(ids[begin]), int(ids[end - 1]) + 1, each.author, None))
        self._rows.execute("DELETE FROM owners WHERE map = ?", (self._row,))
        self.insert(kept)

    def all(self) -> list[OwnedIds]:
        """Return all ascending runs; StoreError if one was altered."""
        return self._read(
            "SELECT first, until, author, reserved, digest FROM owners WHERE map = ? "
            "ORDER BY first",
            self._row,
        )

    def _within(self, first: int, until: int) -> list[OwnedIds]:
        """Return the ascending runs that overlap these ids."""
        found = self._read(
            "SELECT first, until, author, reserved, digest FROM owners WHERE map = ? AND "
            "first < ? AND first >= coalesce((SELECT max(first) FROM owners "
            "WHERE map = ? AND first <= ?), ?) ORDER BY first",
            self._row,
            until,
            self._row,
            first,
            first,
        )
        return [each for each in found if each.until > first]

    def _read(self, query: str, *values: int) -> list[OwnedIds]:
        found = []
        for *columns, digest in self._rows.execute(query, values):
            each = OwnedIds(*columns)
            if digest != _digest_of(self._row, each):
                raise StoreError("damaged", "a row of the table owners was altered")
            found.append(each)
        return found

    def _paint(self, runs: Sequence[Run], author: str, reserved: float | None) -> None:
        if not runs:
            return
        # One more id on either side joins the run with adjacent runs of the key.
        low, high = max(runs[0][0] - 1, 0), min(runs[-1][1] + 1, IDS)
        owned = self._within(low, high)
        own = [OwnedIds(*run, author, reserved) for run in _closed(runs, owned)]
        starts = np.array([each.first for each in own])
        ends = np.array([each.until for each in own])
        left = []
        for each in owned:
            at = each.first
            begin = int(np.searchsorted(ends, each.first, "right"))
            end = int(np.searchsorted(starts, each.until, "left"))
            for run in own[begin:end]:
                if at < run.first:
                    left.append(OwnedIds(at, run.first, each.author, each.reserved))
                at = max(at, run.until)
            if at < each.until:
                left.append(OwnedIds(at, each.until, each.author, each.reserved))
        self._rows.executemany(
            "DELETE FROM owners WHERE map = ? AND first = ?",
            [(self._row, each.first) for each in owned],
        )
        self.insert(_joined(sorted([*left, *own], key=lambda each: each.first)))

    def insert(self, owned: Iterable[OwnedIds]) -> None:
        """Add runs that overlap no present one."""
        self._rows.executemany(
            "INSERT INTO owners VALUES (?, ?, ?, ?, ?, ?)",
            [
                (
                    self._row,
                    each.first,
                    each.until,
                    each.author,
                    each.reserved,
                    _digest_of(self._row, each),
                )
                for each in owned
            ],
        )


def _digest_of(row: int, owned: OwnedIds) -> str:
    """Hash a run of a map, so that an altered run is noticed."""
    fields = [row, owned.first, owned.until, owned.author, owned.reserved]
    return hashlib.sha256(json.dumps(fields).encode()).hexdigest()[:16]


def _length(run: Run) -> int:
    return run[1] - run[0]


def _closed(runs: Sequence[Run], owned: Sequence[OwnedIds]) -> list[Run]:
    """Join runs whose gaps are small and unowned."""
    starts = np.array([run[0] for run in runs])
    ends = np.array([run[1] for run in runs])
    before = np.searchsorted([each.until for each in owned], ends[:-1], "right")
    after = np.searchsorted([each.first for each in owned], starts[1:], "left")
    apart = (starts[1:] - ends[:-1] > CLOSED) | (before < after)
    first = np.concatenate([[True], apart])
    last = np.concatenate([apart, [True]])
    return list(zip(starts[first].tolist(), ends[last].tolist(), strict=True))


def _joined(owned: Iterable[OwnedIds]) -> list[OwnedIds]:
    """Join adjacent runs of one owner."""
    joined: list[OwnedIds] = []
    for each in owned:
        last = joined[-1] if joined else None
        if last and (last.until, last.author, last.reserved) == (
            each.first,
            each.author,
            each.reserved,
        ):
            joined[-1] = OwnedIds(last.first, each.until, each.author, each.reserved)
        else:
            joined.append(each)
    return joined
