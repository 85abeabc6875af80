"""Study of further bytes: reconstruction from the code and a few bytes that are made to draw.

An encoder reads the true grid and what the decoder has already, and is trained together with the
decoder. No map stores these bytes: the study says what a column for them would gain.
"""

import math
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import torch

from evaluation.machine import machine
from evaluation.segments.shapes import (
    MEASURED,
    CodedGrids,
    baseline_figures,
    by_size,
    chamfer,
    drawn_rows,
    overlap,
    rounded,
)
from placecell.core.types import Bool, Float32, Int64
from placecell.descriptors.extractor import Extractor, load_extractor
from placecell.descriptors.orientation import bearings_of
from placecell.segmentation.recording import Recording
from placecell.shapes.decoder import Shapes, turned
from training.data.training_set import Source
from training.export.publishing import SPLIT_SEED, VALIDATION_SHARE
from training.methods.run import Run
from training.shapes.data import NOTHING, ShapeData, extracted, shape_data
from training.shapes.learning import (
    THRESHOLDS,
    ShapeRecipe,
    batch_of,
    learn_shapes,
    overlaps_by_threshold,
)
from training.shapes.network import FEATURES, ExtraEncoder, ShapeNetwork
from training.shapes.publishing import VALIDATED, own_part

KNOWN = 8000
"""Largest number of training segments that the baseline knows, drawn at random."""

BATCH = 64
"""Number of segments that are decoded at once."""


@dataclass(frozen=True, slots=True)
class ExtraStudy:
    """Settings of the study; all trainings share them.

    Attributes:
        model: folder of the model whose codes are decoded.
        extra_bytes: numbers of further bytes.
        recipe: recipe of each training.
        seed: random seed.
    """

    model: Path
    extra_bytes: Sequence[int]
    recipe: ShapeRecipe
    seed: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class MeasuredDrive:
    """Segments of a drive that no training saw.

    Attributes:
        name: name of the drive.
        known: segments with their codes and true grids.
        data: the same segments as inputs of the decoder.
    """

    name: str
    known: CodedGrids
    data: ShapeData

    @classmethod
    def drawn(cls, recording: Recording, extractor: Extractor, seed: int) -> "MeasuredDrive":
        """Return segments of a drive, at most `MEASURED`, drawn at random."""
        around = extractor.manifest.neighborhood
        rows = drawn_rows(len(recording.segments), MEASURED, seed)
        segments = recording.segments.take(rows)
        seen = None if around is None else recording.neighborhood(around)[rows]
        random = np.random.default_rng(seed)
        data = extracted(segments, np.arange(len(rows)), seen, extractor, random)
        grids = true_grids(data, np.arange(len(rows)), extractor.manifest.parameters.grid)
        return cls(recording.name, CodedGrids(segments, data.codes, grids), data)


def true_grids(data: ShapeData, rows: Int64, grid: tuple[int, int, int]) -> Bool:
    """Return the true grids of some segments, bool (rows, x, y, z)."""
    return data.occupied(rows, math.prod(grid)).reshape(-1, *grid).astype(bool)


def drawn_grids(data: ShapeData, grid: tuple[int, int, int], seed: int) -> CodedGrids:
    """Return codes and grids for the baseline, at most `KNOWN`; the points are not kept."""
    rows = drawn_rows(len(data), KNOWN, seed)
    return CodedGrids(NOTHING, data.codes[rows], true_grids(data, rows, grid))


def study_extra_bytes(
    training: Sequence[Recording], measured: Sequence[Recording], study: ExtraStudy
) -> Iterator[dict[str, Any]]:
    """Train a decoder for each number of further bytes, and yield the report after each.

    Args:
        training: drives that the decoders learn from; the baseline knows `KNOWN` segments of them.
        measured: drives that the decoders are measured on.
        study: settings.

    Raises:
        ValueError: two drives share a scan, or the training drives have no segments.
    """
    extractor = load_extractor(study.model)
    sources = [Source(each, 0, each.scans - 1) for each in training]
    data, parts = shape_data(sources, extractor, study.seed)
    drives = [MeasuredDrive.drawn(each, extractor, study.seed) for each in measured]
    learned = drawn_grids(data, extractor.manifest.parameters.grid, study.seed)
    report: dict[str, Any] = {
        "model_id": extractor.manifest.model_id,
        "training": [source.recording.name for source in parts],
        "segments": len(data),
        "epochs": study.recipe.epochs,
        "entropy_weight": study.recipe.entropy_weight,
        "seed": study.seed,
        "machine": machine(),
        "baseline": {
            drive.name: {"segments": len(drive.data)}
            | baseline_figures(drive.known, learned, extractor)
            for drive in drives
        },
        "rows": [],
    }
    for count in study.extra_bytes:
        report["rows"].append(trained_row(count, data, drives, extractor, study))
        yield report


def trained_row(
    count: int,
    data: ShapeData,
    drives: Sequence[MeasuredDrive],
    extractor: Extractor,
    study: ExtraStudy,
) -> dict[str, Any]:
    """Train a decoder with a number of further bytes, and return its figures on each drive."""
    manifest = extractor.manifest
    training, validation = data.split(VALIDATION_SHARE, SPLIT_SEED)
    validation = validation.take(np.arange(len(validation))[:: -(-len(validation) // VALIDATED)])
    torch.manual_seed(study.seed)
    own, parameters = own_part(study.model, manifest), manifest.parameters
    grid = parameters.grid
    encoder = ExtraEncoder(count, grid, own.shape[1] + FEATURES) if count else None
    network = ShapeNetwork(own, grid, parameters.grid_voxel, encoder)
    with tempfile.TemporaryDirectory() as folder:
        run = Run(Path(folder), study.seed)
        learn_shapes(network, manifest.quantizer, training, validation, run, study.recipe)
    overlaps = overlaps_by_threshold(network, manifest.quantizer, validation).mean(axis=0)
    threshold = float(THRESHOLDS[overlaps.argmax()])
    return {
        "extra_bytes": count,
        "validation_iou": round(float(overlaps.max()), 4),
        **run.cost(),
        "drives": {
            drive.name: drive_figures(network, drive, extractor, threshold) for drive in drives
        },
    }


def drive_figures(
    network: ShapeNetwork, drive: MeasuredDrive, extractor: Extractor, threshold: float
) -> dict[str, Any]:
    """Return the figures of reconstruction of a drive's segments."""
    segments = drive.known.segments
    grids, centers = decoded(network, drive.data, extractor, threshold)
    bearings = bearings_of(segments.sensors.astype(np.float64) - segments.centroids())
    placed = segments.centroids() + turned(centers.astype(np.float64), bearings)
    overlaps = overlap(grids, drive.known.grids)
    return {
        "segments": len(overlaps),
        "iou": rounded(overlaps),
        "iou_by_size": by_size(overlaps, segments.counts),
        "chamfer_m": chamfer(Shapes(grids, placed, bearings, network.voxel), segments),
    }


@torch.no_grad()
def decoded(
    network: ShapeNetwork, data: ShapeData, extractor: Extractor, threshold: float
) -> tuple[Bool, Float32]:
    """Return grids and centers from what a map holds: the number of points is unknown.

    Returns:
        Occupied voxels, bool (n, x, y, z); and the vector from each centroid to the grid's center,
        float32 (n, 3), meters, with the sensor on the positive x axis.
    """
    network.eval()
    voxels = network.basis.out_features
    grids, centers = [], []
    for rows in np.split(np.arange(len(data)), np.arange(BATCH, len(data), BATCH)):
        missing = np.zeros(len(rows), bool), np.ones(len(rows), bool)
        batch = batch_of(
            data, extractor.manifest.quantizer, rows, voxels, np.zeros(len(rows), np.int64), missing
        )
        logits, center = network.at(None, *batch.inputs, occupied=batch.grids)
        grids.append((logits >= threshold).numpy())
        centers.append(center.numpy())
    return np.concatenate(grids), np.concatenate(centers)
