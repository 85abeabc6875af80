"""Replicas: processes of `placecell serve` that share a database."""

import os
import signal
import time
from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from threading import Event, Lock, Thread

import httpx

from benchmarks.replicas.missing_tool import free_port
from service.child_process import Service

READY_SECONDS = 120.0
POLL_SECONDS = 0.05

ATTEMPTS = 10
"""Number of starts after which a replica that ends again and again is a fault."""

STARTING_NICE = 5
"""Niceness of a replica that starts, unless another is asked for.

In a fleet it starts on its own machine, or on cores that the others leave; here two that start at
once would take all cores from the third.
"""

PAUSE_SECONDS = 0.5
"""Time before a replica that ended is started again, seconds."""

ENVIRONMENT = {
    "PLACECELL_THREADS": "1",
    "OMP_NUM_THREADS": "1",
    # As in deploy/fleet/compose.yaml.
    "PLACECELL_KEEP_ALIVE_SECONDS": "75",
    "PLACECELL_LIMITS__ADDRESS_CONNECTIONS": "1000",
    "PLACECELL_PAGE": "false",
    "PLACECELL_DOCS": "false",
}


class Replica:
    """One replica, with the same port after each start.

    Attributes:
        port: port of the replica.
        starts: seconds of each start, until it was ready.
    """

    def __init__(
        self, folder: Path, environment: Mapping[str, str], starting_nice: int = STARTING_NICE
    ) -> None:
        self.port = free_port()
        self.starts: list[float] = []
        self._folder = folder
        self._environment = ENVIRONMENT | dict(environment)
        self._starting_nice = starting_nice
        self._service: Service | None = None
        self._lock = Lock()

    @property
    def address(self) -> str:
        """Return the address of the replica itself."""
        return f"http://127.0.0.1:{self.port}"

    @property
    def pid(self) -> int:
        """Return the id of the process."""
        assert self._service is not None
        return self._service.process.pid

    @property
    def is_ready(self) -> bool:
        """Return whether the replica says that it is ready."""
        with suppress(httpx.HTTPError):
            return httpx.get(f"{self.address}/readyz", timeout=1.0).status_code == 200
        return False

    def start(self) -> None:
        """Start the process with a low priority, and wait until it is ready.

        Raises:
            RuntimeError: it is not ready in time; the message holds the end of its log.
        """
        begun = time.monotonic()
        with self._lock:
            self._service = service = Service(
                self._folder, "--port", str(self.port), environment=self._environment
            )
        set_niceness(service.process.pid, self._starting_nice)
        while not self.is_ready:
            if service.process.poll() is not None or time.monotonic() > begun + READY_SECONDS:
                raise RuntimeError(f"a replica is not ready: {service.log()[-3000:]}")
            time.sleep(POLL_SECONDS)
        set_niceness(service.process.pid, 0)
        self.starts.append(time.monotonic() - begun)

    def kill(self) -> None:
        """Kill the process with SIGKILL."""
        with self._lock:
            service, self._service = self._service, None
            if service is not None:
                service.kill()

    def pause(self, seconds: float) -> None:
        """Stop the process with SIGSTOP for a time."""
        pid = self.pid
        os.kill(pid, signal.SIGSTOP)
        try:
            time.sleep(seconds)
        finally:
            os.kill(pid, signal.SIGCONT)

    def log(self) -> str:
        """Return the whole log of the replica, over all starts."""
        file = self._folder / "service.log"
        return file.read_text(errors="replace") if file.exists() else ""


class ReplicaGroup:
    """All replicas of a benchmark.

    Attributes:
        replicas: the replicas.
        faults: description of each replica that could not be started again.
        failed_starts: number of starts that ended, such as during a failover.
    """

    def __init__(
        self,
        folder: Path,
        count: int,
        environment: Mapping[str, str],
        starting_nice: int = STARTING_NICE,
    ) -> None:
        self.replicas = tuple(
            Replica(folder / f"replica-{number}", environment, starting_nice)
            for number in range(1, count + 1)
        )
        self.faults: list[str] = []
        self.failed_starts = 0
        self._stopped = Event()
        self._restarts: list[Thread] = []

    def start(self) -> None:
        """Start all replicas; the first one creates the tables of the database.

        Raises:
            RuntimeError: one is not ready in time; the message holds the end of its log.
        """
        self.replicas[0].start()
        with ThreadPoolExecutor(len(self.replicas)) as threads:
            for done in [threads.submit(each.start) for each in self.replicas[1:]]:
                done.result(2 * READY_SECONDS)

    def restart(self, replica: Replica) -> None:
        """Kill a replica now; start it again in a thread of its own."""
        replica.kill()
        thread = Thread(target=self._start, args=(replica,), daemon=True)
        self._restarts.append(thread)
        thread.start()

    def ready(self) -> list[Replica]:
        """Return the replicas that are ready."""
        return [each for each in self.replicas if each.is_ready]

    def wait_ready(self, seconds: float = READY_SECONDS) -> bool:
        """Wait until all restarts are done and all replicas are ready; return whether they are."""
        until = time.monotonic() + seconds
        for thread in self._restarts:
            thread.join(max(until - time.monotonic(), 0.0))
        while len(self.ready()) < len(self.replicas):
            if time.monotonic() > until:
                return False
            time.sleep(POLL_SECONDS)
        return True

    def stop(self) -> None:
        """Kill all replicas."""
        self._stopped.set()
        for replica in self.replicas:
            replica.kill()
        for thread in self._restarts:
            thread.join(READY_SECONDS)
        for replica in self.replicas:  # one that was being started meanwhile
            replica.kill()

    def _start(self, replica: Replica) -> None:
        """Start a replica; again if it ends, as systemd and Kubernetes do."""
        for attempt in range(1, ATTEMPTS + 1):
            try:
                replica.start()
                return
            except (RuntimeError, OSError) as error:
                replica.kill()
                if self._stopped.is_set():
                    return
                self.failed_starts += 1
                if attempt == ATTEMPTS:
                    self.faults.append(f"restart: {error}")
                self._stopped.wait(PAUSE_SECONDS)


def may_set_niceness() -> bool:
    """Return whether this user may lower a niceness again."""
    return os.geteuid() == 0


def set_niceness(pid: int, niceness: int) -> None:
    """Set the niceness of all threads of a process, if this user may lower it again."""
    if not may_set_niceness():
        return
    for _ in range(2):  # a thread that starts meanwhile has the niceness of its starter
        for thread in Path(f"/proc/{pid}/task").glob("*"):
            with suppress(OSError):  # it has ended
                os.setpriority(os.PRIO_PROCESS, int(thread.name), niceness)
