"""KISS-SLAM on the scans of the simulated drives, as a peer in an environment of its own."""

import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drift.town_maps import DriftCase, TrueMap, scans_of
from evaluation.trajectory import absolute_error
from placecell.core.types import Float64
from town.sensing.lidar import SWEEP_SECONDS

PROGRAM = "benchmarks.drift.kiss_slam_program"

END_SECONDS = 600.0
"""Largest time from the last scan to the result, seconds."""


@dataclass(frozen=True, slots=True, eq=False)
class PeerTrajectory:
    """Trajectory of a peer.

    Attributes:
        poses: float64 (scans, 4, 4), pose of each scan.
        closures: number of loop closures.
        seconds: seconds of the processing.
    """

    poses: Float64
    closures: int
    seconds: float


def kiss_slam_row(
    case: DriftCase,
    maps: Sequence[TrueMap],
    python: Path,
    cache: Path,
    tell: Callable[[str], None] = lambda _: None,
) -> dict[str, Any]:
    """Run KISS-SLAM on the drive of a single robot; return the keys that the report has for it.

    Its error is computed at the captures of our map, after the best rigid alignment with the truth.
    It estimates its own odometry from the scans, so the drift of the case does not matter to it.
    """
    file = cache / f"{case.name}-kiss-slam.npz"
    if not file.exists():
        _run(case, python, file, tell)
    with np.load(file) as kept:
        found = PeerTrajectory(kept["poses"], int(kept["closures"]), float(kept["seconds"]))
    scans = np.rint(maps[0].content.frame_times / SWEEP_SECONDS).astype(np.int64)
    error = absolute_error(found.poses[scans, :3, 3], maps[0].poses[:, :3, 3])
    return {
        "kiss_slam_ate_m": round(error.rmse, 3),
        "kiss_slam_closures": found.closures,
        "kiss_slam_seconds": round(found.seconds, 1),
    }


def _run(case: DriftCase, python: Path, file: Path, tell: Callable[[str], None]) -> None:
    """Simulate the scans once more, and send them to KISS-SLAM one by one."""
    city, routes = case.routes()
    part = file.with_name(f"{file.stem}.part.npz")
    with subprocess.Popen(
        [str(python), "-m", PROGRAM, str(part.resolve())],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
    ) as process:
        try:
            assert process.stdin is not None
            drive = scans_of(city, routes[0], case.seed * 100, case.spacing)
            for scan, (_, points) in enumerate(drive):
                process.stdin.write(np.uint64(len(points)).tobytes() + points.tobytes())
                if scan % 500 == 0:
                    tell(f"KISS-SLAM: {scan * case.spacing:,.0f} m")
            process.stdin.close()
            status = process.wait(timeout=END_SECONDS)
        finally:
            process.kill()
    if status:
        raise RuntimeError(
            f"KISS-SLAM ended with status {status} in {python}. Run 'make peers' to build the "
            "environment, and read the error above."
        )
    part.rename(file)
