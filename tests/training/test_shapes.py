"""The training of the shape decoder, on few segments of a shipped model."""

import shutil
from pathlib import Path

import pytest

from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.manifest import SHAPE_FILE, Manifest
from placecell.shapes.decoder import ShapeDecoder
from service.clouds.map_shapes import decoded_points
from tests.placecell.segment_builders import one_scan_recording
from tests.placecell.shapes.shape_builders import FOLDER, map_of, walls
from training.data.training_set import Source
from training.methods.run import Run
from training.shapes.data import shape_data
from training.shapes.publishing import Facts, identity_of, train_and_publish, write_section

pytestmark = pytest.mark.slow


def source(count: int) -> Source:
    return Source(one_scan_recording(walls(count)), 0, 0)


def test_training_adds_a_decoder_and_changes_nothing_else(tmp_path: Path) -> None:
    folder = tmp_path / "model"
    shutil.copytree(FOLDER, folder)
    before = Manifest.load(folder)
    card = (folder / "README.md").read_text()
    data, parts = shape_data([source(12)], load_extractor(folder), seed=0)
    assert len(data) == 12
    facts = Facts(parts, "free", 0, 1)
    run = Run(tmp_path / "runs", 0, identity_of(before, facts))
    published = train_and_publish(folder, before, data, run, facts)
    assert published.model_id == before.model_id
    assert published.classes == before.classes
    assert published.shape["segments"] + published.shape["validation_segments"] == 12
    assert 0 <= published.shape["validation_iou"] <= 1
    assert (folder / SHAPE_FILE).stat().st_size < 4_000_000
    points, owners = decoded_points(map_of(walls()), ShapeDecoder(folder, Manifest.load(folder)))
    assert len(points) == len(owners)
    text = (folder / "README.md").read_text()
    assert text.count("## Shapes") == card.count("## Shapes") == 1
    assert "placecell train-shapes context" in text
    assert text.split("## Train this model again")[1] == card.split("## Train this model again")[1]


def test_section_of_the_card_is_replaced(tmp_path: Path) -> None:
    card = tmp_path / "README.md"
    card.write_text("# Model\n\n## Figures\n\ntext\n\n## Train this model again\n\n    command\n")
    manifest = Manifest.load(FOLDER)
    write_section(card, manifest)
    first = card.read_text()
    write_section(card, manifest)
    assert card.read_text() == first
    assert first.startswith("# Model\n\n## Figures\n\ntext\n\n## Shapes\n")
    assert first.endswith("## Train this model again\n\n    command\n")
