"""Calibration of stated probabilities: expected calibration error and Brier score."""

import numpy as np

from placecell.core.types import Bool, Float64


def expected_calibration_error(
    probability: Float64, matches: Float64 | Bool, bins: int = 10
) -> tuple[float, list[tuple[float, float, int]]]:
    """Return the expected calibration error, and the points of the reliability diagram.

    See Guo et al. 2017, *On Calibration of Modern Neural Networks*.

    Returns:
        The mean of |stated - true|, weighted by count; and per nonempty bin of equal width the mean
        stated probability, the share of matches, and the count.
    """
    which = np.minimum((probability * bins).astype(int), bins - 1)
    points = []
    for index in range(bins):
        inside = which == index
        if inside.any():
            points.append(
                (
                    float(probability[inside].mean()),
                    float(matches[inside].mean()),
                    int(inside.sum()),
                )
            )
    error = sum(abs(stated - true) * count for stated, true, count in points) / len(matches)
    return error, points


def brier(probability: Float64, matches: Float64 | Bool) -> float:
    """Return the Brier score: the mean squared difference of probability and truth (0 or 1)."""
    return float(np.mean((probability - matches) ** 2))


def calibration_figures(probability: Float64, matches: Float64 | Bool) -> dict[str, float | None]:
    """Return `expected_calibration_error` and `brier`; None if there are no probabilities."""
    if not len(probability):
        return {"expected_calibration_error": None, "brier": None}
    error, _ = expected_calibration_error(probability, matches)
    return {"expected_calibration_error": error, "brier": brier(probability, matches)}
