import json
from pathlib import Path

import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from placecell.localization.candidates import Candidates
from placecell.localization.chance import area_of
from placecell.localization.confidence import (
    FEATURES,
    NAME,
    SHIPPED,
    Confidence,
    features_of,
    shipped,
    with_rival,
)
from placecell.localization.hypothesis import Hypothesis
from placecell.localization.overlap import ExplainedShares, SegmentsInMap
from placecell.localization.pose import Pose

MODEL = Confidence((0.0, 1.0), (1.0, 2.0), (1.0, -1.0), 0.5, 0.99, ("score", "inliers"))
"""Model of two of the features."""


def all_features(score: float, inliers: float) -> Float64:
    """Return a row of features; the model does not use the others."""
    row = np.full(len(FEATURES), 7.0)
    row[FEATURES.index("score")], row[FEATURES.index("inliers")] = score, inliers
    return row


def test_the_logistic_model_by_hand() -> None:
    # 2 - (3 - 1) / 2 + 0.5 = 1.5
    assert MODEL.probability(all_features(2, 3)) == pytest.approx(0.99 / (1 + np.exp(-1.5)))


def test_probability_is_at_most_the_highest() -> None:
    assert MODEL.probability(all_features(1e9, 0)) == 0.99
    assert MODEL.probability(all_features(-1e9, 0)) == pytest.approx(0)


def test_many_features_at_once_equal_single_ones() -> None:
    features = np.array([all_features(2, 3), all_features(0, 0)])
    alone = [MODEL.probability(each) for each in features]
    assert MODEL.probabilities(features).tolist() == pytest.approx(alone)


def test_features_by_hand() -> None:
    source = np.array([[-3.0, 0, 5], [3, 0, 5], [0, 2, 5], [0, -2, 5]])
    numbers = np.arange(4)
    residuals = np.array([0.0, 0.0, 0.6, 0.8])
    pose = Pose.of_yaw(0, np.zeros(3))
    best = Hypothesis(pose, np.eye(4), 8.0, numbers, numbers, source, residuals)
    candidates = Candidates(
        source, numbers[:, None], source[:, None] + (100.0, 0, 0), np.full((4, 1), 0.5)
    )
    in_map = SegmentsInMap(candidates.take(numbers[:2]), ExplainedShares(0.9, 1.0))
    shares = ExplainedShares(0.6, 0.8)
    row = features_of(best, 10.0, 0.25, 16, candidates, shares, in_map).tolist()
    # No candidate is near: no p-value, and 72 yaws at 64 m2 (one cell, or two) for 7 thresholds.
    alarms = 72 * area_of(candidates) * 7
    assert dict(zip(FEATURES, row, strict=True)) == pytest.approx(
        {
            "score": np.log(10),
            "margin": 0.75,
            "inliers": np.log(4),
            "share": 0.25,
            "residual": 0.5,
            "spread": np.log1p(np.sqrt(2)),  # 2 meters squared across, 4.5 along
            "surprise": -np.arcsinh(np.log(alarms)),
            "majority": 0.25,
            "explained": 0.8 * 16 / (16 + 8),
            "explained_in_plan": 0.6 * 16 / (16 + 8),
            "surprise_in_map": -np.arcsinh(np.log(72 * area_of(in_map.candidates) * 7)),
            "explained_in_map": 0.9 * 2 / (2 + 8),
        }
    )


def test_another_rival_changes_the_margin_only() -> None:
    features = np.arange(float(len(FEATURES)))
    changed = with_rival(features, 0.25)
    assert changed[FEATURES.index("margin")] == 0.75
    others = [number for number, name in enumerate(FEATURES) if name != "margin"]
    assert changed[others].tolist() == features[others].tolist()
    assert features[FEATURES.index("margin")] == 1.0


def test_majority_grows_up_to_one_half_of_the_segments() -> None:
    points = np.arange(12.0).reshape(4, 3)
    numbers = np.arange(4)
    best = Hypothesis(
        Pose.of_yaw(0, np.zeros(3)), np.eye(4), 8.0, numbers, numbers, points, np.zeros(4)
    )
    candidates = Candidates(points, numbers[:, None], points[:, None], np.full((4, 1), 0.5))
    shares = {}
    for usable in (4, 6, 8, 16):
        in_map = SegmentsInMap(candidates, ExplainedShares())
        row = features_of(best, 8.0, 0.0, usable, candidates, ExplainedShares(), in_map)
        shares[usable] = row[FEATURES.index("majority")]
    assert shares == {4: 0.5, 6: 0.5, 8: 0.5, 16: 0.25}


OLD = """{"features": ["score", "margin", "inliers", "share", "residual", "spread"],
"model": {"means": [3, 0.7, 2.4, 0.6, 0.4, 2], "deviations": [1, 0.3, 0.8, 0.3, 0.2, 0.5],
"weights": [1, 1, 0, 4, -1.5, 1], "bias": 3.5, "highest": 0.999},
"fitted_on": {"model_id": "mine-1"}, "held_out": {"reliability": [], "brier": 0.01}}"""
"""File of the first version, with its six features."""


def test_file_of_the_first_version_is_read(tmp_path: Path) -> None:
    file = tmp_path / NAME
    file.write_text(OLD)
    old = Confidence.load(file, "mine-1")
    assert old.features == FEATURES[:6]
    assert old.acceptance is None
    row = np.array(
        [3, 0.7, 2.4, 0.6, 0.4, 2, 99, 99, 99, 99]
    )  # the means; the new ones do not count
    assert old.probability(row) == pytest.approx(0.999 / (1 + np.exp(-3.5)))


SHIPPED_FILES = sorted(MODELS_FOLDER.glob(f"*/{NAME}"))


@pytest.mark.parametrize("file", SHIPPED_FILES, ids=lambda file: file.parent.name)
def test_shipped_constants_were_fitted_and_validated_on_other_towns(file: Path) -> None:
    content = json.loads(file.read_text())
    assert content["fitted_on"]["cases"] > 1_000
    assert len(content["fitted_on"]["towns"]) > 1
    often = [row for row in content["held_out"]["reliability"] if row["count"] >= 50]
    assert len(often) > 2
    assert all(abs(row["stated"] - row["right"]) < 0.2 for row in often)
    fitted = Confidence.load(file)
    assert 0.9 < fitted.highest < 1
    # More that agrees, and less that competes, is never worth less.
    weights = dict(zip(fitted.features, fitted.weights, strict=True))
    assert all(value <= 0 if name == "residual" else value >= 0 for name, value in weights.items())
    assert max(weights.values()) > 0


def test_the_models_have_constants_that_were_fitted_for_them() -> None:
    default = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
    assert Confidence.load(SHIPPED, default.model_id) == shipped()
    own = [file.parent.name for file in SHIPPED_FILES]
    assert {DEFAULT_MODEL, "group", "siamese", "contrastive", "eigenvalue"} <= set(own)
    for name in own:
        folder = MODELS_FOLDER / name
        assert Confidence.load(folder / NAME, Manifest.load(folder).model_id)


def test_constants_of_other_features_are_refused(tmp_path: Path) -> None:
    content = json.loads(SHIPPED.read_text()) | {"features": ["luck"]}
    file = tmp_path / "confidence.json"
    file.write_text(json.dumps(content))
    with pytest.raises(ValueError, match="luck"):
        Confidence.load(file)


def test_constants_of_another_model_are_refused() -> None:
    model_id = json.loads(SHIPPED.read_text())["fitted_on"]["model_id"]
    assert Confidence.load(SHIPPED, model_id) == Confidence.load()
    with pytest.raises(ValueError, match=f"for model {model_id}, not other"):
        Confidence.load(SHIPPED, "other")
