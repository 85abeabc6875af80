"""Tests of the training of the head for classes, on few segments."""

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from placecell.core.segment_classes import CLASSES, class_indices
from placecell.core.segments import Segments
from placecell.core.types import UInt8
from placecell.datasets.labels import NO_CLASS
from placecell.descriptors.class_features import FEATURES
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import MODELS_FOLDER
from placecell.segmentation.recording import Recording
from tests.placecell.segment_builders import one_scan_recording
from training.classes import placing
from training.classes.augmentation import bent, grown, varied
from training.classes.examples import Examples, LabeledDrive, examples_of
from training.classes.learning import ClassRecipe, agreed, learn, weights_of
from training.classes.publishing import publish_head

VEGETATION, VEHICLE = 1, 3
QUICK = ClassRecipe(epochs=8, batch=32)


def segments_of(count: int, seed: int = 0) -> Segments:
    rng = np.random.default_rng(seed)
    clouds = [
        (rng.uniform(0, 1 + number % 3, (60, 3)) + [4.0 * number, 5, 0]).astype(np.float32)
        for number in range(count)
    ]
    return Segments.of(clouds, np.zeros((count, 3)))


def recording_of(segments: Segments, name: str) -> Recording:
    return one_scan_recording(segments, name, np.arange(len(segments)) % 2 == 0)


def separable(count: int, size: int, seed: int = 0) -> Examples:
    """Return examples of two classes that differ in a fifth of their inputs."""
    rng = np.random.default_rng(seed)
    classes = rng.choice([VEGETATION, VEHICLE], count).astype(np.uint8)
    inputs = rng.normal(size=(count, size)).astype(np.float32)
    inputs[:, ::5] += np.where(classes == VEHICLE, 3, -3)[:, None]
    kind = np.zeros(count, np.float32)
    return Examples(inputs, classes, np.arange(count), kind, kind, kind)


def test_bent_segments_stay_near_their_points() -> None:
    segments = segments_of(6)
    moved = bent(segments, np.random.default_rng(1))
    distance = np.linalg.norm(moved - segments.points, axis=1)
    assert 0.01 < distance.mean() < 0.8
    assert distance.max() < 2.0


def test_only_vegetation_grows_together() -> None:
    segments = segments_of(8)
    classes: UInt8 = np.array([VEGETATION] * 6 + [VEHICLE] * 2, np.uint8)
    joined = grown(segments, classes, np.zeros(8, np.int64), np.random.default_rng(0))
    assert (joined.counts[6:] == segments.counts[6:]).all()
    assert (joined.counts[:6] >= segments.counts[:6]).all()
    assert joined.counts[:6].max() > 60
    copies = varied(segments, classes, np.zeros(8, np.int64), np.random.default_rng(0))
    assert len(copies) == 8


def test_examples_of_simulated_recorded_and_unlabeled_drives(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(placing, "THINGS", {"car": (3, ("vehicle",))})
    extractor = load_extractor(MODELS_FOLDER / "context-town", threads=1)
    classes: UInt8 = np.array([VEGETATION, VEHICLE, NO_CLASS, VEHICLE], np.uint8)
    drives = [
        LabeledDrive(recording_of(segments_of(4), "town:1"), classes),
        LabeledDrive(recording_of(segments_of(4), "street"), classes),
        LabeledDrive(recording_of(segments_of(4), "street")),
    ]
    found = examples_of(drives, extractor, seed=0)
    cast = int(found.is_cast.sum())
    assert 0 < cast <= 3
    assert (found.classes[found.is_cast > 0] == VEHICLE).all()
    assert len(found) == 4 * 2 + cast + 4 * 5 + 2 * 2  # of the unlabeled drive, distinct segments
    assert found.inputs.shape[1] == extractor.manifest.dimension + FEATURES
    assert len(np.unique(found.groups)) == 4 + 4 + 2
    assert (found.classes[-4:] == NO_CLASS).all()
    labeled = found.labeled_as(found.classes)
    assert (labeled.classes != NO_CLASS).all()
    weights = weights_of(labeled, QUICK)
    simulated = labeled.simulated > 0
    assert set(weights[simulated]) == {1.0, QUICK.cast}
    assert weights[~simulated].sum() == pytest.approx(0.7 * weights[simulated].sum())


@pytest.mark.slow
def test_training_with_unlabeled_drives_and_publishing(tmp_path: Path) -> None:
    folder = tmp_path / "context-town"
    shutil.copytree(MODELS_FOLDER / "context-town", folder)
    before = Manifest.load(folder)
    size = before.dimension + FEATURES
    unlabeled = separable(60, size, seed=1)
    truth = unlabeled.classes
    unlabeled = replace(unlabeled, classes=np.full(60, NO_CLASS, np.uint8))
    told: list[str] = []
    trained = learn(separable(200, size), unlabeled, 0, QUICK, told.append)
    assert len(told) == 2
    agree = agreed(trained.network, unlabeled)
    assert (agree[agree != NO_CLASS] == truth[agree != NO_CLASS]).mean() > 0.95
    again = learn(separable(200, size), unlabeled, 0, QUICK)
    assert (agreed(again.network, unlabeled) == agree).all()
    drive = LabeledDrive(recording_of(segments_of(3), "town:1"))
    manifest = publish_head(folder, trained, [drive], {"seed": 0})
    assert manifest.model_id == before.model_id
    assert manifest.classes["held_out"]["accuracy"] > 0.9
    assert Manifest.load(folder).classes == manifest.classes
    found = load_extractor(folder, threads=1).description(segments_of(3)).classes
    assert found is not None
    assert {CLASSES[index] for index in class_indices(found)} <= set(CLASSES)


def test_one_class_is_refused() -> None:
    examples = separable(20, 5)
    alone = examples.take(np.flatnonzero(examples.classes == VEHICLE))
    with pytest.raises(ValueError, match="expected 2 or more"):
        learn(alone, None, 0, QUICK)
