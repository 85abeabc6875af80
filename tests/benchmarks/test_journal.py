"""Journal of a writer against the versions that are found after a crash."""

import pytest

from benchmarks.durability.journal import Discrepancy, Journal
from benchmarks.durability.map_versions import VersionFile, VersionHistory


def history(*files: bytes, first: int = 1) -> VersionHistory:
    """Return a history with these files, as a service returns it."""
    return VersionHistory(
        tuple(
            VersionFile(number, file, f"tag-{number}") for number, file in enumerate(files, first)
        )
    )


@pytest.fixture
def journal() -> Journal:
    """Journal of a map with two acknowledged versions."""
    made = Journal("yard")
    made.begin("put", VersionHistory.begun(b"a"))
    made.acknowledge("tag-1")
    assert made.known is not None
    made.begin("edit", made.known.after(b"b"))
    made.acknowledge("tag-2")
    return made


def test_acknowledged_versions_settle_without_discrepancy(journal: Journal) -> None:
    assert journal.known == history(b"a", b"b")
    assert journal.settle(history(b"a", b"b")) == Discrepancy()
    assert journal.acknowledged == {"put": 1, "edit": 1}
    assert journal.landed == 0


def test_write_in_flight_may_have_taken_effect_or_not(journal: Journal) -> None:
    for found in (history(b"a", b"b"), history(b"a", b"b", b"c"), history(b"a", b"b", b"c", b"d")):
        assert journal.known is not None
        journal.begin("edit", journal.known.after(b"c" if len(found.versions) < 4 else b"d"))
        assert journal.settle(found) == Discrepancy()
        assert journal.known == found
        assert journal.in_flight is None
    assert journal.landed == 2


def test_write_that_changes_nothing_makes_no_version(journal: Journal) -> None:
    assert journal.known is not None
    assert journal.known.after(b"b") is journal.known


@pytest.mark.parametrize(
    ("found", "lost", "half"),
    [
        (None, 2, 0),
        (history(b"a"), 1, 0),
        (history(b"a", b"x"), 1, 1),
        (history(b"x", b"b"), 1, 1),
        (history(b"b", first=2), 1, 0),
        (history(b"a", b"b", b"c"), 0, 1),
        (VersionHistory((VersionFile(1, b"a", "tag-1"), VersionFile(2, b"b", "other"))), 1, 1),
    ],
)
def test_any_other_history_is_a_discrepancy(
    journal: Journal, found: VersionHistory | None, lost: int, half: int
) -> None:
    difference = journal.settle(found)
    assert (difference.lost, difference.half) == (lost, half)
    assert "Map 'yard'" in difference.fault


def test_version_that_a_write_in_flight_drops_is_not_lost(journal: Journal) -> None:
    assert journal.known is not None
    journal.begin("compact", journal.known.shortened(1))
    assert journal.settle(history(b"b", first=2)) == Discrepancy()
    journal.begin("delete", None)
    assert journal.settle(None) == Discrepancy()
    assert journal.known is None
    journal.begin("put", VersionHistory.begun(b"c"))
    assert journal.settle(history(b"d")).half == 1


def test_versions_of_two_moments_are_half_seen(journal: Journal) -> None:
    """Each version existed, but the write drops the older ones: it took effect in part."""
    assert journal.known is not None
    journal.begin("put", history(b"c", first=3))
    difference = journal.settle(history(b"a", b"b", b"c"))
    assert (difference.lost, difference.half) == (0, 1)


def test_journal_knows_every_file_that_the_map_may_have_had(journal: Journal) -> None:
    assert journal.has_been(b"a")
    assert journal.has_been(b"b")
    assert not journal.has_been(b"c")
    journal.begin("edit", history(b"a", b"b", b"c"))
    assert journal.has_been(b"c")
