"""Secondary classifiers: symmetry, calibration, export, and the choice of the best."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import onnxruntime
import pytest
import torch

from evaluation.calibration import expected_calibration_error
from placecell.descriptors.manifest import PAIR_FILE, Manifest
from placecell.descriptors.pair_classifier import PairClassifier
from placecell.descriptors.quantizer import Quantizer
from training.export import pair_classifier
from training.export.pair_classifier import DescriptorPairs, HeldOut, PlattScaling
from training.methods.siamese import MatchNetwork

DIMENSION = 6


def toy_pairs(count: int, seed: int, *, curved: bool = False) -> DescriptorPairs:
    """Return pairs whose matches are close; if curved, only the first dimension counts."""
    random = np.random.default_rng(seed)
    a = random.normal(size=(count, DIMENSION)).astype(np.float32)
    b = random.normal(size=(count, DIMENSION)).astype(np.float32)
    matches = (np.arange(count) % 2).astype(np.float64)
    is_match = matches > 0.5
    if curved:
        b[is_match, 0] = a[is_match, 0] + 0.05 * b[is_match, 0]
    else:
        b[is_match] = a[is_match] + 0.6 * b[is_match]
    return DescriptorPairs(a, b, matches)


def swapped(pairs: DescriptorPairs) -> DescriptorPairs:
    return replace(pairs, a=pairs.b, b=pairs.a)


def run_pair(file: Path, pairs: DescriptorPairs) -> np.ndarray:
    session = onnxruntime.InferenceSession(file)
    (probability,) = session.run(["probability"], {"a": pairs.a, "b": pairs.b})
    return np.asarray(probability)


def test_served_forest_is_symmetric_unlike_the_papers() -> None:
    training, pairs = toy_pairs(2000, 0), toy_pairs(200, 1)
    forest = pair_classifier.train_forest(training, pair_classifier.symmetric, seed=0)
    there = forest.predict_proba(pair_classifier.symmetric(pairs))
    back = forest.predict_proba(pair_classifier.symmetric(swapped(pairs)))
    assert (there == back).all()
    paper = pair_classifier.train_forest(training, pair_classifier.concatenated, seed=0)
    there = paper.predict_proba(pair_classifier.concatenated(pairs))
    back = paper.predict_proba(pair_classifier.concatenated(swapped(pairs)))
    assert (there != back).any()


def test_forest_in_onnx_equals_sklearn(tmp_path: Path) -> None:
    training, pairs = toy_pairs(2000, 0), toy_pairs(300, 1)
    forest = pair_classifier.train_forest(training, pair_classifier.symmetric, seed=0)
    calibration = PlattScaling(slope=0.7, offset=-0.2)
    graph = pair_classifier.forest_graph(forest, calibration, DIMENSION)
    (tmp_path / "pair.onnx").write_bytes(graph.SerializeToString())
    raw = forest.predict_proba(pair_classifier.symmetric(pairs))[:, 1]
    expected = calibration.apply(pair_classifier.log_odds(raw))
    assert run_pair(tmp_path / "pair.onnx", pairs) == pytest.approx(expected, abs=1e-4)
    swap = run_pair(tmp_path / "pair.onnx", swapped(pairs))
    assert swap == pytest.approx(expected, abs=1e-4)


def test_head_in_onnx_equals_torch_on_projected_descriptors(tmp_path: Path) -> None:
    torch.manual_seed(0)
    match = MatchNetwork()
    random = np.random.default_rng(0)
    axes = np.linalg.qr(random.normal(size=(64, DIMENSION)))[0].astype(np.float32)
    mean = random.normal(size=64).astype(np.float32)
    pairs = toy_pairs(50, 2)
    graph = pair_classifier.HeadGraph(match, mean, axes, PlattScaling(1.3, 0.4))
    pair_classifier.export_pair(graph, DIMENSION, tmp_path / "pair.onnx")
    with torch.no_grad():
        back = [torch.from_numpy(side @ axes.T + mean) for side in (pairs.a, pairs.b)]
        expected = torch.sigmoid(1.3 * match(*back) + 0.4).numpy()
    assert run_pair(tmp_path / "pair.onnx", pairs) == pytest.approx(expected, abs=1e-4)


def test_calibration_recovers_the_true_probability() -> None:
    random = np.random.default_rng(0)
    scores = random.normal(size=40_000)
    true = 1 / (1 + np.exp(-(2.0 * scores - 0.5)))
    matches = (random.random(40_000) < true).astype(np.float64)
    fitted = PlattScaling.fit(scores, matches)
    assert fitted.slope == pytest.approx(2.0, abs=0.1)
    assert fitted.offset == pytest.approx(-0.5, abs=0.1)


def test_calibration_error_by_hand() -> None:
    stated = np.array([0.05, 0.05, 0.95, 0.95])
    matches = np.array([0.0, 1.0, 1.0, 1.0])
    error, points = expected_calibration_error(stated, matches)
    assert [count for _, _, count in points] == [2, 2]
    assert np.array(points)[:, :2] == pytest.approx(np.array([[0.05, 0.5], [0.95, 1.0]]))
    assert error == pytest.approx((0.45 + 0.05) / 2)


@pytest.mark.parametrize(("curved", "kind"), [(False, "distance"), (True, "forest")])
def test_classifier_worse_than_distance_is_not_served(
    curved: bool, kind: str, tmp_path: Path
) -> None:
    learnt, fitted, held_out = (toy_pairs(3000, seed, curved=curved) for seed in range(3))
    chosen = pair_classifier.choose(
        learnt, HeldOut(fitted, fitted), HeldOut(held_out, held_out), None, tmp_path / PAIR_FILE
    )
    assert chosen["kind"] == kind
    assert max(chosen["auc"], key=lambda name: chosen["auc"][name]) == kind
    probability = run_pair(tmp_path / PAIR_FILE, held_out)
    told = (probability > chosen["threshold"]) == (held_out.matches > 0.5)
    assert told.mean() > 0.8
    assert chosen["calibration_error"] < 0.1


def test_served_classifier_accepts_stored_codes(tmp_path: Path) -> None:
    learnt, fitted, held_out = (toy_pairs(2000, seed) for seed in range(3))
    chosen = pair_classifier.choose(
        learnt, HeldOut(fitted, fitted), HeldOut(held_out, held_out), None, tmp_path / PAIR_FILE
    )
    manifest = Manifest("toy", "group", "fast", DIMENSION, Quantizer(0.05), {}, pair=chosen)
    classifier = PairClassifier(tmp_path, manifest)
    pairs = toy_pairs(20, 9)
    a, b = (manifest.quantizer.encode(side) for side in (pairs.a, pairs.b))
    decoded = replace(pairs, a=manifest.quantizer.decode(a), b=manifest.quantizer.decode(b))
    expected = run_pair(tmp_path / PAIR_FILE, decoded)
    assert classifier.probabilities(a, b) == pytest.approx(expected, abs=1e-6)
    assert classifier.probabilities(a[:0], b[:0]).shape == (0,)


def test_probability_is_calibrated_on_nearest_pairs_and_threshold_on_drawn_pairs(
    tmp_path: Path,
) -> None:
    # Half of the random pairs match, and one in ten of the nearest pairs.
    learnt, fitted, held_out = (toy_pairs(3000, seed) for seed in range(3))

    def mostly_strangers(pairs: DescriptorPairs) -> HeldOut:
        kept = (pairs.matches < 0.5) | (np.arange(len(pairs.a)) % 18 == 1)
        return HeldOut(pairs, DescriptorPairs(pairs.a[kept], pairs.b[kept], pairs.matches[kept]))

    asked = mostly_strangers(held_out)
    chosen = pair_classifier.choose(
        learnt, mostly_strangers(fitted), asked, None, tmp_path / PAIR_FILE
    )
    probability = run_pair(tmp_path / PAIR_FILE, asked.nearest)
    assert asked.nearest.matches.mean() == pytest.approx(0.1, abs=0.01)
    assert probability.mean() == pytest.approx(0.1, abs=0.02)
    assert chosen["calibration_error"] < 0.03
    told = run_pair(tmp_path / PAIR_FILE, held_out) > chosen["threshold"]
    assert (told == (held_out.matches > 0.5)).mean() > 0.8


def test_calibration_without_matches_gives_low_probabilities() -> None:
    fitted = PlattScaling.fit(np.linspace(-1, 1, 98), np.zeros(98))
    assert fitted.apply(np.array([-3.0, 3.0])) == pytest.approx([0.01, 0.01])
