"""Kills the service while robots write, and checks what it promised when it is back.

The promise: a write that was answered with 2xx survives, and a map is seen whole or not at all.
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
"""A request that fails is not repeated: the journal tells each apart."""

WANTED = {
    "put": "put",
    "edit": "edit",
    "cache": "large edit",
    "restore": "restore",
    "compact": "compact",
    "age": "age",
    "delete": "delete",
}
"""What writers do much of where it is to be killed in the midst of that, or of what comes of it."""

MOMENTS = (
    *("put", "cache", "compact", "start", "edit", "any"),
    *("put", "cache", "restore", "age", "edit", "delete"),
)
"""To kill at, in turn."""

PATIENCE = 5.0
"""Seconds to wait for the moment before it is killed at any other."""


@dataclass(frozen=True, slots=True)
class CrashPlan:
    """What is done.

    Attributes:
        kills: how many.
        writers: each with a map of its own.
        large: segments of a large map.
        seconds: of writing before the moment to kill at is waited for, at most.
    """

    kills: int = 200
    writers: int = 3
    large: int = 20_000
    seconds: float = 1.5


@dataclass(slots=True)
class CrashFindings:
    """What came of it, so far.

    Attributes:
        lost, half: as of `Verdict`.
        told: all that is wrong.
        starts: seconds of each start, from the process to its first answer.
        killed: how often each was going on when the service was killed.
        versions: how many were downloaded and compared.
        seconds: of each write that was acknowledged, by operation.
    """

    lost: int = 0
    half: int = 0
    told: list[str] = field(default_factory=list)
    starts: list[float] = field(default_factory=list)
    killed: Counter[str] = field(default_factory=Counter)
    versions: int = 0
    seconds: dict[str, list[float]] = field(default_factory=dict)


class Crasher:
    """Writers, a reader, and a service that they outlive."""

    def __init__(
        self, data_dir: Path, options: tuple[str, ...], plan: CrashPlan, draw: random.Random
    ) -> None:
        self.tally = CrashFindings()
        self._plan = plan
        self._options = options
        self._data_dir = data_dir
        self._draw = draw
        self._left = set[tuple[int, int]]()
        with self._started() as (_, address), Client(address) as client:
            template = MapTemplate.from_info(client.info())
        self.writers = [
            WritingRobot(
                *(f"robot-{number}", template, Journal(f"map-{number}"), plan.large),
                draw=random.Random(self._draw.getrandbits(64)),
            )
            for number in range(plan.writers)
        ]
        has_been = {writer.journal.name: writer.journal.has_been for writer in self.writers}
        self.reader = ReadingRobot(template, has_been, random.Random(self._draw.getrandbits(64)))

    def crash(self, moment: str) -> None:
        """Start the service, check everything, write, and kill it at such a moment."""
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
                self.tally.killed[writer.journal.in_flight.operation] += 1
        self.tally.killed["cache"] += self._saves_cache()

    def finish(self) -> None:
        """Start it once more, and check everything."""
        with self._started() as (_, address):
            self.check(address)

    def check(self, address: str) -> None:
        """Hold every version of every map against the journals."""
        with Client(address) as client:
            for writer in self.writers:
                found = history_of(client, writer.journal.name)
                verdict = writer.journal.settle(found)
                self.tally.versions += len(found.versions) if found is not None else 0
                self.tally.lost += verdict.lost
                self.tally.half += verdict.half
                self.tally.told += [verdict.told] if verdict.told else []

    def _crash_start(self) -> None:
        service = Service(self._data_dir, *self._options)
        time.sleep(self._draw.uniform(0, 1.1 * float(np.median(self.tally.starts))))
        service.kill()
        self.tally.killed["start"] += 1

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
                    self.tally.told.append(f"{operation} of {writer.journal.name!r}: {error}")
                    return
                self.tally.seconds.setdefault(operation, []).append(time.perf_counter() - begun)

    def _read(self, address: str) -> None:
        with Client(address, retries=ONCE) as client:
            while True:
                try:
                    self.reader.read(client)
                except httpx.TransportError:
                    return
                except ServiceError as error:
                    self.tally.told.append(f"a read: {error}")
                    return

    def _wait_for(self, moment: str) -> None:
        """Wait for the moment, and a while that ends with luck in the midst of it."""
        time.sleep(self._draw.uniform(0, self._plan.seconds))
        if moment == "any":
            return
        deadline = time.monotonic() + PATIENCE
        while not self._is_now(moment) and time.monotonic() < deadline:
            time.sleep(0.0005)
        usual = float(np.median(self.tally.seconds.get(WANTED[moment], [0.02])))
        time.sleep(self._draw.uniform(0, 0.005 if moment == "cache" else usual))

    def _is_now(self, moment: str) -> bool:
        if moment == "cache":
            return self._saves_cache()
        writes = [writer.journal.in_flight for writer in self.writers]
        return any(write is not None and write.operation == moment for write in writes)

    def _saves_cache(self) -> bool:
        """Whether a cache was begun since the service was started, and not finished."""
        return bool(self._unfinished() - self._left)

    def _unfinished(self) -> set[tuple[int, int]]:
        """Of each half cache: its file, and when it was begun or last written to."""
        found = set()
        for path in (self._data_dir / "cache").glob("*.unfinished"):
            with suppress(FileNotFoundError):  # it was finished just now
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
            self.tally.starts.append(time.perf_counter() - begun)
            yield service, address
        finally:
            service.kill()
