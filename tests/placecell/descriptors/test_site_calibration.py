"""Calibration of a site by its own segments: by hand, without labels, and with few data."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import expit

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float64, Int8, Int64
from placecell.descriptors.manifest import Manifest, preprocessing_of
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.site_calibration import (
    BLOCKS,
    SAMPLE,
    SiteCalibration,
    SiteConstants,
    calibrate,
    fit_line,
    sample_rows,
)

QUANTIZER = Quantizer(0.5)
CONSTANTS = SiteConstants(slope=2.0, offset=1.0, mean=3.0, deviation=0.5)


def drive(
    objects: int, views: int, seed: int = 0, scale: float = 1.0
) -> tuple[Int8, Float64, Int64, Int64]:
    """Codes, centroids, captures and objects; each capture sees every object once."""
    random = np.random.default_rng(seed)
    places = np.stack([np.arange(objects) * 5.0, np.zeros(objects), np.zeros(objects)], axis=1)
    appearance = random.normal(size=(objects, 16)) * 20
    rows = np.tile(np.arange(objects), views)
    codes = (appearance[rows] + random.normal(size=(len(rows), 16)) * 6) * scale
    jitter = random.normal(size=(len(rows), 3)) * 0.05
    captures = np.repeat(np.arange(views), objects)
    return codes.round().clip(-127, 127).astype(np.int8), places[rows] + jitter, captures, rows


def site_of(objects: int, views: int, scale: float = 1.0) -> SiteCalibration:
    codes, centroids, captures, _ = drive(objects, views, scale=scale)
    return calibrate(codes, centroids, captures, QUANTIZER, CONSTANTS)


def test_normalization_by_hand() -> None:
    # The query is at 0. Decoded, the cohort is at 1, 2, 3, ..., 10; a fifth of 10 are 2 segments.
    # The nearest one is left out, so 2 and 3 normalize.
    cohort = np.arange(2, 22, 2, dtype=np.int8)[:, None]
    site = SiteCalibration(CONSTANTS, QUANTIZER, cohort, segments=10)
    queries = site.queries(np.zeros((1, 1), dtype=np.int8))
    mean = (2 * 2.5 + 1 * CONSTANTS.mean) / 3
    variance = (2 * 0.25 + 8 * CONSTANTS.deviation**2) / 10
    assert queries.means == pytest.approx([mean])
    assert queries.deviations == pytest.approx([variance**0.5])
    ratios = site.log_ratios(queries, np.array([0, 0]), np.array([[1], [-6]], dtype=np.int8))
    expected = [1.0 - 2.0 * (distance - mean) / variance**0.5 for distance in (0.5, 3.0)]
    assert ratios == pytest.approx(expected)
    corrected = replace(site, shift=0.5, scale=2.0, views=5.0)
    assert corrected.log_prior == pytest.approx(np.log(5 / 10))
    stated = corrected.probabilities(queries, np.array([0]), np.array([[1]], dtype=np.int8))
    assert stated == pytest.approx(expit(0.5 + 2.0 * expected[0] + np.log(0.5)))


def test_site_without_segments_uses_the_constants_of_the_model() -> None:
    none = np.zeros((0, 1), dtype=np.int8)
    for codes in (none, none[:0].copy()):
        site = calibrate(codes, np.zeros((0, 3)), np.zeros(0, np.int64), QUANTIZER, CONSTANTS)
        assert (site.state, site.negatives, site.positives) == ("default", 0, 0)
    one = np.array([[3]], dtype=np.int8)
    site = calibrate(one, np.zeros((1, 3)), np.zeros(1, np.int64), QUANTIZER, CONSTANTS)
    assert site.state == "default"
    queries = site.queries(one)
    assert queries.means == pytest.approx([CONSTANTS.mean])
    assert queries.deviations == pytest.approx([CONSTANTS.deviation])
    assert site.probabilities(queries, np.array([0]), one) == pytest.approx(
        expit(1.0 + 2.0 * 3.0 / 0.5)
    )


def test_map_of_one_capture_normalizes_distances_but_fits_nothing() -> None:
    site = site_of(objects=25, views=1)
    assert site.state == "collecting"
    assert len(site.cohort) == 25
    assert (site.positives, site.negatives) == (0, 25 * 24)
    assert (site.shift, site.scale, site.views) == (0.0, 1.0, 0.0)


def test_map_of_fifty_segments_is_collecting() -> None:
    site = site_of(objects=10, views=5)
    assert site.state == "collecting"
    assert (site.shift, site.scale) == (0.0, 1.0)
    assert site.views == pytest.approx(4.0)


def test_large_site_is_calibrated_and_counts_views() -> None:
    site = site_of(objects=80, views=4)
    assert site.state == "calibrated"
    assert site.views == pytest.approx(3.0)
    assert len(site.cohort) == 80
    assert site.positives == 128
    assert (site.shift, site.scale) != (0.0, 1.0)


def test_cohort_has_one_view_of_each_object() -> None:
    codes, centroids, captures, objects = drive(objects=40, views=6)
    site = calibrate(codes, centroids, captures, QUANTIZER, CONSTANTS)
    rows = [np.flatnonzero((codes == code).all(axis=1))[0] for code in site.cohort]
    assert sorted(objects[rows]) == list(range(40))


@pytest.mark.parametrize("scale", [0.4, 0.7, 1.0])
def test_accuracy_does_not_depend_on_the_scale_of_distances(scale: float) -> None:
    constants = replace(CONSTANTS, offset=-3.0, mean=40.0)
    codes, centroids, captures, objects = drive(objects=80, views=4, scale=scale)
    site = calibrate(codes, centroids, captures, QUANTIZER, constants)
    a, b = np.random.default_rng(1).integers(0, len(codes), (2, 4000))
    b[:2000] = (a[:2000] + 80) % len(codes)  # another view of the same object
    apart = a != b
    is_match = (objects[a] == objects[b])[apart]
    told = site.pair_log_ratios(codes[a[apart]], codes[b[apart]]) > 0
    assert np.mean(told == is_match) > 0.97


def test_calibration_uses_no_labels_and_no_order_of_requests() -> None:
    codes, centroids, captures, _ = drive(objects=80, views=4)
    one = calibrate(codes, centroids, captures, QUANTIZER, CONSTANTS)
    other = calibrate(codes.copy(), centroids, captures + 1000, QUANTIZER, CONSTANTS)
    assert one.as_dict() == other.as_dict()
    assert (one.cohort == other.cohort).all()
    # A query's probability does not depend on the other queries.
    queries = one.queries(codes)
    rows = np.arange(len(codes))
    together = one.probabilities(queries, rows, codes[::-1])
    for row in (0, 57, 300):
        alone = one.queries(codes[row : row + 1])
        single = one.probabilities(alone, np.zeros(1, np.int64), codes[::-1][row : row + 1])
        assert single[0] == together[row]


def test_negatives_are_of_one_capture_or_far_apart() -> None:
    # Two captures of 3 objects, 5 m apart: only pairs of one capture are certain, or at 10 m.
    codes, centroids, captures, _ = drive(objects=3, views=2)
    site = calibrate(codes, np.round(centroids), captures, QUANTIZER, CONSTANTS)
    assert len(site.cohort) == 3
    # Each of the 6 queries has the 2 other objects in its capture, or the object at 10 m exactly,
    # which is not beyond 10 m.
    kept = [np.flatnonzero((codes == code).all(axis=1))[0] for code in site.cohort]
    expected = sum(
        captures[query] == captures[row] and query != row for query in range(6) for row in kept
    )
    assert site.negatives == expected


def test_fit_of_a_line_by_hand() -> None:
    # Without data the prior stays; with many data it yields to them.
    assert fit_line(np.zeros(0), np.zeros(0), np.zeros(0), 0.0) == (0.0, 1.0)
    ratios = np.repeat([-1.0, 1.0], 2)
    matches = np.array([0.0, 1.0, 0.0, 1.0])
    # Truth: -1 is a match in one of four, 1 in three of four; log 3 at both.
    weights = np.array([3.0, 1.0, 1.0, 3.0]) * 1e6
    shift, scale = fit_line(ratios, matches, weights, 0.0)
    assert shift == pytest.approx(0.0, abs=1e-4)
    assert scale == pytest.approx(np.log(3), abs=1e-3)
    # The odds of the weighted pairs are taken out.
    shift, _ = fit_line(ratios, matches, weights, 0.7)
    assert shift == pytest.approx(-0.7, abs=1e-3)


def test_large_site_is_read_in_runs_of_rows() -> None:
    assert (sample_rows(SAMPLE) == np.arange(SAMPLE)).all()
    rows = sample_rows(10 * SAMPLE)
    assert len(rows) == len(np.unique(rows)) == SAMPLE
    assert (np.diff(rows) != 1).sum() == BLOCKS - 1
    assert (rows[0], rows[-1]) == (0, 10 * SAMPLE - 1)
    codes, centroids, captures, _ = drive(objects=80, views=4)
    site = calibrate(codes, centroids, captures, QUANTIZER, CONSTANTS, segments=32_000)
    assert site.log_prior == pytest.approx(np.log(3 / 32_000))


def test_constants_of_a_manifest_and_of_an_old_one() -> None:
    manifest = Manifest(
        name="tiny",
        method="group",
        network="",
        dimension=1,
        quantizer=QUANTIZER,
        preprocessing=preprocessing_of(PROTOCOL_V1),
        pair={"kind": "distance", "threshold": 0.5},
    )
    assert SiteConstants.of(manifest) is None
    stated = json.loads(json.dumps(CONSTANTS.as_dict()))
    new = replace(manifest, pair=manifest.pair | {"site": stated})
    assert SiteConstants.of(new) == CONSTANTS
    assert new.model_id == manifest.model_id
