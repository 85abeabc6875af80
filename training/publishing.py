"""From a trained network to a model's folder: projection, quantiser, threshold, card."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from segments.eigenvalue import eigenvalue_descriptors
from segments.extractor import MODEL_FILE, Extractor, load_extractor
from segments.manifest import Manifest, preprocessing_of
from segments.quantiser import Quantiser
from segments.types import Float32
from training import recognition
from training.card import write_card
from training.evaluation import measure
from training.networks import DescriptorNetwork, describe
from training.training_set import TrainingSet

STORED_DIMENSION = 32
"""Of the 64: at 8 bits each, 32 bytes a segment."""


def publish_network(
    folder: Path,
    name: str,
    method: str,
    network_name: str,
    network: DescriptorNetwork,
    training: TrainingSet,
    validation: TrainingSet,
    provenance: dict[str, Any],
) -> Manifest:
    """Write `model.onnx`, `manifest.json` and the card of a trained network."""
    # Torch's exporter is slow to import: only here.
    from training.export import Exported, export_onnx, principal_axes

    folder.mkdir(parents=True, exist_ok=True)
    learned = describe(network, training)
    mean, axes = principal_axes(learned, STORED_DIMENSION)
    export_onnx(Exported(network, mean, axes), training.parameters.grid, folder / MODEL_FILE)
    manifest = Manifest(
        name=name,
        method=method,
        network=network_name,
        dimension=STORED_DIMENSION,
        quantiser=Quantiser.fit(np.asarray((learned - mean) @ axes, dtype=np.float32)),
        preprocessing=preprocessing_of(training.parameters),
        training=provenance,
    ).with_files(folder, [MODEL_FILE])
    return finish(folder, manifest, validation)


def publish_eigenvalue(
    folder: Path, training: TrainingSet, validation: TrainingSet, provenance: dict[str, Any]
) -> Manifest:
    """Write the baseline, standardised on the training set."""
    folder.mkdir(parents=True, exist_ok=True)
    features = eigenvalue_descriptors(training.segments).astype(np.float64)
    mean, deviation = features.mean(axis=0), features.std(axis=0)
    manifest = Manifest(
        name="eigenvalue",
        method="eigenvalue",
        network="",
        dimension=features.shape[1],
        quantiser=Quantiser.fit(((features - mean) / deviation).astype(np.float32)),
        preprocessing=preprocessing_of(training.parameters),
        standardisation={"mean": mean.tolist(), "deviation": deviation.tolist()},
        training=provenance,
    )
    return finish(folder, manifest, validation)


def finish(folder: Path, manifest: Manifest, validation: TrainingSet) -> Manifest:
    """Choose the pair threshold and measure on the validation groups, as stored; then save."""
    manifest.save(folder)
    extractor = load_extractor(folder)
    stored = stored_descriptors(extractor, validation)
    pairs = recognition.draw_pairs(validation.groups, recognition.PAIRS, np.random.default_rng(0))
    near, far = (recognition.pair_distances(stored, some) for some in pairs)
    manifest = replace(manifest, pair_threshold=recognition.best_threshold(near, far))
    extractor.manifest = manifest
    figures = measure(extractor, stored, validation.groups, validation.segments.sensors, seed=1)
    figures.pop("model_id")
    manifest = replace(manifest, figures={"validation": figures})
    manifest.save(folder)
    write_card(folder, manifest)
    return manifest


def stored_descriptors(extractor: Extractor, data: TrainingSet) -> Float32:
    """Descriptors after a round trip through their stored form."""
    quantiser = extractor.manifest.quantiser
    return quantiser.decode(quantiser.encode(extractor.describe(data.segments)))
