"""Time of each step of a robot that localizes while it drives: from a scan to segments and a pose.

`placecell bench robot` prints it. Each scan of a drive is added to the local map, segmented,
described and localized, which is the worst case: a robot localizes every few meters. A long drive
is played forward and backward, so that its poses never jump. Processor times stand beside the wall
times, so that figures of a busy machine can be judged.
"""

import ctypes
import gc
import os
import resource
import statistics
import sys
import time
from array import array
from collections import deque
from collections.abc import Callable, Iterator, MutableSequence, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import dataclass, field
from functools import partial
from itertools import islice
from pathlib import Path
from typing import Any, TypeVar

import numpy as np
from placecell_client import CompactMap

from evaluation.machine import machine
from evaluation.poses.robot import Robot, clouds
from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.types import Float32, Float64, Int64
from placecell.datasets import Drive
from placecell.odometry.live_odometry import LiveOdometry
from placecell.segmentation.incremental import IncrementalSegmentation, LiveSegments
from placecell.segmentation.local_map import in_range, transform, voxel_means
from placecell.segmentation.pipeline import Progress, record, segment_map, silent
from placecell.segmentation.region_growing import Regions
from placecell.sources.errors import DriveError
from placecell.sources.scan import LidarScan
from service.engine import Engine

Result = TypeVar("Result")

TO_SEGMENTS = ("local map", "ground", "regions", "ids")
TO_POSE = (*TO_SEGMENTS, "describe", "localize")

USUAL_PERIOD = 0.1
"""Period of the scans, seconds, if the drive's times do not tell it."""

MEMORY_SAMPLES = 60
"""Number of memory samples over the scans."""

BATCH_SCANS = 12
"""Number of scans that the batch pipeline segments for comparison."""

MAP = "drive"


@dataclass(slots=True)
class StepTimes:
    """Times of each step, seconds.

    Attributes:
        wall: wall times of each step, one a scan.
        processor: processor times of all threads of the process.

    The times are kept in arrays: over an hour, lists would grow more than what is measured.
    """

    wall: dict[str, MutableSequence[float]] = field(default_factory=dict)
    processor: dict[str, MutableSequence[float]] = field(default_factory=dict)

    def measure(self, step: str, work: Callable[[], Result]) -> Result:
        """Do the work of a step and note its times."""
        began, spent = time.perf_counter(), time.process_time()
        result = work()
        self.processor.setdefault(step, array("d")).append(time.process_time() - spent)
        self.wall.setdefault(step, array("d")).append(time.perf_counter() - began)
        return result

    def total(self, steps: Sequence[str], *, processor: bool = False) -> Float64:
        """Return the time of some steps together, float64 (scans,), seconds.

        Where a step was not done at each scan, only as many scans count.
        """
        times = self.processor if processor else self.wall
        some = [times[step] for step in steps if step in times]
        shortest = min(len(each) for each in some)
        return np.asarray(np.sum([each[:: len(each) // shortest][:shortest] for each in some], 0))

    def row(self, steps: Sequence[str]) -> dict[str, float]:
        """Return percentiles of the time of some steps together, milliseconds."""
        wall, processor = self.total(steps), self.total(steps, processor=True)
        return {
            "p50_ms": percentile(wall, 50),
            "p99_ms": percentile(wall, 99),
            "cpu_p50_ms": percentile(processor, 50),
            "cpu_p99_ms": percentile(processor, 99),
        }


def percentile(seconds: Float64, percent: float) -> float:
    """Return a percentile of times, milliseconds."""
    return round(1e3 * float(np.percentile(seconds, percent)), 2)


class TimedSegmentation(IncrementalSegmentation):
    """Incremental segmentation that notes the time of its steps."""

    def __init__(self, parameters: Parameters, times: StepTimes) -> None:
        super().__init__(parameters)
        self.times = times

    def add(self, points: Float32, pose: Float64) -> None:
        """Add the next scan to the local map."""
        self.times.measure("local map", lambda: IncrementalSegmentation.add(self, points, pose))

    def objects(self) -> Int64:
        """Return the voxels that are neither ground nor overhead."""
        return self.times.measure("ground", lambda: IncrementalSegmentation.objects(self))

    def regions(self, objects: Int64) -> Regions:
        """Return the regions of these voxels."""
        return self.times.measure("regions", lambda: IncrementalSegmentation.regions(self, objects))

    def follow(self, objects: Int64, regions: Regions) -> LiveSegments:
        """Assign ids to regions."""
        return self.times.measure(
            "ids", lambda: IncrementalSegmentation.follow(self, objects, regions)
        )


@contextmanager
def on_cores(count: int) -> Iterator[None]:
    """Run on some of the cores, where the system allows to choose them.

    Raises:
        ValueError: there are fewer cores.
    """
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    allowed = os.sched_getaffinity(0)
    if not 1 <= count <= len(allowed):
        raise ValueError(f"Invalid --cores {count}: this process may use 1 to {len(allowed)}.")
    pin_threads(set(sorted(allowed)[:count]))
    try:
        # Threads beyond the cores would wait for each other.
        with limited_threads(count):
            yield
    finally:
        pin_threads(allowed)


def limited_threads(count: int) -> AbstractContextManager[object]:
    """Limit the threads of libraries that are loaded, if threadpoolctl is there (scikit-learn)."""
    try:
        from threadpoolctl import threadpool_limits
    except ImportError:
        return nullcontext()
    limits: AbstractContextManager[object] = threadpool_limits(count)
    return limits


def pin_threads(cores: set[int]) -> None:
    """Let all threads of this process run on these cores only: libraries have started some."""
    tasks = Path("/proc/self/task")
    threads = [int(each.name) for each in tasks.iterdir()] if tasks.exists() else [0]
    for thread in threads:
        with suppress(ProcessLookupError):  # it ended
            os.sched_setaffinity(thread, cores)


def measure_robot(
    drive: Drive,
    mapped: Robot | None,
    model: Path,
    *,
    scans: int | None = None,
    localize_every: int = 1,
    seed: int = 7,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Measure the steps of a robot on a drive; return the report of `placecell bench robot`.

    Args:
        drive: drive to play.
        mapped: robot whose map the drive is localized in; None for a map of the drive itself.
        model: folder of the model.
        scans: number of scans to measure; the drive is played forward and backward as often as
            needed. None for the scans of the drive.
        localize_every: scans from one that is described and localized to the next.
        seed: random seed, for the report.
        progress: wraps the loop.
    """
    parameters = PROTOCOL_V1.for_drive(len(drive), every=1)
    warm = parameters.accumulated_scans
    count = scans or max(1, len(drive) - warm)
    with Engine.temporary(model) as engine:
        content = map_of(drive, mapped, engine, progress)
        engine.put_map(MAP, content)
        times, memory = StepTimes(), list[tuple[int, float]]()
        segmentation = TimedSegmentation(parameters, times)
        localized, segments, points = array("b"), array("q"), array("q")
        every = max(1, count // MEMORY_SAMPLES)
        order = islice(forward_and_backward(len(drive)), warm + count)
        for number, index in enumerate(progress(order, warm + count, f"scans of {drive.title}")):
            if number == warm:
                begin_peak()
                forget(times)
                del localized[:]
            scan = times.measure("read", partial(drive.scan, index))
            segmentation.add(scan, drive.poses[index])
            live = segmentation.segments()
            if (number - warm) % localize_every == 0:
                localized.append(localize(live, engine, times))
            segmentation.take_final_views()
            segments.append(len(live))
            points.append(len(scan))
            if number >= warm and (number - warm) % every == 0:
                memory.append((number - warm, resident_mb()))
        peak = peak_mb()
        name = engine.model.manifest.name
    batch = measure_batch(drive, parameters, progress)
    segments_row, pose_row = times.row(TO_SEGMENTS), times.row(TO_POSE)
    rows = {step: times.row([step]) for step in ("read", *TO_POSE)}
    return {
        "drive": drive.title,
        "map": "of the drive itself" if mapped is None else f"of {mapped.name}",
        "map_segments": len(content.ids),
        "scans": count,
        "points_a_scan": round(statistics.median(points[warm:])),
        "segments_a_scan": round(statistics.median(segments[warm:])),
        "rows": {"odometry": measure_odometry(drive), **rows},
        "scan_to_segments_p50_ms": segments_row["p50_ms"],
        "scan_to_segments_p99_ms": segments_row["p99_ms"],
        "scan_to_segments_cpu_p50_ms": segments_row["cpu_p50_ms"],
        "scan_to_segments_cpu_p99_ms": segments_row["cpu_p99_ms"],
        "scan_to_pose_p50_ms": pose_row["p50_ms"],
        "scan_to_pose_p99_ms": pose_row["p99_ms"],
        "scan_to_pose_cpu_p50_ms": pose_row["cpu_p50_ms"],
        "scan_to_pose_cpu_p99_ms": pose_row["cpu_p99_ms"],
        "batch": batch,
        "batch_ratio": round(batch["cpu_p50_ms"] / segments_row["cpu_p50_ms"], 2),
        "localized": round(sum(localized) / len(localized), 4),
        "localize_every": localize_every,
        "period_ms": round(1e3 * period_of(drive), 1),
        "scans_dropped": dropped(all_work(times, count, localize_every), period_of(drive)),
        "peak_mb": peak,
        "memory_mb": memory,
        "local_map_mb": round(segmentation.nbytes / 1e6, 1),
        "model": name,
        "seed": seed,
        "cores": len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else None,
        "machine": machine(),
    }


def map_of(drive: Drive, mapped: Robot | None, engine: Engine, progress: Progress) -> CompactMap:
    """Return the map to localize in."""
    if mapped is None:
        parameters = PROTOCOL_V1.for_drive(len(drive))
        recording = record(drive, parameters, progress=progress)
        mapped = Robot("the drive", drive, [recording], np.eye(4))
    return mapped.build_map(engine, MAP)


def localize(live: LiveSegments, engine: Engine, times: StepTimes) -> bool:
    """Describe and localize the segments of a scan; return whether a pose was found.

    A scan without segments takes no time in these steps.
    """
    segments = live.segments
    if not len(segments):
        for step in ("describe", "localize"):
            times.measure(step, lambda: None)
        return False
    described = times.measure(
        "describe", lambda: engine.describe(clouds(segments), segments.sensors)
    )
    result = times.measure("localize", lambda: engine.localize(described, [MAP], session="robot"))
    return result[0].localization.pose is not None


def measure_batch(drive: Drive, parameters: Parameters, progress: Progress) -> dict[str, Any]:
    """Measure the segmentation of local maps that are built anew at each scan.

    The scans that the local map keeps are transformed once, as the incremental segmentation does.
    """
    times, kept = StepTimes(), deque[Float32](maxlen=parameters.accumulated_scans)
    last = min(len(drive), parameters.accumulated_scans + BATCH_SCANS)
    for index in progress(range(last), last, "batch pipeline"):
        scan, pose = drive.scan(index), drive.poses[index]

        def local_map(scan: Float32 = scan, pose: Float64 = pose) -> Float32:
            kept.append(transform(pose, in_range(scan, parameters)))
            points = np.concatenate(kept)
            offset = points[:, :2] - pose[:2, 3].astype(np.float32)
            near = np.einsum("ij,ij->i", offset, offset) <= parameters.local_map_radius**2
            return voxel_means(points[near], parameters.map_voxel)

        found = times.measure("local map", local_map)
        times.measure("ground and regions", partial(segment_map, found, parameters))
    if last > parameters.accumulated_scans:
        forget(times, parameters.accumulated_scans)
    rows = {step: times.row([step]) for step in times.wall}
    return {"scans": len(times.wall["local map"]), **times.row(list(rows)), "rows": rows}


def measure_odometry(drive: Drive) -> dict[str, Any]:
    """Measure KISS-ICP on the first scans, apart from the other steps.

    Returns:
        Percentiles of the times, or why there are none.
    """
    times, odometry = StepTimes(), LiveOdometry()
    try:
        for index in range(min(len(drive), 2 * BATCH_SCANS)):
            scan = LidarScan(drive.scan(index), None, float(drive.times[index]))
            times.measure("odometry", partial(odometry.add, scan))
    except DriveError as error:
        return {"not_measured": str(error)}
    forget(times, min(2, len(times.wall["odometry"]) - 1))
    return times.row(["odometry"])


def forward_and_backward(count: int) -> Iterator[int]:
    """Yield the indices of a drive's scans forward, backward, forward, and so on."""
    if count == 1:
        while True:
            yield 0
    while True:
        yield from range(count - 1)
        yield from range(count - 1, 0, -1)


def forget(times: StepTimes, count: int | None = None) -> None:
    """Forget the times of the first scans; None for all so far."""
    for measured in (times.wall, times.processor):
        for each in measured.values():
            del each[:count]


def period_of(drive: Drive) -> float:
    """Return the period of the scans, seconds."""
    steps = np.diff(drive.times)
    steps = steps[np.isfinite(steps) & (steps > 0)]
    return float(np.median(steps)) if len(steps) else USUAL_PERIOD


def all_work(times: StepTimes, scans: int, localize_every: int) -> Float64:
    """Return the time that the robot works at each scan, float64 (scans,), seconds."""
    work = times.total(TO_SEGMENTS)
    for step in ("describe", "localize"):
        work[:scans:localize_every] += times.wall[step]
    return work


def dropped(durations: Float64, period: float) -> int:
    """Return how many scans a robot drops that keeps one scan waiting while it works.

    Args:
        durations: float64 (scans,), time that each scan takes, seconds.
        period: time from one scan to the next, seconds.
    """
    free, lost = 0.0, 0
    for number, duration in enumerate(durations.tolist()):
        arrives = number * period
        if free > arrives + period:  # the next scan takes this one's place
            lost += 1
        else:
            free = max(free, arrives) + duration
    return lost


def begin_peak() -> None:
    """Give freed memory back to the system and begin a new peak, where the system can (Linux)."""
    gc.collect()
    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).malloc_trim(0)
        Path("/proc/self/clear_refs").write_text("5")


def resident_mb() -> float:
    """Return the resident memory of this process, MB."""
    return status_mb("VmRSS")


def peak_mb() -> float:
    """Return the largest resident memory of this process since `begin_peak`, MB."""
    return status_mb("VmHWM")


def status_mb(name: str) -> float:
    """Return a size that the system states for this process, MB; its peak if it states none."""
    status = Path("/proc/self/status")
    if status.exists():
        for line in status.read_text().splitlines():
            if line.startswith(f"{name}:"):
                return round(int(line.split()[1]) * 1024 / 1e6, 1)
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return round(peak / 1e6 if sys.platform == "darwin" else peak * 1024 / 1e6, 1)
