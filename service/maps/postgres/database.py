"""Connections to PostgreSQL with bounded waits, and transactions that survive a lost connection."""

import logging
import math
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from functools import lru_cache
from typing import Any, TypeVar

import psycopg
from psycopg import conninfo
from psycopg_pool import ConnectionPool, PoolTimeout

from placecell.core.cancellation import current
from service.maps.postgres.errors import is_busy, is_lost, translated
from service.maps.postgres.tables import SCHEMA
from service.maps.postgres.watchdog import Watchdog
from service.maps.sql.rows import Rows
from service.maps.store import StoreError

Result = TypeVar("Result")
Connection = psycopg.Connection[tuple[Any, ...]]
Work = Callable[[Rows, bool], Result]
"""Statements of a transaction. They may run again; the flag says whether an earlier run may have
been committed."""

CONNECT_SECONDS = 3
"""Seconds within which a server must accept a connection."""

POOL_SECONDS = 3.0
"""Seconds to wait for a connection of the pool."""

RECONNECT_SECONDS = 2.0
"""Seconds for which the pool tries to connect before it gives up; the next request tries anew.
The pool doubles its pauses, so a longer time would delay the first write after a failover."""

RETRY_SECONDS = 6.0
"""Seconds for which a write is repeated whose connection was lost."""

PAUSE_SECONDS = 0.1
"""Seconds between two tries."""

STATEMENT_SECONDS = 20.0
"""Seconds that a statement or a commit may take, unless a transaction states another limit."""

LOCK_SECONDS = 3.0
"""Seconds to wait for a row that another transaction has locked."""

IDLE_SECONDS = 1.0
"""Seconds without a statement after which the server ends a write, so that a stopped service holds
no lock."""

READ_IDLE_SECONDS = 600.0
"""Seconds without a statement after which the server ends a read."""

NETWORK = {
    "connect_timeout": f"{CONNECT_SECONDS}",
    "keepalives_idle": "5",
    "keepalives_interval": "2",
    "keepalives_count": "3",
    "tcp_user_timeout": "10000",
    "application_name": "placecell",
    # Of several hosts, and behind a proxy, only the primary is used.
    "target_session_attrs": "read-write",
}
"""Parameters of connections; the URL can state others."""

INVALID_URL = (
    "The URL of the database is invalid. Expected postgresql://USER:PASSWORD@HOST:PORT/DATABASE. "
    "Write the signs @, / and % of a password as %40, %2F and %25"
)

TOLD_SECONDS = 10.0
"""Seconds between two log lines about connections that cannot be made."""

SYNC_CANCELED = {"57014", "57P01"}
"""Codes of the warning that a commit did not wait for its synchronous standby."""

logger = logging.getLogger("placecell")


class PlainWords(logging.Filter):
    """Tells in plain words what the pool logs about connections, without the driver's objects."""

    def __init__(self) -> None:
        super().__init__()
        self._told_at = -math.inf

    def filter(self, record: logging.LogRecord) -> bool:
        """Change a record; return whether it is logged: a failure to connect not at each try."""
        arguments = record.args if isinstance(record.args, tuple) else ()
        message = str(record.msg)
        if message.startswith("reconnection attempt"):
            return False  # the failed tries say why
        if message.startswith("error connecting"):
            now = time.monotonic()
            if now < self._told_at + TOLD_SECONDS:
                return False
            self._told_at = now
            record.msg = "The database accepts no connection: %s"
            record.args = (" ".join(f"{arguments[-1]}".split()),)
        if any(isinstance(each, psycopg.Connection) for each in arguments):
            record.msg = "A connection to the database was lost. Another one replaces it."
            record.args = ()
        return True


logging.getLogger("psycopg.pool").addFilter(PlainWords())


class PostgresRows:
    """Statements on one connection; each has a time limit."""

    def __init__(
        self, connection: Connection, watchdog: Watchdog, seconds: float | None = None
    ) -> None:
        self._connection = connection
        self._watchdog = watchdog
        self._seconds = STATEMENT_SECONDS if seconds is None else seconds

    def execute(self, statement: str, values: Sequence[Any] = (), /) -> Any:
        """Run a statement; return its cursor."""
        with self._watchdog.limit(self._connection, self._seconds):
            return self._connection.execute(_in_dialect(statement), values or None)

    def executemany(self, statement: str, values: Iterable[Sequence[Any]], /) -> Any:
        """Run a statement once for each row of values."""
        rows = list(values)
        cursor = self._connection.cursor()
        if rows:
            with self._watchdog.limit(self._connection, self._seconds):
                cursor.executemany(_in_dialect(statement), rows)
        return cursor


class GatheredRows:
    """Statements on one connection that are sent as one message, once an answer is read.

    A service that is stopped between two messages leaves a server that waits for it, and that ends
    the transaction (IDLE_SECONDS). The driver's pipelines send each statement by itself; a server
    that has got a part of them does not count as waiting, and would keep the map's lock.
    """

    def __init__(self, connection: Connection, watchdog: Watchdog, seconds: float) -> None:
        self._connection = connection
        self._watchdog = watchdog
        self._seconds = seconds
        self._gathered: list[GatheredAnswer] = []

    def execute(self, statement: str, values: Sequence[Any] = (), /) -> "GatheredAnswer":
        """Gather a statement; return its answer, which sends it when it is read."""
        answer = GatheredAnswer(self, statement, values)
        self._gathered.append(answer)
        return answer

    def executemany(self, statement: str, values: Iterable[Sequence[Any]], /) -> None:
        """Gather a statement once for each row of values."""
        for each in values:
            self.execute(statement, each)

    def send(self) -> None:
        """Send the gathered statements, and wait for all answers."""
        gathered, self._gathered = self._gathered, []
        if not gathered:
            return
        cursor = psycopg.ClientCursor(self._connection)  # it writes the values into the message
        message = ";".join(
            cursor.mogrify(_in_dialect(each.statement), each.values or None) for each in gathered
        )
        with self._watchdog.limit(self._connection, self._seconds):
            cursor.execute(message.encode())
        for each in gathered:
            each.take(cursor)
            cursor.nextset()


class GatheredAnswer:
    """Answer of a statement that was gathered; reading it sends the statement if it must."""

    def __init__(self, rows: GatheredRows, statement: str, values: Sequence[Any]) -> None:
        self.statement = statement
        self.values = values
        self._rows = rows
        self._found: Iterator[tuple[Any, ...]] | None = None
        self._changed = -1

    @property
    def rowcount(self) -> int:
        """Number of changed rows."""
        self._sent()
        return self._changed

    def fetchone(self) -> tuple[Any, ...] | None:
        """Return the next row; None after the last one."""
        return next(self._sent(), None)

    def fetchall(self) -> list[tuple[Any, ...]]:
        """Return all other rows."""
        return list(self._sent())

    def __iter__(self) -> Iterator[tuple[Any, ...]]:
        return self._sent()

    def take(self, cursor: psycopg.Cursor[tuple[Any, ...]]) -> None:
        """Take the result at which a cursor is."""
        self._changed = cursor.rowcount
        self._found = iter(cursor.fetchall() if cursor.description else ())

    def _sent(self) -> Iterator[tuple[Any, ...]]:
        if self._found is None:
            self._rows.send()
        assert self._found is not None
        return self._found


class PostgresDatabase:
    """Database with a pool of connections. Safe to use from many threads."""

    def __init__(self, url: str, connections: int) -> None:
        """Prepare connections; none is made yet.

        Args:
            url: URL of the database; the password stays out of all messages.
            connections: largest number of connections at once.

        Raises:
            StoreError: the URL is invalid.
        """
        try:
            stated: Mapping[str, Any] = conninfo.conninfo_to_dict(url)
        except psycopg.ProgrammingError as error:
            raise StoreError("failing", INVALID_URL) from error
        if not _has_plain_hosts(stated):
            # The driver would show these parts, which may be of the password.
            raise StoreError("failing", INVALID_URL)
        self._parameters = conninfo.make_conninfo(**NETWORK | dict(stated))
        self._last_error: psycopg.Error | None = None
        self._watchdog = Watchdog()
        self._parts = ExitStack()
        self._parts.callback(self._watchdog.close)
        self._pool = ConnectionPool(
            self._parameters,
            connection_class=_connecting(self._note_error),
            min_size=1,
            max_size=connections,
            open=False,
            configure=_configure,
            timeout=POOL_SECONDS,
            reconnect_timeout=RECONNECT_SECONDS,
            num_workers=2,
        )

    def open(self) -> None:
        """Open the pool; its connections are made in the background."""
        self._pool.open()
        self._parts.callback(self._pool.close, POOL_SECONDS)

    def close(self) -> None:
        """Close all connections."""
        self._parts.close()

    @contextmanager
    def connected(self) -> Iterator[tuple[Connection, Rows]]:
        """Make a connection outside of the pool; each statement is its own transaction.

        Raises:
            StoreError: the server does not accept it.
        """
        with _translated(), psycopg.connect(self._parameters, autocommit=True) as connection:
            _configure(connection)
            yield connection, PostgresRows(connection, self._watchdog)

    @contextmanager
    def watching(self, connection: Connection, seconds: float) -> Iterator[None]:
        """Wait in a block for this time at most, and a little longer."""
        with self._watchdog.limit(connection, seconds + STATEMENT_SECONDS):
            yield

    def transaction(
        self, work: Work[Result], seconds: float | None = None, is_short: bool = False
    ) -> Result:
        """Run writes as one transaction, durable on return.

        If the connection is lost, they run again on another one. If that was during the commit, its
        outcome is not known; the next run is told so and finds out.

        They are not committed if nobody waits for the answer any more: the robot may have repeated
        the write at another service, and changed the same segments since. A robot that gives up
        later than this check cannot overtake the commit, because the writes hold the map's lock.
        Nor do they wait for that lock, or for another connection, longer than their request does.

        Args:
            work: the writes.
            seconds: seconds that a statement or the commit may take; STATEMENT_SECONDS unless
                given.
            is_short: the writes are few and small. Those whose answers nobody reads are sent
                as one message, so that they hold the map's lock for few round trips.

        Raises:
            StoreError: nothing was changed; unless its message says that this is not known.
            Cancelled: the request is late, or its client disconnected.
        """
        until = time.monotonic() + RETRY_SECONDS
        unsure = False
        while True:
            attempt = _Attempt()
            try:
                return self._run(work, unsure, attempt, seconds, is_short)
            except PoolTimeout as error:
                failed = self._unreachable(error)
                if not unsure:
                    raise failed from error
            except psycopg.Error as error:
                failed = translated(error)
                unsure = unsure or (attempt.is_committing and is_lost(error))
                if not (is_lost(error) or (is_busy(error) and (unsure or _is_conflict(error)))):
                    raise failed from error
            if time.monotonic() > until:
                raise _unsure(failed) if unsure else failed
            current().check()
            time.sleep(PAUSE_SECONDS)

    @contextmanager
    def snapshot(self) -> Iterator[Rows]:
        """Read one state of the database, without waiting for writers or blocking them."""
        with _translated(), ExitStack() as held:
            connection = self._begin_reading(held)
            yield PostgresRows(connection, self._watchdog)
            connection.rollback()

    def read(self, work: Callable[[Rows], Result]) -> Result:
        """Read by statements that are a transaction each: one round trip for each statement.

        If the connection is lost, they run again on another one.

        Raises:
            StoreError: the server does not answer.
        """
        until = time.monotonic() + RETRY_SECONDS
        with _translated():
            while True:
                try:
                    with self._pool.connection() as connection:
                        connection.autocommit = True
                        return work(PostgresRows(connection, self._watchdog))
                except PoolTimeout as error:
                    raise self._unreachable(error) from error
                except psycopg.Error as error:
                    # A connection that was idle while the server restarted.
                    if not is_lost(error) or time.monotonic() > until:
                        raise

    def _begin_reading(self, held: ExitStack) -> Connection:
        """Return a connection of the pool with a read transaction, held for a block."""
        until = time.monotonic() + RETRY_SECONDS
        while True:
            with ExitStack() as trying:
                try:
                    connection = trying.enter_context(self._pool.connection())
                    connection.autocommit = True  # the transaction begins here, by one round trip
                    PostgresRows(connection, self._watchdog).execute(
                        "BEGIN ISOLATION LEVEL REPEATABLE READ, READ ONLY;"
                        "SET LOCAL idle_in_transaction_session_timeout = "
                        f"'{READ_IDLE_SECONDS:.0f}s'"
                    )
                except PoolTimeout as error:
                    raise self._unreachable(error) from error
                except psycopg.Error as error:
                    # A connection that was idle while the server restarted.
                    if not is_lost(error) or time.monotonic() > until:
                        raise
                    continue
                held.push(trying.pop_all())
                return connection

    def _run(
        self,
        work: Work[Result],
        unsure: bool,
        attempt: "_Attempt",
        seconds: float | None,
        is_short: bool,
    ) -> Result:
        seconds = STATEMENT_SECONDS if seconds is None else seconds
        with self._pool.connection() as connection:
            try:
                connection.autocommit = True  # the transaction begins here, with what follows it
                gathered = GatheredRows(connection, self._watchdog, seconds)
                gathered.execute("BEGIN")
                gathered.execute("SELECT set_config('lock_timeout', ?, true)", (_lock_timeout(),))
                if is_short:
                    result = work(gathered, unsure)
                    gathered.send()
                else:
                    gathered.send()
                    result = work(PostgresRows(connection, self._watchdog, seconds), unsure)
                current().check()
                attempt.is_committing = True
                with _noticing(connection) as notices, self._watchdog.limit(connection, seconds):
                    connection.commit()
            except psycopg.Error as error:
                if is_lost(error):
                    connection.close()  # the pool makes another one
                raise
            if SYNC_CANCELED & notices:
                raise psycopg.OperationalError("the wait for the synchronous standby was canceled")
            return result

    def _note_error(self, error: psycopg.Error | None) -> None:
        self._last_error = error

    def _unreachable(self, timeout: PoolTimeout) -> StoreError:
        """Return the reason why the pool has no connection."""
        last = self._last_error
        return translated(last if last is not None else timeout)


class _Attempt:
    """State of a run of a transaction."""

    is_committing = False


def _has_plain_hosts(stated: Mapping[str, Any]) -> bool:
    """Return whether hosts and ports have no signs of a password that was not encoded."""
    ports = str(stated.get("port") or "").split(",")
    return "@" not in str(stated.get("host") or "") and all(
        not port or port.isdecimal() for port in ports
    )


def _connecting(note: Callable[[psycopg.Error | None], None]) -> type[Connection]:
    """Return a class of connections that notes why a connection could not be made."""

    class Noting(psycopg.Connection[tuple[Any, ...]]):
        @classmethod
        def connect(cls, *args: Any, **options: Any) -> Any:
            try:
                connection = super().connect(*args, **options)
            except psycopg.Error as error:
                note(error)
                raise
            note(None)
            return connection

    return Noting


def _configure(connection: Connection) -> None:
    """Set what each connection needs; the server may have other defaults for the user.

    A statement has no time limit at the server: it would also end the wait of a commit for its
    synchronous standby, which then counts as committed.
    """
    was_auto = connection.autocommit
    connection.autocommit = True
    connection.execute(
        f"SET search_path TO {SCHEMA}; SET statement_timeout = 0;"
        f"SET lock_timeout = '{LOCK_SECONDS:.0f}s';"
        f"SET idle_in_transaction_session_timeout = '{IDLE_SECONDS:.0f}s'".encode()
    )
    connection.autocommit = was_auto


def _lock_timeout() -> str:
    """Return the longest wait for a row: no longer than the request waits for its answer."""
    seconds = min(LOCK_SECONDS, current().seconds_left)
    return f"{max(1000 * seconds, 1):.0f}ms"


@contextmanager
def _noticing(connection: Connection) -> Iterator[set[str]]:
    """Collect the codes of the server's notices within a block."""
    codes: set[str] = set()

    def note(diagnostic: psycopg.errors.Diagnostic) -> None:
        codes.add(diagnostic.sqlstate or "")

    connection.add_notice_handler(note)
    try:
        yield codes
    finally:
        connection.remove_notice_handler(note)


@contextmanager
def _translated() -> Iterator[None]:
    """Translate errors of PostgreSQL into a StoreError."""
    try:
        yield
    except psycopg.Error as error:
        raise translated(error) from error


def _is_conflict(error: psycopg.Error) -> bool:
    return isinstance(error, psycopg.errors.TransactionRollback)


def _unsure(error: StoreError) -> StoreError:
    return StoreError(
        error.kind,
        f"{error}. The connection was lost during a commit, so it is not known whether the write "
        "was stored",
        is_unsure=True,
    )


@lru_cache(maxsize=256)
def _in_dialect(statement: str) -> bytes:
    """Return a statement with the placeholders of the driver."""
    return statement.replace("?", "%s").encode()
