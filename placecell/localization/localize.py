"""Where in a map the robot is: the way from candidates to a pose, step by step."""

from collections.abc import Sequence
from dataclasses import dataclass
from math import erf
from typing import Literal

import numpy as np

from placecell.core.types import Float64
from placecell.localization.candidates import Candidates
from placecell.localization.confidence import Confidence, features_of, shipped
from placecell.localization.correspondences import correspond
from placecell.localization.evidence import Evidence
from placecell.localization.guided_matching import CandidateSegments, MapSegments, match_guided
from placecell.localization.hypothesis import Hypothesis, find_hypotheses
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.voting import most_voted

Reason = Literal["too-few-segments", "inconsistent", "ambiguous"]

PARAMETERS = LocalizationParameters()

RIGHT_DEGREES = 3.0
"""A pose is right within a meter and this (docs/results/localization.md, Protocol)."""


@dataclass(frozen=True, slots=True, eq=False)
class Localization:
    """What is known of the robot's place in a map.

    Attributes:
        best: the best hypothesis, also where it is not good enough; None if there is none.
        second: the best one at another place.
        probability: that the best one is right: within a meter and three degrees.
        reason: why the robot is not localized; None: it is.
        detail: the reason in words; empty if it is localized.
        features: that the probability follows from (`features_of`); None without a hypothesis.
        hypotheses: all, best first, for later requests to look back at.
    """

    best: Hypothesis | None
    second: Hypothesis | None
    probability: float
    reason: Reason | None
    detail: str
    features: Float64 | None
    hypotheses: tuple[Hypothesis, ...]

    @property
    def pose(self) -> Pose | None:
        """From the robot's frame to the map's; None if it is not localized."""
        return self.best.pose if self.best is not None and self.reason is None else None


def localize(
    candidates: Candidates,
    parameters: LocalizationParameters = PARAMETERS,
    confidence: Confidence | None = None,
    evidence: Evidence | None = None,
    there: MapSegments | None = None,
) -> Localization:
    """Find the robot's frame in the map's.

    Args:
        candidates: what each of its segments may be.
        confidence: gives the probability; the shipped one unless said.
        evidence: what the robot's requests of the last seconds found.
        there: the map; as much of it as the candidates show unless given.
    """
    places = find_places(candidates, parameters, evidence)
    if not places.hypotheses:
        return unknown(places.usable, parameters)
    there = there or CandidateSegments(candidates)
    hypotheses = [match_guided(each, candidates, there, parameters) for each in places.hypotheses]
    return judge(hypotheses, places.usable, parameters, confidence or shipped(), evidence)


@dataclass(frozen=True, slots=True, eq=False)
class PlaceHypotheses:
    """Candidate places of the robot in one map, before they are scored and judged.

    Attributes:
        hypotheses: best first, each at another place; empty if there is none.
        usable: how many queries have candidates.
    """

    hypotheses: tuple[Hypothesis, ...]
    usable: int


def find_places(
    candidates: Candidates, parameters: LocalizationParameters, evidence: Evidence | None = None
) -> PlaceHypotheses:
    """Find the places in one map that candidates agree on, and those of earlier requests."""
    correspondences = correspond(candidates, parameters)
    if correspondences.usable < parameters.least_segments:
        return PlaceHypotheses((), correspondences.usable)
    voted = most_voted(correspondences, parameters)
    guesses = evidence.guesses(voted.source.mean(axis=0)) if evidence else []
    return PlaceHypotheses(
        tuple(find_hypotheses(voted, parameters, guesses)), correspondences.usable
    )


def unknown(usable: int, parameters: LocalizationParameters) -> Localization:
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
    return Localization(None, None, 0.0, reason, detail, None, ())


def judge(
    hypotheses: Sequence[Hypothesis],
    usable: int,
    parameters: LocalizationParameters,
    confidence: Confidence,
    evidence: Evidence | None = None,
) -> Localization:
    """Decide whether the best hypothesis is good enough.

    Args:
        hypotheses: one or more, each at another place.
        usable: how many queries had candidates.
    """
    totals = totals_of(hypotheses, evidence)
    order = np.argsort(-totals, kind="stable").tolist()
    best, total = hypotheses[order[0]], float(totals[order[0]])
    second = hypotheses[order[1]] if len(order) > 1 else None
    rival = float(totals[order[1]]) / total if len(order) > 1 else 0.0
    features = features_of(best, total, rival, usable)
    probability = confidence.probability(features)
    reason: Reason | None = None
    detail = ""
    if rival >= parameters.ambiguous:
        reason = "ambiguous"
        detail = f"Another place has {rival:.0%} of the best one's score."
        probability = min(probability, 1 / (1 + rival))
    elif not np.degrees(best.rotation_deviation) <= parameters.undetermined_yaw:
        reason = "inconsistent"
        detail = f"The {len(best)} segments that agree do not tell the direction."
        probability = min(probability, chance_of_direction(best.rotation_deviation))
    elif probability < parameters.least_probability:
        reason = "inconsistent"
        detail = f"The best place, where {len(best)} of {usable} segments agree, is hardly likely."
    return Localization(best, second, probability, reason, detail, features, tuple(hypotheses))


def totals_of(hypotheses: Sequence[Hypothesis], evidence: Evidence | None) -> Float64:
    """Return each hypothesis' score plus the support of earlier requests, float64 (n,)."""
    support = [evidence.support(each) if evidence else 0.0 for each in hypotheses]
    return np.array([each.score for each in hypotheses]) + support


def chance_of_direction(deviation: float) -> float:
    """That an angle of this standard deviation, radians, is within the degrees of a right pose."""
    return erf(np.radians(RIGHT_DEGREES) / (np.sqrt(2) * deviation))
