"""Tests of the head for classes of the shipped model."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from placecell.core.segment_classes import CLASSES, class_indices, class_probabilities
from placecell.core.segments import Segments
from placecell.descriptors.class_features import FEATURES
from placecell.descriptors.class_head import ClassHead
from placecell.descriptors.extractor import CLASS_FEATURES, Extractor, load_extractor
from placecell.descriptors.manifest import CLASSES_FILE, FILE, Manifest, ModelError
from placecell.descriptors.shipped_models import MODELS_FOLDER

FOLDER = MODELS_FOLDER / "context-town"


@pytest.fixture(scope="module")
def extractor() -> Extractor:
    return load_extractor(FOLDER, threads=1)


@pytest.fixture(scope="module")
def segments() -> Segments:
    rng = np.random.default_rng(0)
    clouds = [
        rng.uniform([9, -2, -1.4], [9.05, 2, 1.6], (600, 3)),  # a wall
        rng.uniform([5, 5, -1.4], [5.15, 5.15, 2.5], (200, 3)),  # a pole
        *(rng.uniform(0, 1 + n, (120, 3)) for n in range(70)),
    ]
    return Segments.of([each.astype(np.float32) for each in clouds], np.zeros((len(clouds), 3)))


def test_classes_come_with_the_descriptors(extractor: Extractor, segments: Segments) -> None:
    found = extractor.description(segments)
    assert extractor.has_classes
    assert found.classes is not None
    assert (found.values == extractor.describe(segments)).all()
    assert (class_indices(found.classes) >= 0).all()
    assert (class_probabilities(found.classes) > 1 / len(CLASSES) - 0.02).all()
    assert CLASSES[class_indices(found.classes)[1]] in ("pole", "sign")


def test_segment_has_the_same_byte_in_any_request(extractor: Extractor, segments: Segments) -> None:
    inputs = extractor.prepare(segments)
    values = extractor.infer(inputs)
    assert inputs[CLASS_FEATURES].shape == (len(segments), FEATURES)
    expected = extractor.classify(inputs, values)
    assert expected is not None
    for rows in (np.arange(1), np.arange(5, 70), np.arange(len(segments))[::-1]):
        some = {name: each[rows] for name, each in inputs.items()}
        found = extractor.classify(some, values[rows])
        assert found is not None
        assert (found == expected[rows]).all()


def test_descriptor_that_is_not_finite_has_no_class(extractor: Extractor) -> None:
    head = ClassHead(FOLDER, extractor.manifest, threads=1)
    values = np.zeros((2, extractor.manifest.dimension), np.float32)
    values[0, 3] = np.nan
    found = head.classify(values, np.zeros((2, FEATURES), np.float32))
    assert found[0] == 0
    assert found[1] > 0
    assert len(head.classify(values[:0], np.zeros((0, FEATURES), np.float32))) == 0


def test_model_without_a_head_has_no_classes(segments: Segments) -> None:
    plain = load_extractor(MODELS_FOLDER / "group", threads=1)
    assert not plain.has_classes
    assert plain.description(segments.take([0])).classes is None
    assert CLASS_FEATURES not in plain.prepare(segments.take([0]))


def test_head_does_not_change_the_id(tmp_path: Path, segments: Segments) -> None:
    folder = tmp_path / "context-town"
    shutil.copytree(FOLDER, folder)
    content = json.loads((folder / FILE).read_text())
    del content["classes"], content["files"][CLASSES_FILE]
    (folder / FILE).write_text(json.dumps(content))
    (folder / CLASSES_FILE).unlink()
    manifest = Manifest.load(folder)
    assert manifest.model_id == Manifest.load(FOLDER).model_id
    some = segments.take([0, 1])
    plain = load_extractor(folder, threads=1)
    assert (plain.describe(some) == load_extractor(FOLDER, threads=1).describe(some)).all()
    manifest.save(folder)
    assert "classes" not in json.loads((folder / FILE).read_text())


def test_head_of_other_features_is_refused(tmp_path: Path) -> None:
    folder = tmp_path / "context-town"
    shutil.copytree(FOLDER, folder)
    content = json.loads((folder / FILE).read_text())
    content["classes"]["features_version"] = 7
    (folder / FILE).write_text(json.dumps(content))
    with pytest.raises(ModelError, match="placecell train-classes"):
        load_extractor(folder, threads=1)
