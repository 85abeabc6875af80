"""Alignment of two maps: the steps from their segments to a transform."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from placecell.localization import Pose
from placecell.localization.correspondences import correspond
from placecell.localization.covariance import rotation_deviation
from placecell.localization.hypothesis import find_hypotheses, same_place
from placecell.localization.localize import Reason
from placecell.localization.voting import most_voted
from placecell.map_alignment.consensus import SubmapPose, common_pose, consensus
from placecell.map_alignment.map_view import DescriptorSearch, MapView, MatchProbabilities
from placecell.map_alignment.overlap import Overlap, overlap_of
from placecell.map_alignment.parameters import AlignmentParameters
from placecell.map_alignment.submaps import Submap, candidates_of, cut

PARAMETERS = AlignmentParameters()


@dataclass(frozen=True, slots=True, eq=False)
class MapAlignment:
    """Result of the alignment of map b to map a.

    Attributes:
        best: best overlap, even if it is rejected; None if there is none.
        second: best overlap that puts b at another place.
        reason: reason why the maps are not aligned; None if they are.
        detail: the reason in words; empty if the maps are aligned.
    """

    best: Overlap | None
    second: Overlap | None
    reason: Reason | None
    detail: str

    @property
    def pose(self) -> Pose | None:
        """Transform from b's frame to a's; None if the maps are not aligned."""
        return self.best.pose if self.best is not None and self.reason is None else None


def align(
    a: MapView, b: MapView, search: DescriptorSearch, parameters: AlignmentParameters = PARAMETERS
) -> MapAlignment:
    """Estimate the transform from b's frame to a's frame.

    Submaps of b are localized in a. Submap poses that put the whole map in the same place are
    combined. Each combined pose is verified on the overlap of the maps.

    Args:
        a: map whose frame is the target.
        b: map whose frame is the source.
        search: search for similar segments of a, and match probabilities.
        parameters: constants of alignment.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    least = parameters.least_pairs
    if min(len(a), len(b)) < least:
        detail = f"A map has {min(len(a), len(b))} segments; {least} or more are needed."
        return MapAlignment(None, None, "too-few-segments", detail)
    guesses = submap_poses(cut(b, parameters), a, b, search, parameters)
    overlaps = [
        overlap_of(a, b, common_pose(members, parameters), search, parameters)
        for members in consensus(guesses, parameters)
    ]
    overlaps += [
        overlap_of(a, b, turned_around(best.pose, b.viewpoints[best.rows_b]), search, parameters)
        for best in distinct(overlaps, parameters)[:1]
    ]
    return judge(overlaps, parameters)


def submap_poses(
    submaps: Sequence[Submap],
    a: MapView,
    b: MapView,
    search: DescriptorSearch,
    parameters: AlignmentParameters,
) -> list[SubmapPose]:
    """Return the pose hypotheses of each submap of b in a, before they are judged."""
    guesses = []
    for number, submap in enumerate(submaps):
        candidates = candidates_of(submap, b, a, search, parameters)
        voted = most_voted(correspond(candidates, parameters.local), parameters.local)
        guesses += [
            SubmapPose(number, submap.middle, each.pose, each.score)
            for each in find_hypotheses(voted, parameters.local)
        ]
    return guesses


def turned_around(pose: Pose, viewpoints: Float64) -> Pose:
    """Return the pose rotated by 180 degrees about z at the mean viewpoint, as a comparison.

    Where segments are dense and similar, inliers occur by chance, and just as often after the
    rotation.

    Args:
        pose: transform from b's frame to a's.
        viewpoints: float64 (n, 3), meters, viewpoints of the inliers in b's frame.
    """
    spot = viewpoints.mean(axis=0)
    there = pose.after(Pose.of_yaw(np.pi, np.zeros(3)))
    return Pose(there.rotation, pose.apply(spot) - there.rotation @ spot)


def judge(overlaps: Sequence[Overlap], parameters: AlignmentParameters) -> MapAlignment:
    """Decide whether the best overlap is good enough and better than any other place."""
    ranked = distinct(overlaps, parameters)
    if not ranked:
        return MapAlignment(None, None, "inconsistent", "No part of one map matches the other.")
    best, second = ranked[0], ranked[1] if len(ranked) > 1 else None
    reason: Reason | None = None
    detail = ""
    degrees = np.degrees(rotation_deviation(best.covariance))
    if not is_good(best, parameters):
        reason = "inconsistent"
        detail = (
            f"In the best overlap {len(best)} pairs match, with an agreement of "
            f"{best.agreement:.1%} and a score of {best.score:.1f}. An agreement of "
            f"{parameters.least_agreement:.0%} and a score of {parameters.least_score:.0f} are "
            "needed."
        )
    elif second is not None and is_as_good(second, best, parameters):
        reason = "ambiguous"
        detail = (
            f"Another alignment has {second.score / best.score:.0%} of the best one's score and "
            f"{second.agreement / best.agreement:.0%} of its agreement."
        )
    elif not degrees <= parameters.local.undetermined_yaw:
        reason = "inconsistent"
        detail = f"The {len(best)} matching pairs do not determine the rotation."
    return MapAlignment(best, second, reason, detail)


def is_good(overlap: Overlap, parameters: AlignmentParameters) -> bool:
    """Return whether score and agreement are higher than they are by chance."""
    return (
        overlap.agreement >= parameters.least_agreement and overlap.score >= parameters.least_score
    )


def is_as_good(second: Overlap, best: Overlap, parameters: AlignmentParameters) -> bool:
    """Return whether another overlap may as well be the right one.

    Score or agreement decides: copies of a street overlap by different amounts, and the largest
    overlap need not be the right one.
    """
    return second.score >= parameters.ambiguous * best.score or (
        is_good(second, parameters) and second.agreement >= parameters.ambiguous * best.agreement
    )


def fits_as_well(
    a: MapView,
    b: MapView,
    pose: Pose,
    best: Overlap,
    search: MatchProbabilities,
    parameters: AlignmentParameters = PARAMETERS,
) -> bool:
    """Return whether a pose that puts b at another place fits as well as the best overlap.

    A pose without overlap never does.

    Args:
        a: map whose frame is the target.
        b: map whose frame is the source.
        pose: transform from b's frame to a's.
        best: best overlap of the maps.
        matches: match probabilities of segments.
        parameters: constants of alignment.
    """
    found = overlap_of(a, b, pose, search, parameters)
    is_another = not same_place(found.pose, best.pose, best.source.mean(axis=0), parameters.local)
    return is_another and is_as_good(found, best, parameters)


def distinct(overlaps: Sequence[Overlap], parameters: AlignmentParameters) -> list[Overlap]:
    """Sort overlaps, best first; drop those with few pairs or at a better one's place.

    Overlaps that are good enough come before the others.
    """
    kept: list[Overlap] = []
    for one in sorted(overlaps, key=lambda each: (not is_good(each, parameters), -each.score)):
        if len(one) >= parameters.least_pairs and not any(
            same_place(one.pose, other.pose, one.source.mean(axis=0), parameters.local)
            for other in kept
        ):
            kept.append(one)
    return kept
