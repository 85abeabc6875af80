"""Robots that write and read through the balancer while faults happen."""

import random
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Event, Lock

import httpx
import numpy as np
from placecell_client import Client, CompactMap, Delta, Retries, ServiceError, Written, decode
from placecell_client.maps.edit import apply

from benchmarks.replicas.availability import AnswerTimes
from benchmarks.synthetic_maps.random_maps import MapTemplate
from placecell.core.types import UInt32

ONCE = Retries(attempts=1)
"""Retry policy without retries: the robots repeat calls by themselves, and note each answer."""

WRITE_SECONDS = 1.2
"""Time limit of one attempt of a write, seconds."""

READ_SECONDS = 1.0
"""Time limit of one attempt of a read, seconds."""

PAUSE_SECONDS = 0.2
"""Longest time between two calls of a robot, seconds; the mean is half of it."""

RETRY_SECONDS = 0.05
"""Time between two attempts, seconds."""

GIVE_UP_SECONDS = 90.0
"""Time after which a call that never succeeds is a fault of the fleet."""

KEPT = 200
"""Number of its own, removable segments of a map that a writer keeps."""

IDS = 10_000_000
"""Number of ids of each writer; writer i has the ids from i times this number."""

WHOLE_MAPS = 0.1
"""Share of the reads that read a whole map; the others search a segment."""


@dataclass(frozen=True, slots=True)
class WriteProbe:
    """An acknowledged write that every read under its token must show.

    Attributes:
        map_name: name of the map.
        etag: ETag of the version that the write led to.
        id: id of a segment of the write that is never removed.
        code: its code.
    """

    map_name: str
    etag: str
    id: int
    code: tuple[int, ...]


class ProbeBoard:
    """Last probe of each map. Safe to use from many threads."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._probes: dict[str, WriteProbe] = {}

    def put(self, probe: WriteProbe) -> None:
        """Show a probe."""
        with self._lock:
            self._probes[probe.map_name] = probe

    def draw(self, draw: random.Random) -> WriteProbe | None:
        """Return the last probe of a random map; None before the first write."""
        with self._lock:
            return draw.choice([*self._probes.values()]) if self._probes else None


@dataclass(slots=True)
class FleetRobot:
    """Robot that repeats each call until it succeeds: a writer or a reader.

    Attributes:
        name: name of the robot.
        address: address of the balancer.
        draw: random generator of the choices.
        answers: times of its answers.
        refused: number of failed attempts, by status; `0` if there was no answer.
        failed: monotonic time, duration in seconds and status of each failed attempt.
        answered: duration of each attempt that succeeded, seconds.
        wrong: description of each fault.
    """

    name: str
    address: str
    draw: random.Random
    answers: AnswerTimes
    refused: Counter[str] = field(default_factory=Counter)
    failed: list[tuple[float, float, str]] = field(default_factory=list)
    answered: list[float] = field(default_factory=list)
    wrong: list[str] = field(default_factory=list)

    def run(self, ended: Event) -> None:
        """Make calls until the run ends."""
        raise NotImplementedError

    def run_noted(self, ended: Event) -> None:
        """Make calls until the run ends; an unexpected error is a fault."""
        try:
            self.run(ended)
        except Exception as error:
            self.wrong.append(f"{self.name}: {error!r}")

    def pause(self, ended: Event) -> bool:
        """Wait a random time; return whether the run goes on."""
        return not ended.wait(self.draw.uniform(0.0, PAUSE_SECONDS))

    def note_failure(self, begun: float, status: str) -> None:
        """Note that an attempt failed now."""
        self.refused[status] += 1
        self.failed.append((begun, time.monotonic() - begun, status))

    def note_answer(self, begun: float) -> None:
        """Note that an attempt succeeded now."""
        now = time.monotonic()
        self.answered.append(now - begun)
        self.answers.times.append(now)


@dataclass(slots=True)
class FleetWriter(FleetRobot):
    """Robot that edits its own segments of several maps.

    Attributes:
        template: template of the segments.
        maps: names of the maps.
        first_id: its first id.
        board: where it shows its acknowledged writes.
        own: its segments of each map, as the service has acknowledged them.
        acknowledged: number of acknowledged writes.
    """

    template: MapTemplate = field(kw_only=True)
    maps: tuple[str, ...] = field(kw_only=True)
    first_id: int = field(kw_only=True)
    board: ProbeBoard = field(kw_only=True)
    own: dict[str, CompactMap] = field(default_factory=dict)
    acknowledged: int = 0
    _removable: dict[str, list[int]] = field(default_factory=dict)
    _random: np.random.Generator = field(init=False)
    _used: int = 0

    def __post_init__(self) -> None:
        self._random = np.random.default_rng(self.draw.getrandbits(64))
        self.own = {name: self.template.empty_map() for name in self.maps}
        self._removable = {name: [] for name in self.maps}

    def run(self, ended: Event) -> None:
        """Edit until the run ends; each edit is repeated until it is acknowledged."""
        with Client(self.address, timeout=WRITE_SECONDS, retries=ONCE) as client:
            while self.pause(ended):
                if not self._edit(client):
                    return

    def _edit(self, client: Client) -> bool:
        """Add one lasting segment and some others, replace and remove others; False: gave up."""
        name = self.draw.choice(self.maps)
        others = self._removable[name]
        self.draw.shuffle(others)
        replaced, kept = others[: self.draw.randint(0, 3)], max(len(others) - KEPT, 0)
        removed = others[len(replaced) :][: self.draw.randint(0, 3) + kept]
        new = [self.first_id + self._used + i for i in range(self.draw.randint(1, 12))]
        self._used += len(new)
        ids = np.array([*new, *replaced], np.uint32)
        changed = self.template.random_map(self.name, ids, self._random)
        delta = Delta(changed, np.sort(np.array(removed, np.uint32)))
        written = self._repeat(lambda: client.edit_map(name, delta))
        if written is None:
            self.wrong.append(f"{self.name}: an edit of {name!r} was never acknowledged")
            return False
        self.own[name] = apply(self.own[name], delta)
        self.acknowledged += 1
        # The first new segment lasts; the others may be replaced or removed later.
        self._removable[name] = [*others[: len(replaced)], *others[len(replaced) + len(removed) :]]
        self._removable[name] += new[1:]
        self.board.put(WriteProbe(name, written.etag, new[0], tuple(changed.codes[0].tolist())))
        return True

    def _repeat(self, call: Callable[[], Written]) -> Written | None:
        until = time.monotonic() + GIVE_UP_SECONDS
        while time.monotonic() < until:
            begun = time.monotonic()
            try:
                written = call()
            except httpx.TransportError:
                self.note_failure(begun, "0")
            except ServiceError as error:
                self.note_failure(begun, str(error.status))
                if error.status < 500 and error.status != 429:
                    self.wrong.append(f"{self.name}: {error}")
                    return None
            else:
                self.note_answer(begun)
                return written
            time.sleep(RETRY_SECONDS)
        return None


@dataclass(slots=True)
class FleetReader(FleetRobot):
    """Robot that reads with the token of another robot's acknowledged write.

    Attributes:
        model_id: id of the model of the codes.
        board: where writers show their writes.
        reads: number of answers.
        stale: number of answers without a write that their token names.
    """

    model_id: str = field(kw_only=True)
    board: ProbeBoard = field(kw_only=True)
    reads: int = 0
    stale: int = 0

    def run(self, ended: Event) -> None:
        """Read until the run ends; each read is repeated until it is answered."""
        with httpx.Client(base_url=self.address, timeout=READ_SECONDS) as http:
            while self.pause(ended):
                probe = self.board.draw(self.draw)
                if probe is not None and not self._read(http, probe):
                    return

    def _read(self, http: httpx.Client, probe: WriteProbe) -> bool:
        """Read a probe until there is an answer; False: gave up."""
        is_whole = self.draw.random() < WHOLE_MAPS
        until = time.monotonic() + GIVE_UP_SECONDS
        while time.monotonic() < until:
            begun = time.monotonic()
            try:
                answer = self._ask(http, probe, is_whole)
                if answer.status_code == 200:
                    shows = self._shows(answer, probe, is_whole)
                    self.note_answer(begun)
                    self.reads += 1
                    if not shows:
                        self.stale += 1
                        self.wrong.append(f"{self.name}: {probe} is not in an answer")
                    return True
                self.note_failure(begun, str(answer.status_code))
                if answer.status_code < 500 and answer.status_code != 429:
                    self.wrong.append(f"{self.name}: {answer.status_code} {answer.text[:300]}")
                    return False
            except httpx.TransportError:
                self.note_failure(begun, "0")
            time.sleep(RETRY_SECONDS)
        self.wrong.append(f"{self.name}: a read of {probe.map_name!r} was never answered")
        return False

    def _ask(self, http: httpx.Client, probe: WriteProbe, is_whole: bool) -> httpx.Response:
        headers = seen_headers(probe.map_name, probe.etag)
        if is_whole:
            return http.get(f"/maps/{probe.map_name}", headers=headers)
        body = {
            "model_id": self.model_id,
            "codes": [probe.code],
            "maps": [probe.map_name],
            "k": 1,
        }
        return http.post("/match", json=body, headers=headers)

    def _shows(self, answer: httpx.Response, probe: WriteProbe, is_whole: bool) -> bool:
        """Return whether an answer shows the segment of a probe."""
        if is_whole:
            return probe.id in ids_of(decode(answer.content))
        candidates = answer.json()["queries"][0]["candidates"]
        return any(each["id"] == probe.id and each["distance"] == 0 for each in candidates)


def ids_of(content: CompactMap) -> UInt32:
    """Return the ids of a map."""
    return content.ids


def seen_headers(map_name: str, etag: str) -> dict[str, str]:
    """Return the header by which a replica answers only once it has a version of a map."""
    return {"Placecell-Seen": f"{map_name} {etag}"}
