"""Site calibration: match probabilities that carry over to any sensor and any site.

Distances between descriptors differ from sensor to sensor and from site to site, so one threshold
does not fit all. Two corrections need no labels:

1. Each query is compared with a cohort of map segments that stand apart from each other, so that
   at most one of them can be a match. These are free negatives. The distance of a pair is then
   expressed in standard deviations from the mean of the query's nearest free negatives. Speaker
   verification calls this adaptive score normalization (Matejka et al. 2017, *Analysis of Score
   Normalization in Multilingual Speaker Recognition*).
2. Views of one object in the map are pseudo-positives: their centroids nearly coincide, and their
   viewpoints differ. With the free negatives they correct the slope and the offset of the logistic
   curve. The curve of the training is the prior, so few data change little.

The result is the log-likelihood ratio of a pair. The match probability also depends on the share of
the map's segments that show the query's object: its views in the map, divided by all segments.
"""

from dataclasses import asdict, dataclass, replace
from functools import cached_property
from typing import Any, Literal

import numpy as np
from scipy.spatial import cKDTree
from scipy.special import expit

from placecell.core.types import Float32, Float64, Int8, Int64
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.quantizer import Quantizer

SAMPLE, BLOCKS = 1 << 13, 8
"""Largest number of segments that a calibration reads, and the runs of rows that they come from.
Consecutive rows are consecutive captures, which see the same objects."""

MOST_STEPPED = 32
"""Number of segments up to which a growing site is calibrated at each segment; see `milestone`."""

COHORT = 256
"""Largest number of segments that every query is compared with."""

APART = 2.0
"""Smallest distance between two segments of the cohort that different captures saw, meters."""

NEAREST_SHARE = 0.2
"""Share of the cohort, the nearest, that normalizes the distance of a query. The single nearest one
is left out, because it may show the same object."""

MEAN_PRIOR, DEVIATION_PRIOR = 1.0, 8.0
"""Weight of the training's mean and deviation, in segments of the cohort."""

QUERIES = 128
"""Largest number of map segments that serve as queries of the fit."""

SAME_OBJECT = 0.75
"""Distance of centroids within which two captures show one object, meters: half of the distance
within which the protocol groups segments."""

OTHER_OBJECT = 10.0
"""Distance of centroids beyond which two segments are different objects, meters."""

NEGATIVES_PER_POSITIVE = 30.0
"""Total weight of the free negatives in the fit, per pseudo-positive. Candidates are mixed so."""

SHIFT_PRIOR, SCALE_PRIOR = 1.0, 0.2
"""Standard deviations of the priors of shift and scale."""

ENOUGH_NEGATIVES, ENOUGH_POSITIVES = 64, 32
"""Size of the cohort, and number of queries with pseudo-positives, that the fit needs."""

SEED = 0

CalibrationState = Literal["default", "collecting", "calibrated"]


@dataclass(frozen=True, slots=True)
class SiteConstants:
    """Constants of a model, fitted at its training over all sensors (`pair.site` in the manifest).

    Attributes:
        slope: decrease of the log-likelihood ratio per standard deviation of distance.
        offset: log-likelihood ratio at the mean distance of the nearest free negatives.
        mean: that mean distance in training, decoded.
        deviation: the standard deviation of these distances in training, decoded.
    """

    slope: float
    offset: float
    mean: float
    deviation: float

    @classmethod
    def of(cls, manifest: Manifest) -> "SiteConstants | None":
        """Return the constants of a model; None for a model that was published without them."""
        stated = manifest.pair.get("site")
        return None if stated is None else cls(**stated)

    def as_dict(self) -> dict[str, float]:
        """Return the entry of the manifest."""
        return asdict(self)


@dataclass(frozen=True, slots=True, eq=False)
class QueryDistances:
    """Distances of q queries to the nearest free negatives of a site, decoded.

    Attributes:
        levels: levels of the queries, float32 (q, d).
        squared: squared distances to the cohort, in levels, float32 (q, cohort).
        means: mean distance of each query, float64 (q,).
        deviations: standard deviation of the distances of each query, float64 (q,).
    """

    levels: Float32
    squared: Float32
    means: Float64
    deviations: Float64


@dataclass(frozen=True, eq=False)
class SiteCalibration:
    """Calibration of the match probabilities of one site, which is a map or a drive.

    Attributes:
        constants: constants of the model.
        quantizer: quantizer of the model.
        cohort: codes of the cohort, int8 (n, code bytes).
        segments: number of segments of the site.
        read: number of segments that the calibration was computed from.
        negatives: number of free negative pairs of the fit.
        positives: number of queries of the fit that have pseudo-positives.
        views: mean number of other views of a segment's object at the site.
        shift: correction of the log-likelihood ratio: shift + scale * ratio.
        scale: see `shift`.
    """

    constants: SiteConstants
    quantizer: Quantizer
    cohort: Int8
    segments: int
    read: int = 0
    negatives: int = 0
    positives: int = 0
    views: float = 0.0
    shift: float = 0.0
    scale: float = 1.0

    @property
    def state(self) -> CalibrationState:
        """Return how far the site's own data determine the calibration.

        `default`: by the constants of the model. `collecting`: distances are normalized by the
        cohort. `calibrated`: shift and scale are fitted, too.
        """
        if len(self.cohort) < 2:
            return "default"
        enough = len(self.cohort) >= ENOUGH_NEGATIVES and self.positives >= ENOUGH_POSITIVES
        return "calibrated" if enough else "collecting"

    @property
    def log_prior(self) -> float:
        """Log odds that a segment of the site shows the object of a query that it has seen."""
        return float(np.log(max(self.views, 1.0) / max(self.segments, 1)))

    def as_dict(self) -> dict[str, Any]:
        """Return the values that reports and the service show."""
        return {
            "state": self.state,
            "segments": self.segments,
            "read": self.read,
            "cohort": len(self.cohort),
            "negatives": self.negatives,
            "positives": self.positives,
            "views": self.views,
            "shift": self.shift,
            "scale": self.scale,
            "log_prior": self.log_prior,
        }

    def typical(self, codes: Int8) -> tuple[float, float]:
        """Return the mean and the deviation of the distances to the nearest free negatives.

        Both are averages over these queries, for `SiteConstants`; (0, 0) without free negatives.
        """
        nearest = self._nearest(self.queries(codes).squared)
        if not nearest.size:
            return 0.0, 0.0
        return float(nearest.mean()), float(np.sqrt(nearest.var(axis=1).mean()))

    @cached_property
    def _cohort_levels(self) -> Float32:
        return self.quantizer.levels(self.cohort).astype(np.float32)

    def queries(self, codes: Int8) -> QueryDistances:
        """Compare queries with the cohort, each independent of the others.

        Args:
            codes: codes of the queries, int8 (q, code bytes).
        """
        levels = self.quantizer.levels(codes).astype(np.float32)
        # Levels are integers, so float32 products are exact and do not depend on the batch.
        squared = _squared(levels)[:, None] + _squared(self._cohort_levels)[None]
        squared -= 2 * levels @ self._cohort_levels.T
        nearest = self._nearest(squared)
        count = nearest.shape[1]
        means, variances = np.zeros((2, len(codes)))
        if count:
            means, variances = nearest.mean(axis=1), nearest.var(axis=1)
        constants = self.constants
        return QueryDistances(
            levels,
            squared,
            _shrunk(means, constants.mean, count, MEAN_PRIOR),
            np.sqrt(_shrunk(variances, constants.deviation**2, count, DEVIATION_PRIOR)),
        )

    def _nearest(self, squared: Float32) -> Float64:
        """Return the distances to the nearest free negatives, (q, k), without the nearest one."""
        count = min(max(2, round(NEAREST_SHARE * len(self.cohort))), len(self.cohort) - 1)
        if count < 1:
            return np.zeros((len(squared), 0))
        nearest = np.sort(np.partition(squared, count, axis=1)[:, : count + 1], axis=1)[:, 1:]
        return np.asarray(self.quantizer.step * np.sqrt(nearest.astype(np.float64)))

    def log_ratios(self, queries: QueryDistances, rows: Int64, others: Int8) -> Float64:
        """Return the log-likelihood ratio of each pair, float64 (n,): above 0 for a match.

        It compares a match with a random pair of segments.

        Args:
            queries: the queries, compared with the cohort.
            rows: query of each pair, int64 (n,).
            others: codes of the other segment of each pair, int8 (n, code bytes).
        """
        apart = self.quantizer.levels(others).astype(np.float32) - queries.levels[rows]
        return self.log_ratios_of(queries, rows, _squared(apart))

    def log_ratios_of(self, queries: QueryDistances, rows: Int64, squared: Float32) -> Float64:
        """Return the log-likelihood ratio of pairs by their squared distances in levels."""
        distances = self.quantizer.step * np.sqrt(squared.astype(np.float64))
        scores = (distances - queries.means[rows]) / queries.deviations[rows]
        ratio = self.constants.offset - self.constants.slope * scores
        return np.asarray(self.shift + self.scale * ratio)

    def probabilities(
        self,
        queries: QueryDistances,
        rows: Int64,
        others: Int8,
        log_prior: float | None = None,
    ) -> Float64:
        """Return the match probability of each pair, float64 (n,); see `log_ratios`.

        Args:
            queries: the queries, compared with the cohort.
            rows: query of each pair, int64 (n,).
            others: codes of the other segment of each pair, int8 (n, code bytes).
            log_prior: log odds of a match before the comparison; None: those of the site.
        """
        prior = self.log_prior if log_prior is None else log_prior
        return np.asarray(expit(self.log_ratios(queries, rows, others) + prior))

    def pair_log_ratios(self, a: Int8, b: Int8) -> Float64:
        """Return the log-likelihood ratio of each pair of codes; the first one is the query."""
        queries, rows = np.unique(a, axis=0, return_inverse=True)
        return self.log_ratios(self.queries(queries), rows.reshape(-1), b)

    def pair_probabilities(self, a: Int8, b: Int8) -> Float64:
        """Return the match probability of each pair of codes; the first one is the query."""
        return np.asarray(expit(self.pair_log_ratios(a, b) + self.log_prior))


def milestone(count: int) -> int:
    """Return the number of a growing site's first segments that its calibration reads.

    It is the largest step of a series in which each step is a fifth larger. So a site that grows
    segment by segment keeps its calibration until it has grown by a fifth.
    """
    step = MOST_STEPPED
    if count <= step:
        return count
    while (larger := step + step // 5) <= count:
        step = larger
    return step


def sample_rows(count: int) -> Int64:
    """Return the rows that a calibration reads, of a site with this number of segments."""
    if count <= SAMPLE:
        return np.arange(count)
    run = SAMPLE // BLOCKS
    starts = np.linspace(0, count - run, BLOCKS).astype(np.int64)
    return np.asarray((starts[:, None] + np.arange(run)).ravel())


def calibrate(
    codes: Int8,
    centroids: Float64,
    captures: Int64,
    quantizer: Quantizer,
    constants: SiteConstants,
    segments: int | None = None,
) -> SiteCalibration:
    """Calibrate a site by its own segments, without labels.

    Args:
        codes: codes of the segments, or of `sample_rows`, int8 (n, code bytes).
        centroids: their centroids, float64 (n, 3), meters, in one frame.
        captures: number of the capture that each was seen in, int64 (n,).
        quantizer: quantizer of the model.
        constants: constants of the model.
        segments: number of segments of the whole site; None: n.
    """
    order = np.random.default_rng(SEED).permutation(len(codes))
    cohort = _cohort(centroids, captures, order)
    whole = len(codes) if segments is None else segments
    site = SiteCalibration(constants, quantizer, codes[cohort], whole, len(codes))
    if site.state == "default":
        return site
    asked = order[:QUERIES]
    queries = site.queries(codes[asked])
    row, other = _views(centroids, captures, asked)
    far, away = _negatives(centroids, captures, asked, cohort)
    views = np.bincount(row, minlength=len(asked))
    site = replace(
        site,
        negatives=len(far),
        positives=int(np.count_nonzero(views)),
        views=float(views.mean()),
    )
    if site.state != "calibrated":
        return site
    positive = site.log_ratios(queries, row, codes[other])
    negative = site.log_ratios_of(queries, far, queries.squared[far, away])
    # Each query counts once, however many views its object has.
    weights = np.concatenate(
        [
            1 / views[row],
            np.full(len(negative), NEGATIVES_PER_POSITIVE * site.positives / len(negative)),
        ]
    )
    shift, scale = fit_line(
        np.concatenate([positive, negative]),
        np.repeat([1.0, 0.0], [len(positive), len(negative)]),
        weights,
        -float(np.log(NEGATIVES_PER_POSITIVE)),
    )
    return replace(site, shift=shift, scale=scale)


def fit_line(
    ratios: Float64, matches: Float64, weights: Float64, log_odds: float
) -> tuple[float, float]:
    """Return shift and scale of log-likelihood ratios by regularized logistic regression.

    Args:
        ratios: log-likelihood ratios, float64 (n,).
        matches: 1 for matches and 0 for non-matches, float64 (n,).
        weights: weight of each pair, float64 (n,).
        log_odds: log odds of a match among the weighted pairs.
    """
    features = np.stack([np.ones_like(ratios), ratios], axis=1)
    prior = np.array([0.0, 1.0])
    precision = np.array([SHIFT_PRIOR, SCALE_PRIOR]) ** -2.0
    line = prior.copy()
    for _ in range(30):
        stated = expit(features @ line + log_odds)
        slope = features.T @ (weights * (stated - matches)) + precision * (line - prior)
        curvature = (features * (weights * stated * (1 - stated))[:, None]).T @ features
        step = np.linalg.solve(curvature + np.diag(precision), slope)
        line -= step
        if np.abs(step).max() < 1e-6:
            break
    return float(line[0]), float(line[1])


def log_odds(probability: float) -> float:
    """Return the log odds of a probability, which is clipped away from 0 and 1."""
    clipped = min(max(probability, 1e-6), 1 - 1e-6)
    return float(np.log(clipped / (1 - clipped)))


def _squared(levels: Float32) -> Float32:
    return np.asarray(np.einsum("ij,ij->i", levels, levels))


def _shrunk(values: Float64, prior: float, count: int, weight: float) -> Float64:
    return np.asarray((count * values + weight * prior) / (count + weight))


def _cohort(centroids: Float64, captures: Int64, order: Int64) -> Int64:
    """Return the cohort: segments in this order that are no further view of an earlier one."""
    rows = order[: 4 * COHORT]
    places, captures = centroids[rows], captures[rows]
    free = np.ones(len(rows), dtype=bool)
    kept: list[int] = []
    while free.any() and len(kept) < COHORT:
        index = int(free.argmax())
        kept.append(index)
        apart = places - places[index]
        near = np.einsum("ij,ij->i", apart, apart) < APART**2
        free &= ~(near & (captures != captures[index]))
        free[index] = False
    return rows[np.array(kept, dtype=np.int64)]


def _views(centroids: Float64, captures: Int64, asked: Int64) -> tuple[Int64, Int64]:
    """Return the pairs of a query and another view of its object: index in `asked`, and segment."""
    near = cKDTree(centroids).query_ball_point(centroids[asked], SAME_OBJECT, return_sorted=True)
    row = np.repeat(np.arange(len(asked)), [len(each) for each in near])
    other = np.concatenate([*near, []]).astype(np.int64)
    moved = captures[asked[row]] != captures[other]
    return row[moved], other[moved]


def _negatives(
    centroids: Float64, captures: Int64, asked: Int64, cohort: Int64
) -> tuple[Int64, Int64]:
    """Return the pairs of a query and a segment of the cohort that is surely another object.

    Two segments of one capture are never the same, and neither are two that are far apart.
    """
    apart = np.linalg.norm(centroids[asked][:, None] - centroids[cohort][None], axis=2)
    same_capture = captures[asked][:, None] == captures[cohort][None]
    is_other = (apart > OTHER_OBJECT) | (same_capture & (asked[:, None] != cohort[None]))
    row, other = np.nonzero(is_other)
    return row, other
