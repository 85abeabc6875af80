"""Poses against the truth: right, wrong but sure, not localised."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.stats import binomtest

from bench.peers.exchange import Answer, Peer
from segments.types import Bool, Float64

RIGHT_METRES, RIGHT_DEGREES = 1.0, 3.0
WRONG_METRES, WRONG_DEGREES = 3.0, 10.0


def score(peer: Peer, answers: Sequence[Answer], truth: Float64) -> dict[str, Any]:
    """A peer's figures, as `placecell evaluate-poses` names them, and what its rule costs it.

    A pose that the peer's own rule does not accept counts as not localised. So that no figure hangs
    on that rule, three more are given: shares right and wrong if all its poses were accepted, and
    the share right at the lowest score above all of its wrong poses, known only afterwards.

    Args:
        truth: poses of the queries in the map's frame, float64 (queries, 4, 4).
    """
    metres, degrees = errors(answers, truth)
    sure = np.array([answer.estimate.sure for answer in answers])
    scores = np.array([answer.estimate.score for answer in answers], dtype=np.float64)
    right = (metres <= RIGHT_METRES) & (degrees <= RIGHT_DEGREES)
    wrong = np.isfinite(metres) & ((metres > WRONG_METRES) | (degrees > WRONG_DEGREES))
    highest_wrong = scores[wrong].max(initial=-np.inf)
    milliseconds = [answer.milliseconds for answer in answers]
    return {
        "name": peer.name,
        "queries": len(answers),
        "localised_right": share(right & sure),
        "localised_right_95": bounds(right & sure),
        "wrong_but_sure": share(wrong & sure),
        "wrong_but_sure_95": bounds(wrong & sure),
        "not_localised": share(~sure),
        "median_position_error_m": median(metres[sure]),
        "median_yaw_error_deg": median(degrees[sure]),
        "p50_ms": float(np.percentile(milliseconds, 50)),
        "p99_ms": float(np.percentile(milliseconds, 99)),
        "right_if_all_accepted": share(right),
        "wrong_if_all_accepted": share(wrong),
        "right_above_all_wrong": share(right & (scores > highest_wrong)),
        "learning_seconds": peer.learning_seconds,
        "settings": peer.settings,
        "versions": peer.versions,
    }


def errors(answers: Sequence[Answer], truth: Float64) -> tuple[Float64, Float64]:
    """Metres and degrees between each pose and the true one, (queries,); infinite without one."""
    metres, degrees = np.full(len(answers), np.inf), np.full(len(answers), np.inf)
    for index, (answer, true) in enumerate(zip(answers, truth, strict=True)):
        pose = answer.estimate.pose
        if pose is None:
            continue
        # The frame's origin is the sensor: an angle moves no query away.
        metres[index] = np.linalg.norm(pose[:3, 3] - true[:3, 3])
        turn = Rotation.from_matrix(true[:3, :3].T @ pose[:3, :3])
        degrees[index] = np.degrees(turn.magnitude())
    return metres, degrees


def share(which: Bool) -> float:
    """Of the queries."""
    return float(which.mean())


def bounds(which: Bool) -> list[float]:
    """Of a share, with 95% confidence (Clopper and Pearson), as if queries were independent."""
    interval = binomtest(int(which.sum()), len(which)).proportion_ci(0.95, "exact")
    return [float(interval.low), float(interval.high)]


def median(values: Float64) -> float | None:
    """None of no values."""
    return float(np.median(values)) if len(values) else None
