"""Localization in one map: the steps from candidates to a pose."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import erf
from typing import Literal

import numpy as np

from placecell.core.types import Float64
from placecell.localization.candidates import Candidates
from placecell.localization.confidence import Confidence, SegmentNeeds, features_of, shipped
from placecell.localization.correspondences import Correspondences, correspond
from placecell.localization.evidence import Evidence
from placecell.localization.guided_matching import (
    CandidateSegments,
    MapBoxes,
    MapSegments,
    match_guided,
)
from placecell.localization.hypothesis import Hypothesis, find_hypotheses, seen_by_robot
from placecell.localization.overlap import SegmentsInMap, explained_shares
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.pose_height import at_height_of_boxes
from placecell.localization.voting import most_voted

Reason = Literal["too-few-segments", "inconsistent", "ambiguous"]

HintedReason = Reason | Literal["outside-hints"]
"""Reason of a localization whose best pose may contradict the request's hints."""

PARAMETERS = LocalizationParameters()

RIGHT_DEGREES = 3.0
"""Largest rotation error of a right pose (docs/results/localization.md, Protocol). The largest
position error is 1 m."""


@dataclass(frozen=True, slots=True, eq=False)
class Localization:
    """Result of localization in one map.

    Attributes:
        usable: number of queries that have candidates.
        needs: number of queries that a sure pose usually needs.
        best: best hypothesis, even if it is rejected; None if there is none.
        second: best hypothesis at another place.
        probability: probability that the best hypothesis is right, within 1 m and 3 degrees.
        threshold: probability that a pose must exceed.
        risk: largest expected share of queries with a false pose that the threshold stands for;
            None if the model has no calibration.
        reason: reason why the robot is not localized; None if it is.
        detail: the reason in words; empty if the robot is localized.
        features: features of the probability (`features_of`); None without a hypothesis.
        hypotheses: all hypotheses, best first, as evidence for later requests.
    """

    usable: int
    needs: SegmentNeeds
    best: Hypothesis | None
    second: Hypothesis | None
    probability: float
    threshold: float
    risk: float | None
    reason: HintedReason | None
    detail: str
    features: Float64 | None
    hypotheses: tuple[Hypothesis, ...]

    @property
    def pose(self) -> Pose | None:
        """Transform from the robot's frame to the map's; None if the robot is not localized."""
        return self.best.pose if self.best is not None and self.reason is None else None


def localize(
    candidates: Candidates,
    parameters: LocalizationParameters = PARAMETERS,
    confidence: Confidence | None = None,
    evidence: Evidence | None = None,
    there: MapBoxes | None = None,
) -> Localization:
    """Estimate the pose of the robot's frame in the map's frame.

    Args:
        candidates: the most similar map segments of each of the robot's segments.
        parameters: constants of localization.
        confidence: model of the probability; None for that of the default model.
        evidence: evidence of the session's earlier requests.
        there: all segments of the map, for guided matching; None to use the candidates only.

    Raises:
        Cancelled: The request is late, or its client disconnected.
        ValueError: `max_false_acceptance` is out of range, or smaller than the model supports.
    """
    confidence = confidence or shipped()
    places = find_places(candidates, parameters, evidence)
    if not places.hypotheses:
        return unknown(places.usable, parameters, confidence)
    there = there or CandidateSegments(candidates)
    hypotheses = [match_guided(each, candidates, there, parameters) for each in places.hypotheses]
    told = judge(hypotheses, candidates, there, places.usable, parameters, confidence, evidence)
    return places.seen_by_robot(told, candidates, there, parameters)


@dataclass(frozen=True, slots=True, eq=False)
class PlaceHypotheses:
    """Candidate places of the robot in one map, before they are scored and judged.

    Attributes:
        hypotheses: hypotheses at different places, best first.
        usable: number of queries that have candidates.
        correspondences: the correspondences that the hypotheses come from; None if there are none.
    """

    hypotheses: tuple[Hypothesis, ...]
    usable: int
    correspondences: Correspondences | None = None

    def seen_by_robot(
        self,
        told: Localization,
        candidates: Candidates,
        there: MapBoxes,
        parameters: LocalizationParameters,
    ) -> Localization:
        """Return a localization with the pose that the robot's own view of the segments gives.

        Its height follows from the boxes as well (`pose_height`).

        Probability, reason and the hypotheses for later requests stay: they are about the place.
        """
        if told.best is None or self.correspondences is None:
            return told
        best = seen_by_robot(told.best, self.correspondences, parameters)
        return replace(told, best=at_height_of_boxes(best, candidates, there, parameters))


def find_places(
    candidates: Candidates,
    parameters: LocalizationParameters,
    evidence: Evidence | None = None,
    guesses: Sequence[Pose] = (),
) -> PlaceHypotheses:
    """Find the pose hypotheses of one map, from candidates, earlier requests and other guesses.

    A guess becomes a hypothesis only by the candidates that agree with it.
    """
    correspondences = correspond(candidates, parameters)
    if correspondences.usable < parameters.least_segments:
        return PlaceHypotheses((), correspondences.usable)
    voted = most_voted(correspondences, parameters)
    past = evidence.guesses(voted.source.mean(axis=0)) if evidence else []
    found = find_hypotheses(voted, parameters, [*past, *guesses])
    return PlaceHypotheses(tuple(found), correspondences.usable, voted)


def unknown(
    usable: int, parameters: LocalizationParameters, confidence: Confidence
) -> Localization:
    """Return the localization of a map without any hypothesis."""
    if usable < parameters.least_segments:
        reason: Reason = "too-few-segments"
        detail = (
            f"{usable} segments have candidates in the map; "
            f"{parameters.least_segments} or more are needed."
        )
    else:
        reason = "inconsistent"
        detail = "No geometrically consistent match was found in the map."
    threshold, risk = threshold_of(parameters, confidence)
    return Localization(
        usable=usable,
        needs=confidence.needs,
        best=None,
        second=None,
        probability=0.0,
        threshold=threshold,
        risk=risk,
        reason=reason,
        detail=detail,
        features=None,
        hypotheses=(),
    )


def threshold_of(
    parameters: LocalizationParameters, confidence: Confidence
) -> tuple[float, float | None]:
    """Return the probability that a pose must exceed, and its risk (`Confidence.threshold`)."""
    return confidence.threshold(parameters.max_false_acceptance, parameters.least_probability)


def judge(
    hypotheses: Sequence[Hypothesis],
    candidates: Candidates,
    there: MapSegments,
    usable: int,
    parameters: LocalizationParameters,
    confidence: Confidence,
    evidence: Evidence | None = None,
) -> Localization:
    """Decide whether the best hypothesis is good enough.

    Args:
        hypotheses: one or more hypotheses at different places.
        candidates: candidates of all queries.
        there: segments of the map.
        usable: number of queries that have candidates.
        parameters: constants of localization.
        confidence: model of the probability.
        evidence: evidence of the session's earlier requests.
    """
    totals = totals_of(hypotheses, evidence)
    order = np.argsort(-totals, kind="stable").tolist()
    best, total = hypotheses[order[0]], float(totals[order[0]])
    second = hypotheses[order[1]] if len(order) > 1 else None
    rival = float(totals[order[1]]) / total if len(order) > 1 else 0.0
    explained = explained_shares(best.pose, candidates, there)
    in_map = SegmentsInMap.of(best.pose, candidates, there)
    features = features_of(best, total, rival, usable, candidates, explained, in_map)
    probability = confidence.probability(features)
    threshold, risk = threshold_of(parameters, confidence)
    reason, limit = rejection_of(best, rival, parameters)
    probability = min(probability, limit)
    detail = ""
    if reason == "ambiguous":
        assert second is not None  # it has the rival's score
        one, other = places_of(best, second)
        detail = (
            f"Another place has {rival:.0%} of the best place's score. The segments fit at "
            f"{_position_text(one)} and at {_position_text(other)}, "
            f"{np.linalg.norm(one - other):.1f} m apart."
        )
    elif reason == "inconsistent" and not is_turn_known(best, parameters):
        detail = f"The {len(best)} inlier segments do not determine the rotation."
    elif reason == "inconsistent":
        detail = (
            f"The {len(best)} inlier segments stand at {spots_of(best, parameters)} places; "
            f"{parameters.least_segments} or more are needed. Segments less than "
            f"{parameters.one_spot:g} m apart count as one place, for example the parts of one "
            "tree."
        )
    elif probability <= threshold:
        reason = "inconsistent"
        detail = (
            f"The best pose, with {len(best)} of {usable} segments as inliers, has the probability "
            f"{probability:.3f}; more than {threshold:.3f} is needed."
        )
    return Localization(
        usable=usable,
        needs=confidence.needs,
        best=best,
        second=second,
        probability=probability,
        threshold=threshold,
        risk=risk,
        reason=reason,
        detail=detail,
        features=features,
        hypotheses=tuple(hypotheses),
    )


def rejection_of(
    best: Hypothesis, rival: float, parameters: LocalizationParameters
) -> tuple[Reason | None, float]:
    """Return why a pose is rejected whatever its features are, and its largest probability.

    Args:
        best: best hypothesis.
        rival: score of the best hypothesis at another place, divided by that of `best`.
        parameters: constants of the judgment.
    """
    if rival >= parameters.ambiguous:
        return "ambiguous", 1 / (1 + rival)
    if not is_turn_known(best, parameters):
        return "inconsistent", chance_of_direction(best.rotation_deviation)
    if spots_of(best, parameters) < parameters.least_segments:
        return "inconsistent", parameters.least_probability
    return None, 1.0


def is_turn_known(best: Hypothesis, parameters: LocalizationParameters) -> bool:
    """Return whether the inliers of a hypothesis determine its rotation."""
    return bool(np.degrees(best.rotation_deviation) <= parameters.undetermined_yaw)


def spots_of(best: Hypothesis, parameters: LocalizationParameters) -> int:
    """Return at how many places the inliers of a hypothesis stand, at most `least_segments`.

    A sensor with few beams sees one tree as several segments, one above the other. If a pose puts
    one of them right, it puts all of them right, so together they are one piece of evidence.

    Args:
        best: the hypothesis.
        parameters: distance of two places; it is horizontal if gravity is known.
    """
    left = best.pose.apply(best.source)
    if parameters.model == "yaw":
        left = left[:, :2]
    spots = 0
    while len(left) and spots < parameters.least_segments:
        left = left[np.linalg.norm(left - left[0], axis=1) >= parameters.one_spot]
        spots += 1
    return spots


def places_of(best: Hypothesis, other: Hypothesis) -> tuple[Float64, Float64]:
    """Return where two hypotheses put the middle of the best one's segments, float64 (3,) each."""
    middle = best.source.mean(axis=0)
    return best.pose.apply(middle), other.pose.apply(middle)


def _position_text(position: Float64) -> str:
    return f"({position[0]:.1f}, {position[1]:.1f}, {position[2]:.1f})"


def totals_of(hypotheses: Sequence[Hypothesis], evidence: Evidence | None) -> Float64:
    """Return each hypothesis' score plus the support of earlier requests, float64 (n,)."""
    support = [evidence.support(each) if evidence else 0.0 for each in hypotheses]
    return np.array([each.score for each in hypotheses]) + support


def chance_of_direction(deviation: float) -> float:
    """Return the probability that the rotation error is within `RIGHT_DEGREES`.

    Args:
        deviation: standard deviation of the rotation, radians.
    """
    return erf(np.radians(RIGHT_DEGREES) / (np.sqrt(2) * deviation))
