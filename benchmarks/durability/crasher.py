"""Crasher: kills the service while robots write, restarts it, and checks its promise.

The promise: an acknowledged (2xx) write survives, and no reader sees part of a write.
"""

import random
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path
from threading import Thread

import httpx
import numpy as np
from placecell_client import Client, Retries, ServiceError

from benchmarks.durability.journal import Journal
from benchmarks.durability.map_versions import history_of
from benchmarks.durability.reading_robot import ReadingRobot
from benchmarks.durability.writing_robot import WritingRobot
from benchmarks.synthetic_maps.random_maps import MapTemplate
from service.child_process import Service

ONCE = Retries(attempts=1)
"""Retry policy without retries: the journal records each attempt by itself."""

WANTED = {
    "put": "put",
    "edit": "edit",
    "cache": "large edit",
    "restore": "restore",
    "compact": "compact",
    "age": "age",
    "delete": "delete",
}
"""Operation that the writers prefer before a kill at each moment: the one that leads to it."""

MOMENTS = (
    *("put", "cache", "compact", "start", "edit", "any"),
    *("put", "cache", "restore", "age", "edit", "delete"),
)
"""Moments of the kills, in turn."""

MOMENT_TIMEOUT_S = 5.0
"""Longest wait for the moment, seconds; after it the kill comes at any moment."""


@dataclass(frozen=True, slots=True)
class CrashPlan:
    """Extent of a crash run.

    Attributes:
        kills: number of kills.
        writers: number of writing robots, each with a map of its own.
        large: segments of a large map.
        seconds: longest time of writes before the wait for the moment of the kill.
    """

    kills: int = 200
    writers: int = 3
    large: int = 20_000
    seconds: float = 1.5


@dataclass(slots=True)
class CrashFindings:
    """Findings of a crash run so far.

    Attributes:
        lost, half: sums of `Discrepancy.lost` and `Discrepancy.half`.
        faults: description of each fault.
        starts: time of each start of the service until its first answer, seconds.
        killed: number of kills during each operation.
        versions: number of compared versions.
        seconds: times of the acknowledged writes, by operation, seconds.
    """

    lost: int = 0
    half: int = 0
    faults: list[str] = field(default_factory=list)
    starts: list[float] = field(default_factory=list)
    killed: Counter[str] = field(default_factory=Counter)
    versions: int = 0
    seconds: dict[str, list[float]] = field(default_factory=dict)


class Crasher:
    """Writing robots, a reading robot, and a service that is killed and restarted."""

    def __init__(
        self, data_dir: Path, options: tuple[str, ...], plan: CrashPlan, draw: random.Random
    ) -> None:
        self.findings = CrashFindings()
        self._plan = plan
        self._options = options
        self._data_dir = data_dir
        self._draw = draw
        self._left = set[tuple[int, int]]()
        with self._started() as (_, address), Client(address) as client:
            template = MapTemplate.from_info(client.info())
        self.writers = [
            WritingRobot(
                robot=f"robot-{number}",
                template=template,
                journal=Journal(f"map-{number}"),
                large=plan.large,
                draw=random.Random(self._draw.getrandbits(64)),
            )
            for number in range(plan.writers)
        ]
        has_been = {writer.journal.name: writer.journal.has_been for writer in self.writers}
        self.reader = ReadingRobot(template, has_been, random.Random(self._draw.getrandbits(64)))

    def crash(self, moment: str) -> None:
        """Start the service, check all maps, let robots write, and kill it at the moment."""
        if moment == "start":
            self._crash_start()
            return
        with self._started() as (service, address):
            self.check(address)
            threads = [
                Thread(target=self._write, args=(writer, address, moment))
                for writer in self.writers
            ]
            threads.append(Thread(target=self._read, args=(address,)))
            for thread in threads:
                thread.start()
            self._wait_for(moment)
            service.kill()
            for thread in threads:
                thread.join()
        for writer in self.writers:
            if writer.journal.in_flight is not None:
                self.findings.killed[writer.journal.in_flight.operation] += 1
        self.findings.killed["cache"] += self._saves_cache()

    def finish(self) -> None:
        """Start the service once more and check all maps."""
        with self._started() as (_, address):
            self.check(address)

    def check(self, address: str) -> None:
        """Compare every version of every map with the journals."""
        with Client(address) as client:
            for writer in self.writers:
                found = history_of(client, writer.journal.name)
                difference = writer.journal.settle(found)
                self.findings.versions += len(found.versions) if found is not None else 0
                self.findings.lost += difference.lost
                self.findings.half += difference.half
                self.findings.faults += [difference.fault] if difference.fault else []

    def _crash_start(self) -> None:
        service = Service(self._data_dir, *self._options)
        time.sleep(self._draw.uniform(0, 1.1 * float(np.median(self.findings.starts))))
        service.kill()
        self.findings.killed["start"] += 1

    def _write(self, writer: WritingRobot, address: str, moment: str) -> None:
        with Client(address, retries=ONCE) as client:
            while True:
                operation = writer.choose(WANTED.get(moment))
                begun = time.perf_counter()
                try:
                    writer.do(client, operation)
                except httpx.TransportError:
                    return
                except ServiceError as error:
                    self.findings.faults.append(f"{operation} of {writer.journal.name!r}: {error}")
                    return
                self.findings.seconds.setdefault(operation, []).append(time.perf_counter() - begun)

    def _read(self, address: str) -> None:
        with Client(address, retries=ONCE) as client:
            while True:
                try:
                    self.reader.read(client)
                except httpx.TransportError:
                    return
                except ServiceError as error:
                    self.findings.faults.append(f"Read: {error}")
                    return

    def _wait_for(self, moment: str) -> None:
        """Wait for the moment, and for a random time that likely ends within it."""
        time.sleep(self._draw.uniform(0, self._plan.seconds))
        if moment == "any":
            return
        deadline = time.monotonic() + MOMENT_TIMEOUT_S
        while not self._is_now(moment) and time.monotonic() < deadline:
            time.sleep(0.0005)
        usual = float(np.median(self.findings.seconds.get(WANTED[moment], [0.02])))
        time.sleep(self._draw.uniform(0, 0.005 if moment == "cache" else usual))

    def _is_now(self, moment: str) -> bool:
        if moment == "cache":
            return self._saves_cache()
        writes = [writer.journal.in_flight for writer in self.writers]
        return any(write is not None and write.operation == moment for write in writes)

    def _saves_cache(self) -> bool:
        """Return whether the service has an unfinished cache file of its own."""
        return bool(self._unfinished() - self._left)

    def _unfinished(self) -> set[tuple[int, int]]:
        """Return inode and modification time of each unfinished cache file."""
        found = set()
        for path in (self._data_dir / "cache").glob("*.unfinished"):
            with suppress(FileNotFoundError):  # the service has finished it meanwhile
                status = path.stat()
                found.add((status.st_ino, status.st_mtime_ns))
        return found

    @contextmanager
    def _started(self) -> Iterator[tuple[Service, str]]:
        self._left = self._unfinished()
        begun = time.perf_counter()
        service = Service(self._data_dir, *self._options)
        try:
            address = service.address()
            with Client(address) as client:
                client.info()
            self.findings.starts.append(time.perf_counter() - begun)
            yield service, address
        finally:
            service.kill()
