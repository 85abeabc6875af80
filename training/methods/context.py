"""Context model: describes a segment together with its neighborhood (beyond the paper).

A network trained by the multi-similarity loss (Wang et al., 2019), the best loss of those compared,
describes the segment itself. Linear discriminant analysis projects the neighborhood
(`placecell.descriptors.neighborhood`): it finds the directions that separate groups and keep the
views of a group together. Views from far apart weigh more. Synthetic drives teach it what other
sensors see in other places. Drives of one town in opposite directions, by several sensors, share
groups, which weigh more. The analysis has a closed form, takes seconds and hardly over-fits. The
descriptor holds both parts side by side. The neighborhood's part has about the same length for all
segments, so that segments without a neighborhood are still ranked by their own part.

    placecell train context DRIVE@0:299 --seed 0
"""

from dataclasses import dataclass, field

import numpy as np
from scipy.linalg import eigh
from scipy.spatial.distance import cdist
from scipy.stats import ortho_group

from placecell.core.parameters import NEIGHBORHOOD_V1
from placecell.core.types import Bool, Float32, Float64, Int64
from placecell.descriptors.quantizer import Quantizer
from training.data.training_set import TrainingSet
from training.methods.group_based import GroupBasedRecipe
from training.methods.metric import MetricRecipe

NEAR, FAR = 0.4, 12.0
"""Weight of two views from one position, and largest distance that adds to the weight, meters."""


@dataclass(frozen=True, slots=True)
class ContextRecipe:
    """Recipe of the context training; the defaults are those of the shipped model."""

    segment: GroupBasedRecipe | MetricRecipe = field(
        default_factory=lambda: MetricRecipe("multi-similarity")
    )
    dimension: int = 96
    """Number of dimensions of the neighborhood's part of the descriptor."""
    weight: float = 1.4
    """Length of the neighborhood's part; the segment's own part has about length 1."""
    shrinkage: float = 0.1
    """Shrinkage of the scatter within groups toward a multiple of the identity, 0 to 1."""
    recorded: float = 0.5
    """Weight of all groups of recorded drives together, if there are synthetic ones, 0 to 1."""
    linked: float = 4.0
    """Weight of a group that several drives see, in the weight of one that a single drive sees."""
    heights: float = 2.0
    """Scatter of shifted heights, in parts of the scatter within groups (`height_scatter`).

    It is added if all drives are synthetic; recorded drives show how heights differ themselves.
    """


@dataclass(frozen=True, slots=True)
class Projection:
    """Projection of the neighborhood to its part of the descriptor.

    Attributes:
        mean: mean neighborhood, float32 (size,).
        axes: axes of the projection, float32 (size, dimension).
        weight: length of the neighborhood's part.
        center: mean of the projections of length one, float32 (dimension,). It is subtracted, so
            that the quantizer's levels are around 0.
    """

    mean: Float32
    axes: Float32
    weight: float
    center: Float32

    def part(self, neighborhood: Float32) -> Float32:
        """Return the neighborhood's part of the descriptor, float32 (segments, dimension)."""
        projected = (neighborhood - self.mean) @ self.axes
        projected /= np.linalg.norm(projected, axis=1, keepdims=True)
        return np.asarray((projected - self.center) * np.float32(self.weight))


def learn_neighborhood(training: TrainingSet, recipe: ContextRecipe) -> Projection:
    """Fit linear discriminant analysis of the neighborhoods, with groups as classes (Fisher, 1936).

    All groups of recorded drives have equal weight, because a robot that stands still adds many
    views but no information, and so have all groups of synthetic drives.

    Raises:
        ValueError: there are too few groups of two or more segments.
    """
    assert training.neighborhood is not None
    sizes = training.group_sizes()
    plural = np.flatnonzero(sizes[training.groups] >= 2)
    count = int((sizes >= 2).sum())
    if count <= recipe.dimension:
        raise ValueError(
            f"{count} groups of two or more segments are too few to learn {recipe.dimension} "
            "dimensions of the neighborhood. Use a longer drive."
        )
    values = training.neighborhood[plural].astype(np.float64)
    _, firsts, groups = np.unique(training.groups[plural], return_index=True, return_inverse=True)
    weights = np.ones(count)
    if training.synthetic is not None:
        weights = group_weights(training.synthetic[plural][firsts], recipe.recorded)
    if training.drives is not None:
        weights[seen_by_several(groups, training.drives[plural])] *= recipe.linked
    within, centers = scatter(values, groups, training.segments.sensors[plural], weights)
    between = np.cov(centers.T, bias=True, aweights=weights)
    if recipe.heights and training.synthetic is not None and training.synthetic.all():
        shifts = height_scatter(centers, weights)
        within += recipe.heights * np.trace(within) / np.trace(shifts) * shifts
    sphere = np.eye(len(within)) * np.trace(within) / len(within)
    drawn = (1 - recipe.shrinkage) * within + recipe.shrinkage * sphere
    # Eigenvalues ascend. Axes have length one in the scatter within groups, which weights them.
    axes = eigh(between + within, drawn)[1][:, : -recipe.dimension - 1 : -1]
    mean = np.average(centers, axis=0, weights=weights)
    recorded = training.recorded().neighborhood
    assert recorded is not None
    projected = (recorded - mean) @ axes
    projected /= np.linalg.norm(projected, axis=1, keepdims=True)
    return Projection(
        mean.astype(np.float32),
        np.ascontiguousarray(axes, dtype=np.float32),
        recipe.weight,
        projected.mean(axis=0).astype(np.float32),
    )


def group_weights(synthetic: Bool, recorded: float) -> Float64:
    """Return the weight of each group, float64 (groups,); their mean is 1.

    Args:
        synthetic: bool (groups,), whether a group is of a synthetic drive.
        recorded: weight of all groups of recorded drives together, 0 to 1.
    """
    made_up = int(synthetic.sum())
    real = len(synthetic) - made_up
    if not made_up or not real:
        return np.ones(len(synthetic))
    return len(synthetic) * np.where(synthetic, (1 - recorded) / made_up, recorded / real)


def seen_by_several(groups: Int64, drives: Int64) -> Bool:
    """Return whether several drives see each group, bool (groups,).

    Args:
        groups: group of each segment, from 0, int64 (segments,).
        drives: drive of each segment, int64 (segments,).
    """
    first, last = np.full(groups.max() + 1, drives.max()), np.zeros(groups.max() + 1, np.int64)
    np.minimum.at(first, groups, drives)
    np.maximum.at(last, groups, drives)
    return np.asarray(last > first)


def scatter(
    values: Float64, groups: Int64, sensors: Float32, group_weight: Float64
) -> tuple[Float64, Float64]:
    """Return the scatter within groups, (size, size), and the means of the groups, (groups, size).

    The scatter is the mean over all pairs of views of a group, half the squared difference each.
    Pairs from viewpoints far apart weigh more: they tell what changes with the viewpoint.

    Args:
        values: value of each segment, float64 (segments, size).
        groups: group of each segment, from 0, int64 (segments,). A group has two segments or more.
        sensors: sensor position of each segment, float32 (segments, 3), meters.
        group_weight: weight of each group, float64 (groups,).
    """
    order = np.argsort(groups, kind="stable")
    members = np.split(order, np.flatnonzero(np.diff(groups[order])) + 1)
    within, total = np.zeros((values.shape[1], values.shape[1])), 0.0
    centers = np.array([values[together].mean(axis=0) for together in members])
    for together, center, weight in zip(members, centers, group_weight, strict=True):
        off, seen_from = values[together] - center, sensors[together, :2].astype(np.float64)
        weights = NEAR + np.minimum(cdist(seen_from, seen_from), FAR)
        np.fill_diagonal(weights, 0.0)
        weights *= weight / (len(together) * (len(together) - 1))
        # The Laplacian matrix of the weights sums the squared differences over all pairs.
        within += off.T @ (np.diag(weights.sum(axis=1)) - weights) @ off
        total += weights.sum()
    return within / total, centers


def height_scatter(centers: Float64, weights: Float64) -> Float64:
    """Return the scatter that a small shift of all heights adds to neighborhoods, (size, size).

    A view that sees only the upper part of a segment has a higher centroid, so its neighbors are
    counted in lower layers. Synthetic towns have less of this than real streets. The scatter is
    that of the derivative by the layer, as in tangent distance (Simard et al., 1993).

    Args:
        centers: mean neighborhood of each group, float64 (groups, size of `NEIGHBORHOOD_V1`).
        weights: weight of each group, float64 (groups,).
    """
    layers = np.pad(centers.reshape(-1, *NEIGHBORHOOD_V1.shape), ((0, 0), (0, 0), (1, 1)))
    slopes = ((layers[:, :, 2:] - layers[:, :, :-2]) / 2).reshape(len(centers), -1)
    return np.asarray((slopes * weights[:, None]).T @ slopes / weights.sum())


def learn_rotation(descriptors: Float32, per_byte: int, steps: int = 20) -> Float32:
    """Learn the rotation that loses least by quantization, (dimension, dimension).

    Iterative quantization (Gong and Lazebnik, 2011), with the quantizer's levels in place of signs:
    round the rotated descriptors, then rotate the descriptors as near to them as possible.

    Args:
        descriptors: descriptors of training segments, float32 (segments, dimension).
        per_byte: number of dimensions that share a byte (see `Quantizer`).
        steps: number of repetitions.
    """
    turn = rotation(descriptors.shape[1])
    for _ in range(steps):
        turned = descriptors @ turn
        quantizer = Quantizer.fit(turned, per_byte)
        left, _, right = np.linalg.svd(descriptors.T @ quantizer.decode(quantizer.encode(turned)))
        turn = np.asarray(left @ right, dtype=np.float32)
    return turn


def rotation(dimension: int) -> Float32:
    """Return a fixed random rotation, (dimension, dimension).

    The rotation keeps all distances. It spreads the variance evenly over the dimensions, so that
    few bits per dimension suffice.
    """
    turn = ortho_group.rvs(dimension, random_state=np.random.default_rng(0))
    return np.asarray(turn, dtype=np.float32)
