"""Site constants: the logistic curve over normalized distances, fitted over all drives."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from sklearn.linear_model import LogisticRegression

from evaluation.recognition import retrieval
from placecell.core.types import Bool, Float64, Int8, Int64
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.site_calibration import SiteCalibration, SiteConstants, calibrate
from placecell.segmentation.recording import Recording
from training.data.training_set import TrainingSet


@dataclass(frozen=True, slots=True, eq=False)
class LabeledSite:
    """Segments of one drive, with their groups.

    Attributes:
        codes: int8 (n, code bytes).
        centroids: float64 (n, 3), meters, in the frame of the drive.
        captures: int64 (n,), number of the capture that each was seen in.
        groups: int64 (n,), group of each.
        held_out: bool (n,), whether the model was trained on other groups.
    """

    codes: Int8
    centroids: Float64
    captures: Int64
    groups: Int64
    held_out: Bool

    @classmethod
    def of_recording(cls, recording: Recording, codes: Int8) -> "LabeledSite":
        """Return a drive that no model was trained on, by the codes of its distinct segments."""
        chosen = np.flatnonzero(recording.distinct)
        return cls(
            codes,
            recording.segments.take(chosen).centroids(),
            recording.captures[chosen],
            recording.groups[chosen],
            np.ones(len(chosen), dtype=bool),
        )

    def calibration(self, quantizer: Quantizer, constants: SiteConstants) -> SiteCalibration:
        """Return the site with its cohort, without a fit of shift and scale."""
        site = calibrate(self.codes, self.centroids, self.captures, quantizer, constants)
        return replace(site, shift=0.0, scale=1.0)


def sites_of(learned: TrainingSet, held_out: TrainingSet, codes: Int8) -> list[LabeledSite]:
    """Return the drives of a split training set; one drive if the sources are unknown.

    Args:
        learned: groups that the model was trained on.
        held_out: other groups of the same drives.
        codes: codes of `learned`, then of `held_out`.
    """
    parts = (learned, held_out)
    drives = np.concatenate(
        [np.zeros(len(part), np.int64) if part.drives is None else part.drives for part in parts]
    )
    centroids = np.concatenate([part.segments.centroids() for part in parts])
    sensors = np.concatenate([part.segments.sensors for part in parts])
    groups = np.concatenate([learned.groups, held_out.groups + len(learned.group_sizes())])
    captures = np.unique(sensors, axis=0, return_inverse=True)[1].reshape(-1)
    apart = np.arange(len(drives)) >= len(learned)
    found = []
    for drive in np.unique(drives):
        rows = np.flatnonzero(drives == drive)
        found.append(
            LabeledSite(codes[rows], centroids[rows], captures[rows], groups[rows], apart[rows])
        )
    return found


def fit_site_constants(
    sites: Sequence[LabeledSite], quantizer: Quantizer
) -> tuple[SiteConstants, float] | None:
    """Fit the constants of a model on drives, each of which counts the same.

    The segments of each drive normalize its distances. Pairs of held-out groups then give the
    logistic curve.

    Returns:
        The constants, and the area under the ROC curve of the normalized distance over these
        pairs; None if no drive has held-out pairs of both kinds.
    """
    # With these constants, the log-likelihood ratio is the normalized distance, sign changed.
    constants = SiteConstants(slope=1.0, offset=0.0, mean=0.0, deviation=1.0)
    typical = [site.calibration(quantizer, constants).typical(site.codes) for site in sites]
    mean, deviation = map(float, np.mean(typical, axis=0))
    constants = replace(constants, mean=mean, deviation=deviation)
    scores, matches = [], []
    for site in sites:
        chosen = np.flatnonzero(site.held_out)
        drawn = retrieval.draw_pairs(site.groups[chosen], retrieval.PAIRS, np.random.default_rng(0))
        if min(map(len, drawn)):
            a, b = chosen[np.concatenate(drawn)].T
            normalized = site.calibration(quantizer, constants)
            scores.append(-normalized.pair_log_ratios(site.codes[a], site.codes[b]))
            matches.append(np.repeat([1.0, 0.0], [len(pairs) for pairs in drawn]))
    if not scores:
        return None
    normalized_distances, is_match = np.concatenate(scores), np.concatenate(matches)
    curve = LogisticRegression(C=1e6, max_iter=1000).fit(normalized_distances[:, None], is_match)
    slope, offset = -float(curve.coef_[0, 0]), float(curve.intercept_[0])
    auc = retrieval.area_under_roc(
        -normalized_distances[is_match > 0.5], -normalized_distances[is_match < 0.5]
    )
    return SiteConstants(slope, offset, mean, deviation), auc


def with_constants(folder: Path, constants: SiteConstants) -> Manifest:
    """Return the manifest of a model folder with these constants.

    Raises:
        ValueError: the model's pair classifier is no distance; its probabilities stay as they are.
    """
    manifest = Manifest.load(folder)
    kind = manifest.pair.get("kind")
    if kind != "distance":
        raise ValueError(
            f"The pair classifier of {folder} is of kind {kind!r}. Site constants replace a "
            "classifier of kind 'distance' only"
        )
    return replace(manifest, pair=manifest.pair | {"site": constants.as_dict()})
