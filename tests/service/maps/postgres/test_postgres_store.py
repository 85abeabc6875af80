"""Store on PostgreSQL: several services, lost connections, and versions of the tables."""

import asyncio
import builtins
import logging
import os
import signal
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import psycopg
import pytest
from psycopg.conninfo import conninfo_to_dict, make_conninfo

from benchmarks.durability.loopback_proxy import LoopbackProxy
from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from service.core.settings import Settings
from service.engine import StartError
from service.maps.postgres import database, watchdog
from service.maps.postgres.durability import durability_warnings
from service.maps.postgres.store import PostgresStore
from service.maps.postgres.tables import LAYOUT, SCHEMA
from service.maps.sql import operations
from service.maps.sqlite.store import SqliteMapStore
from service.maps.store import Annotation, Ids, MapHead, Note, StoreError
from service.maps.stores import open_store
from tests.service.postgres_server import PostgresServer

NOTE = Note(1.7e9, "ann", "edit", 3, 1)

COLUMN = f"ALTER TABLE {SCHEMA}.maps ADD COLUMN color text NOT NULL DEFAULT 'red'"


@pytest.fixture
def store(postgres_database: str) -> Iterator[PostgresStore]:
    with PostgresStore.opened(postgres_database) as opened:
        yield opened


@pytest.fixture
def quick(monkeypatch: pytest.MonkeyPatch) -> None:
    """Short waits."""
    monkeypatch.setattr(database, "RETRY_SECONDS", 0.3)
    monkeypatch.setattr(database, "POOL_SECONDS", 0.3)
    monkeypatch.setattr(watchdog, "TICK_SECONDS", 0.05)


def lose_commits(monkeypatch: pytest.MonkeyPatch, is_done: bool, count: int = 1) -> None:
    """Let the next commits lose their connection, before or after the server has committed."""
    left = [count]
    commit = psycopg.Connection.commit

    def lost(connection: psycopg.Connection[Any]) -> None:
        if not left[0] or connection.info.transaction_status.name != "INTRANS":
            commit(connection)
            return
        left[0] -= 1
        if is_done:
            commit(connection)
        connection.close()
        raise psycopg.OperationalError("server closed the connection unexpectedly")

    monkeypatch.setattr(psycopg.Connection, "commit", lost)


@pytest.mark.parametrize("is_done", [False, True])
def test_write_whose_answer_was_lost_is_stored_once(
    store: PostgresStore, monkeypatch: pytest.MonkeyPatch, is_done: bool
) -> None:
    lose_commits(monkeypatch, is_done)
    head = store.create("yard", b"file", NOTE, 0)
    assert store.heads() == [head]
    lose_commits(monkeypatch, is_done)
    second = store.append(head, b"one", NOTE, 0)
    assert store.heads() == [second]
    assert second.sequence == 2
    lose_commits(monkeypatch, is_done)
    store.annotate(head.uid, [Annotation("tag", "a", "{}", "ann", 1.0)])
    lose_commits(monkeypatch, is_done)
    assert store.compact(head.uid, 2, b"file of 2").oldest == 2
    lose_commits(monkeypatch, is_done)
    assert store.reserve(head.uid, 5) in {0, 5}
    assert store.verify() == []
    lose_commits(monkeypatch, is_done)
    store.delete(head.uid)
    assert store.heads() == []


def test_write_that_the_server_ended_for_idleness_is_repeated(
    store: PostgresStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The service was stopped within a write, so the server freed the map for the others."""
    head = store.create("yard", b"file", NOTE, 0)
    append, calls = operations.append_commit, list[Any]()

    def slow(rows: Any, *arguments: Any, **named: Any) -> MapHead:
        calls.append(arguments)
        if len(calls) == 1:
            limit = "SELECT set_config('idle_in_transaction_session_timeout', '50ms', true)"
            rows.execute(limit).fetchone()
            time.sleep(0.4)
        return append(rows, *arguments, **named)

    monkeypatch.setattr("service.maps.postgres.store.append_commit", slow)
    assert store.append(head, b"one", NOTE, 0).sequence == 2
    assert len(calls) == 2


@pytest.mark.parametrize("stopped", [False, True])
def test_write_that_nobody_waits_for_any_more_is_not_committed(
    store: PostgresStore, monkeypatch: pytest.MonkeyPatch, stopped: bool
) -> None:
    """The robot may have repeated its edit at another service, and edited on."""
    head = store.create("yard", b"file", NOTE, 0)
    append, token = operations.append_commit, CancelToken()

    def slow(rows: Any, *arguments: Any, **named: Any) -> MapHead:
        if stopped and not token.is_cancelled:
            token.cancel()
            limit = "SELECT set_config('idle_in_transaction_session_timeout', '50ms', true)"
            rows.execute(limit).fetchone()
            time.sleep(0.4)
        token.cancel()
        return append(rows, *arguments, **named)

    monkeypatch.setattr("service.maps.postgres.store.append_commit", slow)
    with cancelled_by(token), pytest.raises(Cancelled):
        store.append(head, b"one", NOTE, 0)
    assert [each.sequence for each in store.heads()] == [1]
    # The map is free for the others.
    monkeypatch.setattr("service.maps.postgres.store.append_commit", append)
    assert store.append(head, b"two", NOTE, 0).sequence == 2


def test_write_waits_for_a_locked_map_no_longer_than_its_request(
    store: PostgresStore, postgres_database: str
) -> None:
    """Else a request that nobody waits for would queue for the map, ahead of those that count."""
    head = store.create("yard", b"file", NOTE, 0)
    with psycopg.connect(postgres_database) as other:
        other.execute(f"SELECT 1 FROM {SCHEMA}.maps FOR UPDATE".encode())
        begun = time.monotonic()
        with (
            cancelled_by(CancelToken(begun + 0.3)),
            pytest.raises((StoreError, Cancelled)),
        ):
            store.append(head, b"one", NOTE, 0)
        assert time.monotonic() - begun < database.LOCK_SECONDS / 2
    assert store.append(head, b"two", NOTE, 0).sequence == 2


LOGIN = (196_608).to_bytes(4, "big")
"""Version of PostgreSQL's protocol, at the begin of a login."""


class TurnCounter(LoopbackProxy):
    """Link to a server that counts how often the client speaks after the server has.

    Attributes:
        turns: number of round trips of all connections.
        messages: number of the client's messages on all connections, from its login on.
    """

    def __init__(self, target: int) -> None:
        super().__init__()
        self.turns = 0
        self.messages = 0
        self._target = target

    async def connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        from_server, to_server = await asyncio.open_connection("127.0.0.1", self._target)
        is_answered = True

        async def requests() -> None:
            nonlocal is_answered
            is_logged_in = False
            # A message has a type and a length, which counts itself; the login has no type.
            with suppress(asyncio.IncompleteReadError):
                while head := await reader.readexactly(5 if is_logged_in else 4):
                    body = await reader.readexactly(int.from_bytes(head[-4:], "big") - 4)
                    self.messages += is_logged_in
                    is_logged_in = is_logged_in or body[:4] == LOGIN
                    self.turns += is_answered
                    is_answered = False
                    to_server.write(head + body)

        async def answers() -> None:
            nonlocal is_answered
            while chunk := await from_server.read(1 << 16):
                is_answered = True
                writer.write(chunk)

        try:
            both = [asyncio.create_task(requests()), asyncio.create_task(answers())]
            await asyncio.wait(both, return_when=asyncio.FIRST_COMPLETED)
        finally:
            to_server.transport.abort()
            writer.transport.abort()


def test_write_takes_few_round_trips(postgres_database: str) -> None:
    """A map is locked for as many round trips; each takes its time on a busy or distant machine."""
    server = conninfo_to_dict(postgres_database)
    counter = TurnCounter(int(str(server["port"])))
    with counter.running():
        url = make_conninfo(postgres_database, port=counter.port)
        with PostgresStore.opened(url, connections=1) as store:
            head = store.create("yard", b"file", NOTE, 0)

            def turns(call: Callable[[], object]) -> int:
                before = counter.turns
                call()
                time.sleep(0.05)
                return counter.turns - before

            first = Ids(((1, 5), (7, 9)), ((1, 5), (7, 9)))
            # Lock and head, owners, all writes, commit.
            assert turns(lambda: store.append(head, b"one", NOTE, 9, first)) == 4
            assert turns(lambda: store.find("yard")) == 1
            assert turns(lambda: store.owners(head.uid, [1, 8])) == 2
            assert [each and each.author for each in store.owners(head.uid, [1, 8])] == ["ann"] * 2
            # Each round trip of a write is one message. A service that is stopped between two
            # messages leaves a server that counts as idle, which frees the map.
            messages = counter.messages
            tag = Annotation("tag", "a", "{}", "ann", 1.0)
            assert turns(lambda: store.annotate(head.uid, [tag])) == counter.messages - messages


def test_commits_since_a_version_lead_to_a_later_one(store: PostgresStore) -> None:
    heads = [store.create("yard", b"file", NOTE, 0)]
    for blob in (b"one", b"two", b"three"):
        heads.append(store.append(heads[-1], blob, NOTE, 0))
    blobs = [b"one", b"two", b"three"]
    for begin, before in enumerate(heads):
        for head in heads[begin:]:
            found = store.commits_since(before, head)
            assert [blob for _, blob in found] == blobs[begin : head.sequence - 1]
            assert [before.mark, *(commit.mark for commit, _ in found)][-1] == head.mark
    # A write that adds no version changes the head only.
    store.reserve(heads[-1].uid, 5)
    assert store.commits_since(heads[-1], store.heads()[0]) == []


def test_commits_since_a_version_that_is_not_of_the_history_are_refused(
    store: PostgresStore, postgres_database: str
) -> None:
    first = store.create("yard", b"file", NOTE, 0)
    second = store.append(first, b"one", NOTE, 0)
    third = store.append(second, b"two", NOTE, 0)
    other = store.create("other", b"file", NOTE, 0)
    for before, head in [
        (third, second),  # it is older
        (other, second),  # it is of another map
        (replace(first, mark=other.mark), second),  # a fork
        (replace(second, mark=other.mark), second),  # a fork at the same version
        (first, replace(third, mark=other.mark)),
        (third, replace(third, sequence=4)),  # a version that is not there
    ]:
        with pytest.raises(KeyError):
            store.commits_since(before, head)
    store.compact(first.uid, 2, b"file of 2")
    assert [blob for _, blob in store.commits_since(second, third)] == [b"two"]
    with pytest.raises(KeyError):
        store.commits_since(first, third)
    with psycopg.connect(postgres_database) as other_client:
        other_client.execute(
            f"UPDATE {SCHEMA}.commits SET delta = 'too' WHERE sequence = 3".encode()
        )
    with pytest.raises(KeyError):
        store.commits_since(second, third)


def test_import_may_take_longer_than_other_writes(
    store: PostgresStore, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with SqliteMapStore.owned(tmp_path) as source:
        source.create("yard", b"file", NOTE, 0)
        with source.snapshot() as maps:
            monkeypatch.setattr(database, "STATEMENT_SECONDS", -1.0)  # each wait is too long
            monkeypatch.setattr(watchdog, "TICK_SECONDS", 0.01)
            run = operations.import_all

            def slow(rows: Any, *arguments: Any) -> list[MapHead]:
                rows.execute("SELECT pg_sleep(0.7)")
                return run(rows, *arguments)

            monkeypatch.setattr("service.maps.postgres.store.import_all", slow)
            assert [each.name for each in store.import_maps(maps, replaces=True)] == ["yard"]


def test_lost_connection_is_logged_in_plain_words(
    store: PostgresStore,
    postgres_server: PostgresServer,
    postgres_database: str,
    caplog: pytest.LogCaptureFixture,
) -> None:
    store.heads()  # the pool has connected
    postgres_server.execute(
        "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = "
        f"'{postgres_database.rpartition('/')[2]}'"
    )
    store.create("yard", b"file", NOTE, 0)
    assert "A connection to the database was lost" in caplog.text
    assert "psycopg" not in " ".join(each.getMessage() for each in caplog.records)


def test_failed_connections_are_logged_once_and_in_one_line(
    caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    pool = logging.getLogger("psycopg.pool")
    monkeypatch.setattr(pool, "filters", [database.PlainWords()])
    for _ in range(3):
        pool.warning("error connecting in %r: %s", "pool-1", OSError("refused\n\tIs it running?"))
        pool.warning("reconnection attempt in pool %r failed after %s sec", "pool-1", 2.0)
    assert [each.getMessage() for each in caplog.records] == [
        "The database accepts no connection: refused Is it running?"
    ]


def test_user_without_rights_is_told_what_to_do(
    store: PostgresStore,
    postgres_server: PostgresServer,
    postgres_database: str,
    caplog: pytest.LogCaptureFixture,
) -> None:
    store.create("yard", b"file", NOTE, 0)
    reader = make_conninfo(postgres_database, user="reader")
    postgres_server.execute("CREATE ROLE reader LOGIN")
    try:
        with pytest.raises(StoreError, match=r"lacks a right. Use the owner .*42501"):
            PostgresStore(reader)
        with psycopg.connect(postgres_database) as owner:
            owner.execute(f"GRANT USAGE ON SCHEMA {SCHEMA} TO reader")
            owner.execute(f"GRANT SELECT ON ALL TABLES IN SCHEMA {SCHEMA} TO reader")
        with PostgresStore.opened(reader) as reading:
            assert [head.name for head in reading.heads()] == ["yard"]
        assert "The user 'reader' of the database may read the maps and not write" in caplog.text
        caplog.clear()
        with PostgresStore.opened(postgres_database):
            assert "may read" not in caplog.text
    finally:
        with psycopg.connect(postgres_database) as owner:
            owner.execute("DROP OWNED BY reader")
        postgres_server.execute("DROP ROLE reader")


def test_commit_is_found_although_another_service_wrote_after_it(
    store: PostgresStore, postgres_database: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    commit = psycopg.Connection.commit
    lose_commits(monkeypatch, is_done=True)
    lost = psycopg.Connection.commit

    def lost_and_followed(connection: psycopg.Connection[Any]) -> None:
        try:
            lost(connection)
        except psycopg.OperationalError:
            monkeypatch.setattr(psycopg.Connection, "commit", commit)
            with PostgresStore.opened(postgres_database) as other:
                other.append(other.heads()[0], b"other", NOTE, 0)
            raise

    monkeypatch.setattr(psycopg.Connection, "commit", lost_and_followed)
    second = store.append(head, b"one", NOTE, 0)
    (newest,) = store.heads()
    assert (second.sequence, newest.sequence) == (2, 3)
    with store.read(head.uid) as history:
        assert history.mark(2) == second.mark
        assert second.log_bytes == 3


def test_write_with_an_unknown_outcome_says_so(
    quick: None, store: PostgresStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    lose_commits(monkeypatch, is_done=False, count=1_000)
    with pytest.raises(StoreError, match="not known whether the write was stored") as raised:
        store.append(head, b"one", NOTE, 0)
    assert raised.value.kind == "unreachable"
    assert raised.value.is_unsure


def test_only_one_of_several_services_adds_to_a_version(
    store: PostgresStore, postgres_database: str
) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    with PostgresStore.opened(postgres_database) as other, ThreadPoolExecutor(4) as threads:
        for count in range(10):
            before = head

            def add(number: int, before: MapHead = before) -> MapHead | None:
                try:
                    return (store, other)[number % 2].append(before, bytes([number]), NOTE, 0)
                except KeyError:
                    return None

            added = [each for each in threads.map(add, range(4)) if each is not None]
            assert len(added) == 1
            (head,) = added
            assert head.sequence == count + 2
    assert store.verify() == []


def test_only_one_of_several_services_creates_a_map(
    store: PostgresStore, postgres_database: str
) -> None:
    def make(number: int) -> bool:
        try:
            (store, other)[number % 2].create("yard", b"file", NOTE, 0)
        except ValueError:
            return False
        return True

    with PostgresStore.opened(postgres_database) as other, ThreadPoolExecutor(4) as threads:
        assert [*threads.map(make, range(4))].count(True) == 1


def test_killed_server_is_reported_and_used_again(
    quick: None, store: PostgresStore, postgres_server: PostgresServer
) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    postgres_server.kill()
    try:
        for call in (store.heads, lambda: store.append(head, b"one", NOTE, 0)):
            with pytest.raises(StoreError, match="cannot be reached") as raised:
                call()
            assert raised.value.kind == "unreachable"
        assert "cannot be reached" in str(store.trouble())
        with pytest.raises(StoreError, match="Connection refused"):
            PostgresStore(postgres_server.url())
    finally:
        postgres_server.start()
    store._database._pool.timeout = 10.0
    assert store.append(head, b"one", NOTE, 0).sequence == 2
    assert store.trouble() is None


@pytest.mark.slow
def test_stopped_server_is_not_awaited_without_end(
    quick: None,
    store: PostgresStore,
    postgres_server: PostgresServer,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    monkeypatch.setattr(database, "STATEMENT_SECONDS", 0.2)
    monkeypatch.setattr(database, "RETRY_SECONDS", 10.0)
    pids = [
        int(str(row[0]))
        for row in postgres_server.execute(
            "SELECT pid FROM pg_stat_activity WHERE application_name = 'placecell'"
        )
    ]
    try:
        for pid in pids:
            os.kill(pid, signal.SIGSTOP)
        # The connections are cut; others, which the running server accepts, do the work.
        assert store.append(head, b"one", NOTE, 0).sequence == 2
    finally:
        for pid in pids:
            os.kill(pid, signal.SIGCONT)


def test_locked_map_is_reported_after_a_wait(
    store: PostgresStore, postgres_database: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database, "LOCK_SECONDS", 1.0)
    head = store.create("yard", b"file", NOTE, 0)
    with psycopg.connect(postgres_database) as other:
        other.execute(f"SELECT 1 FROM {SCHEMA}.maps FOR UPDATE")
        with pytest.raises(StoreError) as raised:
            store.append(head, b"one", NOTE, 0)
        assert raised.value.kind == "busy"
        assert store.heads() == [head]  # reads do not wait
    assert store.append(head, b"one", NOTE, 0).sequence == 2


def test_read_only_database_is_reported(
    quick: None, store: PostgresStore, postgres_server: PostgresServer, postgres_database: str
) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    name = postgres_database.rpartition("/")[2]
    postgres_server.execute(f"ALTER DATABASE {name} SET default_transaction_read_only = on")
    with psycopg.connect(postgres_database, autocommit=True) as connection:
        connection.execute("SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE "
                           "application_name = 'placecell'")  # fmt: skip
    with pytest.raises(StoreError, match="read-only, as a standby is") as raised:
        store.append(head, b"one", NOTE, 0)
    assert raised.value.kind == "read-only"


def test_sqlstates_have_kinds() -> None:
    from service.maps.postgres.errors import translated

    kinds = {
        psycopg.errors.DiskFull: "full",
        psycopg.errors.ReadOnlySqlTransaction: "read-only",
        psycopg.errors.LockNotAvailable: "busy",
        psycopg.errors.DataCorrupted: "damaged",
        psycopg.errors.UndefinedTable: "moved",
        psycopg.errors.AdminShutdown: "unreachable",
        psycopg.errors.TooManyConnections: "unreachable",
        psycopg.errors.InvalidPassword: "failing",
        psycopg.errors.InternalError_: "failing",
    }
    assert {error: translated(error("words")).kind for error in kinds} == kinds


def test_start_changes_no_table_that_is_current(
    store: PostgresStore, postgres_server: PostgresServer, postgres_database: str
) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    with psycopg.connect(postgres_database) as other:
        # A statement that changes a table would wait for this one.
        other.execute(f"SELECT * FROM {SCHEMA}.maps, {SCHEMA}.commits, {SCHEMA}.version")
        with PostgresStore.opened(postgres_database) as second:
            assert second.heads() == [head]


def test_services_of_two_minor_versions_use_one_database(
    store: PostgresStore, postgres_database: str
) -> None:
    """The earlier version goes on while a later one adds a column, and starts after that too."""
    head = store.create("yard", b"file", NOTE, 0)
    later = replace(LAYOUT, minor=LAYOUT.minor + 1, additions={LAYOUT.minor: COLUMN})
    newer = PostgresStore(postgres_database, layout=later)
    try:
        head = store.append(head, b"by the older", NOTE, 0)
        head = newer.append(head, b"by the newer", NOTE, 0)
        other = store.create("other", b"file", NOTE, 0)
        with PostgresStore.opened(postgres_database) as older:
            assert older.heads() == [other, head]
            older.delete(other.uid)
        assert newer.verify() == store.verify() == []
        with newer._database.snapshot() as rows:
            assert rows.execute("SELECT name, color FROM maps").fetchall() == [("yard", "red")]
    finally:
        newer.close()


def test_database_of_another_major_version_is_refused(
    store: PostgresStore, postgres_database: str
) -> None:
    with pytest.raises(StoreError, match=r"version 1\.0; this program uses versions 2\.x"):
        PostgresStore(postgres_database, layout=replace(LAYOUT, major=2))
    with psycopg.connect(postgres_database) as connection:
        connection.execute(f"DELETE FROM {SCHEMA}.version")
    with pytest.raises(StoreError, match="is empty") as raised:
        PostgresStore(postgres_database)
    assert raised.value.kind == "damaged"


def test_services_that_start_at_once_create_the_tables_once(postgres_database: str) -> None:
    with ThreadPoolExecutor(4) as threads:
        stores = [*threads.map(lambda _: PostgresStore(postgres_database), range(4))]
    try:
        head = stores[0].create("yard", b"file", NOTE, 0)
        assert [each.heads() for each in stores] == [[head]] * 4
    finally:
        for each in stores:
            each.close()


def test_server_without_the_promise_is_warned_about(
    postgres_database: str, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    # A run of all tests on PostgreSQL hears no such warnings otherwise.
    monkeypatch.setattr("service.maps.postgres.store.durability_warnings", durability_warnings)
    with caplog.at_level(logging.WARNING), PostgresStore.opened(postgres_database):
        pass
    assert "has no synchronous standby. Add two standbys" in caplog.text
    assert "fsync=off" in caplog.text


def test_each_setting_that_breaks_the_promise_is_named() -> None:
    class Server:
        def __init__(self, standbys: int, **settings: str) -> None:
            self.settings = {
                "fsync": "on",
                "full_page_writes": "on",
                "synchronous_commit": "on",
                "synchronous_standby_names": "ANY 1 (*)",
            } | settings
            self.standbys = standbys

        def execute(self, statement: str, values: Any = (), /) -> Any:
            is_setting = statement.startswith("SHOW ")
            found = self.settings[statement[5:]] if is_setting else self.standbys
            return type("Cursor", (), {"fetchone": lambda _: (found,)})()

        def executemany(self, statement: str, values: Any, /) -> Any:
            raise NotImplementedError

    def warned(standbys: int = 1, **settings: str) -> list[str]:
        return [*durability_warnings(Server(standbys, **settings))]

    assert warned() == warned(synchronous_commit="remote_apply") == []
    assert "synchronous_commit=local" in warned(synchronous_commit="local")[0]
    assert "No synchronous standby is connected" in warned(0)[0]
    assert "full_page_writes=off" in warned(full_page_writes="off")[0]


def test_commit_that_did_not_wait_for_its_standby_is_repeated(
    store: PostgresStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    head = store.create("yard", b"file", NOTE, 0)
    calls: list[bool] = []
    synced = store._database.transaction

    def canceled_once(work: Callable[[Any, bool], Any], **named: Any) -> Any:
        def noted(rows: Any, again: bool) -> Any:
            calls.append(again)
            if len(calls) == 1:
                # The server sends such a notice with the answer to the commit.
                rows.execute(
                    "CREATE FUNCTION warn() RETURNS trigger LANGUAGE plpgsql AS $$BEGIN "
                    "RAISE WARNING 'canceling the wait' USING ERRCODE = '57014'; RETURN NULL; "
                    "END$$"
                )
                rows.execute(
                    "CREATE CONSTRAINT TRIGGER late AFTER UPDATE ON maps "
                    "DEFERRABLE INITIALLY DEFERRED FOR EACH ROW EXECUTE FUNCTION warn()"
                )
            if len(calls) == 2:
                rows.execute("DROP TRIGGER late ON maps")
            return work(rows, again)

        return synced(noted, **named)

    monkeypatch.setattr(store._database, "transaction", canceled_once)
    second = store.append(head, b"one", NOTE, 0)
    assert calls == [False, True]
    assert store.heads() == [second]


def test_wrong_url_is_refused() -> None:
    with pytest.raises(StoreError, match="URL of the database is invalid") as raised:
        PostgresStore("postgresql://ann:hidden@db:port:x/maps?wrong=1")
    assert "hidden" not in str(raised.value)


def test_service_without_its_database_does_not_start(start: Any) -> None:
    with (
        pytest.raises(StartError, match="Check the URL of the database") as raised,
        start(database="postgresql://ann:hidden@127.0.0.1:1/maps"),
    ):
        pass
    told = str(raised.value)
    assert told.startswith("database: PostgreSQL: the database cannot be reached: connection")
    assert "hidden" not in told


def test_missing_package_is_named_with_the_command(
    tmp_path: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    imported = builtins.__import__

    def missing(name: str, *rest: Any, **more: Any) -> Any:
        if name.startswith("service.maps.postgres"):
            raise ModuleNotFoundError("No module named 'psycopg'", name="psycopg")
        return imported(name, *rest, **more)

    monkeypatch.setattr(builtins, "__import__", missing)
    settings = Settings(data_dir=tmp_path, database="postgresql://db/maps")  # type: ignore[arg-type]
    with pytest.raises(StoreError, match=r"psycopg is missing.*placecell\[postgres\]"):
        open_store(settings).__enter__()
