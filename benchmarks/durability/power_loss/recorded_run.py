"""A run of the service whose every write, rename and sync is known, and every answer."""

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
"""Ends of files that nothing is read from after a start: SQLite's shared memory is made anew."""

TIDYING_SECONDS = 1.8
"""For the service to fold layers and save its caches after the last write."""

TRACER_SECONDS = 20.0
"""For strace to end after the service has."""

NAME = "write-"
"""Begins the name of a request; the number of the write follows."""

Outline = tuple[tuple[str, tuple[tuple[int, str | None], ...], str], ...]
"""Of all maps by name: sequence and tag of each version, SHA-256 of the newest one's file."""


@dataclass(frozen=True, slots=True)
class RecordedRun:
    """What a service did to its disk.

    Attributes:
        folder: its data directory.
        steps: in order; those of template `said` tell of an answer.
        states: the maps after so many answers.
    """

    folder: Path
    steps: Sequence[Step]
    states: Sequence[Outline]

    def check(self) -> None:
        """See that the steps lead to the files that there are; a call may have been missed.

        Raises:
            RuntimeError: they do not.
        """
        disk = Disk(UNKEPT)
        for step in self.steps:
            disk.apply(step)
        told = disk.left("everything", random.Random(0))
        there = {
            str(path): path.read_bytes()
            for path in self.folder.resolve().rglob("*")
            if path.is_file() and not str(path).endswith(UNKEPT)
        }
        if told != there:
            differ = [path for path in told | there if told.get(path) != there.get(path)]
            raise RuntimeError(f"strace did not tell all that was done to {', '.join(differ)}")


class _Numbered(httpx.BaseTransport):
    """Names each request after the write that it makes."""

    def __init__(self) -> None:
        self._network = httpx.HTTPTransport()
        self.number = 0

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        request.headers["X-Request-Id"] = f"{NAME}{self.number}"
        return self._network.handle_request(request)

    def close(self) -> None:
        self._network.close()


class _Recorder:
    """Writes to a service under strace, one request after the other."""

    def __init__(self, data_dir: Path, options: tuple[str, ...], large: int, seed: int) -> None:
        self._data_dir = data_dir
        self._options = options
        self._large = large
        self._draw = random.Random(seed)
        self._numbered = _Numbered()
        self._writers: list[WritingRobot] = []
        self.states: list[Outline] = [()]

    def run(self, log: Path, writes: int, is_killed: bool) -> None:
        """From a start of the service to its end, with so many writes more."""
        service = Service(self._data_dir, *self._options, tracer=tracer(log))
        try:
            with Client(service.address(), transport=self._numbered) as client:
                self._write(client, writes)
            time.sleep(TIDYING_SECONDS)
        finally:
            service.kill() if is_killed else service.stop()
        _wait_for_end(log)

    def _write(self, client: Client, writes: int) -> None:
        template = MapTemplate.from_info(client.info())
        if not self._writers:
            self._writers = [
                WritingRobot(
                    *(f"robot-{number}", template, Journal(f"map-{number}"), self._large),
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
    """Write to a service that is killed in the middle, started again, and stopped.

    Args:
        folder: an empty one.
        writes: how many.
        large: segments of a large map.
        seed: of the writes.
        options: further ones of `placecell serve`.

    Raises:
        FileNotFoundError: there is no strace.
        RuntimeError: the service did not start, or strace cannot watch it.
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
    """Of maps as they are known."""
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
    """Until strace has written down that the service has ended."""
    deadline = time.monotonic() + TRACER_SECONDS
    while not re.search(rb"\+\+\+ (exited|killed)[^\n]*\n\Z", log.read_bytes()[-200:]):
        if time.monotonic() > deadline:
            raise RuntimeError("strace did not come to an end")
        time.sleep(0.05)
