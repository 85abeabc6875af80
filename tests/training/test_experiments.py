"""Experiments: the plan of trainings and the curves of the report."""

import numpy as np
import pytest

from training.experiments.comparison import roc_curve
from training.experiments.plan import ExperimentPlan


def test_roc_curve_by_hand() -> None:
    positive = np.array([0.9, 0.8, 0.3])
    negative = np.linspace(0, 0.5, 101)
    curve = np.array(roc_curve(positive, negative, points=3))
    assert curve[:, 0] == pytest.approx([0.0, 0.5, 1.0])
    assert curve[:, 1] == pytest.approx([2 / 3, 1.0, 1.0])


def test_plan_has_every_method_and_network_and_each_ablation_once() -> None:
    trainings = list(ExperimentPlan(seeds=3).trainings())
    names = [training.name for training in trainings]
    assert len(set(names)) == len(names)
    compared = [(t.method, t.network) for t in trainings if not t.ablation]
    for method in ("group", "siamese", "contrastive"):
        assert compared.count((method, "fast")) == 3
        assert compared.count((method, "paper")) == compared.count((method, "paper-reduced")) == 1
    # Two dropout rates besides that of the recipe, and random pairs.
    assert sum(bool(training.ablation) for training in trainings) == 3
