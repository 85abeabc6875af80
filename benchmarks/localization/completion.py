"""Completion: benefit of the decoded shapes of a map for poses and recognition.

Poses: the pose of each query is refined by ICP of the robot's points against the shapes that are
decoded from the map and, as the upper bound, against the true points of the mapped segments, which
no map holds. Recognition: the candidates of each segment are ordered by the overlap of their
decoded grids, in place of the distance of their descriptors.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import encode
from scipy.stats import rankdata

from benchmarks.localization.registration import Registration
from evaluation.machine import machine
from evaluation.poses.queries import Pair, PoseQuery, localize_query, spread
from evaluation.poses.robot import Robot
from evaluation.recognition.retrieval import (
    CROSS_VIEW_METERS,
    Retrieval,
    retrieve,
    seen_within,
)
from evaluation.segments.shapes import CodedGrids, drawn_rows
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float64, Int64, UInt8
from placecell.datasets import open_drive
from placecell.descriptors.extractor import Extractor, load_extractor
from placecell.localization import Hypothesis, LocalizationParameters, Pose
from placecell.odometry.ground_plane import cell_means
from placecell.segmentation.pipeline import Progress, record, silent
from placecell.segmentation.recording import Recording
from placecell.shapes.decoder import ShapeDecoder
from placecell.shapes.geometry import points_of
from service.engine import Engine

MAP = "map"

CELL = 0.2
"""Edge length of the cells in which points are averaged, meters: a voxel of the grids."""

MOST_SEGMENTS = 4000
"""Largest number of segments whose candidates are ordered, drawn at random."""

WAYS = ("as localized", "decoded shapes", "true points")
"""Ways of refinement: none, ICP against decoded shapes, and ICP against the true points."""


@dataclass(frozen=True, slots=True, eq=False)
class SegmentPoints:
    """Points of the segments of a map, for ICP.

    Attributes:
        points: float64 (points, 3), meters, in the map's frame.
        ends: int64 (segments,), end of each segment's points.
    """

    points: Float64
    ends: Int64

    def of(self, rows: Int64) -> Float64:
        """Return the points of some segments, float64 (points, 3)."""
        starts = np.concatenate([[0], self.ends[:-1]])
        parts = [self.points[starts[row] : self.ends[row]] for row in rows]
        return np.concatenate([np.zeros((0, 3)), *parts])


def measure_completion(
    pair: Pair, model: Path, most: int | None = None, seed: int = 0, *, progress: Progress = silent
) -> dict[str, Any]:
    """Measure what decoded shapes add to the poses and the recognition of a model.

    Args:
        pair: robot that makes the map, and robot that localizes.
        model: folder of the model.
        most: largest number of queries, spread evenly; None: all.
        seed: random seed of the segments whose candidates are ordered.
        progress: wraps the loops.

    Raises:
        DriveError: the package with the ICP is not installed.
        ModelError: the model has no shape decoder.
        ValueError: a drive has no segments.
    """
    for robot in (pair.mapper, pair.asker):
        robot.check_segments()
    extractor = load_extractor(model)
    decoder = ShapeDecoder(model, extractor.manifest)
    with Engine.temporary(model) as engine:
        errors = refined_poses(pair, engine, decoder, most, progress)
    recording = pair.mapper.recordings[0]
    if pair.blocks:
        recording = record(
            open_drive(pair.mapper.drive.folder), recording.parameters, None, progress
        )
    return {
        "map_drive": pair.mapper.drive.title,
        "query_drive": pair.asker.drive.title,
        "model_id": extractor.manifest.model_id,
        "seed": seed,
        "machine": machine(),
        "poses": {way: error_figures(errors[:, number]) for number, way in enumerate(WAYS)},
        "recognition": recognition_figures(recording, extractor, decoder, seed),
    }


def refined_poses(
    pair: Pair, engine: Engine, decoder: ShapeDecoder, most: int | None, progress: Progress
) -> Float64:
    """Return the errors of all localized poses, (queries, `WAYS`, 2), meters and degrees."""
    compact = pair.mapper.build_map(engine, MAP)
    engine.put_map(MAP, encode(compact))
    mapped = mapped_segments(pair.mapper)
    stored = CodedGrids(mapped, compact.codes, np.zeros((0, 0, 0, 0), bool)).stored()
    decoded, owners = points_of(decoder.decode(stored))
    surfaces = (
        SegmentPoints(
            decoded.astype(np.float64),
            np.searchsorted(owners, np.arange(len(mapped)), side="right"),
        ),
        SegmentPoints(mapped.points.astype(np.float64), mapped.ends),
    )
    views = [segments for _, segments, _ in pair.asker.views()]
    chosen = spread(len(views), most)
    queries = list(pair.queries(engine, Pose(np.eye(3), np.zeros(3)), most))
    parameters, registration = LocalizationParameters(), Registration()
    rows = []
    for number in progress(range(len(queries)), len(queries), "refining"):
        query, segments = queries[number], views[chosen[number]]
        found = localize_query(engine, query, MAP, 25, parameters)[0]
        if found.pose is None or found.best is None or len(segments) != len(query.codes):
            continue
        poses = [found.best.pose]
        poses += [refined(found.best, segments, each, registration) for each in surfaces]
        rows.append([error_of(pose, query) for pose in poses])
    return np.array(rows).reshape(-1, len(WAYS), 2)


def mapped_segments(robot: Robot) -> Segments:
    """Return the segments of a robot's map, in the order of its rows (`Robot.build_map`)."""
    return Segments.concatenate(
        [segments.take(np.flatnonzero(kept)) for _, segments, kept in robot.views()]
    )


def refined(
    best: Hypothesis, segments: Segments, surfaces: SegmentPoints, registration: Registration
) -> Pose:
    """Return a pose refined by ICP of the inliers' points against those of their matches."""
    target = surfaces.of(best.rows)
    if not len(target):
        return best.pose
    source = segments.take(best.queries).points.astype(np.float64)
    matrix = registration.align(
        cell_means(source, CELL), cell_means(target, CELL), best.pose.matrix
    )
    return Pose.of_matrix(matrix)


def error_of(pose: Pose, query: PoseQuery) -> tuple[float, float]:
    """Return the error of a pose, meters and degrees."""
    meters, angle = pose.difference(query.truth, query.sensor)
    return meters, float(np.degrees(angle))


def error_figures(errors: Float64) -> dict[str, Any]:
    """Return median and 90th percentile of errors (queries, 2), meters and degrees."""
    if not len(errors):
        return {"poses": 0, "median_m": None, "p90_m": None, "median_deg": None, "p90_deg": None}
    (median_m, median_deg), (p90_m, p90_deg) = np.quantile(errors, [0.5, 0.9], axis=0)
    return {
        "poses": len(errors),
        "median_m": round(float(median_m), 4),
        "p90_m": round(float(p90_m), 4),
        "median_deg": round(float(median_deg), 4),
        "p90_deg": round(float(p90_deg), 4),
    }


def recognition_figures(
    recording: Recording, extractor: Extractor, decoder: ShapeDecoder, seed: int
) -> dict[str, Any]:
    """Return the share of right first candidates, ordered by descriptors and by decoded grids."""
    known = CodedGrids.drawn(recording, extractor, MOST_SEGMENTS, seed)
    rows = drawn_rows(len(recording.segments), MOST_SEGMENTS, seed)
    groups = recording.groups[rows]
    descriptors = extractor.manifest.quantizer.decode(known.codes)
    shapes = decoder.decode(known.stored())
    decoded = packed(shapes.occupancy)
    figures: dict[str, Any] = {"segments": len(rows)}
    easy = seen_within(known.segments.sensors, CROSS_VIEW_METERS)
    for name, found in (
        ("top1", retrieve(descriptors, groups)),
        ("cross_view_top1", retrieve(descriptors, groups, easy)),
    ):
        by_shape = overlaps_of(decoded, found.candidates)
        completed = overlaps_of(decoded, found.candidates, packed(known.grids))
        figures[name] = {
            "queries": int(found.has_mate.sum()),
            "descriptors": share_right(found, groups, -found.distances),
            "decoded shapes": share_right(found, groups, by_shape),
            "true shape against decoded shapes": share_right(found, groups, completed),
            "ranks of both": share_right(found, groups, -ranks(found.distances) - ranks(-by_shape)),
        }
    return figures


def packed(grids: Bool) -> UInt8:
    """Return the voxels of grids as bits, uint8 (n, bytes)."""
    return np.packbits(grids.reshape(len(grids), -1), axis=1)


def overlaps_of(
    decoded: UInt8,
    candidates: Int64,
    asked: UInt8 | None = None,
) -> Float64:
    """Return the intersection over union with each candidate, float64 (n, k); -1 without one."""
    asked = decoded if asked is None else asked
    found = np.full(candidates.shape, -1.0)
    for row, some in enumerate(candidates):
        usable = some >= 0
        pairs = decoded[some[usable]]
        common = np.bitwise_count(pairs & asked[row]).sum(axis=1, dtype=np.int64)
        union = np.bitwise_count(pairs | asked[row]).sum(axis=1, dtype=np.int64)
        found[row, usable] = common / np.maximum(union, 1)
    return found


def ranks(values: Float64) -> Float64:
    """Return the rank of each value in its row, the smallest first."""
    return np.asarray(rankdata(values, axis=1))


def share_right(found: Retrieval, groups: Int64, scores: Float64) -> float | None:
    """Return the share of segments with a mate whose best candidate is one."""
    scores = np.where(found.candidates >= 0, scores, -np.inf)
    best = np.take_along_axis(found.candidates, scores.argmax(axis=1)[:, None], axis=1)[:, 0]
    right = (best >= 0) & (groups[best] == groups)
    return round(float(right[found.has_mate].mean()), 4) if found.has_mate.any() else None
