"""Stage of an attack case: services to attack, a measured victim, and findings."""

import json
import pickle
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import CompactMap, Delta, decode, encode_delta
from placecell_client.maps.edit import take

from benchmarks.attack.prober import Probe, ProbePlan
from benchmarks.attack.target import OWNER, VICTIM, Target
from benchmarks.attack.wire import DELTA, MSGPACK, AttackRequest, AttackResponse, ask, ask_all
from benchmarks.synthetic_maps.random_maps import MapTemplate
from placecell.core.types import UInt32

VICTIM_MAP = "victim-map"
VICTIM_SEGMENTS = 20
"""Segments in the victim's request."""

IDLE_SECONDS = 1.0
"""Seconds for which the victim is measured before each attack; a third in the short form."""

EDITS = 400
"""Largest number of victim writes during one attack."""

ALL_EDITS = 8_000
"""Largest number of victim writes to one service."""

NONE: UInt32 = np.zeros(0, np.uint32)


@dataclass(slots=True)
class Findings:
    """Findings of one case.

    Attributes:
        why: one sentence per fault.
        victim_max_s: longest wait of a victim's request during an attack, seconds.
        victim_idle_max_s: longest wait of a victim's request just before an attack, seconds.
        statuses: number of answers with each status, to the attacker and the victim.
        lost: number of acknowledged writes that were lost.
        peak_mb: peak memory of the case's services, MB.
        notes: further figures, by name.
    """

    why: list[str] = field(default_factory=list)
    victim_max_s: float = 0.0
    victim_idle_max_s: float = 0.0
    statuses: Counter[str] = field(default_factory=Counter)
    lost: int = 0
    peak_mb: float = 0.0
    notes: dict[str, Any] = field(default_factory=dict)


@dataclass(slots=True)
class Stage:
    """Services, victim and findings of one case.

    Attributes:
        folder: folder for the data directories of its services.
        limit_mb: memory limit of a service, MB.
        short: whether sizes and times are those of the short form.
        victim_seconds: longest allowed wait of a victim's request, seconds.
        random: random generator of the case.
        shared: running service for cases that need none of their own; None: each case starts its
            own.
        found: findings so far.
    """

    folder: Path
    limit_mb: float
    short: bool
    victim_seconds: float
    random: np.random.Generator
    shared: Target | None = None
    found: Findings = field(default_factory=Findings)
    _services: int = 0
    _written: dict[Target, set[int]] = field(default_factory=dict)
    _lost: set[tuple[Target, str, int]] = field(default_factory=set)

    def size(self, full: float, short: float) -> int:
        """Return the size for this form of the run."""
        return int(short if self.short else full)

    def expect(self, good: bool, why: str) -> bool:
        """Note `why` as a fault unless `good` is true; return `good`."""
        if not good and why not in self.found.why:
            self.found.why.append(why)
        return good

    def note(self, name: str, value: object) -> None:
        """Add a figure to the report."""
        self.found.notes[name] = value

    def next_data(self) -> Path:
        """Return the data directory of the next service."""
        return self.folder / f"service-{self._services + 1}" / "data"

    @contextmanager
    def service(
        self,
        environment: Mapping[str, str] | None = None,
        with_keys: bool = True,
        own: bool = True,
    ) -> Iterator[Target]:
        """Run a service; at the end of the block it must run and hold every acknowledged write.

        Args:
            environment: further environment variables.
            with_keys: whether the service requires API keys.
            own: whether the case needs a service of its own instead of the shared one.
        """
        if self.shared is not None and not own:
            yield from self._sharing(self.shared)
            return
        self._services += 1
        target = Target(
            self.folder / f"service-{self._services}", self.limit_mb, environment, with_keys
        )
        try:
            target.start()
            yield target
            self.settle(target)
        finally:
            target.stop()
            self._judge(target)

    def ask(self, target: Target, request: AttackRequest, seconds: float = 120.0) -> AttackResponse:
        """Send a request and count its status."""
        answer = ask(target, request, seconds)
        self.count([answer])
        return answer

    def ask_all(
        self,
        target: Target,
        requests: Sequence[AttackRequest],
        at_once: int,
        seconds: float = 120.0,
    ) -> list[AttackResponse]:
        """Send requests concurrently and count their statuses."""
        answers = ask_all(target, requests, at_once, seconds)
        self.count(answers)
        return answers

    def count(self, answers: Iterable[AttackResponse]) -> None:
        """Count statuses."""
        self.found.statuses.update(str(answer.status) for answer in answers)

    def expect_no_failure(self, answers: Iterable[AttackResponse], what: str) -> None:
        """Expect successes or refusals only: no status 500 or 502, no cut connection."""
        bad = Counter(answer.status for answer in answers if answer.status in {0, 500, 502})
        self.expect(not bad, f"{what}: {sum(bad.values())} requests failed (statuses {dict(bad)}).")

    @contextmanager
    def victim(
        self,
        target: Target,
        writes: bool = True,
        reads: bool = False,
        seconds: float | None = None,
    ) -> Iterator[None]:
        """Measure how long the victim waits while the block attacks.

        Args:
            target: service under attack.
            writes: whether the victim also edits its map.
            reads: whether the victim also downloads its map.
            seconds: longest allowed wait, seconds; None: that of the run.
        """
        probes = [self._describe_probe(target)]
        if writes:
            probes.append(self._edit_probe(target))
        if reads:
            probes.append(Probe("get", "GET", f"/maps/{VICTIM_MAP}", (b"",), _victim(target)))
        host, port = target.place
        plan = self.folder / f"probes-{len(self.found.notes)}-{time.monotonic_ns()}.pickle"
        plan.write_bytes(pickle.dumps(ProbePlan(host, port, tuple(probes))))
        with subprocess.Popen(
            [sys.executable, "-m", "benchmarks.attack.prober", str(plan)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        ) as process:
            assert process.stdin is not None
            assert process.stdout is not None
            process.stdout.readline()
            time.sleep(IDLE_SECONDS * (0.3 if self.short else 1))
            try:
                process.stdin.write("attack\n")
                process.stdin.flush()
                yield
            finally:
                process.stdin.close()
                waits = json.loads(process.stdout.read())
        self._take(target, waits, self.victim_seconds if seconds is None else seconds)

    def settle(self, target: Target) -> None:
        """Kill the service, restart it, and count the victim's lost writes."""
        written = self._written.get(target)
        if not written or target.died:
            return
        target.kill()
        if target.died:
            return
        target.start()
        self.expect_there(target, VICTIM_MAP, written, "after a kill")

    def expect_there(self, target: Target, name: str, written: Iterable[int], when: str) -> None:
        """Expect that a map holds the segments of acknowledged writes; count the lost ones."""
        answer = ask(target, AttackRequest("GET", f"/maps/{name}", key=OWNER))
        there = {*decode(answer.body).ids.tolist()} if answer.status == 200 else set[int]()
        lost = {*written} - there
        self._lost |= {(target, name, id_) for id_ in lost}
        self.found.lost = len(self._lost)
        self.expect(not lost, f"{len(lost)} acknowledged writes of {name} are lost {when}.")

    def _sharing(self, target: Target) -> Iterator[Target]:
        """Lend the shared service; restart it if the previous case ended it."""
        if not target.is_running():
            target.stop()
            self.expect(not target.died, f"The service ended after the last case: {target.died}.")
            target.start()
        target.forget_peak()
        target.memory.peak_mb, target.memory.killed, target.died = 0.0, False, ""
        self._written[target] = set()
        try:
            yield target
            if target.is_running() and self._written[target]:
                self.expect_there(target, VICTIM_MAP, self._written[target], "after the attack")
        finally:
            target.peak_mb()
            if not target.is_running():
                target.stop()
            self._judge(target)

    def _judge(self, target: Target) -> None:
        self.found.peak_mb = max(self.found.peak_mb, round(target.memory.peak_mb, 1))
        self.expect(not target.died, f"The service did not survive: {target.died}.")
        self.expect(
            target.memory.peak_mb <= self.limit_mb,
            f"The service took {target.memory.peak_mb:.0f} MB; the limit is "
            f"{self.limit_mb:.0f} MB.",
        )

    def _take(self, target: Target, waits: dict[str, Any], most: float) -> None:
        for name, each in waits.items():
            self.found.statuses.update({k: v for k, v in each["statuses"].items() if k != "0"})
            self.found.victim_max_s = max(self.found.victim_max_s, round(each["max"], 3))
            self.found.victim_idle_max_s = max(
                self.found.victim_idle_max_s, round(each["idle_max"], 3)
            )
            self.expect(
                each["max"] <= most and not each["unanswered"],
                f"Another key's small request ({name}) waited {each['max']:.2f} s"
                f"{' and was never answered' if each['unanswered'] else ''}; {most:g} s are "
                "allowed.",
            )
            if name == "edit":
                done = target.reserved[target.edited :][: each["done"]]
                self._written[target] |= {*done.tolist()}
                target.edited += each["done"]

    def _describe_probe(self, target: Target) -> Probe:
        body = describe_body(clouds(VICTIM_SEGMENTS, 100, self.random))
        headers = _victim(target) | {"Content-Type": MSGPACK, "Accept": MSGPACK}
        return Probe("describe", "POST", "/describe", (body,), headers)

    def _edit_probe(self, target: Target) -> Probe:
        client = target.client(VICTIM)
        template = MapTemplate.from_info(client.info())
        if not len(target.reserved):
            client.edit_map(VICTIM_MAP, Delta(template.empty_map(), NONE), create=True)
            target.reserved = client.reserve_ids(VICTIM_MAP, ALL_EDITS)
        self._written.setdefault(target, set())
        ids = target.reserved[target.edited :][:EDITS]
        made = template.random_map(VICTIM, ids, self.random)
        bodies = tuple(
            encode_delta(Delta(take(made, np.arange(len(ids)) == row), NONE))
            for row in range(len(ids))
        )
        headers = _victim(target) | {"Content-Type": DELTA}
        path = f"/maps/{VICTIM_MAP}/segments"
        return Probe("edit", "POST", path, bodies, headers, interval=0.2, once=True)


Attack = Callable[[Stage], None]


@dataclass(frozen=True, slots=True)
class AttackCase:
    """One attack and the behavior that it must not break.

    Attributes:
        id: row in the list of known faults, such as A1.
        attack: function that attacks; its docstring states the attack in one sentence.
        expected: required behavior of the service, in one sentence.
        in_short: whether the short form runs the case.
    """

    id: str
    attack: Attack
    expected: str
    in_short: bool = True


def clouds(
    count: int, points: int, random: np.random.Generator, spread: float = 20.0
) -> list[np.ndarray[Any, np.dtype[np.float32]]]:
    """Return the random points of `count` segments, float32 (points, 3) each.

    The segments lie within `spread` meters of the sensor along each axis.
    """
    return [
        (random.uniform(-1, 1, (points, 3)) + random.uniform(-spread, spread, 3)).astype("<f4")
        for _ in range(count)
    ]


def described(
    segments: Sequence[np.ndarray[Any, np.dtype[np.float32]]], sensor: Sequence[float] = (0, 0, 0)
) -> dict[str, Any]:
    """Return the body of a request with segments, before encoding in msgpack."""
    return {
        "segments": [
            {"points": each.astype("<f4").tobytes(), "sensor": [*map(float, sensor)]}
            for each in segments
        ]
    }


def describe_body(segments: Sequence[np.ndarray[Any, np.dtype[np.float32]]]) -> bytes:
    """Return the body of a `/describe` request in msgpack."""
    packed: bytes = msgpack.packb(described(segments))
    return packed


def template_of(target: Target) -> MapTemplate:
    """Return the template of maps for the service's default model."""
    return MapTemplate.from_info(target.client(OWNER).info())


def delta_of(changed: CompactMap, removed: UInt32 = NONE) -> bytes:
    """Return the delta file of an edit."""
    return encode_delta(Delta(changed, removed))


def with_columns(content: CompactMap, **columns: Any) -> CompactMap:
    """Return a copy of a map with some columns replaced."""
    return replace(content, **columns)


def _victim(target: Target) -> dict[str, str]:
    return target.authorization(VICTIM)
