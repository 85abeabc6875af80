"""Power loss benchmark: cuts the power at every step of a recorded run, and counts lost writes.

A service runs under strace while a robot writes, one request at a time. All writes, renames and
syncs are then replayed onto a simulated disk that may lose everything unsynced. At every step the
store opens the files that a power cut may leave.
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

MAX_FAULTS = 20
"""Largest number of faults in the report."""

Progress = Callable[[Iterable[int], int, str], Iterable[int]]


@dataclass(frozen=True, slots=True)
class PowerLossPlan:
    """Extent of the benchmark.

    Attributes:
        writes: number of writes to the service.
        large: segments of a large map.
        cuts: approximate number of steps at which the power is cut; 0: every step.
        random_cuts: number of cuts per step that keep a random part of the unsynced changes.
    """

    writes: int = 60
    large: int = 2_000
    cuts: int = 0
    random_cuts: int = 2


@dataclass(frozen=True, slots=True)
class Cut:
    """A power cut.

    Attributes:
        answered: number of writes acknowledged before.
        keep: unsynced changes that the disk keeps.
        files: files that remain, by path.
    """

    answered: int
    keep: str
    files: Mapping[str, bytes]


@dataclass(slots=True)
class PowerLossFindings:
    """Findings of the power cuts.

    Attributes:
        cuts: number of cuts, by the unsynced changes that the disk kept.
        found: maps on each distinct disk by its digest, or the reason why they are unreadable.
        results: number of cuts with each result. `good`: all acknowledged writes are there.
            `landed`: so is a write that was not yet acknowledged. `lost`: an acknowledged write is
            missing. `half`: the maps are of no single moment, or unreadable.
        faults: description of each fault.
    """

    cuts: Counter[str] = field(default_factory=Counter)
    found: dict[bytes, Outline | str] = field(default_factory=dict)
    results: Counter[str] = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)


def run_power_cuts(
    plan: PowerLossPlan,
    seed: int = 0,
    options: tuple[str, ...] = (),
    progress: Progress = lambda items, *_: items,
) -> dict[str, Any]:
    """Run the power cuts; return the report that `placecell bench powerloss` writes.

    Args:
        plan: extent of the benchmark.
        seed: random seed of all choices.
        options: further options of `placecell serve`.
        progress: wraps the loop.

    Raises:
        FileNotFoundError: strace is not installed.
        RuntimeError: strace cannot trace the service on this machine.
    """
    with tempfile.TemporaryDirectory(prefix="placecell-powerloss-") as name:
        recorded = record_run(Path(name), plan.writes, plan.large, seed, options)
        findings = replay_power_cuts(
            recorded, plan, random.Random(seed), Path(name) / "left", progress
        )
    return {
        "writes": plan.writes,
        "steps": dict(sorted(Counter(step.kind for step in recorded.steps).items())),
        "power_cuts": findings.cuts.total(),
        "kept": dict(sorted(findings.cuts.items())),
        "distinct_disks": len(findings.found),
        "losses": findings.results["lost"],
        "half_seen": findings.results["half"],
        "in_flight_that_landed": findings.results["landed"],
        "wrong": findings.faults[:MAX_FAULTS],
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
    """Cut the power at every step, or some, and check the files that remain.

    Args:
        recorded: the run.
        plan: extent of the benchmark.
        draw: random generator of the cuts.
        folder: folder in which the files are opened.
        progress: wraps the loop.
    """
    findings = PowerLossFindings()
    for cut in cuts(recorded, plan, draw, progress):
        findings.cuts[cut.keep] += 1
        digest = _digest(cut.files)
        if digest not in findings.found:
            findings.found[digest] = read_maps_left(cut.files, recorded.folder, folder)
            shutil.rmtree(folder)
        result, fault = judge_maps(recorded, cut.answered, findings.found[digest])
        findings.results[result] += 1
        findings.faults += [f"Unsynced changes kept: {cut.keep}. {fault}"] if fault else []
    return findings


def cuts(
    recorded: RecordedRun, plan: PowerLossPlan, draw: random.Random, progress: Progress
) -> Iterator[Cut]:
    """Yield the power cuts of every step, or of some, in order."""
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
    """Read the maps in the files that a power cut left, and check that a write succeeds.

    Args:
        files: content by path.
        root: folder of these paths.
        folder: empty folder in which the files are opened.

    Returns:
        The maps, or the reason why they are unreadable or damaged.
    """
    write_files(files, root, folder)
    cache, maps = MapCache(folder), []
    try:
        with SqliteMapStore.owned(folder) as store:
            for head in store.heads():
                with store.read(head.uid) as history:
                    commits = history.commits()
                tags = tuple((each.sequence, tag_of(each.sequence, each.mark)) for each in commits)
                _, layers, _ = load_newest(store, head.uid, cache)
                file = encode(layers.content())
                maps.append((head.name, tags, hashlib.sha256(file).hexdigest()))
            if wrong := store.verify():
                return "; ".join(wrong)
            store.delete(store.create("after", b"", Note(0.0, "", "put", 0, 0), 0).uid)
    except StoreError as error:
        return str(error)
    return tuple(maps)


def judge_maps(recorded: RecordedRun, answered: int, found: Outline | str) -> tuple[str, str]:
    """Compare the maps with those after the acknowledged writes.

    Returns:
        `good`, `landed`, `lost` or `half` (see `PowerLossFindings`), and the fault, if any.
    """
    if isinstance(found, str):
        return "half", found
    if found == recorded.states[answered]:
        return "good", ""
    if found in recorded.states[answered : answered + 2]:
        return "landed", ""
    if found in recorded.states[:answered]:
        before = recorded.states.index(found)
        return "lost", f"{answered} writes were acknowledged, the maps hold {before}."
    return "half", f"{answered} writes were acknowledged, the maps are of no single moment."


def _number_of(step: Step) -> int:
    return int(step.to.removeprefix(NAME))


def _digest(files: Mapping[str, bytes]) -> bytes:
    digest = hashlib.sha256()
    for path, content in sorted(files.items()):
        digest.update(f"{path} {len(content)}\n".encode())
        digest.update(content)
    return digest.digest()
