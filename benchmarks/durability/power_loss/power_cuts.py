"""Power cuts at every moment of a recorded run, and whether what was acknowledged is still there.

A service under strace is written to, one request at a time. Its writes, renames and syncs are then
replayed onto a disk that keeps only what was synced, and of the rest what chance will; at every
step the files that a power cut might leave are opened with the store.
"""

import hashlib
import random
import shutil
import tempfile
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from placecell_client import encode

from benchmarks.durability.power_loss.disk import KEEPS, Disk, write_files
from benchmarks.durability.power_loss.disk_log import Step
from benchmarks.durability.power_loss.recorded_run import (
    NAME,
    UNKEPT,
    Outline,
    RecordedRun,
    record_run,
)
from evaluation.machine import machine
from service.maps.cache import MapCache
from service.maps.history import load_newest
from service.maps.snapshot import tag_of
from service.maps.sqlite.store import SqliteMapStore
from service.maps.store import Note, StoreError

TOLD = 20
"""Of what was wrong, in the report."""

Progress = Callable[[Iterable[int], int, str], Iterable[int]]


@dataclass(frozen=True, slots=True)
class PowerLossPlan:
    """What is done.

    Attributes:
        writes: to the service.
        large: segments of a large map.
        cuts: steps at which the power is cut, about; 0: at every one.
        random_cuts: at each of these, beside those that keep all or nothing.
    """

    writes: int = 60
    large: int = 2_000
    cuts: int = 0
    random_cuts: int = 2


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


@dataclass(slots=True)
class PowerLossFindings:
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


def run_power_cuts(
    plan: PowerLossPlan,
    seed: int = 0,
    options: tuple[str, ...] = (),
    progress: Progress = lambda items, *_: items,
) -> dict[str, Any]:
    """Run it; the report as `placecell bench powerloss` writes it.

    Args:
        plan: what is done.
        seed: of everything that is drawn.
        options: further ones of `placecell serve`.
        progress: wraps the loop.

    Raises:
        FileNotFoundError: there is no strace.
        RuntimeError: strace cannot watch the service here.
    """
    with tempfile.TemporaryDirectory(prefix="placecell-powerloss-") as name:
        recorded = record_run(Path(name), plan.writes, plan.large, seed, options)
        tally = replay_power_cuts(
            recorded, plan, random.Random(seed), Path(name) / "left", progress
        )
    return {
        "writes": plan.writes,
        "steps": dict(sorted(Counter(step.kind for step in recorded.steps).items())),
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


def replay_power_cuts(
    recorded: RecordedRun,
    plan: PowerLossPlan,
    draw: random.Random,
    folder: Path,
    progress: Progress = lambda items, *_: items,
) -> PowerLossFindings:
    """Cut the power at every moment, or some, and open what is left each time in the folder."""
    tally = PowerLossFindings()
    for cut in cuts(recorded, plan, draw, progress):
        tally.cuts[cut.keep] += 1
        digest = _digest(cut.files)
        if digest not in tally.found:
            tally.found[digest] = read_maps_left(cut.files, recorded.folder, folder)
            shutil.rmtree(folder)
        result, told = judge_maps(recorded, cut.answered, tally.found[digest])
        tally.results[result] += 1
        tally.told += [f"{cut.keep} kept: {told}"] if told else []
    return tally


def cuts(
    recorded: RecordedRun, plan: PowerLossPlan, draw: random.Random, progress: Progress
) -> Iterator[Cut]:
    """Every moment, or some, in order."""
    disk, answered, count = Disk(UNKEPT), 0, len(recorded.steps)
    chance = plan.cuts / count if plan.cuts else 1.0
    for number in progress(range(count), count, "steps"):
        step = recorded.steps[number]
        if step.kind == "said":
            answered = _number_of(step)
        elif not disk.apply(step):
            continue
        if draw.random() < chance:
            for keep in KEEPS:
                for _ in range(plan.random_cuts if keep == "some" else 1):
                    yield Cut(answered, keep, disk.left(keep, draw))


def read_maps_left(files: Mapping[str, bytes], root: Path, folder: Path) -> Outline | str:
    """The maps in files that a power cut left, after a write that must be possible.

    Args:
        files: by path.
        root: the folder of these paths.
        folder: an empty one, to open them in.

    Returns:
        The maps; or what is wrong, if they cannot be used or are damaged.
    """
    write_files(files, root, folder)
    cache, maps = MapCache(folder), []
    try:
        with SqliteMapStore.owned(folder) as store:
            for head in store.heads():
                with store.read(head.uid) as history:
                    commits = history.commits()
                tags = tuple((each.sequence, tag_of(each.sequence, each.mark)) for each in commits)
                file = encode(load_newest(store, head, cache)[0].content())
                maps.append((head.name, tags, hashlib.sha256(file).hexdigest()))
            if wrong := store.verify():
                return "; ".join(wrong)
            store.delete(store.create("after", b"", Note(0.0, "", "put", 0, 0), 0).uid)
    except StoreError as error:
        return str(error)
    return tuple(maps)


def judge_maps(recorded: RecordedRun, answered: int, found: Outline | str) -> tuple[str, str]:
    """Whether maps are as they must be after so many answers.

    Returns:
        `good`, `landed`, `lost` or `half`, as `Tally` counts them; and what is wrong.
    """
    if isinstance(found, str):
        return "half", found
    if found == recorded.states[answered]:
        return "good", ""
    if found in recorded.states[answered : answered + 2]:
        return "landed", ""
    if found in recorded.states[:answered]:
        before = recorded.states.index(found)
        return "lost", f"as after {before} writes; {answered} were acknowledged"
    return "half", f"as it never was; {answered} writes were acknowledged"


def _number_of(step: Step) -> int:
    return int(step.to.removeprefix(NAME))


def _digest(files: Mapping[str, bytes]) -> bytes:
    digest = hashlib.sha256()
    for path, content in sorted(files.items()):
        digest.update(f"{path} {len(content)}\n".encode())
        digest.update(content)
    return digest.digest()
