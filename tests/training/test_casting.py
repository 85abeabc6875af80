"""Tests of the things that are cast for the training of classes."""

import numpy as np
import pytest

from placecell.core.segment_classes import CLASSES
from placecell.core.segments import Segments
from placecell.core.types import Float64, UInt8
from training.classes import placing
from training.classes.casting import Thing, cast, connected, voxels
from training.classes.placing import placed_things
from training.classes.things import MAKERS, POLE, SIGN, VEHICLE, Box, Rod, car

TO_SENSOR: Float64 = np.array([12.0, 0.0])


def test_a_cast_car_is_as_large_as_a_car_and_seen_from_its_near_side() -> None:
    for seed in range(6):
        found = cast(
            car(0.0, np.random.default_rng(seed)), TO_SENSOR, 1.8, np.random.default_rng(0)
        )
        assert found is not None
        assert found.kind == VEHICLE
        low, high = found.points.min(axis=0), found.points.max(axis=0)
        assert (high - low)[:2].max() < 6.5
        assert 0.1 < low[2] < high[2] < 2.8
        assert np.median(found.points[:, 0]) > 0


def test_a_cast_depends_only_on_the_seed() -> None:
    first, again = (
        cast(MAKERS["tree"](0.0, rng), TO_SENSOR, 1.8, rng)
        for rng in (np.random.default_rng(4), np.random.default_rng(4))
    )
    assert first is not None
    assert again is not None
    assert (first.points == again.points).all()


def test_the_class_of_a_cast_is_that_of_most_of_its_voxels() -> None:
    rod = Rod((0, 0, 0), (0, 0, 3), (0.25, 0.25), POLE)
    for half, kind in ((0.05, POLE), (0.9, SIGN)):
        plate = Box((0, 0, 2), (half, half, half), 0.0, SIGN)
        found = [
            cast(Thing([plate, rod], 1.0, 3.0), TO_SENSOR / 2, 1.8, np.random.default_rng(seed))
            for seed in range(12)
        ]
        kinds = [each.kind for each in found if each is not None]
        assert kinds
        assert np.bincount(kinds).argmax() == kind


def test_a_thing_that_is_too_far_or_too_small_is_no_segment() -> None:
    rng = np.random.default_rng(0)
    assert cast(car(0.0, rng), np.array([70.0, 0.0]), 1.8, rng) is None
    crumb = Box((0, 0, 0.5), (0.05, 0.05, 0.05), 0.0, SIGN)
    assert cast(Thing([crumb], 0.5, 0.6), TO_SENSOR, 1.8, rng) is None


def test_leaves_let_rays_pass_deeper_than_solid_parts() -> None:
    depths = []
    for density in (1.0, 0.1):
        wall = Box((0, 0, 1), (2.0, 2.0, 1.0), 0.0, SIGN, density)
        found = cast(Thing([wall], 3.0, 2.0), TO_SENSOR, 1.2, np.random.default_rng(2))
        assert found is not None
        depths.append(float(found.points[:, 0].mean()))
    assert depths[1] < depths[0] - 0.3


def test_voxels_take_means_and_growing_keeps_the_largest_part() -> None:
    points: Float64 = np.array([[0.01, 0.0, 0.0], [0.03, 0.0, 0.0], [0.15, 0.0, 0.0], [9, 9, 9]])
    means, kinds = voxels(points, np.array([1, 2, 3, 4]))
    assert means[:2, 0] == pytest.approx([0.02, 0.15])
    assert kinds.tolist() == [2, 3, 4]
    assert connected(means).tolist() == [0, 1]


def test_things_stand_in_the_places_of_segments_of_like_classes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(placing, "THINGS", {"car": (4, ("vehicle",)), "crown": (2, ("person",))})
    cloud = np.random.default_rng(0).uniform(0, 1, (50, 3)).astype(np.float32)
    segments = Segments.of([cloud, cloud + np.float32(20)], np.array([[12, 0, 1.7], [32, 20, 1.7]]))
    classes: UInt8 = np.array([CLASSES.index("building"), VEHICLE], np.uint8)
    placed = placed_things(segments, classes, np.random.default_rng(1))
    assert len(placed.segments) == len(placed.classes) == len(placed.places) >= 3
    cars = placed.classes == VEHICLE
    assert (placed.places[cars] == 1).all()
    apart = placed.segments.centroids() - segments.centroids()[placed.places]
    assert np.abs(apart[:, :2]).max() < 5
    none = Segments.of([], np.zeros((0, 3)))
    nothing = placed_things(none, classes[:0], np.random.default_rng(1))
    assert not len(nothing.segments)
