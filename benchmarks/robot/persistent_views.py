"""Recognition with the best view of each persistent segment, beside that with all captures.

A robot that keeps its segments over time can store the best view of each, in place of a view of
each capture. `placecell bench persistent` compares both maps: by the same queries with the same
labels, and by poses where blocks of a drive are localized in the map of the other blocks.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.machine import machine
from evaluation.poses.evaluate import evaluate
from evaluation.poses.queries import Pair
from evaluation.poses.robots import robots_of_drive
from evaluation.recognition.retrieval import CROSS_VIEW_METERS
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Bool, Float32, Int64
from placecell.datasets import Drive
from placecell.descriptors.extractor import load_extractor
from placecell.segmentation.incremental import IncrementalSegmentation
from placecell.segmentation.pipeline import Progress, record, silent
from placecell.segmentation.recording import Recording


@dataclass(frozen=True, slots=True, eq=False)
class PersistentViews:
    """Persistent ids of the segments of a recording.

    Attributes:
        ids: int64 (segments,), id of each segment.
        is_best: bool (segments,), whether it is the final best view of its id.
        is_final: bool (segments,), whether it is a final best view that is complete.
        is_complete: bool (segments,), whether its segment was complete when it was seen.
    """

    ids: Int64
    is_best: Bool
    is_final: Bool
    is_complete: Bool


def persistent_views(drive: Drive, recording: Recording) -> PersistentViews:
    """Follow the segments of a recording scan by scan.

    Args:
        drive: drive of the recording.
        recording: segments of the drive or of a part of it.

    Raises:
        ValueError: the recording is not of this drive.
    """
    scans = range(recording.scans) if recording.part is None else recording.part
    captures, count = set(recording.capture_scans), len(recording.segments)
    segmentation = IncrementalSegmentation(recording.parameters)
    ids = np.full(count, -1, dtype=np.int64)
    is_best, is_final, is_complete = (np.zeros(count, dtype=bool) for _ in range(3))
    row_of: dict[tuple[int, int], int] = {}
    best: dict[int, tuple[int, bool]] = {}
    first = 0
    for number, index in enumerate(scans):
        segmentation.add(drive.scan(index), drive.poses[index])
        if index not in captures:
            continue
        live = segmentation.segments()
        rows = np.arange(first, first + len(live))
        if len(live) != (recording.captures == index).sum():
            raise ValueError(f"{drive.folder}: the recording {recording.name} is of other scans.")
        ids[rows], is_complete[rows] = live.ids, live.complete
        row_of |= {(each, number): row for each, row in zip(live.ids.tolist(), rows, strict=True)}
        first += len(live)
        final = segmentation.take_final_views(at_end=index == recording.capture_scans[-1])
        for each, scan, complete in zip(final.ids, final.scans, final.complete, strict=True):
            best[int(each)] = (row_of[int(each), int(scan)], bool(complete))
    for row, complete in best.values():
        is_best[row], is_final[row] = True, complete
    return PersistentViews(ids, is_best, is_final, is_complete)


def one_of_each(keys: Int64, order: Int64) -> Int64:
    """Return the first row of each distinct key in an order of rows, int64 (keys,), ascending."""
    _, first = np.unique(keys[order], return_index=True)
    return np.sort(order[first])


@dataclass(frozen=True, slots=True, eq=False)
class CrossViews:
    """Result of each query across views.

    Attributes:
        right: bool (queries,), whether the nearest segment is a mate.
        has_mate: bool (queries,), whether the database has a mate seen from far enough.
    """

    right: Bool
    has_mate: Bool


def search_across_views(
    codes: Float32, groups: Int64, sensors: Float32, queries: Int64, database: Int64
) -> CrossViews:
    """Search some segments among others; mates seen from near the query's sensor are left out.

    Args:
        codes: float32 (segments, dimension), descriptors as stored.
        groups: int64 (segments,), group of each segment.
        sensors: float32 (segments, 3), sensor positions, meters.
        queries: int64 (q,), segments to search.
        database: int64 (n,), segments to search in.
    """
    right, has_mate = np.zeros(len(queries), dtype=bool), np.zeros(len(queries), dtype=bool)
    stored = codes[database]
    squared = np.einsum("ij,ij->i", stored, stored)
    for first in range(0, len(queries), 500):
        rows = queries[first : first + 500]
        distances = squared[None] - 2 * codes[rows] @ stored.T
        mates = groups[rows, None] == groups[database][None]
        offsets = sensors[rows, None] - sensors[database][None]
        easy = mates & (np.einsum("ijk,ijk->ij", offsets, offsets) <= CROSS_VIEW_METERS**2)
        distances[easy | (rows[:, None] == database[None])] = np.inf
        mates &= ~easy
        nearest = distances.argmin(axis=1)
        has_mate[first : first + 500] = mates.any(axis=1)
        right[first : first + 500] = mates[np.arange(len(rows)), nearest]
    return CrossViews(right, has_mate)


def measure_recognition(
    drive: Drive,
    scans: tuple[int, int] | None,
    model: Path,
    seed: int = 0,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Measure recognition across views in the views of all captures and in best views.

    The queries and their labels (groups) are those of protocol v1. The figures count the queries
    that have a mate in all of the databases, so that they are of the same queries.

    Args:
        drive: the drive.
        scans: first and last scan, both included; only groups completely within them count.
        model: folder of the model.
        seed: random seed of the random views.
        progress: wraps the loops.

    Raises:
        ValueError: no group lies within the scans.
    """
    recording = record(drive, PROTOCOL_V1.for_drive(len(drive)), progress=progress)
    views = persistent_views(drive, recording)
    first, last = scans or (0, recording.scans - 1)
    inside = recording.within(first, last)
    queries = np.flatnonzero(inside & recording.distinct)
    if not len(queries):
        raise ValueError(f"{drive.folder}: no group lies within scans {first} to {last}.")
    extractor = load_extractor(model)
    around = extractor.manifest.neighborhood
    seen = None if around is None else recording.neighborhood(around)
    quantizer = extractor.manifest.quantizer
    codes = quantizer.levels(quantizer.encode(extractor.describe(recording.segments, seen)))
    rows = np.flatnonzero(inside)
    along = np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(drive.poses[:, :3, 3], axis=0), axis=1))]
    )
    stretch = (along // CROSS_VIEW_METERS).astype(np.int64)[recording.captures]
    counts = recording.segments.counts
    # The largest view of each id and stretch, and any view of each id, for comparison.
    largest = rows[np.argsort(-counts[rows], kind="stable")]
    drawn = np.random.default_rng(seed).permutation(rows)
    databases = {
        "captures": queries,
        "best view of each id": np.flatnonzero(inside & views.is_best),
        "complete best view of each id": np.flatnonzero(inside & views.is_final),
        "random view of each id": one_of_each(views.ids, drawn),
        "largest view of each id and 10 m": one_of_each(
            views.ids * (stretch.max() + 1) + stretch, largest
        ),
    }
    found = {
        name: search_across_views(
            codes.astype(np.float32), recording.groups, recording.segments.sensors, queries, rows
        )
        for name, rows in databases.items()
    }
    common = np.logical_and.reduce([each.has_mate for each in found.values()])
    complete = common & views.is_complete[queries]
    return {
        "scans": [first, last],
        "seed": seed,
        "queries": len(queries),
        "groups": len(np.unique(recording.groups[queries])),
        "persistent_ids": len(np.unique(views.ids[inside])),
        "common_queries": int(common.sum()),
        "complete_queries": int(complete.sum()),
        "databases": {
            name: {
                "segments": len(rows),
                "queries_with_mate": int(found[name].has_mate.sum()),
                "cross_view_top1": share(found[name].right[found[name].has_mate]),
                "cross_view_top1_common": share(found[name].right[common]),
                "cross_view_top1_complete_queries": share(found[name].right[complete]),
            }
            for name, rows in databases.items()
        },
        "model_id": extractor.manifest.model_id,
        "seen": extractor.manifest.has_seen(recording.scan_hashes[first : last + 1]),
    }


def share(values: Bool) -> float | None:
    """Return the share of true values; None if there are none."""
    return round(float(values.mean()), 4) if len(values) else None


POSE_KEYS = ("queries", "map_segments", "map_bytes", "best_pose_right", "counts")


def measure_poses(folder: Path, model: Path, progress: Progress = silent) -> dict[str, Any]:
    """Localize blocks of a drive in maps of the other blocks, of all captures and of best views.

    Args:
        folder: folder or file of the drive.
        model: folder of the model.
        progress: wraps the loops.

    Raises:
        ValueError: the drive is too short for a second block.
    """
    mapper, asker = robots_of_drive(folder, progress)
    assert isinstance(mapper.drive, Drive)
    kept = [(each, persistent_views(mapper.drive, each)) for each in mapper.recordings]
    distinct: dict[str, Sequence[Recording]] = {
        "captures": mapper.recordings,
        "best view of each id": [replace(each, distinct=views.is_best) for each, views in kept],
    }
    rows = {}
    for name, recordings in distinct.items():
        pair = Pair(replace(mapper, recordings=recordings), asker, blocks=True)
        report, _ = evaluate(pair, model, progress=progress)
        rows[name] = {key: report[key] for key in POSE_KEYS}
    return rows


def measure_persistent(
    drive: Drive, scans: tuple[int, int] | None, model: Path, *, progress: Progress = silent
) -> dict[str, Any]:
    """Return the report of `placecell bench persistent`.

    Args:
        drive: the drive.
        scans: first and last scan of the groups for recognition, both included.
        model: folder of the model.
        progress: wraps the loops.
    """
    return {
        "drive": drive.title,
        "protocol": PROTOCOL_V1.protocol,
        "recognition": measure_recognition(drive, scans, model, progress=progress),
        "poses_by_blocks": measure_poses(drive.folder, model, progress),
        "machine": machine(),
    }
