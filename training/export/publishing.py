"""Publishing: writes a model folder with projection, quantizer, pair classifier and card."""

import hashlib
import json
import shlex
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.machine import machine
from evaluation.recognition import retrieval
from evaluation.recognition.evaluate import measure
from placecell.core.parameters import NEIGHBORHOOD_V1, NeighborhoodParameters
from placecell.core.types import Float32, Int64
from placecell.descriptors.eigenvalue import eigenvalue_descriptors
from placecell.descriptors.extractor import MODEL_FILE, Extractor, OnnxExtractor, load_extractor
from placecell.descriptors.manifest import FULL_FILE, PAIR_FILE, Manifest, preprocessing_of
from placecell.descriptors.pair_classifier import load_pair_classifier
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.site_calibration import SiteConstants
from placecell.localization import confidence
from training.data.training_set import Source, TrainingSet
from training.export.card import write_card
from training.methods.context import Projection, learn_rotation
from training.methods.networks import DescriptorNetwork, describe
from training.methods.registry import Trained

VALIDATION_SHARE = 0.1
"""Share of the groups that are held out for validation."""

SPLIT_SEED = 0

NORMALIZED = "normalized distance"
"""Name of the distance that a site's own segments normalize, among the kinds of pair classifier."""

VOXEL_PARTS = 2
"""Parts along each edge of a voxel (`Parameters.voxel_parts`), for models with context."""

STORED_DIMENSION = 32
"""Number of stored dimensions out of 64; with 8 bits each, 32 bytes per segment."""


@dataclass(frozen=True, slots=True)
class Data:
    """Data of a model.

    Attributes:
        training: training set.
        validation: held-out groups, for thresholds, calibration and figures.
        provenance: entry of the manifest: sources, seed, seconds, license and command.
    """

    training: TrainingSet
    validation: TrainingSet
    provenance: dict[str, Any]

    def stating(self, **facts: object) -> "Data":
        """Return the data with further provenance: `seed`, `seconds`, `command`."""
        return replace(self, provenance=self.provenance | facts)


def collect(
    sources: Sequence[Source], license_name: str, neighborhood: NeighborhoodParameters | None = None
) -> Data:
    """Build training and validation set from parts of recordings, with their provenance.

    The split does not depend on a training's seed, so that seeds can be compared.

    Args:
        sources: parts of recordings.
        license_name: license of the drives.
        neighborhood: parameters of the neighborhood, for a model with context; None otherwise.

    Raises:
        ValueError: there are too few groups to train on.
    """
    everything = TrainingSet.of(sources, neighborhood)
    if neighborhood is not None:
        parameters = replace(everything.parameters, voxel_parts=VOXEL_PARTS)
        everything = replace(everything, parameters=parameters)
    training, validation = everything.split(VALIDATION_SHARE, SPLIT_SEED)
    # The validation groups are halved for calibration, and each half must hold pairs of both kinds.
    # This is checked before the training.
    halves = map(validation.take, validation.halves(0.5, seed=0))
    if not all(has_pairs(part) for part in (training, *halves)):
        raise ValueError(
            f"{len(training) + len(validation)} segments form too few groups to train on. Use "
            "longer drives or more scans."
        )
    return Data(
        training,
        validation,
        {
            "sources": [source.describe() for source in sources],
            "segments": len(training),
            "groups": len(training.group_sizes()),
            "validation_share": VALIDATION_SHARE,
            "licence": license_name,
            "seed": 0,
            "seconds": 0.0,
            "machine": machine(),
            "command": "",
        },
    )


def retraining(
    command: Sequence[str],
    sources: Sequence[Source],
    license_name: str,
    seed: int,
    *options: object,
) -> str:
    """Return the commands that train again, beginning with the drives.

    Args:
        command: words of the command before the drives, such as `train context`.
        sources: parts of recordings.
        license_name: license of the drives.
        seed: random seed of the training.
        options: further words of the command.
    """
    lines, prepared = [], []
    for source in sources:
        recording, file = source.recording, f"data/{source.recording.name}.safetensors"
        if recording.name.startswith("town:"):
            prepared.append(recording.name)
            continue
        step = recording.parameters.frame_step
        lines.append(f"placecell prepare {shlex.quote(recording.name)} --every {step} -o data")
        whole_drive = (source.first, source.last) == (0, recording.scans - 1)
        prepared.append(file if whole_drive else f"{file}@{source.first}:{source.last}")
    words = ["placecell", *command, *dict.fromkeys(prepared), "--seed", seed, *options]
    lines.append(shlex.join(map(str, [*words, "--license", license_name])))
    return "\n".join(dict.fromkeys(lines))


def fingerprint(data: Data, *settings: object) -> str:
    """Return a hash of the segments and the settings of a training."""
    sources = [[source["scan_hashes"], source["scans"]] for source in data.provenance["sources"]]
    parts = data.training.parameters.voxel_parts
    named = [str(value) for value in settings] + ([] if parts == 1 else [f"voxel_parts={parts}"])
    text = json.dumps([sources, data.provenance["seed"], named])
    return hashlib.sha256(text.encode()).hexdigest()[:16]


@contextmanager
def whole(folder: Path) -> Iterator[Path]:
    """Yield a temporary folder, which gets the final name only if the block succeeds.

    A confidence file stays: models without one use the file in the default model's folder.
    """
    unfinished = folder.with_name(folder.name + ".unfinished")
    shutil.rmtree(unfinished, ignore_errors=True)
    unfinished.mkdir(parents=True)
    yield unfinished
    if folder.exists():
        if (folder / confidence.NAME).exists():
            shutil.copy2(folder / confidence.NAME, unfinished)
        shutil.rmtree(folder)
    unfinished.rename(folder)


def has_pairs(data: TrainingSet) -> bool:
    """Return whether the set has both matching and non-matching pairs of segments."""
    return len(data.group_sizes()) >= 2 and int(data.group_sizes().max()) >= 2


def publish_network(folder: Path, trained: Trained, data: Data) -> Manifest:
    """Write `model.onnx`, `pair.onnx`, `manifest.json` and the card of a trained network."""
    axes = stored_axes(trained, data)
    head = None if trained.match is None else (trained.match, *axes)
    with whole(folder) as unfinished:
        manifest = export_network(unfinished, trained, data, axes)
        return finish(unfinished, replace(manifest, name=folder.name), data, head)


def stored_axes(trained: Trained, data: Data) -> tuple[Float32, Float32]:
    """Return mean and principal axes of the stored part of the descriptors."""
    from training.export.onnx_graph import principal_axes

    return principal_axes(describe(trained.network, data.training.recorded()), STORED_DIMENSION)


def export_network(
    folder: Path, trained: Trained, data: Data, axes: tuple[Float32, Float32]
) -> Manifest:
    """Write `model.onnx` of a trained network; return its manifest.

    Args:
        folder: folder of the model.
        trained: trained network.
        data: data of the model.
        axes: result of `stored_axes`.
    """
    # Torch's exporter is slow to import, so it is imported only here.
    from training.export.onnx_graph import Exported, ExportedContext, export_onnx
    from training.export.quantization import quantize

    recorded = data.training.recorded()
    segment = Exported(trained.network, *axes)
    grid = data.training.parameters.grid
    around, dimension, per_byte, files = None, STORED_DIMENSION, 1, [MODEL_FILE]
    if trained.projection is None:
        export_onnx(segment, grid, folder / MODEL_FILE)
    else:
        # Four times the dimensions with a quarter of the bits take the same number of bytes.
        around, per_byte = NEIGHBORHOOD_V1, 4
        dimension += trained.projection.axes.shape[1]
        parts = joined_parts(trained.network, trained.projection, *axes, recorded)
        turn = learn_rotation(parts, per_byte)
        network = ExportedContext(segment, trained.projection, turn)
        export_onnx(network, grid, folder / FULL_FILE)
        quantize(folder / FULL_FILE, data.training, folder / MODEL_FILE)
        files.append(FULL_FILE)
    manifest = Manifest(
        name=trained.method,
        method=trained.method,
        network=trained.network_name,
        dimension=dimension,
        quantizer=Quantizer(1.0, per_byte),
        preprocessing=preprocessing_of(data.training.parameters, around),
        training=data.provenance,
    ).with_files(folder, files)
    described = OnnxExtractor(folder, manifest).describe(recorded.segments, recorded.neighborhood)
    return replace(manifest, quantizer=Quantizer.fit(described, per_byte))


def joined_parts(
    network: DescriptorNetwork,
    projection: Projection,
    mean: Float32,
    axes: Float32,
    data: TrainingSet,
) -> Float32:
    """Return both parts of the descriptors side by side, without their rotation."""
    assert data.neighborhood is not None
    seen = np.flatnonzero(data.neighborhood.any(axis=1))
    own = (describe(network, data.take(seen)) - mean) @ axes
    return np.concatenate([own, projection.part(data.neighborhood[seen])], axis=1)


def publish_eigenvalue(folder: Path, data: Data) -> Manifest:
    """Write the eigenvalue baseline, standardized on the training set, with pair classifier."""
    features = eigenvalue_descriptors(data.training.segments).astype(np.float64)
    mean, deviation = features.mean(axis=0), features.std(axis=0)
    manifest = Manifest(
        name=folder.name,
        method="eigenvalue",
        network="",
        dimension=features.shape[1],
        quantizer=Quantizer.fit(((features - mean) / deviation).astype(np.float32)),
        preprocessing=preprocessing_of(data.training.parameters),
        standardization={"mean": mean.tolist(), "deviation": deviation.tolist()},
        training=data.provenance,
    )
    with whole(folder) as unfinished:
        return finish(unfinished, manifest, data, head=None)


def finish(
    folder: Path, manifest: Manifest, data: Data, head: tuple[Any, Float32, Float32] | None
) -> Manifest:
    """Add pair classifier, thresholds and validation figures to a model folder; save it."""
    from training.export.pair_classifier import DescriptorPairs, HeldOut, choose
    from training.export.site_constants import fit_site_constants, sites_of

    manifest.save(folder)
    extractor = load_extractor(folder)

    def pairs_of(part: TrainingSet, descriptors: Float32) -> DescriptorPairs:
        drawn = retrieval.draw_pairs(part.groups, retrieval.PAIRS, np.random.default_rng(0))
        return DescriptorPairs.of(descriptors, *drawn)

    learned, held_out = (
        stored_descriptors(extractor, part) for part in (data.training, data.validation)
    )
    # The map holds all segments, so that held-out segments have many non-matches. With context the
    # figures are optimistic, because neighborhoods of held-out groups were part of the training.
    database = np.concatenate([held_out, learned])
    last = int(data.validation.groups.max())
    groups = np.concatenate([data.validation.groups, data.training.groups + last + 1])

    def half(queries: Int64) -> HeldOut:
        nearest = retrieval.nearest_pairs(database, groups, queries)
        return HeldOut(
            pairs_of(data.validation.take(queries), held_out[queries]),
            DescriptorPairs.of(database, *nearest),
        )

    calibration, selection = map(half, data.validation.halves(0.5, seed=0))
    chosen = choose(
        pairs_of(data.training, learned), calibration, selection, head, folder / PAIR_FILE
    ) | {"database": len(database), "nearest": retrieval.CANDIDATES}
    codes = manifest.quantizer.encode(np.concatenate([learned, held_out]))
    sites = sites_of(data.training, data.validation, codes)
    chosen |= site_entry(chosen, fit_site_constants(sites, manifest.quantizer))
    distances = pairs_of(data.validation, held_out)
    is_match = distances.matches > 0.5
    lengths = distances.distances()
    manifest = replace(
        manifest.with_files(folder, [*manifest.files, PAIR_FILE]),
        pair=chosen,
        pair_threshold=retrieval.best_threshold(lengths[is_match], lengths[~is_match]),
    )
    extractor.manifest = manifest
    figures = measure(
        extractor,
        load_pair_classifier(folder, manifest),
        data.validation.segments,
        data.validation.groups,
        seed=1,
        neighborhood=data.validation.neighborhood,
    )
    figures.pop("model_id")
    manifest = replace(manifest, figures={"validation": figures})
    manifest.save(folder)
    write_card(folder, manifest)
    return manifest


def site_entry(pair: dict[str, Any], fitted: tuple[SiteConstants, float] | None) -> dict[str, Any]:
    """Return the manifest's entries of the site constants.

    Without constants, or if a forest or a network separates the pairs better than the normalized
    distance, the match probability stays that of the pair classifier.
    """
    if fitted is None:
        return {}
    constants, auc = fitted
    compared = {"auc": pair["auc"] | {NORMALIZED: auc}}
    is_best = pair["kind"] == "distance" or auc >= max(pair["auc"].values())
    return compared | ({"site": constants.as_dict()} if is_best else {})


def stored_descriptors(extractor: Extractor, data: TrainingSet) -> Float32:
    """Return descriptors after encoding to and decoding from their stored form."""
    quantizer = extractor.manifest.quantizer
    return quantizer.decode(quantizer.encode(extractor.describe(data.segments, data.neighborhood)))
