"""PostgreSQL server of a benchmark or of tests: a primary, or a standby that follows it."""

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from benchmarks.replicas.missing_tool import free_port, ordinary_user, postgres_binaries

USER = "placecell"
START_SECONDS = 60.0
STOP_SECONDS = 20.0
POLL_SECONDS = 0.02

OPTIONS = {
    "listen_addresses": "127.0.0.1",
    "unix_socket_directories": "",
    "wal_level": "replica",
    "hot_standby": "on",
    "synchronous_commit": "on",
    # Small, so that a server is copied in a second, and its disk is filled in a second.
    "shared_buffers": "32MB",
    "wal_keep_size": "32MB",
    "max_wal_size": "64MB",
    "min_wal_size": "16MB",
    "max_connections": "100",
    # The balancer of connections is libpq itself: a dead peer is seen within seconds.
    "tcp_keepalives_idle": "2",
    "wal_receiver_status_interval": "1",
    "wal_retrieve_retry_interval": "200ms",
}

ONE_STANDBY = "ANY 1 (*)"
"""Value of `synchronous_standby_names` by which a commit waits for one standby."""


class PostgresNode:
    """One server with a port and a data directory of its own.

    Attributes:
        name: name of the server.
        folder: folder of its log and data; a disk of its own if a full disk is tested.
        port: port on the loopback interface.
    """

    def __init__(self, name: str, folder: Path, options: Mapping[str, str] = OPTIONS) -> None:
        """Create it; it does not run yet.

        Args:
            name: name of the server; its log is NAME.log beside the folder.
            folder: folder of the server, which the user of PostgreSQL may enter.
            options: settings of the server.

        Raises:
            MissingToolError: PostgreSQL is not installed, or cannot run here.
        """
        self.name = name
        self.folder = folder
        self.port = free_port()
        self._options = options
        self._binaries = postgres_binaries()
        self._user = ordinary_user()
        self._process: subprocess.Popen[bytes] | None = None
        folder.mkdir(parents=True, exist_ok=True)
        self._own(folder)

    @property
    def data(self) -> Path:
        """Data directory."""
        return self.folder / "data"

    @property
    def is_alive(self) -> bool:
        """Whether the process runs."""
        return self._process is not None and self._process.poll() is None

    @property
    def accepts(self) -> bool:
        """Whether the port accepts connections."""
        with suppress(OSError), socket.create_connection(("127.0.0.1", self.port), timeout=1.0):
            return True
        return False

    def initialize(self) -> None:
        """Create the data directory, which must not exist."""
        self.call(
            *("initdb", "-D", str(self.data), "-U", USER, "-A", "trust", "-E", "UTF8"),
            *("--wal-segsize=1", "--no-sync"),
        )

    def start(self) -> None:
        """Start the server and wait until it answers.

        Raises:
            RuntimeError: it did not start; the message holds the end of its log.
        """
        options = {**self._options, "port": str(self.port)}
        stated = [part for name, value in options.items() for part in ("-c", f"{name}={value}")]
        with (self.folder.parent / f"{self.name}.log").open("ab") as log:
            self._process = subprocess.Popen(
                [str(self._binaries / "postgres"), "-D", str(self.data), *stated],
                user=self._user,
                cwd="/",
                stdin=subprocess.DEVNULL,
                stdout=log,
                stderr=log,
            )
        until = time.monotonic() + START_SECONDS
        while not self._answers():
            if not self.is_alive or time.monotonic() > until:
                self.kill()
                raise RuntimeError(f"PostgreSQL did not start: {self.log()}")
            time.sleep(POLL_SECONDS)

    def clone(self, primary: "PostgresNode") -> None:
        """Replace the data directory by a copy of a primary's, as its standby."""
        for child in self.folder.iterdir():
            shutil.rmtree(child) if child.is_dir() else child.unlink()
        origin = f"host=127.0.0.1 port={primary.port} user={USER} application_name={self.name}"
        self.call(
            *("pg_basebackup", "-D", str(self.data), "-d", origin, "--checkpoint=fast"),
            *("--write-recovery-conf", "--wal-method=stream", "--no-sync"),
        )
        # Once promoted it takes writes alone, until it has a standby.
        with (self.data / "postgresql.auto.conf").open("a") as file:
            file.write("synchronous_standby_names = ''\n")

    def promote(self) -> None:
        """Make a standby the primary; return when it takes writes."""
        self.call("pg_ctl", "promote", "-D", str(self.data), "-w", "-t", str(int(START_SECONDS)))

    def require_standby(self, is_required: bool) -> None:
        """Make commits wait for a standby, or not."""
        names = ONE_STANDBY if is_required else ""
        self.execute(f"ALTER SYSTEM SET synchronous_standby_names = '{names}'")
        self.execute("SELECT pg_reload_conf()")

    @property
    def has_synchronous_standby(self) -> bool:
        """Whether commits wait for a standby that streams."""
        rows = self.execute("SELECT sync_state FROM pg_stat_replication WHERE state = 'streaming'")
        return any(state in ("sync", "quorum") for (state,) in rows)

    def kill(self) -> None:
        """Kill the server and all its processes with SIGKILL, as a crash of the machine would."""
        process, self._process = self._process, None
        if process is None:
            return
        children = children_of(process.pid)
        process.kill()
        for child in children:
            with suppress(ProcessLookupError):
                os.kill(child, signal.SIGKILL)
        process.wait(STOP_SECONDS)

    def stop(self) -> None:
        """Stop the server in order: it disconnects all clients."""
        process = self._process
        if process is not None and process.poll() is None:
            process.send_signal(signal.SIGINT)
            with suppress(subprocess.TimeoutExpired):
                process.wait(STOP_SECONDS)
        self.kill()

    def url(self, database: str = "postgres") -> str:
        """Return the URL of a database."""
        return f"postgresql://{USER}@127.0.0.1:{self.port}/{database}"

    def execute(self, statement: str, url: str | None = None) -> list[tuple[object, ...]]:
        """Run one statement as the owner; return its rows.

        Args:
            statement: statement.
            url: URL of the database; the database `postgres` unless given.
        """
        import psycopg

        with psycopg.connect(url or self.url(), autocommit=True, connect_timeout=5) as connection:
            connection.execute("SET statement_timeout = '10s'")
            cursor = connection.execute(statement.encode())
            return cursor.fetchall() if cursor.description else []

    def call(self, program: str, *arguments: str) -> None:
        """Run a program of PostgreSQL to its end.

        Raises:
            RuntimeError: it failed; the message holds its output.
        """
        done = subprocess.run(
            [str(self._binaries / program), *arguments],
            user=self._user,
            cwd="/",
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=START_SECONDS,
            check=False,
        )
        if done.returncode:
            raise RuntimeError(f"{program} ended with {done.returncode}: {done.stdout[-2000:]}")

    def log(self) -> str:
        """Return the last lines of the log."""
        text = (self.folder.parent / f"{self.name}.log").read_text(errors="replace")
        return text[-2000:]

    def _answers(self) -> bool:
        import psycopg

        try:
            self.execute("SELECT 1")
        except psycopg.Error:
            return False
        return True

    def _own(self, folder: Path) -> None:
        if self._user is not None:
            shutil.chown(folder, self._user)
            folder.chmod(0o755)


def children_of(pid: int) -> list[int]:
    """Return the processes that a process started; on Linux only."""
    try:
        text = Path(f"/proc/{pid}/task/{pid}/children").read_text()
    except OSError:
        return []
    return [int(each) for each in text.split()]
