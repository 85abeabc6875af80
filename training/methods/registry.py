"""Registry of the training methods by name."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from training.data.training_set import TrainingSet
from training.methods import context, contrastive, group_based, metric, siamese
from training.methods.context import Projection
from training.methods.group_based import GroupBasedRecipe
from training.methods.metric import MetricRecipe
from training.methods.networks import DescriptorNetwork
from training.methods.run import Run
from training.methods.siamese import MatchNetwork

METHODS = ("group", "siamese", "contrastive")
"""Methods of the paper."""


@dataclass(frozen=True, slots=True)
class Trained:
    """Result of a training.

    Attributes:
        method: name of the method.
        network_name: name of the trunk.
        network: descriptor network.
        match: third network of the Siamese method; None for other methods.
        projection: projection of the neighborhood of `context`; None for other methods.
    """

    method: str
    network_name: str
    network: DescriptorNetwork
    match: MatchNetwork | None = None
    projection: Projection | None = None


def train(
    method: str,
    training: TrainingSet,
    validation: TrainingSet,
    run: Run,
    network: str = "fast",
    **changes: Any,
) -> Trained:
    """Train by one of `METHODS` or by `context`.

    Args:
        method: name of the method.
        training: training set.
        validation: validation set.
        run: seed, checkpoints and history of the training.
        network: name of the trunk.
        **changes: changed settings of the method's recipe, such as `epochs`; None keeps a setting.

    Raises:
        ValueError: there is no such method.
    """
    given = {name: value for name, value in changes.items() if value is not None}
    if method == "group":
        group_recipe = replace(group_based.GroupBasedRecipe(), **given)
        learned = group_based.train(training, validation, run, network, group_recipe)
        return Trained(method, network, learned)
    if method == "contrastive":
        contrastive_recipe = replace(contrastive.ContrastiveRecipe(), **given)
        learned = contrastive.train(training, validation, run, network, contrastive_recipe)
        return Trained(method, network, learned)
    if method == "siamese":
        siamese_recipe = replace(siamese.SiameseRecipe(), **given)
        pair = siamese.train(training, validation, run, network, siamese_recipe)
        return Trained(method, network, pair.extractor, pair.match)
    if method == "context":
        recipe = given.pop("recipe", context.ContextRecipe())
        projection = context.learn_neighborhood(training, recipe)
        segment_recipe = replace(recipe.segment, **given)
        learned = train_segment(training, validation, run, network, segment_recipe)
        return Trained(method, network, learned, projection=projection)
    raise ValueError(f"Unknown method {method!r}: expected {', '.join(METHODS)} or context.")


def train_segment(
    training: TrainingSet,
    validation: TrainingSet,
    run: Run,
    network: str,
    recipe: GroupBasedRecipe | MetricRecipe,
) -> DescriptorNetwork:
    """Train the descriptor network of the context model, by either kind of loss."""
    if isinstance(recipe, MetricRecipe):
        return metric.train(training, validation, run, network, recipe)
    return group_based.train(training, validation, run, network, recipe)


def run_folder(runs: Path, method: str, network: str, seed: int) -> Path:
    """Return the folder of a training's checkpoint and history."""
    return runs / f"{method}-{network}-{seed}"
