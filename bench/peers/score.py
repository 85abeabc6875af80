"""Poses against the truth: right, wrong but sure, not localised.

Figures have the names and the meaning that they have in `placecell evaluate-poses`.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.stats import binomtest

from bench.peers.exchange import Answer, Peer
from segments.types import Bool, Float64

RIGHT = (1.0, 3.0)
OFF = (3.0, 10.0)
"""Metres and degrees."""

STEPS = 20
"""Scores at which right and wrong are counted, at most."""


def score(peer: Peer, answers: Sequence[Answer], truth: Float64, mapped: Bool) -> dict[str, Any]:
    """A peer's figures; and, so that they do not hang on its rule alone, what other rules give.

    A pose that the peer's own rule does not accept counts as not localised.

    Args:
        truth: poses of the queries in the map's frame, float64 (queries, 4, 4).
        mapped: whether the map was made near by, bool (queries,); others stand apart.
    """
    metres, degrees = errors(answers, truth)
    sure = np.array([answer.estimate.sure for answer in answers])
    scores = np.array([answer.estimate.score for answer in answers], dtype=np.float64)
    right = (metres <= RIGHT[0]) & (degrees <= RIGHT[1])
    wrong = np.isfinite(metres) & ((metres > OFF[0]) | (degrees > OFF[1]))
    told = sure & mapped
    p50, p99 = np.percentile([answer.milliseconds for answer in answers], [50, 99])
    return {
        "name": peer.name,
        **shares(right[mapped], wrong[mapped], sure[mapped]),
        "median_position_error_m": median(metres[told]),
        "median_yaw_error_deg": median(degrees[told]),
        "p50_ms": round(float(p50), 1),
        "p99_ms": round(float(p99), 1),
        "beyond_the_map": shares(right[~mapped], wrong[~mapped], sure[~mapped]),
        "by_score": by_score(scores[mapped], right[mapped], wrong[mapped]),
        "right_above_all_wrong": right_above(scores[mapped], right[mapped], wrong[mapped]),
        "learning_seconds": round(peer.learning_seconds, 2),
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


def shares(right: Bool, wrong: Bool, sure: Bool) -> dict[str, Any]:
    """How many were right, wrong and unknown, with 95% bounds (Clopper and Pearson)."""
    which = {
        "localised_right": right & sure,
        "wrong_but_sure": wrong & sure,
        "not_localised": ~sure,
    }
    counts = {name: int(each.sum()) for name, each in which.items()}
    n = len(sure)
    return {
        "queries": n,
        **{name: round(count / n, 5) if n else None for name, count in counts.items()},
        "counts": counts,
        "bounds_95": {name: bounds(count, n) for name, count in counts.items()},
    }


def bounds(count: int, n: int) -> list[float]:
    """Of a share, exact, as if queries were independent."""
    if not n:
        return [0.0, 1.0]
    interval = binomtest(count, n).proportion_ci(0.95, "exact")
    return [round(float(interval.low), 5), round(float(interval.high), 5)]


def by_score(scores: Float64, right: Bool, wrong: Bool) -> list[dict[str, float]]:
    """Shares right and wrong if all poses with a score or more were accepted."""
    given = np.unique(scores[np.isfinite(scores)])
    spread = np.linspace(0, len(given) - 1, min(STEPS, len(given))).round().astype(int)
    return [
        {
            "score": float(at),
            "right": round(float((right & (scores >= at)).mean()), 5),
            "wrong": round(float((wrong & (scores >= at)).mean()), 5),
        }
        for at in given[spread]
    ]


def right_above(scores: Float64, right: Bool, wrong: Bool) -> float | None:
    """Share right with a score above all wrong ones': by a limit that is known only afterwards."""
    above = right & (scores > scores[wrong].max(initial=-np.inf))
    return round(float(above.mean()), 5) if len(above) else None


def median(values: Float64) -> float | None:
    """None of no values."""
    return round(float(np.median(values)), 4) if len(values) else None
