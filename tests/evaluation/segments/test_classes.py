"""Tests of the figures of classes, by hand."""

import numpy as np
import pytest

from evaluation.segments.classes import class_figures
from placecell.core.segment_classes import encoded
from placecell.datasets.labels import NO_CLASS

BUILDING, VEGETATION, VEHICLE = 0, 1, 3


def test_figures_without_labels_are_none() -> None:
    figures = class_figures(None, None)
    assert set(figures.values()) == {None}
    assert {"accuracy", "macro_f1", "confusion", "calibration_error"} <= set(figures)


def test_figures_of_a_model_without_a_head_have_the_classes_that_occur() -> None:
    figures = class_figures(np.array([VEHICLE, NO_CLASS], np.uint8), None)
    assert figures["classes_present"] == ["vehicle"]
    assert figures["labeled"] == 1
    assert figures["accuracy"] is None


def test_figures_of_five_segments() -> None:
    labels = np.array([BUILDING, BUILDING, BUILDING, VEHICLE, NO_CLASS], np.uint8)
    stated = encoded([BUILDING, BUILDING, VEGETATION, VEHICLE, VEHICLE], [1.0, 1.0, 1.0, 0.5, 1.0])
    figures = class_figures(labels, stated)
    assert figures["accuracy"] == 0.75
    # Building: precision 1, recall 2/3. Vehicle: both 1.
    assert figures["per_class"]["building"]["f1"] == pytest.approx(0.8)
    assert figures["macro_f1"] == pytest.approx(0.9)
    # Three segments of probability 1 are right in 2 of 3, one of 0.5 is right.
    assert figures["calibration_error"] == pytest.approx((3 * (1 - 2 / 3) + 0.5) / 4)
    assert figures["confusion"]["building"]["vegetation"] == 1
    assert list(figures["confusion"]) == ["building", "vehicle"]


def test_unknown_segment_counts_as_wrong() -> None:
    figures = class_figures(np.array([VEHICLE], np.uint8), np.zeros(1, np.uint8))
    assert figures["accuracy"] == 0.0
    assert figures["confusion"]["vehicle"]["unknown"] == 1
    assert figures["per_class"]["vehicle"]["precision"] == 0.0
