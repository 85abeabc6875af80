"""Joint judgment: compare the robot's pose hypotheses over several maps.

Each map alone may fit well: floors of one building look alike. So the hypotheses of all maps
compete. A rival in another map counts like a second place in the same map. The weight of a pair of
segments follows from the same match probabilities in every map, whatever the map's size.

Two maps are compared segment by segment: a segment supports one of them, or both. If both maps show
the same place, the differences are noise of centroids and descriptors, and their sum favors the
wrong map as often as the right one. So the sum must exceed its standard deviation by far.
"""

from collections.abc import Callable, Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.cancellation import current
from placecell.core.types import Float64
from placecell.localization.candidates import Candidates
from placecell.localization.confidence import Confidence, with_rival
from placecell.localization.evidence import Evidence
from placecell.localization.guided_matching import MapBoxes, match_guided
from placecell.localization.hypothesis import Hypothesis, same_place
from placecell.localization.localize import (
    Localization,
    PlaceHypotheses,
    find_places,
    judge,
    totals_of,
    unknown,
)
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose

Link = Callable[[int, int], Pose | None]
"""Function that returns the pose of one map's frame (second index) in another's (first index), if
both hold the same segments; None otherwise."""


@dataclass(frozen=True, slots=True, eq=False)
class MapQuery:
    """A query in one map.

    Attributes:
        name: name of the map, for messages.
        model: id of the model of its descriptors. Scores of two models are not comparable.
        candidates: the most similar map segments of each query.
        there: segments of the map, for guided matching.
        confidence: model of the probability.
        evidence: evidence of the session's earlier requests in the map.
        guesses: returns poses to try as well, such as poses within a hint, given the hypotheses
            that were found without them; None: there are none.
    """

    name: str
    model: str
    candidates: Candidates
    there: MapBoxes
    confidence: Confidence
    evidence: Evidence | None = None
    guesses: Callable[[Sequence[Hypothesis]], tuple[Pose, ...]] | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Rival:
    """Hypothesis in another map that is not the same place.

    Attributes:
        map: index of the map.
        hypothesis: hypothesis in that map.
        total: its score, with the support of earlier requests.
        ratio: its evidence divided by that of the judged map's best hypothesis.
        ahead: number of standard deviations by which the judged map's hypothesis fits better.
        is_plausible: whether it would be the pose, or one of several ambiguous poses, if its map
            were the only one.
    """

    map: int
    hypothesis: Hypothesis
    total: float
    ratio: float
    ahead: float
    is_plausible: bool


@dataclass(frozen=True, slots=True, eq=False)
class JointLocalization:
    """One map's part of a joint judgment.

    Attributes:
        localization: localization in this map, after the comparison with all maps.
        total: score of the best hypothesis, with the support of earlier requests; 0 without one.
        rival: best hypothesis of the other maps; None if there is none.
        is_between_maps: whether the result is ambiguous because of the rival, not of a second place
            in this map.
    """

    localization: Localization
    total: float
    rival: Rival | None = None
    is_between_maps: bool = False


def localize_jointly(
    queries: Sequence[MapQuery],
    parameters: LocalizationParameters,
    link: Link = lambda *_: None,
) -> list[JointLocalization]:
    """Localize the robot in several maps and judge the hypotheses of all maps together.

    Args:
        queries: one query per map. A single one gives the result of `localize`.
        parameters: constants of localization.
        link: function that returns the transform between maps that hold the same segments.

    Raises:
        Cancelled: The request is late, or its client disconnected.
    """
    common = _common_beliefs(queries)
    found, only_rivals = [], set()
    loose = replace(
        parameters,
        distance_tolerance=LOOSER * parameters.distance_tolerance,
        height_tolerance=LOOSER * parameters.height_tolerance,
    )
    for number, query in enumerate(queries):
        current().check()
        places = find_places(query.candidates, parameters, query.evidence)
        guesses = () if query.guesses is None else query.guesses(places.hypotheses)
        if guesses:
            places = find_places(query.candidates, parameters, query.evidence, guesses)
        beliefs = common.get(query.model)
        if len(queries) > 1 and not places.hypotheses and places.usable <= FEW:
            places = find_places(query.candidates, loose)
            only_rivals.add(number)
        hypotheses = tuple(
            match_guided(each, query.candidates, query.there, parameters, beliefs)
            for each in places.hypotheses
        )
        found.append(replace(places, hypotheses=hypotheses))
    return [
        replace(
            each,
            localization=places.seen_by_robot(
                each.localization, query.candidates, query.there, parameters
            ),
        )
        for each, places, query in zip(
            judge_jointly(queries, found, parameters, link, only_rivals),
            found,
            queries,
            strict=True,
        )
    ]


FEW, LOOSER = 20, 2.0
"""Segment count up to which a map without any hypothesis is searched again, and the factor by which
the tolerances then grow. With few segments, noise of the centroids may leave no inliers in the
right map, while a similar map has enough by chance. Such a hypothesis only makes others ambiguous;
it is never a pose."""


def _common_beliefs(queries: Sequence[MapQuery]) -> dict[str, Float64]:
    """Return each segment's largest belief over all maps of a model, float64 (n,), by model.

    A small map has few similar segments. With its own candidates only, a pair would have a larger
    weight than the same pair in a large map.
    """
    common: dict[str, Float64] = {}
    if len(queries) > 1:
        for query in queries:
            own = query.candidates.beliefs.sum(axis=1)
            common[query.model] = np.maximum(common.get(query.model, own), own)
    return common


def judge_jointly(
    queries: Sequence[MapQuery],
    found: Sequence[PlaceHypotheses],
    parameters: LocalizationParameters,
    link: Link = lambda *_: None,
    only_rivals: Collection[int] = (),
) -> list[JointLocalization]:
    """Judge the hypotheses of all maps together.

    Args:
        queries: one query per map.
        found: hypotheses of each map, with comparable scores.
        parameters: constants of localization.
        link: see `localize_jointly`.
        only_rivals: indices of maps whose hypotheses compete with others but are no result.
    """
    totals = [
        totals_of(places.hypotheses, query.evidence) if places.hypotheses else np.zeros(0)
        for query, places in zip(queries, found, strict=True)
    ]
    alone = [
        judge(
            places.hypotheses,
            query.candidates,
            query.there,
            places.usable,
            parameters,
            query.confidence,
            query.evidence,
        )
        if places.hypotheses and number not in only_rivals
        else unknown(places.usable, parameters, query.confidence)
        for number, (query, places) in enumerate(zip(queries, found, strict=True))
    ]
    groups = _same_places(found, parameters, link)
    judged = []
    for number, own in enumerate(alone):
        if own.best is None:
            judged.append(JointLocalization(own, 0.0))
            continue
        here = int(np.argmax(totals[number]))
        total = float(totals[number][here])
        rivals = [
            _compared(
                own=own.best,
                rival=hypothesis,
                own_evidence=queries[number].evidence,
                evidence=queries[other].evidence,
                number=other,
                total=float(totals[other][at]),
                alone=alone[other],
                parameters=parameters,
            )
            for other, places in enumerate(found)
            for at, hypothesis in enumerate(places.hypotheses)
            if other != number and groups[other, at] != groups[number, here]
        ]
        told, rival = _against(own, number, found[number].usable, rivals, queries, parameters)
        between = told.reason == "ambiguous" and own.reason is None
        judged.append(JointLocalization(told, total, rival, between))
    return judged


def _compared(
    own: Hypothesis,
    rival: Hypothesis,
    own_evidence: Evidence | None,
    evidence: Evidence | None,
    number: int,
    total: float,
    alone: Localization,
    parameters: LocalizationParameters,
) -> Rival:
    """Compare a rival in another map with a map's best hypothesis, segment by segment."""
    assert own.similarity is not None
    assert rival.similarity is not None
    assert own.worth is not None
    assert rival.worth is not None
    of_own = own_evidence.support(own) if own_evidence else 0.0
    of_rival = evidence.support(rival) if evidence else 0.0
    ratio = (float(rival.similarity.sum()) + of_rival) / max(
        float(own.similarity.sum()) + of_own, 1e-9
    )
    ahead = 0.0
    if len(own.similarity) == len(rival.similarity):
        apart, past = own.similarity - rival.similarity, of_own - of_rival
        most = np.log1p(parameters.distinct / parameters.unlikely)
        weight = max(each.weight if each else 0.0 for each in (own_evidence, evidence))
        variance = (
            float(apart @ apart)
            + weight * float(np.sum((own.worth - rival.worth) ** 2))
            + parameters.past_weight * abs(past) * most
        )
        ahead = (float(apart.sum()) + past) / max(np.sqrt(variance), 1e-9)
    plausible = rival is alone.best and (
        alone.reason in {None, "ambiguous"} or alone.probability >= parameters.least_probability
    )
    return Rival(number, rival, total, ratio, ahead, plausible)


def _against(
    own: Localization,
    number: int,
    usable: int,
    rivals: Sequence[Rival],
    queries: Sequence[MapQuery],
    parameters: LocalizationParameters,
) -> tuple[Localization, Rival | None]:
    """Judge a map's best hypothesis against the other maps'; return also the rival to name."""
    assert own.best is not None
    query = queries[number]
    alike = [each for each in rivals if queries[each.map].model == query.model]
    foreign = [each for each in rivals if each not in alike and each.is_plausible]
    strongest = max(alike, key=lambda each: (each.ratio, each.total), default=None)
    rival = strongest
    reason, detail, probability, features = own.reason, own.detail, own.probability, own.features
    second = 0.0 if features is None else 1.0 - float(features[1])
    if strongest is not None and strongest.ratio > second:
        assert features is not None  # as there is a best hypothesis
        features = with_rival(features, min(strongest.ratio, 1.0))
        probability = min(probability, query.confidence.probability(features))
    doubt = min((chance_of_map(each.ahead, parameters) for each in alike), default=1.0)
    close = [each for each in alike if each.is_plausible or each.ratio >= parameters.ambiguous]
    if close:
        nearest = min(close, key=lambda each: each.ahead)
        if nearest.ahead < parameters.decisive or nearest.ratio > parameters.ambiguous:
            rival = nearest
    other = "" if rival is None else queries[rival.map].name
    if (
        rival is not None
        and rival in close
        and rival.ahead <= -parameters.decisive
        and (rival.ratio > 1 / parameters.ambiguous)
    ):
        alone = f" {detail}" if reason == "inconsistent" else ""
        reason = "inconsistent"
        detail = (
            f"Map {other!r:.80} fits better. {_support_text(own.best, rival.hypothesis)}{alone}"
        )
        probability = min(probability, 1 - chance_of_map(-rival.ahead, parameters))
    elif (
        rival is not None
        and rival in close
        and (rival.ahead < parameters.decisive or rival.ratio >= parameters.ambiguous)
    ):
        if reason is None:
            reason = "ambiguous"
            detail = (
                f"Map {other!r:.80} fits about as well. "
                f"{_support_text(own.best, rival.hypothesis)} {ADVICE}"
            )
        probability = min(probability, 1 / (1 + max(rival.ratio, parameters.ambiguous)))
    elif foreign and reason is None:
        # Scores of two models have different scales, so they cannot decide between two maps.
        rival = max(foreign, key=lambda each: each.total)
        other = queries[rival.map].name
        reason = "ambiguous"
        detail = (
            f"Map {other!r:.80} of another model fits too, and scores of different models cannot "
            f"be compared. {ADVICE}"
        )
        probability = min(probability, 0.5)
    else:
        probability = min(probability, doubt)
        if reason is None and probability <= own.threshold:
            reason = "inconsistent"
            detail = (
                f"The best pose, with {len(own.best)} of {usable} segments as inliers, is "
                f"unlikely to be right: map {other!r:.80} fits nearly as well."
            )
    told = replace(own, reason=reason, detail=detail, probability=probability, features=features)
    return told, rival


def chance_of_map(ahead: float, parameters: LocalizationParameters) -> float:
    """Return the probability that the better fitting map is the right one.

    If both maps show the same place, `ahead` is normally distributed with mean 0. Otherwise its
    mean is `apart_by`.

    Args:
        ahead: number of standard deviations by which the map fits better.
        parameters: prior odds (`alike`) and `apart_by`.
    """
    exponent = parameters.apart_by * ahead - parameters.apart_by**2 / 2
    odds = parameters.alike * float(np.exp(-np.clip(exponent, -50.0, 50.0)))
    return 1 - 0.5 * odds / (1 + odds)


def _support_text(own: Hypothesis, rival: Hypothesis) -> str:
    """Return how many segments support each of two maps, as text."""
    assert own.similarity is not None
    assert rival.similarity is not None
    here, there = (
        own.similarity > 0.5 * own.similarity.max(),
        rival.similarity > 0.5 * rival.similarity.max(),
    )
    both = int(np.count_nonzero(here & there))
    return (
        f"Segments that fit both maps: {both}; only this one: "
        f"{int(np.count_nonzero(here)) - both}; only that one: "
        f"{int(np.count_nonzero(there)) - both}."
    )


ADVICE = (
    "If you know which map the robot is in, name it in 'maps'. If both maps show the same place, "
    "merge them: POST /maps/{map}/merge."
)


def _same_places(
    found: Sequence[PlaceHypotheses], parameters: LocalizationParameters, link: Link
) -> dict[tuple[int, int], int]:
    """Return the place number of each hypothesis, by map and index of the hypothesis.

    Hypotheses of linked maps at the same place share a number.
    """
    nodes = [
        (number, at) for number, places in enumerate(found) for at in range(len(places.hypotheses))
    ]
    groups = {node: index for index, node in enumerate(nodes)}
    numbers = [number for number, places in enumerate(found) if places.hypotheses]
    for place, one in enumerate(numbers):
        for other in numbers[place + 1 :]:
            into = link(one, other)
            if into is None:
                continue
            for at, here in enumerate(found[one].hypotheses):
                middle = here.source.mean(axis=0)
                for there, hypothesis in enumerate(found[other].hypotheses):
                    if same_place(here.pose, into.after(hypothesis.pose), middle, parameters):
                        old, new = groups[other, there], groups[one, at]
                        groups = {node: new if g == old else g for node, g in groups.items()}
    return groups
