"""Metric learning: every loss improves recognition, and batches hold matches."""

from pathlib import Path

import numpy as np
import pytest

from training.data.training_set import TrainingSet
from training.methods import metric
from training.methods.fit import Sgd
from training.methods.metric import LOSSES, MetricRecipe, draw_batch
from training.methods.run import Run


def test_batch_has_equal_numbers_per_group() -> None:
    groups = np.repeat(np.arange(40), [2, 9] * 20)
    random = np.random.default_rng(0)
    chosen = draw_batch(random.permutation(groups), random)
    assert len(chosen) == metric.GROUPS * metric.VIEWS
    drawn = draw_batch(groups, random)
    sizes = np.bincount(groups[drawn], minlength=40)
    assert set(sizes.tolist()) == {0, metric.VIEWS}
    # No segment of a large group occurs twice.
    large = drawn[groups[drawn] % 2 == 1]
    assert len(np.unique(large)) == len(large)


@pytest.mark.parametrize(
    ("recorded", "share", "wanted"), [(100, 0.5, 16), (100, 0.25, 8), (5, 0.5, 5), (195, 0.5, 27)]
)
def test_batch_mixes_recorded_and_synthetic_groups(
    recorded: int, share: float, wanted: int
) -> None:
    groups = np.repeat(np.arange(200), 5)
    drawn = draw_batch(groups, np.random.default_rng(0), groups >= recorded, share)
    assert len(np.unique(groups[drawn])) == metric.GROUPS
    assert len(np.unique(groups[drawn][groups[drawn] < recorded])) == wanted


@pytest.mark.parametrize("loss", LOSSES)
def test_every_loss_improves_recognition(loss: str, shapes: TrainingSet, tmp_path: Path) -> None:
    run = Run(tmp_path, 0)
    many = shapes.take(np.tile(np.arange(len(shapes)), 8))
    recipe = MetricRecipe(loss, epochs=4, sgd=Sgd(learning_rate=0.05))
    metric.train(many, shapes, run, "fast", recipe)
    assert run.history[-1]["loss"] < run.history[0]["loss"]
    assert run.history[-1]["validation_top1"] > 0.5
