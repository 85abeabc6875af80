"""Tests of the database's servers and of the link to them; real servers, no replicas."""

import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from benchmarks.replicas.commit_cutter import CommitCutter
from benchmarks.replicas.missing_tool import MissingToolError, postgres_binaries
from benchmarks.replicas.postgres_pair import PostgresPair

pytestmark = [pytest.mark.integration, pytest.mark.slow]
psycopg = pytest.importorskip("psycopg", reason="needs psycopg: pip install 'placecell[postgres]'")


@pytest.fixture(scope="module")
def pair() -> Iterator[PostgresPair]:
    try:
        postgres_binaries()
    except MissingToolError as error:
        pytest.skip(str(error))
    folder = Path(tempfile.mkdtemp(prefix="placecell-pair-"))
    database = PostgresPair(folder)
    try:
        database.start("placecell")
        yield database
    finally:
        database.stop()
        shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture(scope="module")
def cutters(pair: PostgresPair) -> Iterator[list[CommitCutter]]:
    first, second = (CommitCutter(node.port) for node in pair.nodes)
    with first.running(), second.running():
        yield [first, second]


@pytest.fixture(scope="module")
def url(cutters: list[CommitCutter]) -> str:
    hosts = ",".join(f"127.0.0.1:{each.port}" for each in cutters)
    return (
        f"postgresql://placecell@{hosts}/placecell?target_session_attrs=read-write"
        "&connect_timeout=5"
    )


def test_connection_is_cut_after_the_commit(
    pair: PostgresPair, cutters: list[CommitCutter], url: str
) -> None:
    with psycopg.connect(url) as connection:
        connection.execute("CREATE TABLE cut (number int)")
    cutter = cutters[pair.nodes.index(pair.primary)]
    cutter.arm()
    connection = psycopg.connect(url)
    connection.execute("INSERT INTO cut VALUES (1)")
    with pytest.raises(psycopg.OperationalError):
        connection.commit()
    connection.close()
    assert cutter.cuts == 1
    with psycopg.connect(url) as connection:
        assert connection.execute("SELECT number FROM cut").fetchall() == [(1,)]
        connection.rollback()
    assert cutter.disarm() is False


def test_committed_rows_survive_a_crash_of_the_primary(pair: PostgresPair, url: str) -> None:
    before = pair.primary
    with psycopg.connect(url) as connection:
        connection.execute("CREATE TABLE kept (number int)")
        connection.execute("INSERT INTO kept VALUES (7)")
    assert pair.wait_settled()
    pair.crash_primary()
    begun = time.monotonic()
    while True:
        try:
            with psycopg.connect(url) as connection:
                connection.execute("INSERT INTO kept VALUES (8)")
            break
        except psycopg.Error:
            assert time.monotonic() < begun + 30, pair.faults
            time.sleep(0.05)
    assert pair.wait_settled(), pair.faults
    assert pair.primary is not before
    assert pair.promotions == 1
    assert not pair.faults
    with psycopg.connect(url) as connection:
        rows = connection.execute("SELECT number FROM kept ORDER BY number").fetchall()
    assert rows == [(7,), (8,)]
    # The old primary follows the new one.
    assert pair.primary.has_synchronous_standby
    assert pair.standby.execute("SELECT pg_is_in_recovery()") == [(True,)]


def test_full_disk_refuses_rows_and_loses_none(pair: PostgresPair, url: str) -> None:
    if not pair.own_disks:
        pytest.skip(pair.why_no_disks)
    assert pair.wait_settled()
    with psycopg.connect(url) as connection:
        connection.execute("CREATE TABLE large (number int, content bytea)")
        connection.execute("INSERT INTO large VALUES (0, '')")
    refused: list[object] = []

    def write(_: float) -> bool:
        """Write while the disk is full, in place of a wait."""
        try:
            with psycopg.connect(url) as connection:
                for number in range(1, 500):
                    connection.execute(
                        "INSERT INTO large SELECT %s, decode(string_agg(md5(i::text), ''), 'hex') "
                        "FROM generate_series(%s, %s) i",
                        (number, 4_000 * number, 4_000 * number + 3_999),
                    )
        except psycopg.Error as error:
            refused.append(error)
        return True

    pair._ended.wait, wait = write, pair._ended.wait  # type: ignore[method-assign,assignment]
    try:
        pair.fill_disk(1.0)
    finally:
        pair._ended.wait = wait  # type: ignore[method-assign]
    assert refused
    until = time.monotonic() + 60
    while True:
        try:
            with psycopg.connect(url) as connection:
                rows = connection.execute("SELECT number FROM large").fetchall()
                connection.execute("INSERT INTO large VALUES (1, '')")
            break
        except psycopg.Error:
            assert time.monotonic() < until, pair.faults
            time.sleep(0.1)
    assert rows == [(0,)]
