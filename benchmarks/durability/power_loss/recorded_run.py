"""Recorded run of the service: every write, rename and sync, and every answer."""

import hashlib
import random
import re
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import httpx
from placecell_client import Client

from benchmarks.durability.journal import Journal
from benchmarks.durability.power_loss.disk import Disk
from benchmarks.durability.power_loss.disk_log import Step, steps_of, tracer
from benchmarks.durability.writing_robot import WritingRobot
from benchmarks.synthetic_maps.random_maps import MapTemplate
from service.child_process import Service

UNKEPT = ("-shm", "/lock", "/reserve", "/service.log")
"""Endings of files that a start does not read, such as SQLite's shared memory."""

MAINTENANCE_SECONDS = 1.8
"""Time for the service to merge layers and write its caches after the last write, seconds."""

TRACER_SECONDS = 20.0
"""Time for strace to end after the service, seconds."""

NAME = "write-"
"""Prefix of a request id; the number of the write follows."""

Outline = tuple[tuple[str, tuple[tuple[int, str | None], ...], str], ...]
"""All maps by name: number and ETag of each version, SHA-256 of the newest version's file."""


@dataclass(frozen=True, slots=True)
class RecordedRun:
    """Recorded run of a service.

    Attributes:
        folder: data directory of the service.
        steps: file operations and answers (`said`), in order.
        states: maps after each number of acknowledged writes.
    """

    folder: Path
    steps: Sequence[Step]
    states: Sequence[Outline]

    def check(self) -> None:
        """Check that the steps lead to the files in the data directory.

        Raises:
            RuntimeError: they do not, so strace has missed a call.
        """
        disk = Disk(UNKEPT)
        for step in self.steps:
            disk.apply(step)
        logged = disk.left("everything", random.Random(0))
        there = {
            str(path): path.read_bytes()
            for path in self.folder.resolve().rglob("*")
            if path.is_file() and not str(path).endswith(UNKEPT)
        }
        if logged != there:
            differ = [path for path in logged | there if logged.get(path) != there.get(path)]
            raise RuntimeError(f"strace missed operations on {', '.join(differ)}.")


class _Numbered(httpx.BaseTransport):
    """Transport that sets the request id to the number of the write."""

    def __init__(self) -> None:
        self._network = httpx.HTTPTransport()
        self.number = 0

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        request.headers["X-Request-Id"] = f"{NAME}{self.number}"
        return self._network.handle_request(request)

    def close(self) -> None:
        self._network.close()


class _Recorder:
    """Recorder: writes to a service under strace, one request after the other."""

    def __init__(self, data_dir: Path, options: tuple[str, ...], large: int, seed: int) -> None:
        self._data_dir = data_dir
        self._options = options
        self._large = large
        self._draw = random.Random(seed)
        self._numbered = _Numbered()
        self._writers: list[WritingRobot] = []
        self.states: list[Outline] = [()]

    def run(self, log: Path, writes: int, is_killed: bool) -> None:
        """Start the service, send `writes` writes, and stop or kill it."""
        service = Service(self._data_dir, *self._options, tracer=tracer(log))
        try:
            with Client(service.address(), transport=self._numbered) as client:
                self._write(client, writes)
            time.sleep(MAINTENANCE_SECONDS)
        finally:
            service.kill() if is_killed else service.stop()
        _wait_for_end(log)

    def _write(self, client: Client, writes: int) -> None:
        template = MapTemplate.from_info(client.info())
        if not self._writers:
            self._writers = [
                WritingRobot(
                    robot=f"robot-{number}",
                    template=template,
                    journal=Journal(f"map-{number}"),
                    large=self._large,
                    draw=random.Random(self._draw.getrandbits(64)),
                )
                for number in range(2)
            ]
        for _ in range(writes):
            self._numbered.number += 1
            writer = self._draw.choice(self._writers)
            writer.do(client, writer.choose())
            self.states.append(_outline([each.journal for each in self._writers]))


def record_run(
    folder: Path, writes: int, large: int, seed: int = 0, options: tuple[str, ...] = ()
) -> RecordedRun:
    """Record writes to a service that is killed half-way, restarted, and stopped.

    Args:
        folder: an empty folder.
        writes: number of writes.
        large: segments of a large map.
        seed: random seed of the writes.
        options: further options of `placecell serve`.

    Raises:
        FileNotFoundError: strace is not installed.
        RuntimeError: the service did not start, or strace cannot trace it.
    """
    data_dir = folder / "data"
    logs = [folder / "killed.log", folder / "stopped.log"]
    recorder = _Recorder(data_dir, options, large, seed)
    recorder.run(logs[0], writes // 2, is_killed=True)
    recorder.run(logs[1], writes - writes // 2, is_killed=False)
    recorded = RecordedRun(data_dir, steps_of(logs, data_dir), recorder.states)
    recorded.check()
    return recorded


def _outline(journals: Sequence[Journal]) -> Outline:
    """Return the outline of the maps that the journals expect."""
    return tuple(
        (
            journal.name,
            tuple((version.sequence, version.tag) for version in journal.known.versions),
            hashlib.sha256(journal.known.newest.file).hexdigest(),
        )
        for journal in journals
        if journal.known is not None
    )


def _wait_for_end(log: Path) -> None:
    """Wait until strace has logged the end of the service."""
    deadline = time.monotonic() + TRACER_SECONDS
    while not re.search(rb"\+\+\+ (exited|killed)[^\n]*\n\Z", log.read_bytes()[-200:]):
        if time.monotonic() > deadline:
            raise RuntimeError(f"strace did not end within {TRACER_SECONDS:g} s after the service.")
        time.sleep(0.05)
