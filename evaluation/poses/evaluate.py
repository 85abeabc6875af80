"""Evaluation of localization: `placecell evaluate-poses`, by the documented protocol."""

from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import encode

from evaluation.figure import figure
from evaluation.machine import machine
from evaluation.poses.place_recognition import PROTOCOLS, place_answer, place_figures
from evaluation.poses.queries import (
    MAPPED_METERS,
    DriveSession,
    Pair,
    PoseQuery,
    localize_query,
    random_frame,
)
from evaluation.poses.report import Outcome, report
from placecell.core.segment_classes import ClassFilter
from placecell.localization import Localization, LocalizationParameters
from placecell.localization.covariance import at_point
from placecell.localization.evidence import RequestHistory
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine

MAP = "map"


def evaluate(
    pair: Pair,
    model: Path,
    k: int = 25,
    parameters: LocalizationParameters | None = None,
    session: bool = False,
    most: int | None = None,
    seed: int = 0,
    *,
    wanted: ClassFilter | None = None,
    progress: Progress = silent,
) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """Localize every capture of a drive.

    Args:
        pair: robot that makes the map, and robot that localizes.
        model: folder of the model.
        k: candidates per segment.
        parameters: parameters of the localization; the defaults unless given.
        session: whether the queries form one session, at the times of their scans.
        most: largest number of queries, spread evenly; None: all.
        seed: random seed of the robot's own frame.
        wanted: filter of the segments of map and queries by their class; None keeps all.
        progress: wraps the loop.

    Returns:
        The report that `placecell evaluate-poses` writes, and a row per query.

    Raises:
        ValueError: a drive has no segments.
    """
    parameters = parameters or LocalizationParameters()
    for robot in (pair.mapper, pair.asker):
        robot.check_segments()
    with Engine.temporary(model) as engine:
        compact = pair.mapper.build_map(engine, pair.mapper.name, wanted)
        file = encode(compact)
        engine.put_map(MAP, file)
        frame = random_frame(seed)
        queries = list(pair.queries(engine, frame, most, wanted))
        fullest = max(queries, key=lambda each: len(each.codes))
        manifest = engine.model.manifest
        # A warm-up compiles all loops before the measurement.
        localize_query(engine, fullest, MAP, k, parameters)
        memory = DriveSession(RequestHistory(parameters)) if session else None
        frames = pair.mapper.drive.poses[pair.mapper.frames, :3, 3]
        outcomes, places = [], []
        for number in progress(range(len(queries)), len(queries), "localizing"):
            query = queries[number]
            if memory is not None:
                memory.time = query.time
            found, milliseconds = localize_query(engine, query, MAP, k, parameters, memory)
            outcomes.append(outcome_of(found, query, milliseconds))
            places.append(place_answer(found, query, frames))
    first = pair.asker.recordings[0].parameters
    robots = (pair.mapper, pair.asker)
    recordings = [recording for robot in robots for recording in robot.recordings]
    told = {
        "map_drive": pair.mapper.drive.title,
        "query_drive": pair.asker.drive.title,
        "map_sensor": pair.mapper.sensor,
        "query_sensor": pair.asker.sensor,
        "blocks": pair.blocks,
        "protocol": first.protocol,
        "every": first.frame_step,
        "skipped_scans": sum(len(each.skipped_scans) for each in recordings),
        "dropped_points": sum(each.dropped_points for each in recordings),
        "accumulated_scans": first.accumulated_scans,
        "model_id": manifest.model_id,
        "seen": any(manifest.has_seen(each.recordings[0].scan_hashes) for each in robots),
        "motion": parameters.model,
        "session": session,
        "classes": None if wanted is None else sorted(wanted.kept),
        "k": k,
        "seed": seed,
        "machine": machine(),
        "map_segments": len(compact),
        "map_bytes": len(file),
        "query_segments_mean": round(float(np.mean([len(each.codes) for each in queries])), 1),
        "mapped_metres": None if pair.blocks else MAPPED_METERS,
    }
    rows = [row_of(*each) for each in zip(queries, outcomes, strict=True)]
    recognized = {"place_recognition": place_figures(places, PROTOCOLS["kitti-loops"])}
    return told | report(outcomes) | recognized, rows


JSON_KEYS = {"meters": "metres", "normalized": "normalised"}
"""Keys of a row that differ from the attribute's name; recorded rows have them."""


def row_of(query: PoseQuery, outcome: Outcome) -> dict[str, Any]:
    """Return a query and its outcome as a JSON row; infinite and undefined values are null."""
    values = {JSON_KEYS.get(name, name): value for name, value in asdict(outcome).items()}
    return {
        "scan": query.scan,
        "segments": len(query.codes),
        "position": query.truth.apply(query.sensor).round(2).tolist(),
    } | {
        name: None if isinstance(value, float) and not np.isfinite(value) else value
        for name, value in values.items()
    }


def outcome_of(found: Localization, query: PoseQuery, milliseconds: float) -> Outcome:
    """Compare the result of a query with the truth."""
    meters = degrees = np.inf
    normalized = np.nan
    if found.best is not None:
        pose = found.best.pose
        meters, angle = pose.difference(query.truth, query.sensor)
        degrees = float(np.degrees(angle))
        if found.pose is not None:
            covariance = at_point(found.best.covariance, pose, query.sensor)
            # Position and yaw are compared, not the tilt; the last row is the yaw in both models.
            compared = np.ix_([0, 1, 2, -1], [0, 1, 2, -1])
            turn = query.truth.rotation @ pose.rotation.T
            error = np.append(
                query.truth.apply(query.sensor) - pose.apply(query.sensor),
                np.arctan2(turn[1, 0], turn[0, 0]),
            )
            normalized = float(error @ np.linalg.solve(covariance[compared], error))
    return Outcome(
        found.reason or "",
        found.probability,
        meters,
        degrees,
        normalized,
        milliseconds,
        query.meters,
        query.mapped,
    )


def draw(report: dict[str, Any], file: Path) -> None:
    """Plot precision against recall, and the reliability of the stated probability."""
    with figure(file, 2) as (curve, diagram):
        rows = report["precision_recall"]
        recall, precision = ([row[name] for row in rows] for name in ("recall", "precision"))
        curve.plot(recall, precision, marker="o", markersize=3)
        curve.set(xlabel="recall", ylabel="precision", xlim=(0, 1.02), title=report["query_drive"])
        bins = report["reliability"]
        diagram.plot([0, 1], [0, 1], color="0.7", linestyle=":")
        diagram.scatter(
            [each["stated"] for each in bins],
            [each["right"] for each in bins],
            [4 + 100 * each["count"] / sum(one["count"] for one in bins) for each in bins],
        )
        diagram.set(xlabel="stated probability", ylabel="share right", title="reliability")
        for axes in (curve, diagram):
            axes.grid(alpha=0.3)
