"""Second part of the demo: robot B localizes in robot A's map, and both maps are merged."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from placecell_client import Client, ServiceError, encode

from evaluation.poses.report import RIGHT
from evaluation.poses.robot import Robot, clouds
from placecell.core.segments import Segments
from placecell.core.types import Float64
from placecell.localization import Pose

SITE = "site"
"""Name of the merged map."""


@dataclass(frozen=True, slots=True)
class PoseAnswer:
    """Answer to one localization request, compared with the truth.

    Attributes:
        sensor: float64 (3,), true sensor position in the map's frame, meters.
        position: float64 (3,), sensor position by the answer; None: not localized.
        error_m, error_deg: error of the pose, meters and degrees; infinite without a pose.
        milliseconds: duration of the request.
    """

    sensor: Float64
    position: Float64 | None
    error_m: float
    error_deg: float
    milliseconds: float

    @property
    def is_right(self) -> bool:
        """Return whether the pose is within the tolerance of a right pose."""
        return self.error_m <= RIGHT[0] and self.error_deg <= RIGHT[1]


@dataclass(frozen=True, slots=True)
class Meeting:
    """Results of robot B's localization and of the merge.

    Attributes:
        answers: answer to each localization request.
        alignment: transform from robot B's frame into the map's; None: the maps were not aligned.
        alignment_error: error of the alignment along robot B's path, meters and degrees.
        segments: number of segments of the merged map; 0: there is no merged map.
        repeats: number of robot B's segments that the map already had.
        refusal: reason of the service for not merging; empty if the maps were merged.
    """

    answers: Sequence[PoseAnswer]
    alignment: Pose | None
    alignment_error: tuple[float, float]
    segments: int
    repeats: int
    refusal: str = ""

    @property
    def is_localized(self) -> bool:
        """Return whether at least one answer is right."""
        return any(each.is_right for each in self.answers)

    @property
    def is_merged(self) -> bool:
        """Return whether the alignment of the merged maps is within the tolerance of a pose."""
        return self.alignment_error[0] <= RIGHT[0] and self.alignment_error[1] <= RIGHT[1]

    def figures(self) -> dict[str, Any]:
        """Return the figures for the terminal and for JSON."""
        right = [each for each in self.answers if each.is_right]
        localized = sum(each.position is not None for each in self.answers)
        milliseconds = [each.milliseconds for each in self.answers]
        return {
            "poses_asked": len(self.answers),
            "poses_right": len(right),
            "poses_wrong": localized - len(right),
            "not_localised": len(self.answers) - localized,
            "pose_median_m": _median([each.error_m for each in right]),
            "pose_median_deg": _median([each.error_deg for each in right]),
            "localize_p50_ms": round(float(np.median(milliseconds)), 1),
            "maps_merged": self.alignment is not None,
            "merged_off_m": round(self.alignment_error[0], 3) if self.alignment else None,
            "merged_off_deg": round(self.alignment_error[1], 3) if self.alignment else None,
            "segments_in_site": self.segments,
            "repeats_left_out": self.repeats,
        }


def localize_and_merge(
    mapper: Robot,
    asker: Robot,
    client: Client,
    name: str,
    views: Sequence[tuple[int, Segments]],
) -> Meeting:
    """Localize robot B in robot A's map, then upload robot B's map and merge both.

    Args:
        mapper: robot A.
        asker: robot B.
        client: client of the service.
        name: name of robot A's map in the service.
        views: scan and segments of each capture of robot B that is localized.

    Raises:
        ServiceError: the service failed; a refusal to merge is part of the result.
    """
    truth = Pose.of_matrix(mapper.to_common).inverse().after(Pose.of_matrix(asker.to_common))
    answers = [_localize(asker, client, name, scan, segments, truth) for scan, segments in views]
    own = asker.name.replace(" ", "_")
    client.put_map(own, encode(asker.build_map(client, frame=asker.name)))
    try:
        merge = client.merge_maps(SITE, [name, own])
    except ServiceError as error:
        if not error.type.endswith(":not-aligned"):
            raise
        (pair,) = client.merge_maps(SITE, [name, own], dry_run=True).alignments
        return Meeting(answers, None, (np.inf, np.inf), 0, 0, pair.detail)
    part = merge.parts[1]
    assert part.pose is not None  # an unaligned part is a service error
    alignment = Pose.of_matrix(part.pose.matrix)
    middle = asker.drive.poses[:, :3, 3].mean(axis=0)
    meters, angle = alignment.difference(truth, middle)
    difference = meters, float(np.degrees(angle))
    return Meeting(answers, alignment, difference, merge.segments, part.repeats)


def _localize(
    asker: Robot, client: Client, name: str, scan: int, segments: Segments, truth: Pose
) -> PoseAnswer:
    started = time.perf_counter()
    answer = client.localize(segments=clouds(segments), sensors=segments.sensors, maps=[name])
    milliseconds = 1e3 * (time.perf_counter() - started)
    sensor = asker.drive.poses[scan, :3, 3]
    here = truth.apply(sensor)
    if answer.best is None or answer.best.pose is None:
        return PoseAnswer(here, None, np.inf, np.inf, milliseconds)
    pose = Pose.of_matrix(answer.best.pose.matrix)
    meters, angle = pose.difference(truth, sensor)
    return PoseAnswer(here, pose.apply(sensor), meters, float(np.degrees(angle)), milliseconds)


def _median(values: Sequence[float]) -> float | None:
    return round(float(np.median(values)), 3) if values else None
