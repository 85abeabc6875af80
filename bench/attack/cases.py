"""All cases, in the order of the rows."""

from bench.attack import connections, storage, tenants, work
from bench.attack.stage import Case

_ALL = (*work.CASES, *connections.CASES, *storage.CASES, *tenants.CASES)

CASES: tuple[Case, ...] = tuple(sorted(_ALL, key=lambda case: int(case.id[1:])))
