"""Match probability: the probability that two descriptors show the same segment."""

import numpy as np

from placecell.core.types import Float64, Int8, Int64
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.site_calibration import SiteCalibration, SiteConstants, log_odds
from service.inference.model_registry import Model


def match_probabilities(model: Model, one: Int8, other: Int8) -> Float64:
    """Return the match probability of each pair of codes, float64 (n,).

    The model's classifier gives it. Without a classifier it is a normal distribution of descriptor
    distances; its deviation is the model's match distance, at least one quantizer step.

    Args:
        model: model that made all codes.
        one: first code of each pair, int8 (n, code bytes).
        other: second code of each pair, int8 (n, code bytes).
    """
    if model.classifier is not None:
        return model.classifier.probabilities(one, other)
    quantizer = model.manifest.quantizer
    levels = quantizer.levels(one).astype(np.float64) - quantizer.levels(other)
    distances = quantizer.step * np.linalg.norm(levels, axis=1)
    return np.asarray(np.exp(-0.5 * (distances / deviation_of(model)) ** 2))


def deviation_of(model: Model) -> float:
    """Return the standard deviation of the distance of a matching pair, without a classifier."""
    return max(model.manifest.pair_threshold, model.manifest.quantizer.step)


def default_site(manifest: Manifest) -> SiteCalibration | None:
    """Return the calibration of a site without segments; None without site constants."""
    constants = SiteConstants.of(manifest)
    if constants is None:
        return None
    nothing = np.zeros((0, manifest.code_bytes), dtype=np.int8)
    return SiteCalibration(constants, manifest.quantizer, nothing, segments=0)


class QueryComparison:
    """Queries that are compared with segments of one map, calibrated if the map can be."""

    def __init__(
        self, codes: Int8, model: Model, site: SiteCalibration | None, comparable: bool = False
    ) -> None:
        """Prepare the queries.

        Args:
            codes: codes of the queries, int8 (q, code bytes).
            model: model that made all codes.
            site: calibration of the map; None if the model has no site constants.
            comparable: make the probabilities comparable between maps, with the prior of the
                model's pair classifier in place of the map's own.
        """
        self._codes = codes
        self._model = model
        self._site = site
        self._queries = None if site is None else site.queries(codes)
        threshold = model.manifest.pair.get("threshold", 0.5)
        self._log_prior = log_odds(threshold) if comparable else None

    def probabilities(self, queries: Int64, others: Int8) -> Float64:
        """Return the match probability of each pair, float64 (n,).

        Args:
            queries: query of each pair, int64 (n,).
            others: codes of the map's segments, int8 (n, code bytes).
        """
        if self._site is None or self._queries is None:
            return match_probabilities(self._model, self._codes[queries], others)
        return self._site.probabilities(self._queries, queries, others, self._log_prior)
