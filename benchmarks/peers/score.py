"""Score of a peer: its poses against the truth, counted as `placecell evaluate-poses` does."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.peers.exchange import Peer, PeerAnswer
from evaluation.poses.report import OFF, Outcome, best_pose_shares, median, shares
from placecell.core.types import Bool, Float64
from placecell.localization import Pose

STEPS = 20
"""Largest number of score thresholds at which right and wrong poses are counted."""


@dataclass(frozen=True, slots=True)
class Scored:
    """Outcome of a query, and the peer's own score of its pose."""

    outcome: Outcome
    score: float

    @property
    def wrong(self) -> bool:
        """Return whether there is a pose and it is misleading, accepted or not."""
        off = self.outcome.meters > OFF[0] or self.outcome.degrees > OFF[1]
        return off and bool(np.isfinite(self.outcome.meters))


def score_peer(
    peer: Peer, answers: Sequence[PeerAnswer], truth: Float64, mapped: Bool
) -> dict[str, Any]:
    """Return the figures of a peer, with its own acceptance rule and with other score thresholds.

    Args:
        peer: the peer.
        answers: answer to each query.
        truth: float64 (queries, 4, 4), true poses of the queries in the map's frame.
        mapped: bool (queries,), whether the query lies in the mapped area; others are counted
            apart.
    """
    scored = [
        Scored(outcome_of(answer, true, mapped=bool(near)), answer.estimate.score)
        for answer, true, near in zip(answers, truth, mapped, strict=True)
    ]
    within = [each for each in scored if each.outcome.mapped]
    beyond = [each.outcome for each in scored if not each.outcome.mapped]
    told = [each.outcome for each in within if each.outcome.localized]
    p50, p99 = np.percentile([answer.milliseconds for answer in answers], [50, 99])
    return {
        "name": peer.name,
        **shares([each.outcome for each in within]),
        **best_pose_shares([each.outcome for each in within]),
        "median_position_error_m": median([each.meters for each in told]),
        "median_yaw_error_deg": median([each.degrees for each in told]),
        "p50_ms": round(float(p50), 1),
        "p99_ms": round(float(p99), 1),
        "beyond_the_map": shares(beyond),
        "by_score": by_score(within),
        "right_above_all_wrong": right_above_all_wrong(within),
        "learning_seconds": round(peer.learning_seconds, 2),
        "settings": peer.settings,
        "versions": peer.versions,
    }


def outcome_of(answer: PeerAnswer, true: Float64, *, mapped: bool) -> Outcome:
    """Return the outcome of an answer.

    A pose that the peer's rule accepts has probability 1; any other pose counts as not localized.
    """
    meters = degrees = float("inf")
    if answer.estimate.pose is not None:
        pose = Pose.of_matrix(answer.estimate.pose)
        # The query's frame has its origin at the sensor.
        meters, angle = pose.difference(Pose.of_matrix(true), np.zeros(3))
        degrees = float(np.degrees(angle))
    return Outcome(
        reason="" if answer.estimate.sure else "not accepted",
        probability=1.0 if answer.estimate.sure else 0.0,
        meters=meters,
        degrees=degrees,
        normalized=float("nan"),
        milliseconds=answer.milliseconds,
        driven=0.0,
        mapped=mapped,
    )


def by_score(scored: Sequence[Scored]) -> list[dict[str, float]]:
    """Return the shares of right and wrong poses if all poses above a score were accepted."""
    given = np.unique([each.score for each in scored if np.isfinite(each.score)])
    rows = []
    for index in np.linspace(0, len(given) - 1, min(STEPS, len(given))).round().astype(int):
        accepted = [each for each in scored if each.score >= given[index]]
        right = sum(each.outcome.right for each in accepted)
        wrong = sum(each.wrong for each in accepted)
        rows.append(
            {
                "score": float(given[index]),
                "right": round(right / len(scored), 5),
                "wrong": round(wrong / len(scored), 5),
            }
        )
    return rows


def right_above_all_wrong(scored: Sequence[Scored]) -> float | None:
    """Return the share of right poses with a score above that of every wrong pose.

    This threshold is known only in hindsight.
    """
    limit = max((each.score for each in scored if each.wrong), default=float("-inf"))
    above = sum(each.outcome.right and each.score > limit for each in scored)
    return round(above / len(scored), 5) if scored else None
