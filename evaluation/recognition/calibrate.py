"""Offline site calibration of drives and maps: `placecell calibrate`."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from placecell_client import CompactMap

from evaluation.recognition.evaluate import measure
from placecell.core.types import Float64, Int8, Int64
from placecell.descriptors.extractor import Extractor
from placecell.descriptors.pair_classifier import PairClassifier
from placecell.descriptors.site_calibration import SiteCalibration, SiteConstants, calibrate
from placecell.segmentation.recording import Recording

FIGURES = ("pair_accuracy", "pair_auc", "expected_calibration_error", "brier")


@dataclass(frozen=True, slots=True, eq=False)
class CalibratedSite:
    """Drive or map to calibrate.

    Attributes:
        name: name of the drive or of the map.
        codes: int8 (n, code bytes).
        calibration: its calibration.
        reliability: figures before and after the calibration, by the groups of a drive; empty for a
            map, which has no labels.
    """

    name: str
    codes: Int8
    calibration: SiteCalibration
    reliability: dict[str, dict[str, float | None]]


def constants_of(extractor: Extractor) -> SiteConstants:
    """Return the site constants of a model.

    Raises:
        ValueError: the model was published without them.
    """
    constants = SiteConstants.of(extractor.manifest)
    if constants is None:
        raise ValueError(
            f"Model {extractor.manifest.name!r} has no site constants ('pair.site' in its "
            "manifest). Add them with 'placecell calibrate --fit', or train the model again"
        )
    return constants


def calibrate_recording(
    recording: Recording, extractor: Extractor, classifier: PairClassifier | None
) -> CalibratedSite:
    """Calibrate a drive; its groups only check the result.

    Raises:
        ValueError: the model has no site constants.
    """
    constants_of(extractor)
    chosen = np.flatnonzero(recording.distinct)
    segments, groups = recording.segments.take(chosen), recording.groups[chosen]
    captures = recording.captures[chosen]
    codes = describe(recording, extractor)
    site = _calibrated(extractor, codes, segments.centroids(), captures)
    around = extractor.manifest.neighborhood
    seen = None if around is None else recording.neighborhood(around)[chosen]
    figures = measure(extractor, classifier, segments, groups, 0, seen, captures)
    before = {name: figures.get(f"{name}_uncalibrated", figures.get(name)) for name in FIGURES}
    after = {name: figures.get(name) for name in FIGURES}
    return CalibratedSite(recording.name, codes, site, {"before": before, "after": after})


def calibrate_map(name: str, content: CompactMap, extractor: Extractor) -> CalibratedSite:
    """Calibrate a map, as the service does.

    Raises:
        ValueError: another model made the map, or the model has no site constants.
    """
    if content.model_id != extractor.manifest.model_id:
        raise ValueError(
            f"{name} was made by model {content.model_id}, not {extractor.manifest.model_id}. "
            "Name its model with --model"
        )
    captures = content.frame_index.astype(np.int64)
    site = _calibrated(extractor, content.codes, content.centroids, captures)
    return CalibratedSite(name, content.codes, site, {})


def describe(recording: Recording, extractor: Extractor) -> Int8:
    """Return the codes of a drive's distinct segments, int8 (n, code bytes)."""
    chosen = np.flatnonzero(recording.distinct)
    around = extractor.manifest.neighborhood
    seen = None if around is None else recording.neighborhood(around)[chosen]
    described = extractor.describe(recording.segments.take(chosen), seen)
    return extractor.manifest.quantizer.encode(described)


def report(sites: Sequence[CalibratedSite], extractor: Extractor) -> dict[str, Any]:
    """Return the content of the calibration file.

    Its constants are those of the model, corrected by the sites: their own distances to free
    negatives and, where they are calibrated, their shift and scale. Each site counts the same. Maps
    that are too small for a calibration of their own begin with these constants.
    """
    stated = constants_of(extractor)
    typical = [site.calibration.typical(site.codes) for site in sites]
    usable = [each for each in typical if all(each)] or [(stated.mean, stated.deviation)]
    mean, deviation = map(float, np.mean(usable, axis=0))
    lines = [
        (each.scale * stated.slope, each.shift + each.scale * stated.offset)
        for each in (site.calibration for site in sites)
        if each.state == "calibrated"
    ] or [(stated.slope, stated.offset)]
    slope, offset = map(float, np.mean(lines, axis=0))
    return {
        "model_id": extractor.manifest.model_id,
        "site": SiteConstants(slope, offset, mean, deviation).as_dict(),
        "sites": [
            {"name": site.name, "calibration": site.calibration.as_dict()}
            | {"reliability": site.reliability or None}
            for site in sites
        ],
    }


def _calibrated(
    extractor: Extractor, codes: Int8, centroids: Float64, captures: Int64
) -> SiteCalibration:
    quantizer = extractor.manifest.quantizer
    return calibrate(codes, centroids, captures, quantizer, constants_of(extractor))
