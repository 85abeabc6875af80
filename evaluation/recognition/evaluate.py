"""Evaluation of recognition on a drive: `placecell evaluate`, by a named protocol (paper IV-B)."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import expit

from evaluation.calibration import calibration_figures, expected_calibration_error
from evaluation.machine import machine
from evaluation.recognition import retrieval as recognition
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.core.types import Float32, Float64, Int8, Int64
from placecell.descriptors.extractor import Extractor, load_extractor
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.pair_classifier import PairClassifier, load_pair_classifier
from placecell.descriptors.shipped_models import (
    BASELINE,
    DEFAULT_MODEL,
    MODELS_FOLDER,
    model_folder,
    shipped_models,
)
from placecell.descriptors.site_calibration import SiteCalibration, SiteConstants, calibrate
from placecell.segmentation.recording import Recording


def measure(
    extractor: Extractor,
    classifier: PairClassifier | None,
    segments: Segments,
    groups: Int64,
    seed: int,
    neighborhood: Float32 | None = None,
    captures: Int64 | None = None,
) -> dict[str, Any]:
    """Return all figures of one model; a figure that cannot be measured is None.

    With the captures of the segments, and a model that has site constants, match probabilities are
    calibrated by the segments themselves, as the service does with a map. No label is used. The
    figures by the model's pair classifier alone then have the suffix `_uncalibrated`.

    `expected_calibration_error` and `brier` are of the match probabilities of each segment with its
    25 nearest; None without a pair classifier. `pair_calibration_error` is that of the drawn pairs,
    with even odds.

    For a model with a neighborhood, `alone` has the figures of segments with an empty neighborhood;
    its `top1_in_map` searches such segments in a map of segments with their neighborhood.

    With the captures, `reranked_top1`, `reranked_top1_with_mate` and `reranked_cross_view_top1` are
    the figures after re-ranking (`placecell.descriptors.reranking`), for any model.

    `pair_auc` and `pair_accuracy` are those of `pair_by`: the model's pair classifier, or the
    distance if it has none. The figures by distance are always given too.
    """
    manifest = extractor.manifest
    codes = manifest.quantizer.encode(extractor.describe(segments, neighborhood))
    stored = manifest.quantizer.decode(codes)
    steps = manifest.quantizer.levels(codes).astype(np.float32)
    figures = {"model_id": manifest.model_id} | retrieval(steps, segments, groups, captures)
    if manifest.neighborhood is not None:
        nothing = np.zeros((len(segments), manifest.neighborhood.size), dtype=np.float32)
        alone = manifest.quantizer.rounded(extractor.describe(segments, nothing))
        in_map = recognition.retrieve(steps, groups, queries=alone)
        by_itself = retrieval(alone, segments, groups)
        figures["alone"] = {key: by_itself[key] for key in by_itself if key not in RERANKED}
        figures["alone"]["top1_in_map"] = mean(in_map.right)
    figures |= {"expected_calibration_error": None, "brier": None}
    site = site_of(manifest, codes, segments, captures)
    if classifier is not None:
        nearest = recognition.nearest_pairs(stored, groups, np.arange(len(groups)))
        uncalibrated = candidate_calibration(classifier.probabilities, codes, *nearest)
        figures |= uncalibrated
        if site is not None:
            figures |= {f"{name}_uncalibrated": uncalibrated[name] for name in CALIBRATION_FIGURES}
            figures |= candidate_calibration(site.pair_probabilities, codes, *nearest)
            figures["site_calibration"] = site.as_dict()
    positive, negative = recognition.draw_pairs(
        groups, recognition.PAIRS, np.random.default_rng(seed)
    )
    if not len(positive) or not len(negative):
        return figures | dict.fromkeys(PAIR_FIGURES) | {"pair_by": "distance"}
    near, far = (recognition.pair_distances(stored, pairs) for pairs in (positive, negative))
    auc = recognition.area_under_roc(-near, -far)
    accuracy = recognition.accuracy_at(manifest.pair_threshold, near, far)
    by_distance = {"pair_auc_by_distance": auc, "pair_accuracy_by_distance": accuracy}
    if classifier is None:
        paired = {"pair_auc": auc, "pair_accuracy": accuracy, "pair_by": "distance"}
    else:
        likely, unlikely = (
            classifier.probabilities(codes[pairs[:, 0]], codes[pairs[:, 1]])
            for pairs in (positive, negative)
        )
        paired = {
            "pair_auc": recognition.area_under_roc(likely, unlikely),
            "pair_accuracy": recognition.accuracy_at(
                -manifest.pair["threshold"], -likely, -unlikely
            ),
            "pair_by": "classifier",
        }
        if site is not None:
            paired |= with_site(site, codes, positive, negative) | {
                f"{name}_uncalibrated": paired[name] for name in ("pair_auc", "pair_accuracy")
            }
    return figures | paired | by_distance


def site_of(
    manifest: Manifest, codes: Int8, segments: Segments, captures: Int64 | None
) -> SiteCalibration | None:
    """Calibrate a drive by its segments; None without captures, or if the model has no constants.

    The groups, which are labels, are not used.
    """
    constants = SiteConstants.of(manifest)
    if captures is None or constants is None:
        return None
    return calibrate(codes, segments.centroids(), captures, manifest.quantizer, constants)


def with_site(
    site: SiteCalibration, codes: Int8, positive: Int64, negative: Int64
) -> dict[str, float]:
    """Return the figures of the drawn pairs, which are matches with even odds."""
    pairs = np.concatenate([positive, negative])
    ratios = site.pair_log_ratios(codes[pairs[:, 0]], codes[pairs[:, 1]])
    likely, unlikely = ratios[: len(positive)], ratios[len(positive) :]
    truth = np.repeat([1.0, 0.0], [len(positive), len(negative)])
    return {
        "pair_auc": recognition.area_under_roc(likely, unlikely),
        "pair_accuracy": recognition.accuracy_at(0.0, -likely, -unlikely),
        "pair_calibration_error": expected_calibration_error(expit(ratios), truth)[0],
    }


def retrieval(
    steps: Float32, segments: Segments, groups: Int64, captures: Int64 | None = None
) -> dict[str, Any]:
    """Return the figures of nearest neighbors, with the quantized distance of the service.

    The figures after re-ranking are None without captures.
    """
    found = recognition.retrieve(steps, groups)
    too_easy = recognition.seen_within(segments.sensors, recognition.CROSS_VIEW_METERS)
    crossed = recognition.retrieve(steps, groups, too_easy)
    return {
        "top1": mean(found.right),
        "top1_with_mate": mean(found.right[found.has_mate]),
        "cross_view_top1": mean(crossed.right[crossed.has_mate]),
        "cross_view_queries": int(crossed.has_mate.sum()),
        "recall_at_25": mean(found.recalled[found.has_mate]),
    } | reranked(found, crossed, segments, groups, captures)


RERANKED = ("reranked_top1", "reranked_top1_with_mate", "reranked_cross_view_top1")


def reranked(
    found: recognition.Retrieval,
    crossed: recognition.Retrieval,
    segments: Segments,
    groups: Int64,
    captures: Int64 | None,
) -> dict[str, float | None]:
    """Return the figures after re-ranking, of all candidates and across views."""
    if captures is None:
        return dict.fromkeys(RERANKED)
    centroids = segments.centroids().astype(np.float64)
    right, across = (
        recognition.reranked(each, groups, centroids, captures) for each in (found, crossed)
    )
    shares = mean(right), mean(right[found.has_mate]), mean(across[crossed.has_mate])
    return dict(zip(RERANKED, shares, strict=True))


def candidate_calibration(
    probabilities: Callable[[Int8, Int8], Float64], codes: Int8, matches: Int64, others: Int64
) -> dict[str, float | None]:
    """Return the calibration of the match probabilities of pairs; None if there are no pairs."""
    pairs = np.concatenate([matches, others])
    truth = np.repeat([1.0, 0.0], [len(matches), len(others)])
    stated = np.zeros(0)
    if len(pairs):
        stated = probabilities(codes[pairs[:, 0]], codes[pairs[:, 1]])
    figures = calibration_figures(stated, truth)
    # The older key has the same value.
    return {"candidate_calibration_error": figures["expected_calibration_error"]} | figures


CALIBRATION_FIGURES = ("expected_calibration_error", "brier")

PAIR_FIGURES = (
    "pair_auc",
    "pair_accuracy",
    "pair_auc_by_distance",
    "pair_accuracy_by_distance",
)


def mean(values: np.ndarray[Any, Any]) -> float | None:
    """Return the share of true values; None if there are no values."""
    return float(values.mean()) if len(values) else None


Opened = dict[str, tuple[Extractor, PairClassifier | None]]
"""Models by their name in the report."""


def open_models(models: Sequence[str] = (), models_folder: Path = MODELS_FOLDER) -> Opened:
    """Load the models to measure; the eigenvalue baseline is always among them.

    Args:
        models: names in `models/`, or paths; all shipped models unless given. The report names a
            path by its folder, or in full if another model has that name.
        models_folder: folder of the shipped models.

    Raises:
        ModelError: a model cannot be loaded.
    """
    folders = {BASELINE: models_folder / BASELINE}
    for given in models or shipped_models(models_folder):
        folder = model_folder(given, models_folder).resolve()
        if folder not in folders.values():
            folders[given if folder.name in folders else folder.name] = folder
    opened = {}
    for name, folder in folders.items():
        extractor = load_extractor(folder)
        opened[name] = (extractor, load_pair_classifier(folder, extractor.manifest))
    return opened


def evaluate(
    recording: Recording, scans: tuple[int, int] | None, models: Opened, seed: int = 0
) -> dict[str, Any]:
    """Measure extractors on a recording.

    Args:
        recording: segments of a drive.
        scans: first and last scan, both included; only groups completely within them count. None:
            all scans.
        models: models to measure.
        seed: random seed of the pairs.

    Returns:
        The report that `placecell evaluate --json` writes.

    Raises:
        ValueError: the scans hold no segments, or the segmentation had other parameters.
    """
    first, last = scans or (0, recording.scans - 1)
    if not len(recording.segments):
        raise ValueError(f"{recording.name}: the drive has no segments.")
    constants = replace(recording.parameters, frame_step=PROTOCOL_V1.frame_step)
    if constants != PROTOCOL_V1:
        raise ValueError(
            f"{recording.name}: the segments are not of protocol {PROTOCOL_V1.protocol}, so their "
            "figures cannot be compared. Prepare the drive again."
        )
    inside = recording.within(first, last)
    chosen = np.flatnonzero(inside & recording.distinct)
    if not len(chosen):
        raise ValueError(
            f"{recording.name}: no group lies completely within scans {first} to {last} "
            f"(the drive has 0 to {recording.scans - 1})."
        )
    segments, groups = recording.segments.take(chosen), recording.groups[chosen]
    extractors = {}
    for name, (extractor, classifier) in models.items():
        around = extractor.manifest.neighborhood
        seen = None if around is None else recording.neighborhood(around)[chosen]
        figures = measure(
            extractor, classifier, segments, groups, seed, seen, recording.captures[chosen]
        )
        figures["seen"] = extractor.manifest.has_seen(recording.scan_hashes[first : last + 1])
        extractors[name] = figures
    return {
        "drive": recording.name,
        "scans": [first, last],
        "segments_raw": int(inside.sum()),
        "segments": len(chosen),
        "groups": len(np.unique(groups)),
        "default": DEFAULT_MODEL,
        "extractors": extractors,
        "protocol": recording.parameters.protocol,
        "every": recording.parameters.frame_step,
        "skipped_scans": len(recording.skipped_scans),
        "dropped_points": recording.dropped_points,
        "machine": machine(),
        "seed": seed,
    }
