"""Long life against the truth: which segments of a simulated town are gone on another day."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import numpy as np

import town
from evaluation.machine import machine
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import stored_extents
from placecell.core.types import Bool, Float64
from placecell.datasets import open_drive
from placecell.datasets.labels import CODES, NO_CLASS
from placecell.lasting.judgment import ABSENT, CHANGED, CONFIRMED, UNSEEN, ObservedSegments, judge
from placecell.segmentation.pipeline import record
from placecell.segmentation.segment_labels import segment_classes
from town.drives.robots import way_through
from town.places.catalog import STREETS, kind_of

VERDICTS = {"confirmed": CONFIRMED, "changed": CHANGED, "absent": ABSENT, "unseen": UNSEEN}

MARGIN = 0.3
"""Distance from the box of a parked car or a person within which a centroid belongs to it, meters:
segments are the means of voxels."""

OFFSETS = (0.0, 0.3, 0.6)
"""Distances by which the map of the other day lies off the first one's, meters: alignments are
exact to some decimeters."""


@dataclass(frozen=True, slots=True)
class LongLifePlan:
    """Plan of a measurement.

    Attributes:
        seeds: seeds of the towns.
        sensors: names of the sensors.
        scans: number of scans of each drive.
        cache: folder where the segments of simulated drives are kept.
    """

    seeds: Sequence[int]
    sensors: Sequence[str]
    scans: int
    cache: Path


@dataclass(frozen=True, slots=True, eq=False)
class TrueDay:
    """Segments of a drive, and which of them stand there on no other day.

    Attributes:
        seen: the segments and their captures, in the frame that both days share.
        movable: bool (n,), segments of parked cars and people.
        known: bool (n,), segments whose class is known.
    """

    seen: ObservedSegments
    movable: Bool
    known: Bool


def run_long_life(
    plan: LongLifePlan, tell: Callable[[str], None] = lambda _: None
) -> dict[str, Any]:
    """Judge the segments of one day by the drive of another day, when all cars and people changed.

    The truth is that of the town: a segment of a parked car or a person of the first day is gone,
    every other one still stands there.

    Raises:
        ValueError: a sensor is unknown.
    """
    rows = []
    for sensor in plan.sensors:
        town.sensor(sensor)
        for seed in plan.seeds:
            first, second = (
                day_of(seed, sensor, plan.scans, other, plan.cache) for other in (False, True)
            )
            for offset in OFFSETS:
                begun = process_time()
                verdicts = judge(first.seen, moved(second.seen, offset))
                seconds = process_time() - begun
                row = {"town": seed, "sensor": sensor, "scans": plan.scans, "offset_m": offset}
                row |= counted(verdicts, first) | {"cpu_seconds": round(seconds, 2)}
                tell(
                    f"town {seed}, {sensor}, {offset} m off: absent: precision "
                    f"{row['absent_precision']}, recall {row['absent_recall']}; confirmed: "
                    f"precision {row['confirmed_precision']}, recall {row['confirmed_recall']}"
                )
                rows.append(row)
    return {"machine": machine(), "rows": rows}


def moved(seen: ObservedSegments, offset: float) -> ObservedSegments:
    """Return a drive whose map lies off the other one's, by a horizontal distance in meters."""
    shift = offset * np.array([0.6, 0.8, 0.0])
    return replace(seen, centroids=seen.centroids + shift, viewpoints=seen.viewpoints + shift)


def counted(verdicts: np.ndarray, day: TrueDay) -> dict[str, Any]:
    """Compare verdicts with the truth; segments without a class are left out.

    Recall counts segments that the other day looked at: those that are not `unseen`.
    """
    gone, stays = day.movable & day.known, ~day.movable & day.known
    counts = {
        f"{truth}_{name}": int((verdicts[rows] == number).sum())
        for truth, rows in (("gone", gone), ("stays", stays))
        for name, number in VERDICTS.items()
    }
    looked = {
        truth: sum(counts[f"{truth}_{name}"] for name in ("confirmed", "changed", "absent"))
        for truth in ("gone", "stays")
    }
    return counts | {
        "gone": int(gone.sum()),
        "stays": int(stays.sum()),
        "absent_precision": share(
            counts["gone_absent"], counts["gone_absent"] + counts["stays_absent"]
        ),
        "absent_recall": share(counts["gone_absent"], looked["gone"]),
        "absent_of_all_gone": share(counts["gone_absent"], int(gone.sum())),
        "confirmed_precision": share(
            counts["stays_confirmed"], counts["stays_confirmed"] + counts["gone_confirmed"]
        ),
        "confirmed_recall": share(counts["stays_confirmed"], looked["stays"]),
        "confirmed_of_all_standing": share(counts["stays_confirmed"], int(stays.sum())),
    }


def share(part: int, whole: int) -> float | None:
    """Return a share, rounded; None of nothing."""
    return round(part / whole, 4) if whole else None


def day_of(seed: int, sensor: str, scans: int, other_day: bool, cache: Path) -> TrueDay:
    """Return the segments of a day's drive; simulate and segment it unless it is kept."""
    day = "other-day" if other_day else "first-day"
    file = cache / f"long-life-{seed}-{sensor}-{scans}-{day}.npz"
    if not file.exists():
        cache.mkdir(parents=True, exist_ok=True)
        part = file.with_name(f"{file.stem}.part.npz")
        np.savez(part, **_simulated(seed, sensor, scans, other_day))
        part.rename(file)
    with np.load(file) as kept:
        seen = ObservedSegments(
            kept["centroids"], kept["extents"] / 10.0, kept["viewpoints"], kept["captures"]
        )
        return TrueDay(seen, kept["movable"], kept["known"])


def _simulated(seed: int, sensor: str, scans: int, other_day: bool) -> dict[str, Any]:
    """Simulate and segment a drive."""
    with TemporaryDirectory(prefix="placecell-town-") as folder:
        path = town.one_robot(
            Path(folder), seed, scans, lidar=town.sensor(sensor), labels=True, other_cars=other_day
        )
        drive = open_drive(path)
        origin = town.read_origin(path)
        recording = record(drive, PROTOCOL_V1.for_drive(len(drive), None))
        classes = segment_classes(drive, recording)
    low, high = recording.segments.bounds()
    centroids = recording.segments.centroids()
    return {
        "centroids": centroids,
        "extents": stored_extents(high - low),
        "viewpoints": drive.poses[:, :3, 3],
        "captures": recording.captures,
        "movable": _movable(centroids @ origin[:3, :3].T + origin[:3, 3], seed, scans, other_day)
        & np.isin(classes, [list(CODES).index(name) for name in ("vehicle", "person")]),
        "known": classes != NO_CLASS,
    }


def _movable(spots: Float64, seed: int, scans: int, other_day: bool) -> Bool:
    """Return which places (n, 3) in the town are those of parked cars and people, bool (n,)."""
    streets, _ = way_through(STREETS, seed, scans, kind_of(STREETS).spacing)
    assert isinstance(streets, town.Town)
    found = np.zeros(len(spots), dtype=bool)
    for thing in replace(streets, other_cars=other_day).traffic(2 * seed):
        corners = thing.mesh.triangles.reshape(-1, 3)
        low, high = corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN
        found |= ((spots >= low) & (spots <= high)).all(axis=1)
    return found
