"""A robot that shares a map with others: it edits its own segments, and pulls those of all."""

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
PASSING = {429, 502, 503, 504}
"""Statuses after which the same is asked again."""

PATIENCE = 60.0
"""Seconds after which a robot no longer asks again."""

PAUSE = 0.02
"""Seconds between two calls, on average."""

EDIT = 60
"""Segments of an edit, at most."""

MOST = 3_000
"""Segments of its own, about."""

IDS = 400
"""Reserved at once."""

PAGE = 700
"""Segments in a part of what is pulled: few, so that links are cut between the parts."""


@dataclass(slots=True)
class SharingRobot:
    """Does one thing after the other, each until it is done, however often it must ask.

    Attributes:
        name: of the robot.
        site: name of the map.
        template: of its segments.
        draw: what it does.
        compacts: whether it also lets go of old versions, so that others lose their way.
        own: its segments, as the service has acknowledged them.
        copy: of the whole map.
        reserved: all ids that it was given.
        edits, pulls, again: how many; and how often it had to ask again.
        wrong: what should not have been.
    """

    name: str
    site: str
    template: MapTemplate
    draw: random.Random
    compacts: bool = False
    own: CompactMap = field(init=False)
    copy: MapCopy = field(init=False)
    reserved: list[UInt32] = field(default_factory=list)
    edits: int = 0
    pulls: int = 0
    again: int = 0
    wrong: list[str] = field(default_factory=list)
    _free: UInt32 = field(default_factory=lambda: np.zeros(0, np.uint32))
    _random: np.random.Generator = field(init=False)

    def __post_init__(self) -> None:
        self.own = self.template.empty_map()
        self.copy = MapCopy(self.site)
        self._random = np.random.default_rng(self.draw.getrandbits(64))

    def run(self, address: str, ended: Event) -> None:
        """Edit and pull until it is over."""
        with Client(address, timeout=20.0, retries=RETRIES) as client:
            try:
                while not ended.wait(self.draw.expovariate(1 / PAUSE)):
                    self._do(client)
            except (ServiceError, httpx.TransportError) as error:
                self.wrong.append(f"{self.name} gave up: {error}")

    def pull(self, client: Client) -> None:
        """Bring the copy up to date; its own segments must be as they were acknowledged."""
        self._insist(lambda: client.pull(self.copy, PAGE))
        self.pulls += 1
        if encode(self._mine()) != encode(self.own):
            self.wrong.append(f"{self.name}: other segments of its own at {self.copy.etag}")

    def _do(self, client: Client) -> None:
        if self.draw.random() < 0.6:
            self._edit(client)
        elif self.compacts and self.draw.random() < 0.1:
            keep = self.draw.randint(1, 20)
            self._insist(lambda: client.compact_map(self.site, keep))
        else:
            self.pull(client)

    def _mine(self) -> CompactMap:
        content = self.copy.content
        assert content is not None
        if self.name not in content.robots:
            return self.template.empty_map()
        return take(content, content.robot == content.robots.index(self.name))

    def _edit(self, client: Client) -> None:
        """Some segments replaced, some added, some removed."""
        count = self.draw.randint(1, EDIT)
        order = self._random.permutation(self.own.ids)
        replaced = order[: count // 3]
        too_many = max(len(self.own) - MOST, 0)
        removed = np.sort(order[len(replaced) :][: count // 6 + too_many])
        added = self._ids(client, count - count // 3)
        changed = self.template.random_map(
            self.name, np.concatenate([replaced, added]), self._random
        )
        delta = Delta(changed, removed)
        self._insist(lambda: client.edit_map(self.site, delta))
        self.own = apply(self.own, delta)
        self.edits += 1

    def _ids(self, client: Client, count: int) -> UInt32:
        """Some that nobody else has."""
        if len(self._free) < count:
            given = self._insist(lambda: client.reserve_ids(self.site, IDS))
            self.reserved.append(given)
            self._free = np.concatenate([self._free, given])
        ids, self._free = self._free[:count], self._free[count:]
        return ids

    def _insist(self, call: Callable[[], T]) -> T:
        deadline = time.monotonic() + PATIENCE
        while True:
            try:
                return call()
            except httpx.TransportError:
                if time.monotonic() > deadline:
                    raise
            except ServiceError as error:
                if error.status not in PASSING or time.monotonic() > deadline:
                    raise
            self.again += 1
