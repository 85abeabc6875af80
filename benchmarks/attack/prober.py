"""Process of the victim: a robot that sends small requests all the time.

    python -m benchmarks.attack.prober PLAN

The process imports only the standard library, so it starts at once and adds no delay of its own.
It writes `ready`, waits for the line `attack`, continues until its input ends, and then writes its
measurements as JSON.
"""

import http.client
import json
import pickle
import sys
import threading
import time
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path

PATIENCE = 30.0
"""Seconds after the end of an attack within which an answer still counts."""

PAUSE = 0.05
"""Seconds before a refused request is sent again."""


@dataclass(frozen=True, slots=True)
class Probe:
    """A small request that is sent repeatedly.

    Attributes:
        name: name of the request in the report.
        method, path: HTTP method and path.
        bodies: bodies, sent in turn.
        headers: headers of every request, with the key.
        interval: time between two requests, seconds.
        once: whether each body is sent until it is acknowledged, and never again after that.
    """

    name: str
    method: str
    path: str
    bodies: tuple[bytes, ...]
    headers: dict[str, str]
    interval: float = 0.05
    once: bool = False


@dataclass(frozen=True, slots=True)
class ProbePlan:
    """Address of the service and the probes to send."""

    host: str
    port: int
    probes: tuple[Probe, ...]


@dataclass(slots=True)
class Waits:
    """Waiting times and results of one kind of request.

    Attributes:
        idle_max: longest wait before the attack, seconds.
        max: longest wait since the begin of the attack, seconds; unanswered requests count too.
        statuses: number of answers with each status; 0: the connection failed.
        done: number of acknowledged bodies.
        unanswered: whether the last request was never answered.
    """

    idle_max: float = 0.0
    max: float = 0.0
    statuses: Counter[str] = field(default_factory=Counter)
    done: int = 0
    unanswered: bool = False


class _Prober:
    """Sender of one kind of request."""

    def __init__(self, plan: ProbePlan, probe: Probe) -> None:
        self.waits = Waits()
        self._plan = plan
        self._probe = probe
        self._connection: http.client.HTTPConnection | None = None

    def run(self, attacked: threading.Event, ended: threading.Event) -> None:
        """Send requests at their interval until the attack ends, and one after its end.

        A late request delays the next. The last one shows a service that died during a pause.
        """
        probe, waits = self._probe, self.waits
        last = False
        while not last and not (probe.once and waits.done >= len(probe.bodies)):
            last = ended.is_set()
            due = time.perf_counter()
            answered = self._answered(probe.bodies[waits.done % len(probe.bodies)], ended)
            wait = time.perf_counter() - due
            if not attacked.is_set():
                waits.idle_max = max(waits.idle_max, wait)
            else:
                waits.max = max(waits.max, wait)
            waits.done += answered
            waits.unanswered = not answered
            ended.wait(max(0.0, due + probe.interval - time.perf_counter()))

    def _answered(self, body: bytes, ended: threading.Event) -> bool:
        """Send a request until it succeeds; return whether it did."""
        end: float | None = None
        while True:
            status = self._status(body)
            self.waits.statuses[str(status)] += 1
            if 200 <= status < 300:
                return True
            if ended.is_set():
                end = end or time.perf_counter()
                # A refused connection means that the service is down and will not answer.
                if status == 0 or time.perf_counter() > end + PATIENCE:
                    return False
            time.sleep(PAUSE)

    def _status(self, body: bytes) -> int:
        try:
            if self._connection is None:
                self._connection = http.client.HTTPConnection(
                    self._plan.host, self._plan.port, timeout=4 * PATIENCE
                )
            self._connection.request(
                self._probe.method, self._probe.path, body or None, self._probe.headers
            )
            response = self._connection.getresponse()
            response.read()
        except (OSError, http.client.HTTPException):
            if self._connection is not None:
                self._connection.close()
            self._connection = None
            return 0
        return response.status


def main() -> None:
    """Run the plan file that the caller wrote for this process."""
    plan: ProbePlan = pickle.loads(Path(sys.argv[1]).read_bytes())
    attacked, ended = threading.Event(), threading.Event()
    probers = [_Prober(plan, probe) for probe in plan.probes]
    threads = [threading.Thread(target=each.run, args=(attacked, ended)) for each in probers]
    for thread in threads:
        thread.start()
    print("ready", flush=True)
    sys.stdin.readline()
    attacked.set()
    sys.stdin.read()
    ended.set()
    for thread in threads:
        thread.join()
    json.dump(
        {
            probe.name: {name: getattr(each.waits, name) for name in Waits.__slots__}
            for probe, each in zip(plan.probes, probers, strict=True)
        },
        sys.stdout,
    )


if __name__ == "__main__":
    # Under `-m` this module is `__main__`; the plan was pickled with its own name.
    from benchmarks.attack.prober import main as run

    run()
