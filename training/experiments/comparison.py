"""Comparison of the experiments' models: recognition and throughput (paper IV-B)."""

import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import onnxruntime

from evaluation.recognition import retrieval
from evaluation.recognition.evaluate import measure
from placecell.core.parameters import NEIGHBORHOOD_V1, Parameters
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int64
from placecell.descriptors.extractor import Extractor, load_extractor
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.orientation import orient
from placecell.descriptors.pair_classifier import load_pair_classifier
from training.data.training_set import TrainingSet
from training.export.pair_classifier import DescriptorPairs, concatenated, train_forest
from training.export.publishing import stored_descriptors


def compare(
    folder: Path, test: TrainingSet, training: TrainingSet, *, paper_forest: bool
) -> dict[str, Any]:
    """Measure a model on the test set: figures, ROC curve and distributions of distances.

    Args:
        folder: folder of the model.
        test: test set.
        training: training set, for the paper's forest.
        paper_forest: True to train and measure the paper's forest on concatenated descriptors.
    """
    manifest = Manifest.load(folder)
    extractor = load_extractor(folder)
    classifier = load_pair_classifier(folder, manifest)
    figures = measure(extractor, classifier, test.segments, test.groups, 0, test.neighborhood)
    stored = stored_descriptors(extractor, test)
    codes = manifest.quantizer.encode(stored)
    drawn = retrieval.draw_pairs(test.groups, retrieval.PAIRS, np.random.default_rng(0))
    near, far = (retrieval.pair_distances(stored, pairs) for pairs in drawn)
    likely, unlikely = -near, -far
    if classifier is not None:
        likely, unlikely = (
            classifier.probabilities(codes[pairs[:, 0]], codes[pairs[:, 1]]) for pairs in drawn
        )
    compared = {}
    if paper_forest:
        forest_near, forest_far = by_paper_forest(extractor, training, stored, drawn)
        compared = {
            "auc": retrieval.area_under_roc(forest_near, forest_far),
            "roc": roc_curve(forest_near, forest_far),
        }
    edges = np.linspace(0, max(near.max(), far.max()), 61)
    return {
        "figures": figures,
        "pair": manifest.pair,
        "seconds": manifest.training["seconds"],
        "cpu_seconds": manifest.training.get("cpu_seconds", 0.0),
        "roc": roc_curve(likely, unlikely),
        "paper_forest": compared,
        "distances": {
            "edges": edges.tolist(),
            "positive": np.histogram(near, edges, density=True)[0].tolist(),
            "negative": np.histogram(far, edges, density=True)[0].tolist(),
        },
    }


def by_paper_forest(
    extractor: Extractor, training: TrainingSet, stored: Float32, drawn: tuple[Int64, Int64]
) -> tuple[Float64, Float64]:
    """Train the paper's forest on the training set; return its scores of drawn test pairs."""
    learned = retrieval.draw_pairs(training.groups, retrieval.PAIRS, np.random.default_rng(0))
    pairs = DescriptorPairs.of(stored_descriptors(extractor, training), *learned)
    forest = train_forest(pairs, concatenated, seed=0)
    both = DescriptorPairs.of(stored, *drawn)
    probability = forest.predict_proba(concatenated(both))[:, 1]
    return probability[both.matches > 0.5], probability[both.matches < 0.5]


def roc_curve(positive: Float64, negative: Float64, points: int = 101) -> list[list[float]]:
    """Return false and true positive rates at evenly spaced false positive rates."""
    rates = np.linspace(0, 1, points)
    thresholds = np.quantile(negative, 1 - rates)
    return [
        [float(rate), float((positive >= threshold).mean())]
        for rate, threshold in zip(rates, thresholds, strict=True)
    ]


def fits_grid(data: TrainingSet) -> float:
    """Return the share of segments that fit into the voxel grid (in the paper about 95%)."""
    aligned = Segments(orient(data.segments), data.segments.ends, data.segments.sensors)
    lowest, highest = aligned.bounds()
    limit = np.array(data.parameters.grid) * data.parameters.grid_voxel
    return float((highest - lowest <= limit).all(axis=1).mean())


def throughput(files: Mapping[str, Path], parameters: Parameters) -> dict[str, float]:
    """Return the segments per second of each ONNX file, in batches of 64 on all cores."""
    random = np.random.default_rng(0)
    inputs = {
        "occupancy": (random.random((64, *parameters.grid)) < 0.01).astype(np.uint8),
        "extents": random.uniform(0.5, 5, (64, 3)).astype(np.float32),
        "surroundings": random.random((64, NEIGHBORHOOD_V1.size)).astype(np.float32),
    }
    rates = {}
    for network, file in files.items():
        session = onnxruntime.InferenceSession(file, providers=["CPUExecutionProvider"])
        given = {one.name: inputs[one.name] for one in session.get_inputs()}
        session.run(None, given)
        seconds = []
        for _ in range(50):
            started = time.perf_counter()
            session.run(None, given)
            seconds.append(time.perf_counter() - started)
        rates[network] = 64 / float(np.median(seconds))
    return rates
