"""Recognition in context: a segment and what stands around it (beyond the paper).

The segment itself is described by a network trained by the multi-similarity loss (Wang et al.,
2019), which did best of those compared. Its neighborhood (`placecell.descriptors.neighborhood`)
is projected by linear discriminant analysis, which finds the directions in which groups lie
apart while views of one group stay together: a closed form, learned in seconds, that hardly
over-fits. Both stand side by side in the descriptor, the neighborhood with a constant length, so
that segments sent alone are still ranked by themselves.

    placecell train context DRIVE@0:299 --seed 0
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import eigh
from scipy.stats import ortho_group

from placecell.core.types import Float32, Float64, Int64
from training.data.training_set import TrainingSet
from training.methods.group_based import GroupBasedRecipe
from training.methods.metric import MetricRecipe


@dataclass(frozen=True, slots=True)
class ContextRecipe:
    """Settings of the training; the defaults made the model that ships."""

    segment: GroupBasedRecipe | MetricRecipe = field(
        default_factory=lambda: MetricRecipe("multi-similarity")
    )
    dimension: int = 96
    """Of the surroundings in the descriptor."""
    weight: float = 1.2
    """Length of the surroundings' part; the segment's own is about 1."""
    shrinkage: float = 0.2
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


def learn_neighborhood(training: TrainingSet, recipe: ContextRecipe) -> Projection:
    """Linear discriminant analysis of the surroundings, groups as classes (Fisher, 1936).

    Every group counts once, however often it was seen: a robot that stands still sees a thousand
    views of little, and the few that are seen from far apart are what there is to be learned.

    Raises:
        ValueError: there are too few groups of two or more.
    """
    assert training.neighborhood is not None
    sizes = training.group_sizes()
    plural = sizes[training.groups] >= 2
    count = int((sizes >= 2).sum())
    if count <= recipe.dimension:
        raise ValueError(
            f"{count} groups of two or more segments: too few to learn "
            f"{recipe.dimension} dimensions of surroundings from; take a longer drive"
        )
    neighborhood = training.neighborhood[plural].astype(np.float64)
    groups = np.unique(training.groups[plural], return_inverse=True)[1]
    within, centers = scatter(neighborhood, groups)
    between = np.cov(centers.T, bias=True)
    sphere = np.eye(len(within)) * np.trace(within) / len(within)
    drawn = (1 - recipe.shrinkage) * within + recipe.shrinkage * sphere
    # Ascending; of length one in the scatter within groups, so that each weighs what it tells.
    axes = eigh(between + within, drawn)[1][:, ::-1]
    return Projection(
        neighborhood.mean(axis=0).astype(np.float32),
        np.ascontiguousarray(axes[:, : recipe.dimension], dtype=np.float32),
        recipe.weight,
    )


def scatter(values: Float64, groups: Int64) -> tuple[Float64, Float64]:
    """The mean covariance of the groups, (size, size), and their means, (groups, size).

    Args:
        values: float64 (segments, size).
        groups: int64 (segments,), from 0, each of two segments or more.
    """
    sizes = np.bincount(groups)
    centers = np.zeros((len(sizes), values.shape[1]))
    np.add.at(centers, groups, values)
    centers /= sizes[:, None]
    off = values - centers[groups]
    weights = 1 / (sizes - 1)[groups]
    return (off * weights[:, None]).T @ off / len(sizes), centers


def rotation(dimension: int) -> Float32:
    """A fixed random rotation, (dimension, dimension).

    It keeps all distances, and spreads what the descriptor says evenly over its dimensions, so that
    few bits do for each.
    """
    turn = ortho_group.rvs(dimension, random_state=np.random.default_rng(0))
    return np.asarray(turn, dtype=np.float32)
