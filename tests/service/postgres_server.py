"""A PostgreSQL server for tests: one per worker, and a database of its own for each test.

The data lie in a temporary folder, in memory where that is possible: they need not survive.
"""

import itertools
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from benchmarks.replicas.missing_tool import MissingToolError
from benchmarks.replicas.postgres_node import PostgresNode

ON_POSTGRES = os.environ.get("PLACECELL_TEST_STORE") == "postgres"
"""Whether all tests of the service run on PostgreSQL."""

MEMORY = Path("/dev/shm")
"""Folder in memory."""

FAST = {
    "listen_addresses": "127.0.0.1",
    "unix_socket_directories": "",
    "fsync": "off",
    "full_page_writes": "off",
    "max_connections": "100",
    "shared_buffers": "64MB",
    "autovacuum": "off",
}
"""Options of a server whose data need not survive the machine."""


class PostgresServer(PostgresNode):
    """A server on a port of this machine; `start` can follow `stop` and `kill`."""

    def __init__(self, folder: Path) -> None:
        super().__init__("postgres", folder / "server", FAST)
        self._numbers = itertools.count()
        self._template = ""

    def create_database(self, template: str = "template0") -> str:
        """Create a database as a copy of another one, an empty one unless given; return its URL."""
        name = f"test_{next(self._numbers)}"
        # A copy of files is faster than one through the log.
        self.execute(f"CREATE DATABASE {name} TEMPLATE {template} STRATEGY FILE_COPY")
        return self.url(name)

    def create_database_with_tables(self) -> str:
        """Create a database that has the tables of the store, without maps; return its URL."""
        from service.maps.postgres.store import PostgresStore

        if not self._template:
            url = self.create_database()
            with closing(PostgresStore(url)):
                self._template = url.rpartition("/")[2]
        return self.create_database(self._template)

    def drop_database(self, url: str) -> None:
        """Remove a database; its clients are disconnected."""
        self.execute(f"DROP DATABASE IF EXISTS {url.rpartition('/')[2]} WITH (FORCE)")


@pytest.fixture(scope="session")
def postgres_server() -> Iterator[PostgresServer]:
    """A running server, shared by the tests of a worker; skips where none can start."""
    # Not below pytest's own folder, which only the user of the tests may enter.
    folder = Path(
        tempfile.mkdtemp(prefix="placecell-postgres-", dir=MEMORY if MEMORY.is_dir() else None)
    )
    folder.chmod(0o755)
    server = None
    try:
        try:
            server = PostgresServer(folder)
            server.initialize()
            server.start()
        except MissingToolError as error:
            pytest.skip(f"needs PostgreSQL: {error}")
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
