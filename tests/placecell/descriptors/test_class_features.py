"""Tests of the features of a segment's geometry, on simple shapes."""

from pathlib import Path

import numpy as np
import pytest

from placecell.core.segments import Segments
from placecell.core.types import Float32
from placecell.descriptors.class_features import (
    FEATURES,
    HEIGHTS,
    SURFACES,
    VERSION,
    class_features,
)
from placecell.descriptors.class_views import ACROSS, ALONG, LAYER, UP, VIEWS

FIXTURES = Path(__file__).parents[2] / "fixtures"

SENSOR = np.array([[0.0, 0.0, 1.7]], np.float32)


def wall(rng: np.random.Generator) -> Float32:
    """Return points of a wall 4 m long and 2 m high, 10 m ahead of the sensor."""
    along, up = rng.uniform(-2, 2, 500), rng.uniform(0, 2, 500)
    return np.column_stack([np.full(500, 10.0), along, up]).astype(np.float32)


def cloud(rng: np.random.Generator) -> Float32:
    return rng.uniform([9, -1, 0], [11, 1, 2], (500, 3)).astype(np.float32)


def of(points: Float32) -> dict[str, float]:
    """Return the local surfaces in cells of 1 m."""
    found = class_features(Segments.of([points], SENSOR))[0]
    first = 17 + 2 * (len(HEIGHTS) + 1) + len(SURFACES) + 2
    return dict(zip(SURFACES, found[first:].tolist(), strict=False))


def test_local_surfaces_are_those_of_numpy() -> None:
    rng = np.random.default_rng(4)
    points = cloud(rng) * np.array([0.1, 0.3, 0.2], np.float32)  # all in a few cells
    centered = points.astype(np.float64) - points.mean(axis=0, dtype=np.float64)
    cells = np.floor(centered)
    expected = dict.fromkeys(SURFACES, 0.0)
    for cell in np.unique(cells, axis=0):
        inside = centered[(cells == cell).all(axis=1)]
        values, vectors = np.linalg.eigh(np.cov(inside.T, bias=True))
        small, middle, large = np.sqrt(values)
        share = len(inside) / len(points)
        planar, linear = (middle - small) / large, (large - middle) / large
        expected["planar"] += share * planar
        expected["linear"] += share * linear
        expected["scattered"] += share * small / large
        expected["upright plane"] += share * planar * (1 - abs(vectors[2, 0]))
        expected["level plane"] += share * planar * abs(vectors[2, 0])
        expected["upright line"] += share * linear * abs(vectors[2, 2])
        expected["thickness"] += share * small
        expected["judged"] += share
    assert of(points) == pytest.approx(expected, abs=1e-4)


def test_wall_has_upright_planes_and_leaves_are_scattered() -> None:
    rng = np.random.default_rng(1)
    plane, leaves = of(wall(rng)), of(cloud(rng))
    assert plane["upright plane"] > 0.5 > leaves["upright plane"]
    assert plane["level plane"] < 0.05
    assert plane["thickness"] < 0.01 < leaves["thickness"]
    assert plane["scattered"] < 0.05 < leaves["scattered"]


def test_profile_counts_layers_above_the_lowest_point() -> None:
    points = np.array([[0, 0, 0], [2, 0, 0.2], [0, 0, 0.7], [0, 0, 9.0]], np.float32)
    found = class_features(Segments.of([points], SENSOR))[0, 17 : 17 + 2 * (len(HEIGHTS) + 1)]
    shares, widths = found.reshape(2, -1)
    assert shares[[0, 1, len(HEIGHTS)]].tolist() == [0.5, 0.25, 0.25]
    assert widths[0] == pytest.approx(1.0)  # 0 and 2 m: deviation of 1 m
    assert widths[1:].max() == 0


def test_views_of_a_beam() -> None:
    x = np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
    points = np.column_stack([x, np.zeros(5), np.full(5, 3.0)]).astype(np.float32)
    found = class_features(Segments.of([points], np.array([[0.0, 8.0, 3.0]])))[0, -VIEWS:]
    side = np.expm1(found[: ALONG * UP]).reshape(ALONG, UP)
    middle = ALONG // 2
    assert side[middle - 2 : middle + 3, 0] == pytest.approx(np.ones(5))
    assert side.sum() == pytest.approx(5)
    top = found[-ALONG * ACROSS :].reshape(ALONG, ACROSS)
    assert top[middle, ACROSS // 2] == pytest.approx(LAYER)


def test_features_do_not_depend_on_origin_or_other_segments() -> None:
    rng = np.random.default_rng(2)
    clouds = [wall(rng), cloud(rng), cloud(rng)[:40] * np.float32(1.3)]
    segments = Segments.of(clouds, np.tile(SENSOR, (3, 1)))
    expected = class_features(segments)
    assert expected.shape == (3, FEATURES)
    turn = np.array([[0.0, 1, 0], [-1, 0, 0], [0, 0, 1]])
    shift = np.array([30.0, -20.0, 5.0])
    moved = Segments.of(
        [(each @ turn + shift).astype(np.float32) for each in clouds],
        np.tile(SENSOR, (3, 1)) @ turn + shift,
    )
    whole = FEATURES - VIEWS
    # Cells of local surfaces turn with the frame, so these differ a little.
    assert class_features(moved)[:, :17] == pytest.approx(expected[:, :17], abs=1e-3)
    assert class_features(moved)[:, 17:whole] == pytest.approx(expected[:, 17:whole], abs=0.3)
    for index in range(3):
        alone = class_features(segments.take([index]))
        assert (alone[0] == expected[index]).all()


def test_one_point_has_finite_features() -> None:
    point = Segments.of([np.zeros((1, 3), np.float32)], np.zeros((1, 3)))
    assert np.isfinite(class_features(point)).all()
    assert class_features(Segments.of([], np.zeros((0, 3)))).shape == (0, FEATURES)


def test_features_are_those_that_the_shipped_heads_were_trained_with() -> None:
    """The file has features of version 1 by its first code, also of a segment 580 m long."""
    with np.load(FIXTURES / "class_features.npz") as stored:
        segments = Segments(stored["points"], stored["ends"], stored["sensors"])
        expected = stored["features"]
    assert VERSION == 1, "store the features of the new version"
    assert class_features(segments) == pytest.approx(expected, rel=1e-5, abs=1e-5)
