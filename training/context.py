"""Recognition in context: a segment and what stands around it (beyond the paper).

The segment itself is described by a network trained group-based (III-C). Its surroundings
(`segments.surroundings`) are projected by linear discriminant analysis (Fisher, 1936), which finds
the directions in which groups lie apart while views of one group stay together: a closed form,
learned in seconds, that hardly over-fits. Both stand side by side in the descriptor, the
surroundings with a constant length, so that segments sent alone are still ranked by themselves.

    placecell train context DRIVE@0:299 --seed 0
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.stats import ortho_group

from segments.types import Float32, Int64
from training.group_based import GroupBasedRecipe
from training.training_set import TrainingSet


@dataclass(frozen=True, slots=True)
class ContextRecipe:
    """Settings of the training; the defaults made the model that ships."""

    segment: GroupBasedRecipe = field(default_factory=lambda: GroupBasedRecipe(epochs=30))
    dimension: int = 32
    """Of the surroundings in the descriptor."""
    weight: float = 1.0
    """Length of the surroundings' part; the segment's own is about 1."""
    shrinkage: float = 0.1
    """How far the scatter within groups is drawn towards a sphere."""


@dataclass(frozen=True, slots=True)
class Projection:
    """Surroundings to their part of the descriptor.

    Attributes:
        mean: float32 (size,).
        axes: float32 (size, dimension).
        weight: length of the part.
    """

    mean: Float32
    axes: Float32
    weight: float


def learn_surroundings(training: TrainingSet, recipe: ContextRecipe) -> Projection:
    """The projection, learned from what was recorded where there is any.

    Streets that were made up have other surroundings than real ones, and telling the two apart, at
    which the analysis is good, helps nobody. The segments themselves gain from both.

    Raises:
        ValueError: there are too few groups of two or more.
    """
    assert training.surroundings is not None
    made_up = training.synthetic
    if made_up is None or made_up.all():
        return fit_projection(training.surroundings, training.groups, recipe)
    recorded = training.take(np.flatnonzero(~made_up))
    assert recorded.surroundings is not None
    return fit_projection(recorded.surroundings, recorded.groups, recipe)


def fit_projection(surroundings: Float32, groups: Int64, recipe: ContextRecipe) -> Projection:
    """Linear discriminant analysis of the surroundings, groups as classes.

    Args:
        surroundings: float32 (segments, size).
        groups: int64 (segments,).

    Raises:
        ValueError: there are too few groups of two or more.
    """
    from sklearn.discriminant_analysis import LinearDiscriminantAnalysis

    sizes = np.bincount(groups)
    plural = sizes[groups] >= 2
    if (sizes >= 2).sum() <= recipe.dimension:
        raise ValueError(
            f"{(sizes >= 2).sum()} groups of two or more segments: too few to learn "
            f"{recipe.dimension} dimensions of surroundings from; take a longer drive"
        )
    analysis = LinearDiscriminantAnalysis(solver="eigen", shrinkage=recipe.shrinkage)
    analysis.fit(surroundings[plural].astype(np.float64), groups[plural])
    return Projection(
        surroundings[plural].mean(axis=0, dtype=np.float64).astype(np.float32),
        np.ascontiguousarray(analysis.scalings_[:, : recipe.dimension], dtype=np.float32),
        recipe.weight,
    )


def rotation(dimension: int) -> Float32:
    """A fixed random rotation, (dimension, dimension).

    It keeps all distances, and spreads what the descriptor says evenly over its dimensions, so that
    few bits do for each.
    """
    turn = ortho_group.rvs(dimension, random_state=np.random.default_rng(0))
    return np.asarray(turn, dtype=np.float32)
