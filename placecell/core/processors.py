"""Processor cores that this process may use: CPU affinity and control group quota."""

import math
import os
import re
from collections.abc import Iterator, MutableMapping
from pathlib import Path, PurePosixPath

THREAD_VARIABLES = ("OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
"""Variables of libraries that by default start a thread per host core; see `limit_threads`."""

OPENMP = "OMP_NUM_THREADS"


def available_cores(root: Path = Path("/")) -> int:
    """Return the number of cores that this process may keep busy, at least 1.

    It is the minimum of the host's cores, the process's affinity and the CPU quotas of its control
    groups (versions 1 and 2, with their parents). Fractions of a core are rounded up.

    Args:
        root: folder that holds `proc` and `sys`.
    """
    quotas = [math.ceil(quota) for quota in cpu_quotas(root)]
    return max(1, min([visible_cores(), *quotas]))


def visible_cores() -> int:
    """Return the number of cores that the process may be scheduled on."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def limit_threads(
    root: Path = Path("/"), environment: MutableMapping[str, str] = os.environ
) -> None:
    """Limit the threads of numeric libraries; call this before they are imported.

    The libraries respect the affinity by themselves, so a limit is set only if a quota is lower.
    Variables that are already set stay. `OMP_NUM_THREADS` counts for all libraries.
    """
    cores = available_cores(root)
    if OPENMP in environment or cores >= visible_cores():
        return
    for name in (OPENMP, *THREAD_VARIABLES):
        environment.setdefault(name, str(cores))


def cpu_quotas(root: Path) -> Iterator[float]:
    """Yield the quotas, in cores, of the process's control groups and of those above them."""
    try:
        groups = (root / "proc/self/cgroup").read_text()
        mounts = (root / "proc/self/mountinfo").read_text()
    except (OSError, ValueError):
        return
    paths = {}
    for line in groups.splitlines():
        _, _, rest = line.partition(":")
        controllers, _, path = rest.partition(":")
        for controller in controllers.split(","):
            paths[controller] = path  # version 2 has an empty name
    for version, mounted, mount in cgroup_mounts(mounts):
        controller = "" if version == 2 else "cpu"
        if controller not in paths:
            continue
        folder = root / mount.lstrip("/")
        # A container sees its own group as the mount's root, under the host's name for it.
        below = PurePosixPath(paths[controller])
        inside = below.relative_to(mounted) if below.is_relative_to(mounted) else PurePosixPath()
        if ".." in inside.parts:
            inside = PurePosixPath()
        for part in (inside, *inside.parents):
            quota = quota_of(folder / part, version)
            if quota is not None:
                yield quota


def cgroup_mounts(mounts: str) -> Iterator[tuple[int, str, str]]:
    """Yield version, root and mount point of the file systems that hold CPU quotas.

    Args:
        mounts: content of `/proc/self/mountinfo`.
    """
    for line in mounts.splitlines():
        before, _, after = line.partition(" - ")
        fields, kind = before.split(), after.split()
        if len(fields) < 5 or not kind:
            continue
        mounted, mount = (_unescaped(field) for field in fields[3:5])
        if kind[0] == "cgroup2":
            yield 2, mounted, mount
        elif kind[0] == "cgroup" and "cpu" in kind[-1].split(","):
            yield 1, mounted, mount


def quota_of(folder: Path, version: int) -> float | None:
    """Return a control group's CPU quota in cores; None if it has none."""
    try:
        if version == 2:
            quota, period = (folder / "cpu.max").read_text().split()
        else:
            quota = (folder / "cpu.cfs_quota_us").read_text()
            period = (folder / "cpu.cfs_period_us").read_text()
        cores = int(quota) / int(period)
    # 'max' is no number; a period of 0 is none.
    except (OSError, ValueError, ZeroDivisionError):
        return None
    return cores if cores > 0 else None


def _unescaped(field: str) -> str:
    """Return a field of mountinfo, whose spaces and the like are written in octal."""
    return re.sub(r"\\([0-7]{3})", lambda found: chr(int(found[1], 8)), field)
