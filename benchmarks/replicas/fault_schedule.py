"""Plan of a fleet crash run: number and times of the faults."""

import random
from dataclasses import dataclass

from benchmarks.replicas.replica_group import STARTING_NICE

SPREAD = 0.95
"""Share of the duration over which the faults are spread; late faults use the rest."""


@dataclass(frozen=True, slots=True)
class FleetCrashPlan:
    """Extent of a run.

    Attributes:
        seconds: planned duration of the faults.
        kills: number of kills of a replica.
        crashes: number of crashes of the primary.
        cuts: number of connections that are cut after a COMMIT.
        pauses: number of pauses of a replica.
        full_disks: number of times that the primary's disk is full.
        paused: duration of a pause of a replica, seconds.
        full: duration of a full disk, seconds.
        replicas: number of replicas.
        writers, readers: number of robots.
        starting_nice: niceness of a replica while it starts.
    """

    seconds: float = 1200.0
    kills: int = 100
    crashes: int = 10
    cuts: int = 5
    pauses: int = 5
    full_disks: int = 2
    paused: float = 4.0
    full: float = 3.0
    replicas: int = 3
    writers: int = 3
    readers: int = 3
    starting_nice: int = STARTING_NICE

    @classmethod
    def of(
        cls,
        seconds: float,
        kills: int | None = None,
        crashes: int | None = None,
        starting_nice: int = STARTING_NICE,
    ) -> "FleetCrashPlan":
        """Return the plan for a duration, with about a fault every ten seconds.

        Args:
            seconds: planned duration of the faults.
            kills: number of kills of a replica; five a minute unless given.
            crashes: number of crashes of the primary; one in two minutes unless given.
            starting_nice: niceness of a replica while it starts.
        """
        minutes = seconds / 60
        crashes = crashes if crashes is not None else max(round(minutes / 2), 1)
        return cls(
            seconds=seconds,
            kills=kills if kills is not None else max(round(5 * minutes), 1),
            crashes=crashes,
            cuts=max(round(minutes / 4), 1),
            pauses=max(round(minutes / 4), 1),
            full_disks=max(round(minutes / 10), 1),
            starting_nice=starting_nice,
        )


@dataclass(frozen=True, slots=True)
class DueFault:
    """Fault that is planned.

    Attributes:
        cause: kind of the fault.
        seconds: time after the begin of the faults, seconds.
    """

    cause: str
    seconds: float


def scheduled(plan: FleetCrashPlan, draw: random.Random) -> list[DueFault]:
    """Return all faults of a plan in their order.

    Each kind is spread evenly. Each fault has a time slot of its own, and a random time in it.
    """
    counts = {
        "replica": plan.kills,
        "primary": plan.crashes,
        "cut_commit": plan.cuts,
        "paused": plan.pauses,
        "full_disk": plan.full_disks,
    }
    places = [
        ((number + draw.random()) / count, cause)
        for cause, count in counts.items()
        for number in range(count)
    ]
    slot = SPREAD * plan.seconds / max(len(places), 1)
    return [
        DueFault(cause, (number + draw.random()) * slot)
        for number, (_, cause) in enumerate(sorted(places))
    ]
