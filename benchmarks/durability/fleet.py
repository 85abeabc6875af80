"""Fleet benchmark: robots share one map over faulty links while the service restarts.

Each robot adds, replaces and removes its own segments and pulls the changes of the others. At the
end all copies must equal the service's map byte by byte and hold every acknowledged segment.
"""

import random
import tempfile
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import asdict, dataclass
from pathlib import Path
from threading import Event, Thread
from typing import Any

import numpy as np
from placecell_client import Client, encode
from placecell_client.maps.union import union

from benchmarks.durability.cutting_proxy import CuttingProxy
from benchmarks.durability.sharing_robot import SharingRobot
from benchmarks.synthetic_maps.random_maps import MapTemplate
from evaluation.machine import machine
from service.child_process import Service

SITE = "site"


@dataclass(frozen=True, slots=True)
class FleetPlan:
    """Extent of a fleet run.

    Attributes:
        clients: number of robots.
        seconds: duration.
        uptime: mean time between a start of the service and its end, seconds.
        cut_bytes: mean number of bytes until a connection is cut.
    """

    clients: int = 8
    seconds: float = 180.0
    uptime: float = 10.0
    cut_bytes: float = 300_000.0


class Restarter:
    """Service behind a proxy that is killed or stopped at random, and restarted."""

    def __init__(self, data_dir: Path, options: tuple[str, ...], proxy: CuttingProxy) -> None:
        self._data_dir = data_dir
        self._options = options
        self._proxy = proxy
        self.kills = 0
        self.stops = 0
        self._start()

    @contextmanager
    def restarting(self, uptime: float, draw: random.Random) -> Iterator[None]:
        """Restart the service at random until the block ends; the service then runs."""
        ended = Event()
        thread = Thread(target=self._run, args=(ended, uptime, draw))
        thread.start()
        try:
            yield
        finally:
            ended.set()
            thread.join()

    def end(self) -> None:
        """Stop the service."""
        self._service.stop()

    def _run(self, ended: Event, uptime: float, draw: random.Random) -> None:
        while not ended.wait(draw.uniform(0.5, 1.5) * uptime):
            if draw.random() < 0.7:
                self._service.kill()
                self.kills += 1
            else:
                self._service.stop()
                self.stops += 1
            self._start()

    def _start(self) -> None:
        self._service = Service(self._data_dir, *self._options)
        self._proxy.service = self._service.address()


def run_fleet(plan: FleetPlan, seed: int = 0, options: tuple[str, ...] = ()) -> dict[str, Any]:
    """Run the fleet; return the report that `placecell bench fleet` writes.

    Args:
        plan: extent of the run.
        seed: random seed of all choices; the timing of threads, links and disks stays random.
        options: further options of `placecell serve`.
    """
    draw = random.Random(seed)
    proxy = CuttingProxy(random.Random(draw.getrandbits(64)), None)
    with tempfile.TemporaryDirectory(prefix="placecell-fleet-") as folder, proxy.running():
        restarter = Restarter(Path(folder), options, proxy)
        try:
            with Client(proxy.address) as client:
                template = MapTemplate.from_info(client.info())
                client.put_map(SITE, template.empty_map(), create_only=True)
            robots = [
                SharingRobot(
                    name=f"robot-{number}",
                    map_name=SITE,
                    template=template,
                    draw=random.Random(draw.getrandbits(64)),
                    compacts=number == 0,
                )
                for number in range(plan.clients)
            ]
            with restarter.restarting(plan.uptime, random.Random(draw.getrandbits(64))):
                proxy.cut_bytes = plan.cut_bytes
                _share(robots, proxy.address, plan.seconds)
            proxy.cut_bytes = None
            with Client(proxy.address) as client:
                for robot in robots:
                    robot.pull(client)
                file = client.get_map_file(SITE)
                versions = client.versions(SITE, 1)[0].sequence
        finally:
            restarter.end()
    return _report(plan, seed, robots, file) | {
        "versions": versions,
        "connections_cut": proxy.cuts,
        "kills": restarter.kills,
        "stops": restarter.stops,
    }


def _report(
    plan: FleetPlan, seed: int, robots: Sequence[SharingRobot], file: bytes
) -> dict[str, Any]:
    reserved = np.concatenate([ids for robot in robots for ids in robot.reserved])
    same = sum(_has(robot, file) for robot in robots)
    is_union = file == encode(union([robot.own for robot in robots]))
    twice = len(reserved) - len(np.unique(reserved))
    wrong = [fault for robot in robots for fault in robot.wrong]
    return {
        "clients": plan.clients,
        "seconds": plan.seconds,
        "edits_acknowledged": sum(robot.edits for robot in robots),
        "pulls": sum(robot.pulls for robot in robots),
        "asked_again": sum(robot.retries for robot in robots),
        "segments": sum(len(robot.own) for robot in robots),
        "map_bytes": len(file),
        "robots_with_the_service_s_map": same,
        "map_is_the_union": is_union,
        "ids_reserved_twice": twice,
        "wrong": wrong,
        "good": same == len(robots) and is_union and not twice and not wrong,
        "machine": machine(),
        "seed": seed,
        "plan": asdict(plan),
    }


def _share(robots: Sequence[SharingRobot], address: str, seconds: float) -> None:
    ended = Event()
    with ThreadPoolExecutor(len(robots)) as pool:
        runs = [pool.submit(robot.run, address, ended) for robot in robots]
        ended.wait(seconds)
        ended.set()
        for run in runs:
            run.result()


def _has(robot: SharingRobot, file: bytes) -> bool:
    return robot.copy.content is not None and encode(robot.copy.content) == file
