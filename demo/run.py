"""First part of the demo: robot A shares its map through the service, robot B matches in it."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import Client, encode

from demo.meeting import Meeting, localize_and_merge
from demo.page_picture import draw_page
from demo.score import Score, score
from evaluation.poses.robot import DrivePath, Robot, ask
from service.child_process import running_service

MAP = "robot_a"
K = 25
REQUESTS = 60
"""Largest number of requests of robot B: enough for percentiles, few enough to wait for."""

SHORT_METERS = 24.0
"""Length below which a drive is short, meters: two blocks of 12 m."""


@dataclass(frozen=True, slots=True)
class DemoResult:
    """Results of the demo.

    Attributes:
        score: score of the candidates.
        figures: figures of the drive, the map and the requests, for the terminal and for JSON.
        meeting: results of the localization and the merge; None if they were not run.
    """

    score: Score
    figures: dict[str, Any]
    meeting: Meeting | None


def run_demo(
    mapper: Robot, asker: Robot, folder: Path, model: str, pictures: Path | None = None
) -> DemoResult:
    """Start the service, upload robot A's map, match robot B's segments, and score the matches.

    Args:
        mapper: robot A.
        asker: robot B.
        folder: data directory of the service.
        model: name of the model.
        pictures: folder of the pictures; if given, robot B is also localized, and both maps are
            merged.

    Raises:
        ValueError: a robot saw no segments.
    """
    for robot in (mapper, asker):
        robot.check_segments()
    with running_service(folder, "--model", model) as address, Client(address) as client:
        compact = mapper.build_map(client, frame=mapper.drive.folder.name)
        data = encode(compact)
        client.put_map(MAP, data)
        views = [(scan, segments) for scan, segments, _ in asker.views() if len(segments)]
        spread = np.unique(np.linspace(0, len(views) - 1, REQUESTS).astype(int))
        asked = [views[index] for index in spread]
        answers, milliseconds = ask(asker, client, [MAP], K, asked)
        model_id = client.info().model_id
        meeting = (
            None if pictures is None else localize_and_merge(mapper, asker, client, MAP, asked)
        )
        if pictures is not None:
            draw_page(pictures / "page.png", address)
    result = score(answers, compact.centroids, mapper.to_common)
    p50, p99 = np.percentile(milliseconds, [50, 99])
    figures = {
        "model_id": model_id,
        "path_m": round(asker.drive.path_length(), 1),
        "segments_in_map": len(compact),
        "map_bytes": len(data),
        "bytes_per_segment": round(len(data) / max(len(compact), 1), 1),
        "requests": len(milliseconds),
        "queries": result.queries,
        "queries_findable": result.findable,
        "right_by_chance": result.chance,
        **{f"right_at_{cut}": share for cut, share in result.right.items()},
        "request_p50_ms": round(float(p50), 1),
        "request_p99_ms": round(float(p99), 1),
    }
    if pictures is not None and meeting is not None:
        from demo.match_picture import draw_matches
        from demo.merged_map_picture import draw_site

        title = f"Segments of {asker.name}, matched to the map of {mapper.name}"
        right = result.first_is_right
        matches = pictures / "matches.png"
        draw_matches(matches, mapper, asker, compact.centroids, answers, right, title)
        draw_site(pictures / "site.png", mapper, asker, compact.centroids, meeting)
        figures |= meeting.figures()
    return DemoResult(result, figures, meeting)


def is_short(drive: DrivePath) -> bool:
    """Return whether a drive has less than two whole blocks."""
    return drive.path_length() < SHORT_METERS
