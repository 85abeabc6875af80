"""Poses against the truth, counted as `placecell evaluate-poses` counts ours."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.peers.exchange import Peer, PeerAnswer
from evaluation.poses.report import OFF, Outcome, median, shares
from placecell.core.types import Bool, Float64
from placecell.localization import Pose

STEPS = 20
"""Scores at which right and wrong are counted, at most."""


@dataclass(frozen=True, slots=True)
class Scored:
    """What became of a query, and the peer's own score of its pose."""

    outcome: Outcome
    score: float

    @property
    def wrong(self) -> bool:
        """Whether the pose, if there is one, would mislead; accepted or not."""
        off = self.outcome.meters > OFF[0] or self.outcome.degrees > OFF[1]
        return off and bool(np.isfinite(self.outcome.meters))


def score_peer(
    peer: Peer, answers: Sequence[PeerAnswer], truth: Float64, mapped: Bool
) -> dict[str, Any]:
    """A peer's figures; and, so that they do not hang on its rule alone, what other rules give.

    Args:
        truth: poses of the queries in the map's frame, float64 (queries, 4, 4).
        mapped: whether the map was made near by, bool (queries,); others stand apart.
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
    """An answer as if it were ours.

    What a peer's own rule accepts is as good as certain, all else not localised.
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
    """Shares right and wrong if all poses with a score or more were accepted."""
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
    """Share right with a score above all wrong ones': by a limit that is known only afterwards."""
    limit = max((each.score for each in scored if each.wrong), default=float("-inf"))
    above = sum(each.outcome.right and each.score > limit for each in scored)
    return round(above / len(scored), 5) if scored else None
