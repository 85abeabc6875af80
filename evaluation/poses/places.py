"""Evaluation of place recognition by published protocols: `placecell evaluate --protocol`."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.edit import take

from evaluation.machine import machine
from evaluation.poses.place_recognition import (
    PlaceAnswer,
    PlaceProtocol,
    place_answer,
    place_figures,
)
from evaluation.poses.queries import (
    Pair,
    PoseQuery,
    described_captures,
    localize_query,
    random_frame,
)
from evaluation.poses.recordings import recording_of
from evaluation.poses.robot import Robot
from placecell.core.types import Float64
from placecell.datasets import open_drive
from placecell.localization import LocalizationParameters
from placecell.segmentation.pipeline import Progress, silent
from service.engine import Engine

MAP = "map"
K = 25
"""Candidates per segment."""

TOGETHER = 10
"""Queries that share a map on one drive. The map is that of the first one, so for the others it
lacks up to nine captures that the protocol allows."""


@dataclass(frozen=True, slots=True)
class GrowingMap:
    """State of a map that grows along a drive, and the queries that are localized in it.

    Attributes:
        queries: the queries.
        content: segments of the map.
        frames: float64 (n, 3), positions of the map frames.
    """

    queries: Sequence[PoseQuery]
    content: CompactMap
    frames: Float64


def evaluate_places(
    pair: Pair,
    model: Path,
    protocol: PlaceProtocol,
    seed: int = 0,
    *,
    progress: Progress = silent,
) -> dict[str, Any]:
    """Localize each capture of the asking robot; return the figures of the protocol.

    If both robots of the pair have the same drive, each query is localized in what the drive saw
    before, as for loop closures.

    Args:
        pair: robot that makes the map, and robot that localizes.
        model: folder of the model.
        protocol: rules of the evaluation.
        seed: random seed of the robot's own frame.
        progress: wraps the loop.

    Raises:
        ValueError: a drive has no segments.
    """
    for robot in (pair.mapper, pair.asker):
        robot.check_segments()
    loops = pair.mapper.drive is pair.asker.drive
    frame = random_frame(seed)
    parameters = LocalizationParameters()
    with Engine.temporary(model) as engine:
        whole = pair.mapper.build_map(engine, MAP)
        queries = list(pair.posed(described_captures(pair.asker, engine), frame))
        places = pair.mapper.drive.poses[pair.mapper.frames, :3, 3]
        steps = [GrowingMap(queries, whole, places)]
        if loops:
            steps = list(earlier(pair.mapper, whole, queries, protocol.skip_seconds))
        answers: list[PlaceAnswer] = []
        for number in progress(range(len(steps)), len(steps), "localizing"):
            step = steps[number]
            if number:
                engine.delete_map(MAP)
            engine.put_map(MAP, step.content)
            for query in step.queries:
                found, _ = localize_query(engine, query, MAP, K, parameters)
                answers.append(place_answer(found, query, step.frames, flat=protocol.flat))
        manifest = engine.model.manifest
    recordings = [each for robot in (pair.mapper, pair.asker) for each in robot.recordings]
    return {
        "map_drive": pair.mapper.drive.title,
        "query_drive": pair.asker.drive.title,
        "evaluation": protocol.name,
        "skip_seconds": protocol.skip_seconds if loops else None,
        **place_figures(answers, protocol),
        "model_id": manifest.model_id,
        "seen": any(manifest.has_seen(each.scan_hashes) for each in recordings),
        "protocol": recordings[0].parameters.protocol,
        "every": recordings[0].parameters.frame_step,
        "skipped_scans": sum(len(each.skipped_scans) for each in recordings),
        "dropped_points": sum(each.dropped_points for each in recordings),
        "map_segments": len(whole),
        "k": K,
        "seed": seed,
        "machine": machine(),
    }


def robots_of_places(
    drive: Path, map_drive: Path | None, every: int | None = None, progress: Progress = silent
) -> Pair:
    """Return the robots of two drives, or one robot as both if there is one drive.

    Args:
        drive: folder of the queries' drive.
        map_drive: folder of the map's drive; None for loop closures within `drive`.
        every: scans from one capture to the next, as `Parameters.for_drive`.
        progress: wraps the loops.

    Raises:
        ValueError: the drives have no common frame.
    """
    if map_drive is not None:
        return Pair.of(map_drive, drive, every, progress=progress)
    opened = open_drive(drive)
    recording = recording_of(opened, every, progress=progress)
    robot = Robot(opened.title, opened, [recording], np.eye(4))
    return Pair(robot, robot, blocks=False)


def earlier(
    robot: Robot, whole: CompactMap, queries: Sequence[PoseQuery], skip_seconds: float
) -> Iterator[GrowingMap]:
    """Yield the queries of a drive, each with what the drive saw long enough before.

    Queries in the first `skip_seconds` of the drive are left out.
    """
    scans = robot.frames
    times, places = robot.drive.times[scans], robot.drive.poses[scans, :3, 3]
    seen = whole.frame_times[whole.frame_index]
    late = [query for query in queries if query.time - queries[0].time >= skip_seconds]
    for first in range(0, len(late), TOGETHER):
        some = late[first : first + TOGETHER]
        until = some[0].time - skip_seconds
        yield GrowingMap(some, take(whole, seen <= until), places[times <= until])
