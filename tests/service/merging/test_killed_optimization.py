"""SIGKILL during optimizations and merges that bend: the whole old or the whole new version."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from threading import Thread
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Client, CompactMap, Retries

from placecell.descriptors.manifest import Manifest
from service.child_process import Service
from tests.service.merging.drifting_maps import drifting_map
from tests.service.merging.merged_map_builders import models_that_judge
from tests.service.postgres_server import PostgresServer

pytestmark = [pytest.mark.integration, pytest.mark.slow, pytest.mark.sqlite]

WAIT_S = 60.0
"""Longest wait for an answer, for a commit, and for the end of a thread, seconds."""

SIDE = 10
"""Captures on each side of the block: few, for short optimizations."""

Commits = Callable[[], object]
"""Returns a value that changes when a transaction writes."""


@dataclass(slots=True)
class Killed:
    """Service that is killed and started again.

    Attributes:
        data_dir: data directory.
        options: options of `placecell serve`.
        environment: environment variables of the service.
    """

    data_dir: Path
    options: tuple[str, ...]
    environment: dict[str, str]
    process: Service | None = None
    address: str = ""

    def start(self) -> None:
        self.process = Service(self.data_dir, *self.options, environment=self.environment)
        self.address = self.process.address()

    def kill(self) -> None:
        if self.process is not None:
            self.process.kill()
        self.process = None

    def client(self) -> Client:
        return Client(self.address, timeout=WAIT_S, retries=Retries(attempts=1))


@pytest.fixture(scope="module")
def models(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def maps(models: Path) -> dict[str, CompactMap]:
    """A map of two laps, and maps of two robots of one lap each."""
    model_id = Manifest.load(models / "tiny").model_id
    given = {"block": drifting_map(model_id, 1, side=SIDE)[0]}
    for seed, name in ((1, "ann"), (2, "bob")):
        made = drifting_map(model_id, seed, laps=1, robot=name, odometry=True, side=SIDE)
        given[name] = made[0]
    return given


@pytest.fixture
def killed(tmp_path: Path, models: Path) -> Iterator[Killed]:
    options = ("--models-dir", str(models), "--model", "tiny")
    service = Killed(tmp_path / "var", options, {})
    try:
        yield service
    finally:
        service.kill()


def optimize(client: Client) -> None:
    client.optimize_map("block")


def merge(client: Client) -> None:
    client.merge_maps("site", ["ann", "bob"], rigid=False)


OPERATIONS = {"block": optimize, "site": merge}


State = tuple[bytes, tuple[float, ...] | None]
"""File of a map, and position of its anchor."""


def state_of(client: Client, name: str) -> State | None:
    """Return the state of a map; None if there is no such map."""
    if name not in {each.name for each in client.maps()}:
        return None
    positions = [tuple(each.position) for each in client.anchors(name)]
    return client.get_map_file(name), positions[0] if positions else None


Outcomes = dict[str, tuple[State | None, State | None]]


def outcomes(killed: Killed, maps: dict[str, CompactMap]) -> Outcomes:
    """Store the maps; return the state of each map before and after its operation."""
    found: Outcomes = {}
    with killed.client() as client:
        for name, content in maps.items():
            client.put_map(name, content)
        last = maps["block"].frame_positions[-1]
        client.set_named_anchor("block", "dock", last)
        for name, operation in OPERATIONS.items():
            before = state_of(client, name)
            operation(client)
            after = state_of(client, name)
            assert after is not None
            assert after != before
            found[name] = before, after
    undo(killed)
    with killed.client() as client:  # bytes come back, and the anchor up to rounding
        found["block"] = state_of(client, "block"), found["block"][1]
    return found


def undo(killed: Killed) -> None:
    """Bring both maps back to the state before the operations."""
    with killed.client() as client:
        client.restore_map("block", 1)
        if state_of(client, "site") is not None:
            client.delete_map("site")


def kill_during(killed: Killed, commits: Commits, writes: int, seconds: float) -> None:
    """Run both operations, and kill the service some time after one began to write.

    Args:
        killed: the service.
        commits: tells writes.
        writes: number of writes to wait for; 0: only the time passes.
        seconds: time from then to the kill.
    """

    def run(operation: Callable[[Client], None]) -> None:
        try:
            with killed.client() as client:
                operation(client)
        except httpx.TransportError:
            pass  # the service was killed

    state = commits()
    threads = [Thread(target=run, args=(each,), daemon=True) for each in OPERATIONS.values()]
    for thread in threads:
        thread.start()
    end = time.monotonic() + WAIT_S
    for _ in range(writes):
        while commits() == state and time.monotonic() < end:
            time.sleep(0.0002)
        state = commits()
    time.sleep(seconds)
    killed.kill()
    for thread in threads:
        thread.join(WAIT_S)
        assert not thread.is_alive()


def check(killed: Killed, found: Outcomes) -> None:
    """Start the service; each map is as before its operation, or as after it."""
    killed.start()
    with killed.client() as client:
        for name, both in found.items():
            assert any(is_same(state_of(client, name), each) for each in both)
    undo(killed)


def is_same(one: State | None, other: State | None) -> bool:
    """Return whether file and anchor are the same; an anchor that moved twice is rounded."""
    if one is None or other is None:
        return one is other
    places = [np.zeros(3) if each[1] is None else np.array(each[1]) for each in (one, other)]
    return one[0] == other[0] and float(np.abs(places[0] - places[1]).max()) < 1e-4


def wal_of(data_dir: Path) -> Commits:
    log = data_dir / "maps.sqlite-wal"

    def state() -> Any:
        status = log.stat()
        return status.st_size, status.st_mtime_ns

    return state


def test_killed_service_on_sqlite_has_the_old_or_the_new_version(
    killed: Killed, maps: dict[str, CompactMap]
) -> None:
    killed.start()
    found = outcomes(killed, maps)
    for writes, seconds in ((0, 0.3), (1, 0.0)):
        kill_during(killed, wal_of(killed.data_dir), writes, seconds)
        check(killed, found)


def test_killed_service_on_postgresql_has_the_old_or_the_new_version(
    killed: Killed,
    maps: dict[str, CompactMap],
    postgres_server: PostgresServer,
    postgres_database: str,
) -> None:
    import psycopg

    killed.environment = {"PLACECELL_DATABASE": postgres_database}
    killed.start()
    found = outcomes(killed, maps)
    with psycopg.connect(postgres_database, autocommit=True, connect_timeout=10) as connection:

        def writes() -> Any:
            return connection.execute(
                "SELECT count(*) FROM pg_stat_activity WHERE backend_xid IS NOT NULL "
                "AND datname = current_database() AND pid <> pg_backend_pid()"
            ).fetchone()

        kill_during(killed, writes, 1, 0.0)
        check(killed, found)
