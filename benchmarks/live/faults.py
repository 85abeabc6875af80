"""Faults: the agent and the service are killed, and the link is cut; the map must not change."""

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from placecell_client import Client, CompactMap, decode

from benchmarks.durability.cutting_proxy import CuttingProxy
from service.child_process import Service, running_service

SITE, YARD = "site", "yard"
"""Map to localize in, and map that the robot makes."""
EARLY = 0.15
"""Share of the kills that may hit the start of the agent."""
POLL_SECONDS = 0.05
"""Time between two looks at the robot's events."""


@dataclass(frozen=True, slots=True)
class FaultPlan:
    """Plan of a measurement.

    Attributes:
        source: drive, as `placecell robot` takes it.
        kills: number of times that the agent is killed.
        restarts: number of times that the service is killed and started again.
        cut_seconds: duration of one long cut of the link.
        cut_bytes: mean number of bytes until a connection is cut; None: none is.
        seed: seed of the moments.
        options: further options of `placecell robot`.
    """

    source: str
    kills: int = 50
    restarts: int = 5
    cut_seconds: float = 600.0
    cut_bytes: float | None = 300_000.0
    seed: int = 0
    options: tuple[str, ...] = ()


def run_faults(plan: FaultPlan, tell: Callable[[str], None] = lambda _: None) -> dict[str, Any]:
    """Make the map without faults and with them; return how they compare."""
    with ExitStack() as opened:
        folder = Path(opened.enter_context(TemporaryDirectory(prefix="placecell-faults-")))
        expected = undisturbed(plan, folder / "calm")
        tell(f"without faults: {len(decode(expected)):,} segments, {len(expected):,} bytes")
        (folder / "site.map").write_bytes(expected)
        return disturbed(plan, expected, folder, tell)


def undisturbed(plan: FaultPlan, folder: Path) -> bytes:
    """Return the file of the map that a run without faults makes."""
    with running_service(folder / "data") as url:
        command = robot_command(plan, url, folder / "state", folder / "events.jsonl")
        subprocess.run([*command, "--no-localize"], check=True, stdout=subprocess.DEVNULL)
        with Client(url) as client:
            return client.get_map_file(YARD)


def robot_command(plan: FaultPlan, url: str, state: Path, events: Path) -> list[str]:
    """Return the command of the agent."""
    return [
        *(sys.executable, "-m", "cli", "robot", plan.source, "--service", url, "--map", YARD),
        *("--localize-map", SITE, "--state", str(state), "--events", str(events)),
        *("--robot-name", "robot", "--wait", "600", "--json", *plan.options),
    ]


def disturbed(
    plan: FaultPlan, expected: bytes, folder: Path, tell: Callable[[str], None]
) -> dict[str, Any]:
    """Run the agent with faults; compare the map with the expected one."""
    draw = random.Random(plan.seed)
    proxy = CuttingProxy(draw, plan.cut_bytes)
    with ExitStack() as opened:
        opened.enter_context(proxy.running())
        hall = Hall(folder / "data", proxy)
        opened.callback(hall.stop)
        hall.start()
        with Client(hall.address) as client:
            client.put_map(SITE, expected)
        events = folder / "events.jsonl"
        events.touch()
        command = robot_command(plan, proxy.address, folder / "state", events)
        trial = KilledRuns(plan, command, events, hall, draw)
        while not trial.is_over:
            trial.run(tell)
        hall.mend_at_end()
        if trial.spool_entries:  # The link was cut until now.
            trial.run(tell)
        with Client(hall.address) as client:
            found = client.get_map_file(YARD)
            maps = sorted(each.name for each in client.maps().maps)
    return compared(expected, found) | {
        "kills": trial.kills,
        "service_kills": trial.restarts,
        "cut_seconds": plan.cut_seconds,
        "connections_cut": proxy.cuts,
        "runs": trial.runs,
        "maps": maps,
        "fixes": fixes_in(events),
        "spool_entries": trial.spool_entries,
    }


class KilledRuns:
    """The agent's runs, each ended by SIGKILL until all kills are made."""

    def __init__(
        self,
        plan: FaultPlan,
        command: list[str],
        events: Path,
        hall: "Hall",
        draw: random.Random,
    ) -> None:
        self._plan = plan
        self._command = command
        self._events = events
        self._hall = hall
        self._draw = draw
        self._restart_after = sorted(draw.choices(range(max(plan.kills, 1)), k=plan.restarts))
        self.kills = 0
        self.restarts = 0
        self.runs = 0
        self.spool_entries = 0
        self.is_over = False

    def run(self, tell: Callable[[str], None]) -> None:
        """Run the agent until it is killed, or has finished."""
        self.runs += 1
        while self._restart_after and self.kills >= self._restart_after[0]:
            self._restart_after.pop(0)
            self._hall.restart()
            self.restarts += 1
        if self.kills >= self._plan.kills // 3 and self._plan.cut_seconds > 0:
            self._hall.cut_once(self._plan.cut_seconds)
        summary = self._events.with_name("summary.json")
        with summary.open("wb") as output:
            agent = subprocess.Popen(self._command, stdout=output, stderr=subprocess.DEVNULL)
        self._kill_later(agent)
        agent.wait()
        if agent.returncode == 0:
            self.spool_entries = json.loads(summary.read_text())["spool"]["entries"]
        tell(f"{self.kills} kills, {keyframes_in(self._events)} keyframes so far")
        # A run that ended before all kills is started again: its session continues.
        self.is_over = agent.returncode == 0 and self.kills >= self._plan.kills

    def _kill_later(self, agent: subprocess.Popen[bytes]) -> None:
        """Kill the agent at a random moment: sometimes in its start, mostly at a keyframe."""
        wanted = keyframes_in(self._events) + self._draw.randrange(1, 45)
        latest = time.monotonic() + self._draw.uniform(1.0, 10.0)
        is_early = self._draw.random() < EARLY
        while agent.poll() is None:
            self._hall.mend_if_due()
            is_due = keyframes_in(self._events) >= wanted
            if self.kills < self._plan.kills and (
                is_due or (is_early and time.monotonic() >= latest)
            ):
                time.sleep(self._draw.uniform(0.0, 0.3))
                os.kill(agent.pid, signal.SIGKILL)
                self.kills += 1
                return
            time.sleep(POLL_SECONDS)


class Hall:
    """Service that is killed and started again behind a proxy, which keeps its address.

    Attributes:
        address: address of the service itself.
    """

    def __init__(self, data: Path, proxy: CuttingProxy) -> None:
        self._data = data
        self._proxy = proxy
        self._service: Service | None = None
        self._cut_until: float | None = None
        self.address = ""

    def start(self) -> None:
        """Start the service; while the link is cut, only the address itself reaches it."""
        self._service = Service(self._data)
        self.address = self._service.address()
        self.mend_if_due()

    def restart(self) -> None:
        """Kill the service with SIGKILL, and start it again."""
        assert self._service is not None
        self._proxy.service = None
        self._service.kill()
        self.start()

    def cut_once(self, seconds: float) -> None:
        """Cut the link for a time, at the first call; open connections end with the service."""
        if self._cut_until is None:
            self._cut_until = time.monotonic() + seconds
            self.restart()

    def mend_if_due(self) -> None:
        """Mend the link when its time has come."""
        if self._cut_until is None or time.monotonic() >= self._cut_until:
            self._proxy.service = self.address

    def mend_at_end(self) -> None:
        """Wait for the end of the cut, and mend the link."""
        if self._cut_until is not None:
            time.sleep(max(0.0, self._cut_until - time.monotonic()))
        self.mend_if_due()

    def stop(self) -> None:
        """Stop the service."""
        if self._service is not None:
            self._service.stop()


def compared(expected: bytes, found: bytes) -> dict[str, Any]:
    """Compare two map files."""
    before, after = decode(expected), decode(found)
    return {
        "equal_bytes": expected == found,
        "segments_expected": len(before),
        "segments_found": len(after),
        "segments_missing": len(np.setdiff1d(before.ids, after.ids)),
        "segments_twice": twice(after) - twice(before),
    }


def twice(content: CompactMap) -> int:
    """Return the number of segments that have the code and the centroid of another one."""
    rows = np.column_stack([content.codes.astype(np.float64), content.centroids])
    return len(rows) - len(np.unique(rows, axis=0))


def keyframes_in(events: Path) -> int:
    """Return the number of keyframes in a file of events."""
    return events.read_bytes().count(b'"event": "keyframe"')


def fixes_in(events: Path) -> dict[str, int]:
    """Return the number of accepted fixes by their source."""
    counts: dict[str, int] = {"service": 0, "local": 0}
    for text in events.read_text(encoding="utf-8", errors="replace").splitlines():
        try:
            event = json.loads(text)
        except ValueError:
            continue  # The agent was killed while it wrote the line.
        if event.get("event") == "fix" and event["accepted"]:
            counts[event["source"]] = counts.get(event["source"], 0) + 1
    return counts
