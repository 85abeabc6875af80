"""How two maps lie to each other: the way from their segments to a transform, step by step."""

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
    """What is known of how map b lies to map a.

    Attributes:
        best: the best way to lay one on the other, also where it is not good enough; None if there
            is none.
        second: the best one that puts b elsewhere.
        reason: why the maps are not aligned; None: they are.
        detail: the reason in words; empty if they are.
    """

    best: Overlap | None
    second: Overlap | None
    reason: Reason | None
    detail: str

    @property
    def pose(self) -> Pose | None:
        """From b's frame to a's; None if they are not aligned."""
        return self.best.pose if self.best is not None and self.reason is None else None


def align(
    a: MapView, b: MapView, search: DescriptorSearch, parameters: AlignmentParameters = PARAMETERS
) -> MapAlignment:
    """Find b's frame in a's.

    Submaps of b are localized in a; poses of submaps that put the whole map in the same place are
    one guess; and a guess is held against all of the overlap that follows from it.
    """
    least = parameters.least_pairs
    if min(len(a), len(b)) < least:
        detail = f"{min(len(a), len(b))} segments in a map; {least} or more are needed."
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
    """Where each submap of b may be in a: the hypotheses of localization, not yet judged."""
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
    """The map turned around on the spot, to hold against how it was laid.

    Where much lies densely and looks alike, what agrees does so by chance, and would turned, too.

    Args:
        viewpoints: float64 (n, 3), meters, from where the robot saw what agrees.
    """
    spot = viewpoints.mean(axis=0)
    there = pose.after(Pose.of_yaw(np.pi, np.zeros(3)))
    return Pose(there.rotation, pose.apply(spot) - there.rotation @ spot)


def judge(overlaps: Sequence[Overlap], parameters: AlignmentParameters) -> MapAlignment:
    """Decide whether the best overlap is good enough, and the only one that is."""
    ranked = distinct(overlaps, parameters)
    if not ranked:
        return MapAlignment(None, None, "inconsistent", "No part of one map lies in the other.")
    best, second = ranked[0], ranked[1] if len(ranked) > 1 else None
    reason: Reason | None = None
    detail = ""
    degrees = np.degrees(rotation_deviation(best.covariance))
    if not is_good(best, parameters):
        reason = "inconsistent"
        detail = (
            f"Where the maps would overlap, {len(best)} pairs agree, worth {best.agreement:.1%} of "
            f"what should; {parameters.least_agreement:.0%} and a score of "
            f"{parameters.least_score:.0f} are needed, not {best.score:.0f}."
        )
    elif second is not None and is_as_good(second, best, parameters):
        reason = "ambiguous"
        detail = (
            f"Another way to lay them has {second.score / best.score:.0%} of the best's score, and "
            f"{second.agreement / best.agreement:.0%} of its agreement."
        )
    elif not degrees <= parameters.local.undetermined_yaw:
        reason = "inconsistent"
        detail = f"The {len(best)} pairs that agree do not tell the direction."
    return MapAlignment(best, second, reason, detail)


def is_good(overlap: Overlap, parameters: AlignmentParameters) -> bool:
    """Whether so much agrees, of so much that should, as never does by chance."""
    return (
        overlap.agreement >= parameters.least_agreement and overlap.score >= parameters.least_score
    )


def is_as_good(second: Overlap, best: Overlap, parameters: AlignmentParameters) -> bool:
    """Whether another way to lay the maps may as well be the right one.

    By all that agrees, or by its share of what should: copies of a street lie on each other with
    more or less of an overlap, and it is not the largest that is right.
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
    """Whether b lies in a by this pose as well as by the best one, which puts it elsewhere.

    No where the two would not overlap, for nothing speaks for that.
    """
    found = overlap_of(a, b, pose, search, parameters)
    is_another = not same_place(found.pose, best.pose, best.source.mean(axis=0), parameters.local)
    return is_another and is_as_good(found, best, parameters)


def distinct(overlaps: Sequence[Overlap], parameters: AlignmentParameters) -> list[Overlap]:
    """Best first, without those of few pairs, and those that put b where a better one does.

    One that is good enough is better than any that is not.
    """
    kept: list[Overlap] = []
    for one in sorted(overlaps, key=lambda each: (not is_good(each, parameters), -each.score)):
        if len(one) >= parameters.least_pairs and not any(
            same_place(one.pose, other.pose, one.source.mean(axis=0), parameters.local)
            for other in kept
        ):
            kept.append(one)
    return kept
