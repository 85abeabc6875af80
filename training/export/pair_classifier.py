"""Secondary classifier (paper III-C, IV-B): match probability of two descriptors.

The paper trains a random forest on the two concatenated descriptors, so its result depends on their
order. The report measures this form. Served classifiers are symmetric: a forest on the distance in
each dimension, a logistic curve over the plain distance, or the Siamese network's third network.
Plain distance is the control: a classifier that is not better is not served.

The kinds are compared on equal numbers of random matches and non-matches, as in the paper. The
probability is calibrated on the pairs of real queries: held-out segments and their nearest
neighbors in a large map, nearly all of which look similar.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import onnx
import torch
from onnx import helper
from sklearn.ensemble import RandomForestClassifier
from sklearn.linear_model import LogisticRegression
from torch import Tensor, nn

from evaluation.calibration import expected_calibration_error
from evaluation.recognition.retrieval import area_under_roc, best_threshold
from placecell.core.types import Float32, Float64, Int64
from training.export.onnx_graph import to_onnx

TREES = 60
LEAF = 20
"""Smallest number of pairs in a leaf; smaller leaves over-fit to the training groups."""


@dataclass(frozen=True, slots=True)
class DescriptorPairs:
    """Pairs of stored descriptors.

    Attributes:
        a: first descriptor of each pair, float32 (n, d).
        b: second descriptor of each pair, float32 (n, d).
        matches: 1 for matches and 0 for non-matches, float64 (n,).
    """

    a: Float32
    b: Float32
    matches: Float64

    @classmethod
    def of(cls, descriptors: Float32, positive: Int64, negative: Int64) -> "DescriptorPairs":
        """Build the pairs from drawn pairs of indices."""
        pairs = np.concatenate([positive, negative])
        matches = np.repeat([1.0, 0.0], [len(positive), len(negative)])
        return cls(descriptors[pairs[:, 0]], descriptors[pairs[:, 1]], matches)

    def distances(self) -> Float64:
        """Return the Euclidean distance of each pair, float64 (n,)."""
        return np.asarray(np.linalg.norm(self.a.astype(np.float64) - self.b, axis=1))


@dataclass(frozen=True, slots=True)
class HeldOut:
    """Pairs of held-out segments.

    Attributes:
        drawn: random pairs, with as many matches as non-matches.
        nearest: each segment with its nearest neighbors in a database, as in the service.
    """

    drawn: DescriptorPairs
    nearest: DescriptorPairs


def concatenated(pairs: DescriptorPairs) -> Float32:
    """Return the paper's features: both descriptors concatenated, (n, 2 d)."""
    return np.concatenate([pairs.a, pairs.b], axis=1)


def symmetric(pairs: DescriptorPairs) -> Float32:
    """Return the distance in each dimension and in total, (n, d + 1), which is symmetric."""
    difference = np.abs(pairs.a - pairs.b)
    length = np.sqrt(np.square(difference).sum(axis=1, keepdims=True))
    return np.concatenate([difference, length], axis=1)


def train_forest(
    pairs: DescriptorPairs, features: Callable[[DescriptorPairs], Float32], seed: int
) -> RandomForestClassifier:
    """Train a random forest on features of pairs."""
    forest = RandomForestClassifier(
        n_estimators=TREES, min_samples_leaf=LEAF, max_depth=12, random_state=seed, n_jobs=1
    )
    return forest.fit(features(pairs), pairs.matches)


def log_odds(probability: Float64) -> Float64:
    """Return the log odds of probabilities, which are clipped away from 0 and 1."""
    clipped = np.clip(probability, 1e-4, 1 - 1e-4)
    return np.asarray(np.log(clipped / (1 - clipped)))


@dataclass(frozen=True, slots=True)
class PlattScaling:
    """Platt scaling: probability = 1 / (1 + exp(-(slope x + offset))) of a raw score x."""

    slope: float
    offset: float

    @classmethod
    def fit(cls, scores: Float64, matches: Float64) -> "PlattScaling":
        """Fit by logistic regression, on pairs that the score was not trained on."""
        if len(np.unique(matches)) == 2:
            fitted = LogisticRegression(C=1e6, max_iter=1000).fit(scores[:, None], matches)
            if fitted.coef_[0, 0] > 0:
                return cls(float(fitted.coef_[0, 0]), float(fitted.intercept_[0]))
        # The score carries no information here, so the result is the overall rate of matches.
        rate = (matches.sum() + 1) / (len(matches) + 2)
        return cls(0.0, float(np.log(rate / (1 - rate))))

    def apply(self, scores: Float64) -> Float64:
        """Return match probabilities of raw scores."""
        return np.asarray(1 / (1 + np.exp(-(self.slope * scores + self.offset))))


class DistanceGraph(nn.Module):
    """Graph of the match probability from plain distance: the control and the fallback."""

    def __init__(self, calibration: PlattScaling) -> None:
        super().__init__()
        self.calibration = calibration

    def forward(self, a: Tensor, b: Tensor) -> Tensor:
        """(n, d) each -> (n,)."""
        distance = (a - b).square().sum(dim=1).sqrt()
        return torch.sigmoid(self.calibration.slope * distance + self.calibration.offset)


class HeadGraph(nn.Module):
    """Graph of the Siamese network's third network on stored descriptors, calibrated."""

    mean: Tensor
    axes: Tensor

    def __init__(
        self, match: nn.Module, mean: Float32, axes: Float32, calibration: PlattScaling
    ) -> None:
        super().__init__()
        self.match = match
        self.register_buffer("mean", torch.from_numpy(mean))
        self.register_buffer("axes", torch.from_numpy(axes))
        self.calibration = calibration

    def logits(self, a: Tensor, b: Tensor) -> Tensor:
        """Return the logits before calibration, (n,)."""
        logits: Tensor = self.match(a @ self.axes.T + self.mean, b @ self.axes.T + self.mean)
        return logits

    @torch.no_grad()
    def scores(self, pairs: DescriptorPairs) -> Float64:
        """Return the logits of stored pairs, float64 (n,)."""
        logits = self.eval().logits(torch.from_numpy(pairs.a), torch.from_numpy(pairs.b))
        return logits.numpy().astype(np.float64)

    def forward(self, a: Tensor, b: Tensor) -> Tensor:
        """(n, d) each -> (n,)."""
        return torch.sigmoid(self.calibration.slope * self.logits(a, b) + self.calibration.offset)


def forest_graph(
    forest: RandomForestClassifier, calibration: PlattScaling, dimension: int
) -> onnx.ModelProto:
    """Return the ONNX graph of a symmetric forest, with its features and its calibration."""
    import skl2onnx
    from skl2onnx.common.data_types import FloatTensorType

    converted = skl2onnx.to_onnx(
        forest,
        initial_types=[("features", FloatTensorType([None, dimension + 1]))],
        options={"zipmap": False},
        target_opset={"": 20, "ai.onnx.ml": 3},
    )
    constants: dict[str, np.ndarray[Any, Any]] = {
        "axis": np.array([1], dtype=np.int64),
        "second": np.array(1, dtype=np.int64),
        "low": np.array(1e-4, dtype=np.float32),
        "high": np.array(1 - 1e-4, dtype=np.float32),
        "one": np.array(1, dtype=np.float32),
        "slope": np.array(calibration.slope, dtype=np.float32),
        "offset": np.array(calibration.offset, dtype=np.float32),
    }
    before = [
        helper.make_node("Sub", ["a", "b"], ["apart"]),
        helper.make_node("Abs", ["apart"], ["difference"]),
        helper.make_node("ReduceL2", ["difference", "axis"], ["length"], keepdims=1),
        helper.make_node("Concat", ["difference", "length"], ["features"], axis=1),
    ]
    behind = [
        helper.make_node("Gather", ["probabilities", "second"], ["raw"], axis=1),
        helper.make_node("Clip", ["raw", "low", "high"], ["clipped"]),
        helper.make_node("Sub", ["one", "clipped"], ["rest"]),
        helper.make_node("Div", ["clipped", "rest"], ["odds"]),
        helper.make_node("Log", ["odds"], ["score"]),
        helper.make_node("Mul", ["score", "slope"], ["scaled"]),
        helper.make_node("Add", ["scaled", "offset"], ["shifted"]),
        helper.make_node("Sigmoid", ["shifted"], ["probability"]),
    ]
    of_floats = onnx.TensorProto.FLOAT
    graph = helper.make_graph(
        [*before, *converted.graph.node, *behind],
        "pair",
        [helper.make_tensor_value_info(name, of_floats, ["n", dimension]) for name in "ab"],
        [helper.make_tensor_value_info("probability", of_floats, ["n"])],
        [
            *converted.graph.initializer,
            *(onnx.numpy_helper.from_array(value, name) for name, value in constants.items()),
        ],
    )
    model = helper.make_model(
        graph, opset_imports=converted.opset_import, ir_version=converted.ir_version
    )
    onnx.checker.check_model(model)
    return model


def choose(
    training: DescriptorPairs,
    calibration: HeldOut,
    selection: HeldOut,
    head: tuple[nn.Module, Float32, Float32] | None,
    file: Path,
) -> dict[str, Any]:
    """Train and calibrate all kinds; write the best one.

    Args:
        training: pairs to train the forests on.
        calibration: pairs of validation groups, for Platt scaling.
        selection: pairs of other validation groups, to choose the kind.
        head: Siamese network's third network, with mean and axes of the projection; None for other
            methods.
        file: path of the ONNX graph to write.

    Returns:
        Entry of the manifest: `kind`; `threshold`, the best probability threshold for drawn pairs;
        `auc` of every kind over the drawn selection pairs; `calibration_error` and `reliability`
        (stated, true, pairs) of the chosen kind over the nearest selection pairs.
    """
    forest = train_forest(training, symmetric, seed=0)

    def by_forest(pairs: DescriptorPairs) -> Float64:
        return log_odds(forest.predict_proba(symmetric(pairs))[:, 1])

    scores: dict[str, Callable[[DescriptorPairs], Float64]] = {
        "distance": lambda pairs: -pairs.distances(),
        "forest": by_forest,
    }
    if head is not None:
        third_network = HeadGraph(*head, PlattScaling(1.0, 0.0))
        scores["siamese head"] = third_network.scores
    is_match = selection.drawn.matches > 0.5

    def auc(values: Float64) -> float:
        return area_under_roc(values[is_match], values[~is_match])

    compared = {name: auc(score(selection.drawn)) for name, score in scores.items()}
    kind = max(compared, key=lambda name: compared[name])
    score = scores[kind]
    fitted = PlattScaling.fit(score(calibration.nearest), calibration.nearest.matches)
    dimension = training.a.shape[1]
    if kind == "forest":
        onnx.save(forest_graph(forest, fitted, dimension), file)
    elif kind == "distance":
        # The score is the negative distance, but the graph takes the distance.
        export_pair(DistanceGraph(PlattScaling(-fitted.slope, fitted.offset)), dimension, file)
    else:
        assert head is not None
        export_pair(HeadGraph(*head, fitted), dimension, file)
    probability = fitted.apply(score(selection.nearest))
    error, reliability = expected_calibration_error(probability, selection.nearest.matches)
    drawn = fitted.apply(score(calibration.drawn))
    truth = calibration.drawn.matches > 0.5
    return {
        "kind": kind,
        "threshold": -best_threshold(-drawn[truth], -drawn[~truth]),
        "auc": compared,
        "calibration_error": error,
        "reliability": reliability,
    }


def export_pair(graph: nn.Module, dimension: int, file: Path) -> None:
    """Write a pair classifier as ONNX, with inputs `a` and `b` of any number of rows."""
    example = (torch.zeros((2, dimension)), torch.ones((2, dimension)))
    to_onnx(graph, example, ["a", "b"], ["probability"], file)
