"""Context model: describes a segment together with its neighborhood (beyond the paper).

A network trained by the multi-similarity loss (Wang et al., 2019), the best loss of those compared,
describes the segment itself. Linear discriminant analysis projects the neighborhood
(`placecell.descriptors.neighborhood`): it finds the directions that separate groups and keep the
views of a group together. It has a closed form, takes seconds and hardly over-fits. The descriptor
holds both parts side by side. The neighborhood's part has a constant length, so that segments
without a neighborhood are still ranked by their own part.

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
    """Recipe of the context training; the defaults are those of the shipped model."""

    segment: GroupBasedRecipe | MetricRecipe = field(
        default_factory=lambda: MetricRecipe("multi-similarity")
    )
    dimension: int = 96
    """Number of dimensions of the neighborhood's part of the descriptor."""
    weight: float = 1.2
    """Length of the neighborhood's part; the segment's own part has about length 1."""
    shrinkage: float = 0.2
    """Shrinkage of the scatter within groups toward a multiple of the identity, 0 to 1."""


@dataclass(frozen=True, slots=True)
class Projection:
    """Projection of the neighborhood to its part of the descriptor.

    Attributes:
        mean: mean neighborhood, float32 (size,).
        axes: axes of the projection, float32 (size, dimension).
        weight: length of the neighborhood's part.
    """

    mean: Float32
    axes: Float32
    weight: float


def learn_neighborhood(training: TrainingSet, recipe: ContextRecipe) -> Projection:
    """Fit linear discriminant analysis of the neighborhoods, with groups as classes (Fisher, 1936).

    All groups have equal weight, because a robot that stands still adds many views but no
    information.

    Raises:
        ValueError: there are too few groups of two or more segments.
    """
    assert training.neighborhood is not None
    sizes = training.group_sizes()
    plural = sizes[training.groups] >= 2
    count = int((sizes >= 2).sum())
    if count <= recipe.dimension:
        raise ValueError(
            f"{count} groups of two or more segments are too few to learn {recipe.dimension} "
            "dimensions of the neighborhood. Use a longer drive."
        )
    neighborhood = training.neighborhood[plural].astype(np.float64)
    groups = np.unique(training.groups[plural], return_inverse=True)[1]
    within, centers = scatter(neighborhood, groups)
    between = np.cov(centers.T, bias=True)
    sphere = np.eye(len(within)) * np.trace(within) / len(within)
    drawn = (1 - recipe.shrinkage) * within + recipe.shrinkage * sphere
    # Eigenvalues ascend. Axes have length one in the scatter within groups, which weights them.
    axes = eigh(between + within, drawn)[1][:, ::-1]
    return Projection(
        neighborhood.mean(axis=0).astype(np.float32),
        np.ascontiguousarray(axes[:, : recipe.dimension], dtype=np.float32),
        recipe.weight,
    )


def scatter(values: Float64, groups: Int64) -> tuple[Float64, Float64]:
    """Return the mean covariance of the groups, (size, size), and their means, (groups, size).

    Args:
        values: value of each segment, float64 (segments, size).
        groups: group of each segment, from 0, int64 (segments,). A group has two segments or more.
    """
    sizes = np.bincount(groups)
    centers = np.zeros((len(sizes), values.shape[1]))
    np.add.at(centers, groups, values)
    centers /= sizes[:, None]
    off = values - centers[groups]
    weights = 1 / (sizes - 1)[groups]
    return (off * weights[:, None]).T @ off / len(sizes), centers


def rotation(dimension: int) -> Float32:
    """Return a fixed random rotation, (dimension, dimension).

    The rotation keeps all distances. It spreads the variance evenly over the dimensions, so that
    few bits per dimension suffice.
    """
    turn = ortho_group.rvs(dimension, random_state=np.random.default_rng(0))
    return np.asarray(turn, dtype=np.float32)
