"""Fit of a WGS 84 anchor to GNSS fixes."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.core.geodesy import GeoAnchor, to_geodetic
from placecell.core.types import Float64
from service.annotations.fitting import FitError, GnssFixes, fit_anchor

TRUTH = GeoAnchor(49.0112, 8.4243, 115.0, 37.0)


def fixes_of(
    positions: Float64, accuracy: float = 1.0, seed: int = 0, truth: GeoAnchor = TRUTH
) -> GnssFixes:
    """Fixes at positions in the map, with normal errors of their accuracy."""
    random = np.random.default_rng(seed)
    seen = positions + random.normal(0, accuracy, positions.shape)
    return GnssFixes(positions, to_geodetic(seen, truth), np.full(len(positions), accuracy))


def along(meters: float, count: int = 60, curve: float = 0.2) -> Float64:
    steps = np.linspace(0, meters, count)
    return np.column_stack([steps, curve * meters * np.sin(steps / meters * 3), 0.01 * steps])


def off_by(found: GeoAnchor, positions: Float64, truth: GeoAnchor = TRUTH) -> float:
    """Largest horizontal distance of the positions by two anchors, meters."""
    one, other = to_geodetic(positions, found), to_geodetic(positions, truth)
    east = (one[:, 1] - other[:, 1]) * 111_320 * np.cos(np.radians(truth.lat))
    return float(np.hypot(east, (one[:, 0] - other[:, 0]) * 111_200).max())


def test_exact_fixes_give_the_anchor() -> None:
    positions = along(400.0)
    fit = fit_anchor(replace(fixes_of(positions, 1e-9), accuracies=np.full(60, 1.0)))
    # The fitted point is elsewhere, where north has turned a little.
    assert fit.anchor.yaw_deg == pytest.approx(37.0, abs=3e-3)
    assert off_by(fit.anchor, positions) < 0.01
    assert fit.is_inlier.all()
    assert fit.residuals.max() < 0.01
    np.testing.assert_allclose(
        to_geodetic(positions, fit.anchor)[:, 2], to_geodetic(positions, TRUTH)[:, 2], atol=0.1
    )


@pytest.mark.parametrize("yaw", [-179.5, -90.0, 0.0, 91.3, 179.9])
@pytest.mark.parametrize("share", [0.0, 0.3])
def test_noisy_fixes_with_outliers(yaw: float, share: float) -> None:
    truth = replace(TRUTH, yaw_deg=yaw)
    positions = along(300.0)
    fixes = fixes_of(positions, 1.5, truth=truth)
    wrong = np.random.default_rng(5).permutation(60)[: int(60 * share)]
    places = fixes.places.copy()
    places[wrong, 0] += 0.0006  # 67 m to the north, all alike
    fit = fit_anchor(replace(fixes, places=places))
    assert abs((fit.anchor.yaw_deg - yaw + 180) % 360 - 180) < 3 * fit.yaw_deviation_deg
    assert off_by(fit.anchor, positions, truth) < 2.5
    assert not fit.is_inlier[wrong].any()
    assert np.count_nonzero(fit.is_inlier) >= 0.9 * (60 - len(wrong))
    assert fit.residuals[wrong].min(initial=100.0) > 50
    assert 0.2 < fit.anchor.accuracy < 3.0


def test_map_with_large_coordinates() -> None:
    shift = np.array([458_000.0, 5_428_000.0, 100.0])
    truth = replace(TRUTH, position=tuple(shift.tolist()))
    positions = along(400.0) + shift
    fit = fit_anchor(fixes_of(positions, 0.5, truth=truth))
    assert off_by(fit.anchor, positions, truth) < 1.0
    assert np.abs(np.array(fit.anchor.position) - shift).max() < 500


def test_direction_of_north_far_from_the_middle() -> None:
    # Over 20 km at 60 degrees of latitude, north turns by 0.3 degrees.
    truth = replace(TRUTH, lat=60.0)
    positions = np.array([[x, y, 0.0] for x in (0.0, 10_000.0, 20_000.0) for y in (0.0, 3_000.0)])
    fit = fit_anchor(fixes_of(positions, 0.1, truth=truth))
    assert off_by(fit.anchor, positions, truth) < 2.0


def test_fixes_without_heights() -> None:
    fixes = fixes_of(along(300.0), 1.0)
    places = fixes.places.copy()
    places[:, 2] = np.nan
    fit = fit_anchor(replace(fixes, places=places))
    assert fit.anchor.height == 0.0
    assert off_by(fit.anchor, along(300.0)) < 2.0


@pytest.mark.parametrize(
    ("positions", "accuracy", "message"),
    [
        (along(300.0)[:2], 1.0, "2 fixes; expected 3 or more"),
        (along(3.0), 2.0, "do not determine the yaw"),
        (np.zeros((50, 3)), 1.0, "do not determine the yaw"),
        (along(20.0, 500), 2.0, "do not determine the yaw"),
    ],
)
def test_fixes_that_determine_no_yaw_are_refused(
    positions: Float64, accuracy: float, message: str
) -> None:
    with pytest.raises(FitError, match=message):
        fit_anchor(fixes_of(positions, accuracy))


def test_fixes_of_another_map_are_refused() -> None:
    fixes = fixes_of(along(300.0), 1.0)
    other = np.random.default_rng(3).uniform(-300, 300, (60, 3))
    with pytest.raises(FitError, match=r"Only \d+ of 60 fixes agree"):
        fit_anchor(replace(fixes, positions=other))


def test_fixes_across_the_date_line() -> None:
    truth = replace(TRUTH, lat=-17.0, lon=180.0 - 1e-6)
    positions = along(300.0)
    fit = fit_anchor(fixes_of(positions, 0.5, truth=truth))
    assert fit.is_inlier.mean() > 0.9
    assert abs(fit.anchor.lon) > 179.9
