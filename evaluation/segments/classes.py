"""Figures of the classes of segments: accuracy, F1 scores, confusion and calibration."""

from typing import Any

import numpy as np

from evaluation.calibration import expected_calibration_error
from placecell.core.segment_classes import CLASSES, class_indices, class_probabilities
from placecell.core.types import Int64, UInt8
from placecell.datasets.labels import NO_CLASS

KEYS = (
    "labeled",
    "classes_present",
    "accuracy",
    "macro_f1",
    "calibration_error",
    "per_class",
    "confusion",
)
"""Keys of the figures in a report."""


def class_figures(labels: UInt8 | None, stated: UInt8 | None) -> dict[str, Any]:
    """Return the figures of the classes of segments; None where there are no labels or no classes.

    Args:
        labels: true class index of each segment, uint8 (n,), `NO_CLASS` where it is unknown; None
            if the drive has no labels.
        stated: stated class and probability, uint8 (n,) (`placecell.core.segment_classes`); None if
            the model has no head.
    """
    nothing: dict[str, Any] = dict.fromkeys(KEYS)
    if labels is None:
        return nothing
    known = labels != NO_CLASS
    true = labels[known].astype(np.int64)
    present = np.unique(true)
    counted = nothing | {
        "labeled": len(true),
        "classes_present": [CLASSES[index] for index in present],
    }
    if stated is None or not len(true):
        return counted
    found = class_indices(stated[known])
    table = confusion(true, found)
    rows = {CLASSES[index]: scores(table, int(index)) for index in present}
    error, _ = expected_calibration_error(
        class_probabilities(stated[known]).astype(np.float64), found == true
    )
    return counted | {
        "accuracy": float((found == true).mean()),
        "macro_f1": float(np.mean([row["f1"] for row in rows.values()])),
        "calibration_error": error,
        "per_class": rows,
        "confusion": {
            CLASSES[index]: dict(zip((*CLASSES, "unknown"), table[index].tolist(), strict=True))
            for index in present
        },
    }


def confusion(true: Int64, found: Int64) -> Int64:
    """Return the number of segments of each true class (row) and found class (column).

    Args:
        true: class index of each segment, int64 (n,).
        found: found class index, int64 (n,), -1 for unknown, which is the last column.
    """
    table = np.zeros((len(CLASSES), len(CLASSES) + 1), dtype=np.int64)
    np.add.at(table, (true, found), 1)
    return table


def scores(table: Int64, index: int) -> dict[str, float]:
    """Return number, precision, recall and F1 score of a class. Precision is 0 if it is not found.

    Args:
        table: result of `confusion`.
        index: index of a class that occurs.
    """
    right, stated, there = int(table[index, index]), table[:, index].sum(), table[index].sum()
    return {
        "segments": int(there),
        "precision": right / stated if stated else 0.0,
        "recall": right / there,
        "f1": 2 * right / (stated + there),
    }
