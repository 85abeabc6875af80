"""Processor time to simulate the scans of a large town and to segment them."""

import resource
import sys
import time
from pathlib import Path
from typing import Any

from placecell.core.parameters import PROTOCOL_V1
from placecell.datasets import open_drive
from placecell.segmentation.pipeline import Progress, segment_captures, silent
from town import City, write_drive


def measure_town(
    folder: Path,
    meters: float,
    scans: int,
    spacing: float = 1.0,
    seed: int = 7,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Simulate a drive through part of a town, and segment its scans.

    Args:
        folder: folder of the drive.
        meters: total street length of the town, meters.
        scans: number of simulated scans.
        spacing: distance between scans, meters.
        seed: random seed of the town.
        progress: wraps the loops.

    Returns:
        The report; times are seconds of processor time. Keys that begin with `whole_` extrapolate
        the rates to a drive through all streets of the town.

    Raises:
        ValueError: the town cannot be built, or the drive is too short for the scans.
    """
    started = time.process_time()
    city = City.build(seed, meters)
    route = city.route(city.planner.every_street())
    planned = time.process_time()
    write_drive(
        folder, city, route, traffic_seed=0, scans=scans, spacing=spacing, oncoming=10.0,
        overwrite=True, progress=progress,
    )  # fmt: skip
    simulated = time.process_time()
    drive = open_drive(folder)
    # The first frame includes compilation, so it is not measured.
    frames = segment_captures(drive, PROTOCOL_V1.for_drive(scans, 2), progress=progress)
    next(frames)
    begun = time.process_time()
    segments = [len(some) for _, some in frames]
    ended = time.process_time()
    whole = int(route.length() / spacing)
    a_scan = (simulated - planned) / scans
    a_frame = (ended - begun) / max(1, len(segments))
    size = sum(file.stat().st_size for file in drive.scan_files) / scans
    return {
        "street_metres": round(city.network.meters(), 1),
        "route_metres": round(route.length(), 1),
        "seed": seed,
        "spacing_m": spacing,
        "scans": scans,
        "plan_seconds": round(planned - started, 2),
        "simulation_seconds_per_scan": round(a_scan, 4),
        "scans_per_second": round(1 / a_scan, 1),
        "extraction_seconds_per_frame": round(a_frame, 4),
        "segments_per_frame": round(sum(segments) / max(1, len(segments)), 1),
        "megabytes_per_scan": round(size / 1e6, 2),
        "peak_memory_mb": round(peak_memory_mb()),
        "whole_scans": whole,
        "whole_simulation_minutes": round(whole * a_scan / 60, 1),
        "whole_extraction_minutes": round(whole / 2 * a_frame / 60, 1),
        "whole_gigabytes": round(whole * size / 1e9, 1),
    }


def peak_memory_mb() -> float:
    """Return the peak memory of this process, MB."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / 1e6 if sys.platform == "darwin" else peak / 1e3
