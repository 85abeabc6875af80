"""Fleet crash benchmark: three replicas and a database with a standby lose processes at random.

Robots write and read through the balancer meanwhile. At the end every acknowledged segment must be
in the maps, no read under a token may have missed its write, and all replicas must be alike.
"""

import random
import shutil
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from threading import Event, Thread
from typing import Any

import numpy as np
from placecell_client import Client, decode

from benchmarks.load.serve import percentiles
from benchmarks.replicas.availability import AnswerTimes, Fault, FaultLog, cause_of, longest_gaps
from benchmarks.replicas.balancer import running_balancer
from benchmarks.replicas.commit_cutter import CommitCutter
from benchmarks.replicas.fault_schedule import FleetCrashPlan, scheduled
from benchmarks.replicas.fleet_clients import (
    IDS,
    FleetReader,
    FleetRobot,
    FleetWriter,
    ProbeBoard,
)
from benchmarks.replicas.judge import is_union, lost_in, search_in, view_of
from benchmarks.replicas.missing_tool import haproxy_program
from benchmarks.replicas.postgres_node import USER
from benchmarks.replicas.postgres_pair import PostgresPair
from benchmarks.replicas.replica_group import (
    STARTING_NICE,
    Replica,
    ReplicaGroup,
    may_set_niceness,
)
from benchmarks.synthetic_maps.random_maps import MapTemplate
from evaluation.machine import machine

DATABASE = "placecell"
JOIN_SECONDS = 120.0
SETTLE_SECONDS = 60.0
"""Longest wait until every robot has an answer after a fault, seconds."""

LATE_SECONDS = 300.0
"""Time after the planned duration at which no further fault is made, seconds."""

MAPS = ("site", "yard")
"""Maps that all writers share."""


class FleetUnderFault:
    """The running fleet, and the faults that happen to it."""

    def __init__(
        self,
        plan: FleetCrashPlan,
        database: PostgresPair,
        cutters: dict[str, CommitCutter],
        group: ReplicaGroup,
        draw: random.Random,
        tell: Callable[[str], None],
    ) -> None:
        self.log = FaultLog()
        self.skipped: dict[str, str] = {}
        self.wrong: list[str] = []
        self._plan = plan
        self._database = database
        self._cutters = cutters
        self._group = group
        self._draw = draw
        self._tell = tell

    def run(self, robots: list[FleetRobot]) -> None:
        """Make the faults of the plan, each at its time or later; end when all are made.

        Faults that the plan leaves no time for are left out, and told.
        """
        faults: Mapping[str, Callable[[], str | None]] = {
            "replica": self._kill_replica,
            "primary": self._crash_primary,
            "cut_commit": self._cut_commit,
            "paused": self._pause_replica,
            "full_disk": self._fill_disk,
        }
        begun = time.monotonic()
        for number, due in enumerate(scheduled(self._plan, self._draw)):
            if time.monotonic() > begun + self._plan.seconds + LATE_SECONDS:
                self.wrong.append(f"only {number} faults were made in the time of the plan")
                return
            time.sleep(max(begun + due.seconds - time.monotonic(), 0.0))
            self._do(faults[due.cause], robots)

    def _do(self, fault: Callable[[], str | None], robots: list[FleetRobot]) -> None:
        """Make one fault, and wait until every robot has an answer that it asked for later."""
        cause = fault()
        if cause is None:
            return
        after = time.monotonic()
        if not wait_for(lambda: all(answered(each, after) for each in robots), SETTLE_SECONDS):
            silent = [each.name for each in robots if not answered(each, after)]
            self.wrong.append(f"{silent} got no answer for {SETTLE_SECONDS:.0f} s after {cause}")
        self._tell(f"{time.monotonic() - after:.1f} s after {cause}, all robots are answered")

    def _victim(self) -> Replica | None:
        """Return a replica at random if another one is ready."""
        wait_for(lambda: len(self._group.ready()) > 1, SETTLE_SECONDS)
        ready = self._group.ready()
        if len(ready) < 2:
            self.wrong.append(f"only {len(ready)} replicas are ready")
            return None
        return self._draw.choice(ready)

    def _kill_replica(self) -> str | None:
        victim = self._victim()
        if victim is None:
            return None
        self.log.add("replica", time.monotonic())
        self._group.restart(victim)
        return "a kill of a replica"

    def _pause_replica(self) -> str | None:
        victim = self._victim()
        if victim is None:
            return None
        self.log.add("paused", time.monotonic())
        victim.pause(self._plan.paused)
        return "a pause of a replica"

    def _crash_primary(self) -> str | None:
        if not self._database.wait_settled(SETTLE_SECONDS):
            self.wrong.append("the standby did not become synchronous")
            return None
        wait_for(lambda: len(self._group.ready()) > 1, SETTLE_SECONDS)
        self.log.add("primary", time.monotonic())
        self._database.crash_primary()
        return "a crash of the primary"

    def _cut_commit(self) -> str | None:
        cutter = self._cutters[self._database.primary.name]
        cuts = cutter.cuts
        cutter.arm()
        if not wait_for(lambda: cutter.cuts > cuts, SETTLE_SECONDS / 4):
            cutter.disarm()
            self.wrong.append("no connection was cut after its COMMIT")
            return None
        self.log.add("cut_commit", time.monotonic())
        return "a cut after a COMMIT"

    def _fill_disk(self) -> str | None:
        if not self._database.own_disks:
            self.skipped["full_disk"] = self._database.why_no_disks
            return None
        self._database.wait_settled(SETTLE_SECONDS)
        wait_for(lambda: len(self._group.ready()) > 1, SETTLE_SECONDS)
        self.log.add("full_disk", time.monotonic())
        self._database.fill_disk(self._plan.full)
        return "a full disk"


def run_fleet_crash(
    plan: FleetCrashPlan, seed: int = 0, tell: Callable[[str], None] = lambda _: None
) -> dict[str, Any]:
    """Run the faults; return the report that `placecell bench fleet-crash` writes.

    Args:
        plan: extent of the run.
        seed: random seed of all choices; the timing of threads, disks and links stays random.
        tell: takes a line about the progress.

    Raises:
        MissingToolError: PostgreSQL or haproxy is not installed.
    """
    haproxy_program()
    draw = random.Random(seed)
    begun = time.monotonic()
    with ExitStack() as opened:
        folder = opened.enter_context(scratch_folder())
        fleet = opened.enter_context(running_fleet(folder, plan.replicas, tell, plan.starting_nice))
        with Client(fleet.address) as client:
            info = client.info()
            template = MapTemplate.from_info(info)
            for name in MAPS:
                client.put_map(name, template.empty_map(), create_only=True)
        board = ProbeBoard()
        writers = [
            FleetWriter(
                name=f"writer-{number}",
                address=fleet.address,
                draw=random.Random(draw.getrandbits(64)),
                answers=AnswerTimes("write"),
                template=template,
                maps=MAPS,
                first_id=number * IDS,
                board=board,
            )
            for number in range(plan.writers)
        ]
        readers = [
            FleetReader(
                name=f"reader-{number}",
                address=fleet.address,
                draw=random.Random(draw.getrandbits(64)),
                answers=AnswerTimes("read"),
                model_id=info.model_id,
                board=board,
            )
            for number in range(plan.readers)
        ]
        robots: list[FleetRobot] = [*writers, *readers]
        faults = FleetUnderFault(
            plan, fleet.database, fleet.cutters, fleet.group, random.Random(seed), tell
        )
        with running_robots(writers, readers):
            wait_for(lambda: all(len(each.answers.times) > 2 for each in robots), SETTLE_SECONDS)
            faults.run(robots)
        verdict = judged(fleet, writers, info.model_id, faults.wrong)
        starts = sorted(each for one in fleet.group.replicas for each in one.starts)
        wrong = [*faults.wrong, *fleet.group.faults, *fleet.database.faults]
        wrong += [each for robot in robots for each in robot.wrong]
        promotions, failed_starts = fleet.database.promotions, fleet.group.failed_starts
    return _report(writers, readers, faults, verdict) | {
        "promotions": promotions,
        "failed_starts": failed_starts,
        "starting_nice": plan.starting_nice if may_set_niceness() else 0,
        "restart_s": {"p50": round(starts[len(starts) // 2], 2), "max": round(starts[-1], 2)},
        "wrong": wrong,
        "good": is_good(verdict, readers, wrong),
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
        "seconds": round(time.monotonic() - begun, 1),
    }


def is_good(verdict: dict[str, Any], readers: list[FleetReader], wrong: list[str]) -> bool:
    """Return whether the promise was kept."""
    stale = sum(each.stale for each in readers)
    return not (verdict["lost"] or stale or wrong) and bool(verdict["replicas_identical"])


def _report(
    writers: list[FleetWriter],
    readers: list[FleetReader],
    faults: FleetUnderFault,
    verdict: dict[str, Any],
) -> dict[str, Any]:
    robots: list[FleetRobot] = [*writers, *readers]
    all_faults = faults.log.faults
    refused = sum((each.refused for each in robots), Counter[str]())
    return {
        "acknowledged": sum(each.acknowledged for each in writers),
        "lost": verdict["lost"],
        "reads": sum(each.reads for each in readers),
        "stale_reads": sum(each.stale for each in readers),
        "replicas_identical": verdict["replicas_identical"],
        "maps_are_the_union": verdict["maps_are_the_union"],
        "segments": verdict["segments"],
        "longest_gap_s": longest_gaps([each.answers for each in robots], all_faults),
        "slowest": slowest_gaps(robots, all_faults),
        "longest_read_gap_s": longest_gaps([each.answers for each in readers], all_faults),
        "faults": faults.log.counts(),
        "skipped": faults.skipped,
        "failed_attempts": dict(sorted(refused.items())),
        "answered_ms": {
            name: percentiles(np.array([1000 * each for robot in some for each in robot.answered]))
            for name, some in (("write", writers), ("read", readers))
        },
    }


def judged(
    fleet: "RunningFleet", writers: list[FleetWriter], model_id: str, wrong: list[str]
) -> dict[str, Any]:
    """Compare the replicas with each other and with the acknowledged writes."""
    if not fleet.group.wait_ready():
        wrong.append("not all replicas are ready at the end")
    own = {name: [each.own[name] for each in writers] for name in MAPS}
    contents = {}
    with Client(fleet.address) as client:
        files = {name: client.get_map_file(name) for name in MAPS}
        contents = {name: decode(file) for name, file in files.items()}
    search = search_in(contents, model_id)
    views = [view_of(each.address, MAPS, search) for each in fleet.group.replicas]
    # A replica that follows may be a moment behind.
    until = time.monotonic() + SETTLE_SECONDS
    while any(each != views[0] for each in views) and time.monotonic() < until:
        time.sleep(0.5)
        views = [view_of(each.address, MAPS, search) for each in fleet.group.replicas]
    return {
        "lost": max(sum(lost_in(each.files[name], own[name]) for name in MAPS) for each in views),
        "replicas_identical": all(each == views[0] for each in views),
        "maps_are_the_union": all(
            is_union(each.files[name], own[name]) for each in views for name in MAPS
        ),
        "segments": sum(map(len, contents.values())),
    }


@dataclass(frozen=True, slots=True)
class RunningFleet:
    """Database, replicas and balancer that run.

    Attributes:
        database: the servers of the database.
        cutters: the link to each of them, by its name.
        group: the replicas.
        address: address of the balancer.
    """

    database: PostgresPair
    cutters: dict[str, CommitCutter]
    group: ReplicaGroup
    address: str


@contextmanager
def running_fleet(
    folder: Path,
    replicas: int,
    tell: Callable[[str], None] = lambda _: None,
    starting_nice: int = STARTING_NICE,
) -> Iterator[RunningFleet]:
    """Run database, replicas and balancer for a block.

    Args:
        folder: empty folder of all files.
        replicas: number of replicas.
        tell: takes a line about the progress.
        starting_nice: niceness of a replica while it starts.
    """
    with ExitStack() as opened:
        database = PostgresPair(folder, tell)
        opened.callback(database.stop)
        database.start(DATABASE)
        tell("primary and standby run")
        cutters = {node.name: CommitCutter(node.port) for node in database.nodes}
        for cutter in cutters.values():
            opened.enter_context(cutter.running())
        hosts = ",".join(f"127.0.0.1:{each.port}" for each in cutters.values())
        url = f"postgresql://{USER}@{hosts}/{DATABASE}"
        url += "?target_session_attrs=read-write&connect_timeout=2"
        group = ReplicaGroup(folder, replicas, {"PLACECELL_DATABASE": url}, starting_nice)
        opened.callback(group.stop)
        group.start()
        tell(f"{replicas} replicas are ready")
        ports = [each.port for each in group.replicas]
        address = opened.enter_context(running_balancer(folder, ports))
        yield RunningFleet(database, cutters, group, address)


@contextmanager
def running_robots(writers: list[FleetWriter], readers: list[FleetReader]) -> Iterator[None]:
    """Let robots write and read for a block."""
    ended = Event()
    robots: list[FleetWriter | FleetReader] = [*writers, *readers]
    threads = [Thread(target=each.run_noted, args=(ended,), daemon=True) for each in robots]
    for thread in threads:
        thread.start()
    try:
        yield
    finally:
        ended.set()
        until = time.monotonic() + JOIN_SECONDS
        for thread in threads:
            thread.join(max(until - time.monotonic(), 0.0))


@contextmanager
def scratch_folder() -> Iterator[Path]:
    """Yield a folder that the user of PostgreSQL may enter; it is removed at the end."""
    folder = Path(tempfile.mkdtemp(prefix="placecell-fleet-"))
    try:
        yield folder
    finally:
        shutil.rmtree(folder, ignore_errors=True)


def slowest_gaps(
    robots: Sequence[FleetRobot], faults: Sequence[Fault], most: int = 10
) -> list[dict[str, Any]]:
    """Return the longest times without an answer, with the attempts that failed meanwhile."""
    gaps = [
        (end - begin, begin, end, each) for each in robots for begin, end in each.answers.gaps()
    ]
    return [
        {
            "robot": robot.name,
            "seconds": round(seconds, 3),
            "cause": cause_of(begin, end, faults),
            "faults": [
                {"cause": each.cause, "after_s": round(each.start - begin, 3)}
                for each in faults
                if begin <= each.start <= end
            ],
            "failed_attempts": [
                {"after_s": round(at - begin, 3), "seconds": round(lasted, 3), "status": status}
                for at, lasted, status in robot.failed
                if begin <= at <= end
            ],
        }
        for seconds, begin, end, robot in sorted(gaps, key=lambda gap: gap[0], reverse=True)[:most]
    ]


def answered(robot: FleetRobot, after: float) -> bool:
    """Return whether a robot had two answers since a time: it asked for the second one later."""
    return len(robot.answers.times) > 1 and robot.answers.times[-2] > after


def wait_for(condition: Callable[[], bool], seconds: float) -> bool:
    """Wait until a condition holds; return whether it does."""
    until = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > until:
            return False
        time.sleep(0.02)
    return True
