"""The service under attack: a process with keys, a memory limit and a data directory of its own."""

import os
import shutil
import threading
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Self

import numpy as np
from placecell_client import Client, Retries

from placecell.core.types import UInt32
from service.child_process import Service, address_of
from service.core.auth import new_key

CORES = 2
"""Processor cores that the service may use."""

WATCH_SECONDS = 0.01
"""Seconds between two reads of the service's memory."""

ONCE = Retries(attempts=1)
"""Retry policy without retries: a refusal is returned at once."""

PAGE_BYTES = os.sysconf("SC_PAGE_SIZE")

OWNER, VICTIM, ROBOT, WRITER, READER, HALL = (
    "owner",
    "victim",
    "mallory",
    "writer",
    "reader",
    "hall",
)
"""Names of the keys. The owner may do everything. The victim and mallory write their own segments
only. The writer writes segments of all robots. The reader reads. The last key opens maps `hall-*`.
"""

RIGHTS: dict[str, dict[str, Any]] = {
    OWNER: {"write": True, "admin": True},
    VICTIM: {"write": True, "robot": VICTIM},
    ROBOT: {"write": True, "robot": ROBOT},
    WRITER: {"write": True},
    READER: {},
    HALL: {"write": True, "maps": ["hall-*"]},
}


@dataclass(slots=True)
class Memory:
    """Memory use of the watched processes.

    Attributes:
        limit_mb: limit of the resident memory, MB; a service above it is killed.
        peak_mb: peak memory of all processes, MB.
        killed: whether a process was killed for its memory.
    """

    limit_mb: float
    peak_mb: float = 0.0
    killed: bool = False


class Target:
    """Service that can be attacked, killed and restarted on the same data."""

    def __init__(
        self,
        folder: Path,
        limit_mb: float,
        environment: Mapping[str, str] | None = None,
        with_keys: bool = True,
    ) -> None:
        """Prepare the service's files; `start` starts it.

        Args:
            folder: new folder for the data directory `data` and the key file.
            limit_mb: limit of the resident memory, MB.
            environment: further environment variables.
            with_keys: whether the service requires API keys.
        """
        self.folder = folder
        self.data = folder / "data"
        self.keys_file = folder / "keys.toml" if with_keys else None
        self.memory = Memory(limit_mb)
        self.keys = dict[str, str]()
        self.address = ""
        self.died = ""
        self.reserved: UInt32 = np.zeros(0, np.uint32)
        self.edited = 0
        self.environment = dict(environment or {})
        self._service: Service | None = None
        self._watcher: threading.Thread | None = None
        self._clients = dict[str, Client]()
        self.data.mkdir(parents=True, exist_ok=True)
        if self.keys_file is not None:
            self._write_keys(self.keys_file)

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    @property
    def service(self) -> Service:
        """Return the process; fails unless the service runs."""
        assert self._service is not None
        return self._service

    @property
    def place(self) -> tuple[str, int]:
        """Return host and port."""
        return address_of(self.address)

    def start(self) -> None:
        """Start the service and wait until it listens.

        Raises:
            RuntimeError: the service does not start.
        """
        options = [] if self.keys_file is None else ["--keys-file", str(self.keys_file)]
        cores = sorted(os.sched_getaffinity(0))
        tracer = ["taskset", "-c", ",".join(map(str, cores[:CORES]))]
        has_more = len(cores) > CORES and shutil.which("taskset") is not None
        self._service = Service(
            self.data,
            *options,
            environment=self.environment,
            tracer=tracer if has_more else (),
        )
        self._watcher = threading.Thread(target=self._watch, args=(self._service,), daemon=True)
        self._watcher.start()
        self.address = self._service.address()
        # A listening service may still be starting.
        with Client(self.address, key=self.keys.get(OWNER)) as client:
            client.info()

    def stop(self) -> None:
        """Stop the service as an operator does."""
        if self._service is not None:
            self._leave()
            self._service.stop()
            self._service = None

    def kill(self) -> None:
        """Kill the service as a power cut does."""
        if self._service is not None:
            self._leave()
            self._service.kill()
            self._service = None

    def client(self, name: str = OWNER, seconds: float = 120.0) -> Client:
        """Return a client with the key of a name; the stop of the service closes it."""
        if name not in self._clients:
            self._clients[name] = Client(
                self.address, seconds, key=self.keys.get(name), retries=ONCE
            )
        return self._clients[name]

    def authorization(self, name: str | None) -> dict[str, str]:
        """Return the header with the key of a name; empty without a name or without keys."""
        key = self.keys.get(name) if name is not None else None
        return {"Authorization": f"Bearer {key}"} if key is not None else {}

    def is_running(self) -> bool:
        """Return whether the process runs."""
        return self._service is not None and self._service.process.poll() is None

    def resident_mb(self) -> float:
        """Return the service's resident memory, MB."""
        pages = Path(f"/proc/{self.service.process.pid}/statm").read_text().split()[1]
        return int(pages) * PAGE_BYTES / 1e6

    def peak_mb(self) -> float:
        """Return the peak memory since `forget_peak`, MB; 0 if the process has ended."""
        try:
            peak = self.service.peak_mb()
        except (AssertionError, OSError, IndexError):  # an ended process has no memory
            return 0.0
        self.memory.peak_mb = max(self.memory.peak_mb, peak)
        return peak

    def forget_peak(self) -> None:
        """Reset the kernel's count of the peak memory."""
        self.peak_mb()
        Path(f"/proc/{self.service.process.pid}/clear_refs").write_text("5")

    def _write_keys(self, file: Path) -> None:
        sections = []
        for name, rights in RIGHTS.items():
            self.keys[name], digest = new_key()
            lines = [f'sha256 = "{digest}"']
            for right, value in rights.items():
                lines.append(f"{right} = {str(value).lower() if value is True else repr(value)}")
            sections.append("\n".join([f"[{name}]", *lines]))
        file.write_text("\n\n".join(sections) + "\n")

    def _leave(self) -> None:
        if self.is_running():
            self.peak_mb()
        elif not self.died:
            self.died = f"it ended with status {self.service.process.returncode}"
        for client in self._clients.values():
            client.close()
        self._clients.clear()

    def _watch(self, service: Service) -> None:
        """Kill the service when its memory exceeds the limit."""
        file, limit = Path(f"/proc/{service.process.pid}/statm"), self.memory.limit_mb * 1e6
        while service.process.poll() is None:
            try:
                resident = int(file.read_text().split()[1]) * PAGE_BYTES
            except (OSError, IndexError):
                return
            self.memory.peak_mb = max(self.memory.peak_mb, round(resident / 1e6, 1))
            if resident > limit:
                self.memory.killed = True
                self.died = (
                    f"it took {resident / 1e6:.0f} MB; it was killed at the limit of "
                    f"{self.memory.limit_mb:.0f} MB"
                )
                service.process.kill()
                return
            time.sleep(WATCH_SECONDS)
