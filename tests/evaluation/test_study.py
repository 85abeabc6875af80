"""Curves of the recognition study equal those computed by hand."""

import numpy as np
import pytest

from evaluation.recognition import study
from placecell.descriptors.eigenvalue import FEATURES
from placecell.descriptors.extractor import EigenvalueExtractor
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.quantizer import Quantizer
from training.data.training_set import TrainingSet


@pytest.fixture(scope="module")
def extractor() -> EigenvalueExtractor:
    standard = {"mean": [0.0] * len(FEATURES), "deviation": [1.0] * len(FEATURES)}
    return EigenvalueExtractor(
        Manifest("toy", "eigenvalue", "", 7, Quantizer(0.01), {}, standardization=standard)
    )


def test_study_has_all_curves(extractor: EigenvalueExtractor, shapes: TrainingSet) -> None:
    found = study.study(extractor, shapes)
    assert found["by_metres"][0]["top1"] == pytest.approx(found["by_degrees"][0]["top1"])
    # Segments of 150 points all.
    assert [row["queries"] for row in found["by_points"]] == [0, 48, 0, 0, 0, 0]
    assert found["by_points"][0]["top1"] is None
    for key in ("by_occlusion", "by_density"):
        whole, *less = (row["top1"] for row in found[key])
        assert whole == found["by_metres"][0]["top1"]
        assert min(less) < whole
    assert sum(found["misses"].values()) == pytest.approx(1.0)


def test_fewer_bits_and_dimensions_lose() -> None:
    random = np.random.default_rng(0)
    groups = np.repeat(np.arange(40, dtype=np.int64), 3)
    centers = random.normal(size=(40, 16))
    described = (centers[groups] + random.normal(0, 0.25, (120, 16))).astype(np.float32)
    data = TrainingSet(None, groups, None)  # type: ignore[arg-type]
    curve = {
        (row["dimension"], row["bits"]): row["top1"] for row in study.by_storage(described, data)
    }
    assert {dimension for dimension, _ in curve} == {8, 16}
    assert curve[16, 32] >= curve[8, 32] > curve[8, 3]
    assert curve[16, 8] == pytest.approx(curve[16, 32], abs=0.05)


def test_misses_are_sorted_once_each(shapes: TrainingSet) -> None:
    centroids = shapes.segments.centroids()
    # Nothing can be told apart: all find the first, or the second in its stead.
    sorted_misses = study.misses(np.zeros((len(shapes), 2), np.float32), shapes, centroids)
    assert sorted_misses["right"] == pytest.approx(6 / 48)
    assert sorted_misses["no_mate"] == 0
    # The found segments are ten meters or more away, and the boxes stand still.
    assert sorted_misses["near_place"] == 0
    assert sorted_misses["small"] == pytest.approx(42 / 48)


def test_group_with_distant_centroids_wanders() -> None:
    centroids = np.array([[0.0, 0, 0], [1, 0, 0], [0, 2, 0], [5, 5, 5]])
    data = TrainingSet(None, np.array([0, 0, 0, 1]), None)  # type: ignore[arg-type]
    assert study.wander(data, centroids) == pytest.approx([np.sqrt(5)] * 3 + [0])
    same = study.in_near_place(data.groups, centroids, np.array([1, 0, 3, 2]))
    assert same.tolist() == [True, True, False, False]
