"""Value of several stored views per object: stored segments against recall, on a drive."""

from typing import Any

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.edit import empty

from evaluation.machine import machine
from evaluation.recognition.retrieval import CANDIDATES, CROSS_VIEW_METERS, distance_rows
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Int8, Int64
from placecell.descriptors.extractor import Extractor
from placecell.segmentation.recording import Recording
from service.maps.writes.deduplication import (
    RADIUS,
    SAME_VIEW,
    SAME_VIEWPOINT,
    VIEWS,
    SameView,
    deduplicate,
)

MAX_VIEWS = (1, 2, 3, 4, 6, 8, 12)
"""Measured limits of the number of stored views per object."""


def measure_views(
    extractor: Extractor, recording: Recording, scans: tuple[int, int], seed: int
) -> dict[str, Any]:
    """Store a drive's segments with a limited number of views per object, and search for all.

    The queries are all segments with a mate: a segment of the same group, seen from more than 10 m
    away. The search of a query leaves out the query and all segments of its group that were seen
    from within 10 m. The queries are therefore the same in each row, and a mate that is not stored
    cannot be found.

    Args:
        extractor: describes the segments.
        recording: the segments of the drive.
        scans: first and last scan whose segments are used.
        seed: random seed of the rows that keep as many segments at random.

    Raises:
        ValueError: no segment has a mate.
    """
    around = extractor.manifest.neighborhood
    seen = None if around is None else recording.neighborhood(around)
    rows = np.flatnonzero(recording.within(*scans))
    segments, groups = recording.segments.take(rows), recording.groups[rows]
    manifest = extractor.manifest
    found = extractor.describe(segments, None if seen is None else seen[rows])
    codes = manifest.quantizer.encode(found)
    content = _map_of(codes, segments, recording.captures[rows], manifest.model_id)
    nothing = empty(content.model_id, content.preprocessing, content.frame, content.code_bytes)
    same = SameView.of(manifest)

    asked = _Asked(manifest.quantizer.levels(codes).astype(np.float32), groups, segments.sensors)
    if not len(asked.queries):
        raise ValueError(f"{recording.name}: no segment has a mate seen from more than 10 m away.")
    random = np.random.default_rng(seed)
    measured: list[dict[str, Any]] = [
        {"views": None, "kept": "all"} | asked.with_stored(np.ones(len(rows), dtype=bool))
    ]
    for most in MAX_VIEWS:
        kept = deduplicate(content, nothing, same, views=most).changed.ids
        stored = np.isin(np.arange(len(rows)), kept)
        drawn = random.permutation(stored)
        measured.append({"views": most, "kept": "views that differ"} | asked.with_stored(stored))
        measured.append({"views": most, "kept": "as many at random"} | asked.with_stored(drawn))
    return {
        "rows": measured,
        "default_views": VIEWS,
        "radius_m": RADIUS,
        "same_view": SAME_VIEW,
        "same_stand_m": SAME_VIEWPOINT,
        "queries": len(asked.queries),
        "model_id": manifest.model_id,
        "drive": recording.name,
        "scans": list(scans),
        "seed": seed,
        "protocol": recording.parameters.protocol,
        "machine": machine(),
    }


def _map_of(codes: Int8, segments: Segments, frames: Int64, model_id: str) -> CompactMap:
    """Return a map of the segments; ids are row numbers, times are scan numbers."""
    times, first, frame_index = np.unique(frames, return_index=True, return_inverse=True)
    f = len(times)
    return CompactMap(
        model_id=model_id,
        preprocessing="1",
        frame="drive",
        codes=codes,
        centroids=segments.centroids().astype(np.float64),
        ids=np.arange(len(codes), dtype=np.uint32),
        robots=("robot",),
        robot=np.zeros(len(codes), np.uint16),
        frame_index=frame_index.astype(np.uint32),
        frame_times=times.astype(np.float64),
        frame_positions=segments.sensors[first].astype(np.float64),
        frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (f, 1)),
    )


class _Asked:
    """Segments of a drive, and the queries among them: segments that have a mate."""

    def __init__(self, levels: Float32, groups: Int64, sensors: Float32) -> None:
        self._levels = levels
        self._groups = groups
        self._sensors = np.asarray(sensors, np.float64)
        has_mate = [bool(self._mates(row).any()) for row in range(len(groups))]
        self.queries = np.flatnonzero(has_mate)

    def _mates(self, row: int) -> Bool:
        """Return which segments are of the same group and were seen from more than 10 m away."""
        return np.asarray((self._groups == self._groups[row]) & ~self._is_close(row))

    def _is_close(self, row: int) -> Bool:
        offsets = self._sensors - self._sensors[row]
        return np.asarray((offsets**2).sum(axis=1) <= CROSS_VIEW_METERS**2)

    def with_stored(self, stored: Bool) -> dict[str, float]:
        """Return the shares of queries that find a mate if only these segments are stored."""
        top, recalled = 0, 0
        wanted = set(self.queries.tolist())
        for rows, distances in distance_rows(self._levels):
            for row, to_others in zip(rows.tolist(), distances, strict=True):
                if row not in wanted:
                    continue
                mates = self._mates(row)
                same = self._groups == self._groups[row]
                to_others[~stored | (same & self._is_close(row))] = np.inf
                nearest = np.argpartition(to_others, CANDIDATES)[:CANDIDATES]
                top += bool(mates[to_others.argmin()])
                recalled += bool(mates[nearest].any())
        return {
            "segments": int(stored.sum()),
            "cross_view_top1": top / len(wanted),
            "cross_view_recall_at_25": recalled / len(wanted),
        }
