"""Power cuts at every moment of a recorded run, and whether what was acknowledged is still there.

A service under strace is written to, one request at a time. Its writes, renames and syncs are then
replayed onto a disk that keeps only what was synced, and of the rest what chance will; at every
step the files that a power cut might leave are opened with the store.
"""

import hashlib
import random
import re
import shutil
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import httpx
from placecell_client import Client, encode

from bench.disk import KEEPS, Disk, write
from bench.disk_log import Step, steps_of, tracer
from bench.journal import Journal
from bench.made_map import Kind
from bench.server import running_service
from bench.writer import Writer
from service.map_cache import MapCache
from service.map_store import Note, StoreError
from service.replay import newest
from service.sqlite_store import SqliteMapStore
from service.stored_map import tag_of
from training.evaluation import machine

UNKEPT = ("-shm", "/lock", "/service.log")
"""Ends of files that nothing is read from after a start: SQLite's shared memory is made anew."""

TIDYING_SECONDS = 2.5
"""For the service to fold layers and save its caches after the last write."""

TOLD = 20
"""Of what was wrong, in the report."""

TRACER_SECONDS = 20.0
"""For strace to end after the service has."""

Outline = tuple[tuple[str, tuple[tuple[int, str | None], ...], str], ...]
"""Of all maps by name: sequence and tag of each version, SHA-256 of the newest one's file."""


@dataclass(frozen=True, slots=True)
class Plan:
    """What is done.

    Attributes:
        writes: to the service.
        large: segments of a large map.
        cuts: of the power, at most; 0: at every step.
        random_cuts: at each of these steps, beside those that keep all or nothing.
    """

    writes: int = 60
    large: int = 2_000
    cuts: int = 0
    random_cuts: int = 2


@dataclass(frozen=True, slots=True)
class Recording:
    """What a service did to its disk.

    Attributes:
        folder: its data directory.
        steps: in order; those of kind `said` tell of an answer.
        states: the maps after so many answers.
    """

    folder: Path
    steps: Sequence[Step]
    states: Sequence[Outline]


@dataclass(slots=True)
class Tally:
    """What came of the cuts.

    Attributes:
        cuts: how many there were, by what the disk kept.
        found: the maps on each different disk, by its digest; or why they cannot be read.
        results: how often the maps were as they must be (`good`), or so with a write that had not
            yet been acknowledged (`landed`); how often an acknowledged one was not there (`lost`),
            or they were of no one moment or not to be read (`half`).
        told: what was wrong.
    """

    cuts: Counter[str] = field(default_factory=Counter)
    found: dict[bytes, Outline | str] = field(default_factory=dict)
    results: Counter[str] = field(default_factory=Counter)
    told: list[str] = field(default_factory=list)


class _Numbered(httpx.BaseTransport):
    """Gives each request the number of the write that it makes."""

    def __init__(self) -> None:
        self._network = httpx.HTTPTransport()
        self.number = 0

    def handle_request(self, request: httpx.Request) -> httpx.Response:
        request.headers["X-Request-Id"] = f"write-{self.number}"
        return self._network.handle_request(request)


def record(folder: Path, plan: Plan, seed: int, options: tuple[str, ...] = ()) -> Recording:
    """Write to a service under strace.

    Raises:
        FileNotFoundError: there is no strace.
        RuntimeError: the service did not start, or strace cannot watch it.
    """
    data_dir, log = folder / "data", folder / "strace.log"
    draw = random.Random(seed)
    states: list[Outline] = [()]
    numbered = _Numbered()
    with (
        running_service(data_dir, *options, tracer=tracer(log)) as address,
        Client(address, transport=numbered) as client,
    ):
        kind = Kind.of(client.info())
        writers = [
            Writer(
                *(f"robot-{number}", kind, Journal(f"map-{number}"), plan.large),
                draw=random.Random(draw.getrandbits(64)),
            )
            for number in range(2)
        ]
        for number in range(plan.writes):
            numbered.number = number + 1
            writer = draw.choice(writers)
            writer.do(client, writer.choose())
            states.append(_outline([each.journal for each in writers]))
        time.sleep(TIDYING_SECONDS)
    _wait_for_end(log)
    recording = Recording(data_dir, steps_of(log, data_dir), states)
    _check_complete(recording)
    return recording


@dataclass(frozen=True, slots=True)
class Cut:
    """A moment at which the power fails.

    Attributes:
        answered: writes that were acknowledged before.
        keep: what the disk keeps of what was not synced.
        files: that it leaves, by path.
    """

    answered: int
    keep: str
    files: Mapping[str, bytes]


def cuts(recording: Recording, plan: Plan, draw: random.Random) -> Iterator[Cut]:
    """Every moment, or some, in order."""
    disk, answered = Disk(UNKEPT), 0
    changes = sum(step.kind != "said" for step in recording.steps)
    chance = plan.cuts / changes if plan.cuts else 1.0
    for step in recording.steps:
        if step.kind == "said":
            answered = int(step.to.removeprefix("write-"))
        if step.kind != "said" and not (disk.apply(step) and draw.random() < chance):
            continue
        for keep in KEEPS:
            for _ in range(plan.random_cuts if keep == "some" else 1):
                yield Cut(answered, keep, disk.left(keep, draw))


def opened(files: Mapping[str, bytes], root: Path, folder: Path) -> Outline:
    """The maps in files that a power cut left, after a write that must be possible.

    Args:
        files: by path.
        root: the folder of these paths.
        folder: an empty one, to open them in.

    Raises:
        StoreError: they cannot be used, or what is in them is damaged.
    """
    write(files, root, folder)
    cache = MapCache(folder)
    with SqliteMapStore.owned(folder) as store:
        maps = []
        for head in store.heads():
            with store.read(head.uid) as history:
                tags = [
                    (each.sequence, tag_of(each.sequence, each.mark)) for each in history.commits()
                ]
            file = encode(newest(store, head, cache)[0].content())
            maps.append((head.name, tuple(tags), hashlib.sha256(file).hexdigest()))
        if wrong := store.verify():
            raise StoreError("damaged", "; ".join(wrong))
        store.delete(store.create("after", b"", Note(0.0, "", "put", 0, 0), 0).uid)
    return tuple(maps)


def judge(recording: Recording, answered: int, found: Outline | str) -> tuple[str, str]:
    """Whether maps are as they must be after so many answers.

    Returns:
        `good`, `landed`, `lost` or `half`, as `Tally` counts them; and what is wrong.
    """
    if isinstance(found, str):
        return "half", found
    if found == recording.states[answered]:
        return "good", ""
    if found in recording.states[answered : answered + 2]:
        return "landed", ""
    if found in recording.states[:answered]:
        before = recording.states.index(found)
        return "lost", f"as after {before} writes; {answered} were acknowledged"
    return "half", f"as it never was; {answered} writes were acknowledged"


def powerloss(
    plan: Plan,
    seed: int = 0,
    options: tuple[str, ...] = (),
    progress: Callable[[str], None] = lambda _: None,
) -> dict[str, Any]:
    """Run it; the report as `placecell bench powerloss` writes it.

    Args:
        plan: what is done.
        seed: of everything that is drawn.
        options: further ones of `placecell serve`.
        progress: is told how far it is.

    Raises:
        FileNotFoundError: there is no strace.
        RuntimeError: strace cannot watch the service here.
    """
    with tempfile.TemporaryDirectory(prefix="placecell-powerloss-") as name:
        recording = record(Path(name), plan, seed, options)
        progress(f"{len(recording.steps)} steps of {plan.writes} writes recorded")
        tally = replay(recording, plan, random.Random(seed), Path(name) / "left", progress)
    return {
        "writes": plan.writes,
        "steps": dict(sorted(Counter(step.kind for step in recording.steps).items())),
        "power_cuts": tally.cuts.total(),
        "kept": dict(sorted(tally.cuts.items())),
        "distinct_disks": len(tally.found),
        "losses": tally.results["lost"],
        "half_seen": tally.results["half"],
        "in_flight_that_landed": tally.results["landed"],
        "wrong": tally.told[:TOLD],
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }


def replay(
    recording: Recording,
    plan: Plan,
    draw: random.Random,
    folder: Path,
    progress: Callable[[str], None] = lambda _: None,
) -> Tally:
    """Cut the power at every moment, or some, and open what is left each time in the folder."""
    tally = Tally()
    for cut in cuts(recording, plan, draw):
        tally.cuts[cut.keep] += 1
        digest = _digest(cut.files)
        if digest not in tally.found:
            tally.found[digest] = _opened(cut.files, recording.folder, folder)
            shutil.rmtree(folder)
            if len(tally.found) % 100 == 0:
                progress(f"{len(tally.found)} disks opened, of {tally.cuts.total()} power cuts")
        result, told = judge(recording, cut.answered, tally.found[digest])
        tally.results[result] += 1
        tally.told += [f"{cut.keep} kept: {told}"] if told else []
    return tally


def _opened(files: Mapping[str, bytes], root: Path, folder: Path) -> Outline | str:
    try:
        return opened(files, root, folder)
    except StoreError as error:
        return str(error)


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


def _digest(files: Mapping[str, bytes]) -> bytes:
    digest = hashlib.sha256()
    for path, content in sorted(files.items()):
        digest.update(f"{path} {len(content)}\n".encode())
        digest.update(content)
    return digest.digest()


def _wait_for_end(log: Path) -> None:
    """Until strace has written down that the service has ended."""
    deadline = time.monotonic() + TRACER_SECONDS
    while not re.search(rb"\+\+\+ (exited|killed)[^\n]*\n\Z", log.read_bytes()[-200:]):
        if time.monotonic() > deadline:
            raise RuntimeError("strace did not come to an end")
        time.sleep(0.05)


def _check_complete(recording: Recording) -> None:
    """See that the steps lead to the files that there are; a call may have been missed."""
    disk = Disk(UNKEPT)
    for step in recording.steps:
        disk.apply(step)
    replayed = disk.left("everything", random.Random(0))
    there = {
        str(path): path.read_bytes()
        for path in recording.folder.resolve().rglob("*")
        if path.is_file() and not str(path).endswith(UNKEPT)
    }
    if replayed != there:
        differ = [path for path in replayed | there if replayed.get(path) != there.get(path)]
        raise RuntimeError(f"strace did not tell all that was done to {', '.join(differ)}")
