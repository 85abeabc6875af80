"""All attack cases, in the order of the fault rows."""

from benchmarks.attack import connections, storage, tenants, work
from benchmarks.attack.stage import AttackCase

_ALL = (*work.CASES, *connections.CASES, *storage.CASES, *tenants.CASES)

CASES: tuple[AttackCase, ...] = tuple(sorted(_ALL, key=lambda case: int(case.id[1:])))
