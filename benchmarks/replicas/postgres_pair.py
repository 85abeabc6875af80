"""Primary and synchronous standby, with the operator that promotes and rebuilds them."""

import os
import subprocess
import time
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from threading import Event, Thread

from benchmarks.replicas.postgres_node import PostgresNode

WATCH_SECONDS = 0.1
"""Time between two looks at the primary."""

FAILURES = 2
"""Number of failed looks after which the standby is promoted."""

SYNCHRONOUS_SECONDS = 60.0
"""Longest wait for a standby that commits can wait for, seconds."""

DISK = "384m"
"""Size of the disk of each server, if disks can be mounted."""


class PostgresPair:
    """Two servers: one is the primary, the other its synchronous standby.

    Attributes:
        nodes: the servers.
        primary: the server that takes writes.
        promotions: number of promotions.
        own_disks: whether each server has a disk of its own, which can be filled.
        why_no_disks: why not.
        faults: description of each thing that the operator could not do.
    """

    def __init__(self, folder: Path, tell: Callable[[str], None] = lambda _: None) -> None:
        self._tell = tell
        folder.chmod(0o755)
        names = ("postgres-1", "postgres-2")
        self.why_no_disks = ""
        self._mounted: list[Path] = []
        for name in names:
            (folder / name).mkdir()
            self.why_no_disks = self.why_no_disks or self._mount(folder / name)
        self.own_disks = not self.why_no_disks
        self.nodes = tuple(PostgresNode(name, folder / name) for name in names)
        self.primary = self.nodes[0]
        self.promotions = 0
        self.faults: list[str] = []
        self._settled = Event()
        self._ended = Event()
        self._operator = Thread(target=self._operate, daemon=True)

    @property
    def standby(self) -> PostgresNode:
        """The other server."""
        return self.nodes[1] if self.primary is self.nodes[0] else self.nodes[0]

    @property
    def is_settled(self) -> bool:
        """Whether commits wait for a standby, so that the primary may be lost."""
        return self._settled.is_set()

    def start(self, database: str) -> None:
        """Start both servers, create a database, and begin to watch the primary."""
        self.primary.initialize()
        self.primary.start()
        self.primary.execute(f"CREATE DATABASE {database}")
        self._attach_standby()
        self._operator.start()

    def wait_settled(self, seconds: float = SYNCHRONOUS_SECONDS) -> bool:
        """Wait until the primary may be lost; return whether it may."""
        return self._settled.wait(seconds)

    def crash_primary(self) -> None:
        """Kill the primary; the operator promotes the standby and rebuilds the old primary."""
        self._settled.clear()
        self.primary.kill()

    def fill_disk(self, seconds: float) -> None:
        """Fill the disk of the primary for a time.

        Raises:
            OSError: the disk cannot be filled.
        """
        ballast = self.primary.folder / "ballast"
        try:
            with ballast.open("wb", buffering=0) as file:
                for size in (1 << 20, 1 << 12, 1):
                    with suppress(OSError):
                        while file.write(bytes(size)) == size:
                            pass
                self._ended.wait(seconds)
        finally:
            ballast.unlink(missing_ok=True)

    def stop(self) -> None:
        """Stop both servers and unmount their disks."""
        self._ended.set()
        if self._operator.is_alive():
            self._operator.join(SYNCHRONOUS_SECONDS)
        for node in self.nodes:
            node.kill()
        for folder in self._mounted:
            subprocess.run(["umount", "--lazy", str(folder)], check=False, timeout=30)

    def _operate(self) -> None:
        """Watch the primary: promote the standby when it fails, and rebuild the failed server."""
        failures = 0
        while not self._ended.wait(WATCH_SECONDS):
            failures = 0 if self.primary.accepts else failures + 1
            if failures < FAILURES:
                continue
            failures = 0
            try:
                self._fail_over()
            except (RuntimeError, OSError, subprocess.SubprocessError) as error:
                self.faults.append(f"failover: {error}")
                self._ended.wait(1.0)

    def _fail_over(self) -> None:
        self._settled.clear()
        old, new = self.primary, self.standby
        old.kill()  # it must not take writes again
        new.promote()
        self.primary = new
        self.promotions += 1
        self._tell(f"{new.name} is the primary")
        self._attach_standby()

    def _attach_standby(self) -> None:
        """Copy the primary to the other server, and make commits wait for it."""
        import psycopg

        self.standby.kill()
        until = time.monotonic() + SYNCHRONOUS_SECONDS
        while True:
            try:
                self.standby.clone(self.primary)
                self.standby.start()
                self.primary.require_standby(True)
                while not self.primary.has_synchronous_standby:
                    if time.monotonic() > until:
                        raise RuntimeError("the standby does not follow the primary")
                    time.sleep(WATCH_SECONDS)
                self._settled.set()
                return
            except (RuntimeError, psycopg.Error) as error:
                self.standby.kill()
                with suppress(psycopg.Error):
                    self.primary.require_standby(False)
                if time.monotonic() > until or self._ended.is_set():
                    raise RuntimeError(f"no standby: {error}") from error

    def _mount(self, folder: Path) -> str:
        """Make a folder a disk of its own; return the reason why that is impossible."""
        if not hasattr(os, "geteuid") or os.geteuid() != 0:
            return "a disk of its own needs root, to mount a tmpfs"
        done = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={DISK}", "tmpfs", str(folder)],
            capture_output=True,
            text=True,
            check=False,
            timeout=30,
        )
        if done.returncode:
            return f"no disk can be mounted here: {done.stderr.strip()}"
        self._mounted.append(folder)
        return ""
