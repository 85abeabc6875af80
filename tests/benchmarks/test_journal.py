"""What a writer's journal says of a map that is found after a crash."""

import pytest

from benchmarks.durability.journal import Discrepancy, Journal
from benchmarks.durability.map_versions import MapVersion, VersionHistory


def past(*files: bytes, first: int = 1) -> VersionHistory:
    """As a service tells it."""
    return VersionHistory(
        tuple(MapVersion(number, file, f"tag-{number}") for number, file in enumerate(files, first))
    )


@pytest.fixture
def journal() -> Journal:
    """Of a map with two versions that were acknowledged."""
    made = Journal("yard")
    made.begin("put", VersionHistory.begun(b"a"))
    made.acknowledge("tag-1")
    assert made.known is not None
    made.begin("edit", made.known.after(b"b"))
    made.acknowledge("tag-2")
    return made


def test_what_was_acknowledged_is_as_it_must_be(journal: Journal) -> None:
    assert journal.known == past(b"a", b"b")
    assert journal.settle(past(b"a", b"b")) == Discrepancy()
    assert journal.acknowledged == {"put": 1, "edit": 1}
    assert journal.landed == 0


def test_a_write_in_flight_may_have_been_done_or_not(journal: Journal) -> None:
    for found in (past(b"a", b"b"), past(b"a", b"b", b"c"), past(b"a", b"b", b"c", b"d")):
        assert journal.known is not None
        journal.begin("edit", journal.known.after(b"c" if len(found.versions) < 4 else b"d"))
        assert journal.settle(found) == Discrepancy()
        assert journal.known == found
        assert journal.in_flight is None
    assert journal.landed == 2


def test_a_write_that_changes_nothing_makes_no_version(journal: Journal) -> None:
    assert journal.known is not None
    assert journal.known.after(b"b") is journal.known


@pytest.mark.parametrize(
    ("found", "lost", "half"),
    [
        (None, 2, 0),
        (past(b"a"), 1, 0),
        (past(b"a", b"x"), 1, 1),
        (past(b"x", b"b"), 1, 1),
        (past(b"b", first=2), 1, 0),
        (past(b"a", b"b", b"c"), 0, 1),
        (VersionHistory((MapVersion(1, b"a", "tag-1"), MapVersion(2, b"b", "other"))), 1, 1),
    ],
)
def test_all_else_is_told(
    journal: Journal, found: VersionHistory | None, lost: int, half: int
) -> None:
    verdict = journal.settle(found)
    assert (verdict.lost, verdict.half) == (lost, half)
    assert "map 'yard'" in verdict.told


def test_what_a_write_in_flight_may_take_away_is_not_lost(journal: Journal) -> None:
    assert journal.known is not None
    journal.begin("compact", journal.known.shortened(1))
    assert journal.settle(past(b"b", first=2)) == Discrepancy()
    journal.begin("delete", None)
    assert journal.settle(None) == Discrepancy()
    assert journal.known is None
    journal.begin("put", VersionHistory.begun(b"c"))
    assert journal.settle(past(b"d")).half == 1


def test_versions_of_two_moments_are_half_seen(journal: Journal) -> None:
    """Each is real; but a write that drops the older ones and adds one was not done whole."""
    assert journal.known is not None
    journal.begin("put", past(b"c", first=3))
    verdict = journal.settle(past(b"a", b"b", b"c"))
    assert (verdict.lost, verdict.half) == (0, 1)


def test_it_knows_every_file_that_the_map_may_have_been(journal: Journal) -> None:
    assert journal.has_been(b"a")
    assert journal.has_been(b"b")
    assert not journal.has_been(b"c")
    journal.begin("edit", past(b"a", b"b", b"c"))
    assert journal.has_been(b"c")
