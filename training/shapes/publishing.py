"""Publishing of a shape decoder: exports it into the folder of its model."""

import hashlib
import json
import re
import tempfile
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import onnx
import torch
from onnx import numpy_helper

from evaluation.machine import machine
from placecell.core.types import Float32
from placecell.descriptors.extractor import MODEL_FILE
from placecell.descriptors.manifest import SHAPE_FILE, Manifest, file_hash
from training.data.training_set import Source
from training.export.publishing import SPLIT_SEED, VALIDATION_SHARE, retraining
from training.methods.run import Run
from training.shapes.data import ShapeData
from training.shapes.learning import (
    THRESHOLDS,
    ShapeRecipe,
    learn_shapes,
    overlaps_by_threshold,
)
from training.shapes.network import ShapeNetwork

HEADING = "## Shapes"
SECTION = (
    HEADING
    + """

`shape.onnx` ({size:.1f} MB) decodes the occupancy grid of a segment from its stored code. It
learned from {segments:,} segments of the drives below in {minutes:.0f} minutes of processor time.
The license is that of the model.
{held_out:,} segments of groups that it did not see: intersection over union {iou:.3f}
(docs/results/segments.md has other drives and the baseline).

{command}
"""
)
"""Section of the model card about the decoder."""

VALIDATED = 2000
"""Largest number of validation segments that are measured."""

LARGEST = 4_000_000
"""Largest size of a decoder's file, bytes."""


def own_part(folder: Path, manifest: Manifest) -> Float32:
    """Return the projection of a descriptor to the segment's own part, (dimension, own).

    A model with context joins the segment's own part and the neighborhood's, and rotates both. All
    other descriptors are the segment's own.

    Raises:
        ValueError: the network of a model with context was exported by another program.
    """
    if manifest.neighborhood is None:
        return np.eye(manifest.dimension, dtype=np.float32)
    graph = onnx.load(folder / MODEL_FILE).graph
    tensors = {each.name: each for each in graph.initializer if each.name in {"rotation", "axes"}}
    if set(tensors) != {"rotation", "axes"}:
        raise ValueError(
            f"{folder / MODEL_FILE}: expected the tensors 'rotation' and 'axes' of a model with "
            "context. Train the model again with 'placecell train context'."
        )
    rotation, axes = (numpy_helper.to_array(tensors[name]) for name in ("rotation", "axes"))
    return np.ascontiguousarray(rotation[: manifest.dimension - axes.shape[1]].T, np.float32)


@dataclass(frozen=True, slots=True)
class Facts:
    """Facts of a training for the manifest and the card.

    Attributes:
        sources: parts of recordings.
        license_name: license of the drives.
        seed: random seed.
        epochs: number of passes over the training data.
    """

    sources: Sequence[Source]
    license_name: str
    seed: int
    epochs: int

    def command(self, manifest: Manifest) -> str:
        """Return the commands that train the decoder again."""
        command, options = ["train-shapes", manifest.name], ["--epochs", self.epochs]
        return retraining(command, self.sources, self.license_name, self.seed, *options)


def identity_of(manifest: Manifest, facts: Facts) -> str:
    """Return a hash of everything that determines a training, for its checkpoint."""
    sources = [source.describe() for source in facts.sources]
    text = json.dumps([manifest.model_id, sources, facts.seed, facts.epochs])
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def train_and_publish(
    folder: Path, manifest: Manifest, data: ShapeData, run: Run, facts: Facts
) -> Manifest:
    """Train a decoder and write it, its hash and its facts into the folder of its model.

    Args:
        folder: folder of the model.
        manifest: manifest of the model.
        data: segments of all sources; a part of their groups is held out for the threshold.
        run: seed, checkpoints and history of the training.
        facts: facts of the training.

    Raises:
        ValueError: the file is too large.
    """
    training, validation = data.split(VALIDATION_SHARE, SPLIT_SEED)
    validation = validation.take(np.arange(len(validation))[:: -(-len(validation) // VALIDATED)])
    parameters, quantizer = manifest.parameters, manifest.quantizer
    torch.manual_seed(facts.seed)
    network = ShapeNetwork(own_part(folder, manifest), parameters.grid, parameters.grid_voxel)
    recipe = ShapeRecipe(epochs=facts.epochs)
    learn_shapes(network, quantizer, training, validation, run, recipe)
    overlaps = overlaps_by_threshold(network, quantizer, validation).mean(axis=0)
    with torch.no_grad():
        network.basis.bias.sub_(float(THRESHOLDS[overlaps.argmax()]))
    size = write_decoder(folder, network, manifest.dimension)
    shape = {
        "sources": [
            {key: each for key, each in source.describe().items() if key != "scan_hashes"}
            for source in facts.sources
        ],
        "segments": len(training),
        "validation_segments": len(validation),
        "validation_iou": round(float(overlaps.max()), 4),
        "bytes": size,
        "licence": facts.license_name,
        "seed": facts.seed,
        **run.cost(),
        "machine": machine(),
        "command": facts.command(manifest),
    }
    hashes = manifest.files | {SHAPE_FILE: file_hash(folder / SHAPE_FILE)}
    published = replace(manifest, files=hashes, shape=shape)
    published.save(folder)
    write_section(folder / "README.md", published)
    return published


def write_section(card: Path, manifest: Manifest) -> None:
    """Write the section about the decoder into the model's card; nothing else of it changes."""
    shape = manifest.shape
    section = SECTION.format(
        segments=shape["segments"],
        held_out=shape["validation_segments"],
        iou=shape["validation_iou"],
        minutes=shape["cpu_seconds"] / 60,
        size=shape["bytes"] / 1e6,
        command=textwrap.indent(shape["command"], "    "),
    )
    text = re.sub(rf"{HEADING}\n.*?(?=\n## |\Z)", "", card.read_text(), flags=re.S)
    before, heading, after = text.partition("## Train this model again")
    card.write_text(f"{before.rstrip()}\n\n{section}\n{heading}{after}")


def write_decoder(folder: Path, network: ShapeNetwork, dimension: int) -> int:
    """Write the decoder's file into the folder of its model; return its size in bytes.

    Raises:
        ValueError: the file is too large.
    """
    unfinished = folder / f"{SHAPE_FILE}.unfinished"
    try:
        export_decoder(network, dimension, unfinished)
        size = unfinished.stat().st_size
        if size > LARGEST:
            raise ValueError(
                f"{folder / SHAPE_FILE}: {size:,} bytes, expected at most {LARGEST:,}. Use a "
                "smaller basis."
            )
        unfinished.replace(folder / SHAPE_FILE)
    finally:
        unfinished.unlink(missing_ok=True)
    return size


def export_decoder(network: ShapeNetwork, dimension: int, file: Path) -> None:
    """Write the network as ONNX; its large layers have 8-bit weights."""
    from onnxruntime.quantization import QuantType, quantize_dynamic

    # Torch's exporter is slow to import, so it is imported only here.
    from training.export.onnx_graph import to_onnx

    examples = tuple(torch.ones((2, *shape)) for shape in ((dimension,), (2,), (), (3,), ()))
    names = ["descriptor", "offset", "bearing", "extents", "points"]
    with tempfile.TemporaryDirectory() as made:
        full = Path(made) / "full.onnx"
        to_onnx(network, examples, names, ["occupancy", "center"], full)
        model = onnx.load(full)
        # The quantization turns matrices and leaves their stated shapes.
        del model.graph.value_info[:]
        onnx.save(model, full)
        quantize_dynamic(full, file, per_channel=True, weight_type=QuantType.QInt8)
