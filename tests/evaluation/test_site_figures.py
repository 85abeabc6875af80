"""Figures of recognition with site calibration, which uses no labels."""

from typing import Any, cast

import numpy as np
import pytest

from evaluation.recognition.evaluate import measure
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.core.types import Float32, Int8
from placecell.descriptors.extractor import Extractor
from placecell.descriptors.manifest import Manifest, preprocessing_of
from placecell.descriptors.pair_classifier import PairClassifier
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.site_calibration import SiteConstants

OBJECTS, VIEWS = 70, 4
QUANTIZER = Quantizer(0.05)
SITE = SiteConstants(slope=2.0, offset=-3.0, mean=4.0, deviation=0.4)
THRESHOLD = 3.0
"""Distance at which the classifier states 0.5, which suits a scale of 1."""


class _Extractor:
    def __init__(self, descriptors: Float32, pair: dict[str, Any]) -> None:
        self._descriptors = descriptors
        self.manifest = Manifest(
            name="fake",
            method="group",
            network="",
            dimension=descriptors.shape[1],
            quantizer=QUANTIZER,
            preprocessing=preprocessing_of(PROTOCOL_V1),
            pair_threshold=THRESHOLD,
            pair={"kind": "distance", "threshold": 0.5} | pair,
        )

    def describe(self, segments: Segments, neighborhood: Float32 | None = None) -> Float32:
        return self._descriptors[: len(segments)]


class _Classifier:
    def probabilities(self, a: Int8, b: Int8) -> np.ndarray:
        apart = np.linalg.norm(QUANTIZER.decode(a) - QUANTIZER.decode(b), axis=1)
        return np.asarray(1 / (1 + np.exp(5 * (apart - THRESHOLD))))


def figures(
    scale: float, pair: dict[str, Any], permuted: bool = False, with_captures: bool = True
) -> dict[str, Any]:
    random = np.random.default_rng(0)
    objects = np.tile(np.arange(OBJECTS), VIEWS)
    looks = random.normal(size=(OBJECTS, 16))[objects]
    descriptors = (looks + 0.3 * random.normal(size=looks.shape)) * scale
    segments = Segments.of(
        [np.array([[4.0 * each, 0.0, 0.0]], dtype=np.float32) for each in objects],
        np.repeat(np.arange(VIEWS), OBJECTS)[:, None] * [1.0, 0.0, 0.0],
    )
    groups = random.permutation(objects) if permuted else objects
    captures = np.repeat(np.arange(VIEWS), OBJECTS)
    return measure(
        cast("Extractor", _Extractor(descriptors.astype(np.float32), pair)),
        cast("PairClassifier", _Classifier()),
        segments,
        groups,
        seed=0,
        captures=captures if with_captures else None,
    )


def test_site_calibration_restores_the_accuracy_at_another_scale() -> None:
    told = figures(scale=0.5, pair={"site": SITE.as_dict()})
    assert told["site_calibration"]["state"] == "calibrated"
    assert told["pair_accuracy_uncalibrated"] < 0.9
    assert told["pair_accuracy"] > 0.99
    assert told["pair_calibration_error"] < 0.05
    assert told["expected_calibration_error"] < 0.05
    assert told["expected_calibration_error"] < told["expected_calibration_error_uncalibrated"]
    assert told["candidate_calibration_error"] == told["expected_calibration_error"]
    assert told["pair_by"] == "classifier"


def test_permuted_labels_give_the_same_calibration() -> None:
    one, other = (figures(0.5, {"site": SITE.as_dict()}, permuted) for permuted in (False, True))
    assert one["site_calibration"] == other["site_calibration"]
    assert one["pair_accuracy"] > other["pair_accuracy"]


@pytest.mark.parametrize(("pair", "with_captures"), [({}, True), ({"site": SITE.as_dict()}, False)])
def test_model_without_constants_or_captures_is_measured_as_before(
    pair: dict[str, Any], with_captures: bool
) -> None:
    told = figures(scale=0.5, pair=pair, with_captures=with_captures)
    before = figures(scale=0.5, pair={"site": SITE.as_dict()})
    assert "site_calibration" not in told
    assert told["pair_accuracy"] == before["pair_accuracy_uncalibrated"]
    assert told["pair_auc"] == before["pair_auc_uncalibrated"]
    assert told["brier"] == before["brier_uncalibrated"]


def test_reranked_figures_are_none_without_captures() -> None:
    told = figures(scale=0.5, pair={})
    assert told["reranked_top1"] >= told["top1"] > 0.9
    assert told["reranked_top1_with_mate"] == told["reranked_top1"]
    assert told["reranked_cross_view_top1"] is None  # all views are from nearby
    without = figures(scale=0.5, pair={}, with_captures=False)
    assert without["reranked_top1"] is without["reranked_cross_view_top1"] is None
    assert without["top1"] == told["top1"]
