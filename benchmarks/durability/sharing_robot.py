"""Robot that shares a map with others: edits its own segments and pulls all changes."""

import random
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from threading import Event
from typing import TypeVar

import httpx
import numpy as np
from placecell_client import Client, CompactMap, Delta, MapCopy, Retries, ServiceError, encode
from placecell_client.maps.edit import apply, take

from benchmarks.synthetic_maps.random_maps import MapTemplate
from placecell.core.types import UInt32

T = TypeVar("T")

RETRIES = Retries(attempts=4, first_wait=0.05, longest_wait=0.5, longest_attempt=5.0)
TRANSIENT = {429, 502, 503, 504}
"""Statuses after which a robot repeats its call."""

RETRY_SECONDS = 60.0
"""Time after which a robot no longer repeats a call, seconds."""

PAUSE_SECONDS = 0.02
"""Mean time between two calls, seconds."""

EDIT_SEGMENTS = 60
"""Largest number of segments of an edit."""

MAX_SEGMENTS = 3_000
"""Number of its own segments above which a robot removes some."""

RESERVED_IDS = 400
"""Number of ids that a robot reserves at once."""

PAGE = 700
"""Segments per page of a pull: few, so that links are cut between pages."""


@dataclass(slots=True)
class SharingRobot:
    """Sharing robot; repeats each call until it succeeds.

    Attributes:
        name: name of the robot.
        map_name: name of the map.
        template: template of its segments.
        draw: random generator of the choices.
        compacts: whether it also drops old versions, so that the copies of others become outdated.
        own: its own segments, as the service has acknowledged them.
        copy: copy of the whole map.
        reserved: all ids that it has reserved.
        edits, pulls, retries: number of edits, pulls, and repeated calls.
        wrong: description of each fault.
    """

    name: str
    map_name: str
    template: MapTemplate
    draw: random.Random
    compacts: bool = False
    own: CompactMap = field(init=False)
    copy: MapCopy = field(init=False)
    reserved: list[UInt32] = field(default_factory=list)
    edits: int = 0
    pulls: int = 0
    retries: int = 0
    wrong: list[str] = field(default_factory=list)
    _free: UInt32 = field(default_factory=lambda: np.zeros(0, np.uint32))
    _random: np.random.Generator = field(init=False)

    def __post_init__(self) -> None:
        self.own = self.template.empty_map()
        self.copy = MapCopy(self.map_name)
        self._random = np.random.default_rng(self.draw.getrandbits(64))

    def run(self, address: str, ended: Event) -> None:
        """Edit and pull until the run ends."""
        with Client(address, timeout=20.0, retries=RETRIES) as client:
            try:
                while not ended.wait(self.draw.expovariate(1 / PAUSE_SECONDS)):
                    self._do(client)
            except (ServiceError, httpx.TransportError) as error:
                self.wrong.append(f"{self.name} gave up: {error}")

    def pull(self, client: Client) -> None:
        """Update the copy and check that it holds the robot's own acknowledged segments."""
        self._repeat(lambda: client.pull(self.copy, PAGE))
        self.pulls += 1
        if encode(self._mine()) != encode(self.own):
            self.wrong.append(f"{self.name}: own segments differ at version {self.copy.etag}")

    def _do(self, client: Client) -> None:
        if self.draw.random() < 0.6:
            self._edit(client)
        elif self.compacts and self.draw.random() < 0.1:
            keep = self.draw.randint(1, 20)
            self._repeat(lambda: client.compact_map(self.map_name, keep))
        else:
            self.pull(client)

    def _mine(self) -> CompactMap:
        content = self.copy.content
        assert content is not None
        if self.name not in content.robots:
            return self.template.empty_map()
        return take(content, content.robot == content.robots.index(self.name))

    def _edit(self, client: Client) -> None:
        """Replace, add and remove some segments."""
        count = self.draw.randint(1, EDIT_SEGMENTS)
        order = self._random.permutation(self.own.ids)
        replaced = order[: count // 3]
        too_many = max(len(self.own) - MAX_SEGMENTS, 0)
        removed = np.sort(order[len(replaced) :][: count // 6 + too_many])
        added = self._ids(client, count - count // 3)
        changed = self.template.random_map(
            self.name, np.concatenate([replaced, added]), self._random
        )
        delta = Delta(changed, removed)
        self._repeat(lambda: client.edit_map(self.map_name, delta))
        self.own = apply(self.own, delta)
        self.edits += 1

    def _ids(self, client: Client, count: int) -> UInt32:
        """Return ids that no other robot has."""
        if len(self._free) < count:
            given = self._repeat(lambda: client.reserve_ids(self.map_name, RESERVED_IDS))
            self.reserved.append(given)
            self._free = np.concatenate([self._free, given])
        ids, self._free = self._free[:count], self._free[count:]
        return ids

    def _repeat(self, call: Callable[[], T]) -> T:
        deadline = time.monotonic() + RETRY_SECONDS
        while True:
            try:
                return call()
            except httpx.TransportError:
                if time.monotonic() > deadline:
                    raise
            except ServiceError as error:
                if error.status not in TRANSIENT or time.monotonic() > deadline:
                    raise
            self.retries += 1
