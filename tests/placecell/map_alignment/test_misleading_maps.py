"""Misleading or expensive maps are aligned rightly or not at all."""

import tracemalloc

import numpy as np
import pytest

from placecell.core.types import Float64, Int64
from placecell.localization import Pose
from placecell.localization.registration import register_yaw
from placecell.map_alignment import AlignmentParameters, MapAlignment, MapView, align
from tests.placecell.map_alignment.map_builders import (
    DIMENSION,
    ByDistance,
    MadeMap,
    Street,
    a_pose,
    assert_right,
    assert_right_or_none,
    drive,
    off,
    pair,
    street,
)

SAME = Pose.of_yaw(0.0, np.zeros(3))


def aligned(a: MadeMap, b: MadeMap) -> MapAlignment:
    return align(a.view, b.view, ByDistance(a, b))


def houses(count: int, begin: float, pitch: float = 12.0, mirrored: bool = True) -> Street:
    """Return identical houses on both sides of a street."""
    random = np.random.default_rng(99)
    parts = random.uniform((0, 4, 0), (pitch, 12, 4), (6, 3))
    looks = random.normal(size=(6, DIMENSION))
    sides = [parts, parts * (1, -1, 1)] if mirrored else [parts]
    steps = begin + pitch * np.arange(count)
    places = [side + (x, 0, 0) for side in sides for x in steps]
    return Street(np.concatenate(places), np.tile(looks, (len(places), 1)))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_a_street_of_identical_houses_is_ambiguous_or_right(seed: int) -> None:
    random = np.random.default_rng(seed)
    truth = a_pose(random)
    plain = houses(40, -60.0)
    for seen in (plain, plain.with_(street(random, 400.0, gap=15.0, begin=-60.0))):
        # 80 m are shared; laid on each other by more, just as much agrees.
        a, b = drive(seen, 0.0, 150.0, random), drive(seen, 70.0, 220.0, random)
        assert_right_or_none(aligned(a, b.moved(truth.inverse())), truth)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(8))
def test_two_streets_of_the_same_houses_are_not_one(seed: int) -> None:
    random = np.random.default_rng(seed)
    maps = []
    for _ in range(2):
        seen = houses(40, -60.0).with_(street(random, 400.0, gap=10.0, begin=-60.0))
        maps.append(drive(seen, 0.0, 150.0, random))
    assert aligned(*maps).reason is not None


@pytest.mark.parametrize("seed", range(5))
def test_a_street_that_begins_and_ends_is_right_or_ambiguous(seed: int) -> None:
    random = np.random.default_rng(seed)
    seen, truth = houses(5, 40.0), a_pose(random)
    a, b = (drive(seen, 0.0, 150.0, random) for _ in range(2))
    assert_right_or_none(aligned(a, b.moved(truth.inverse())), truth)


@pytest.mark.parametrize("yaw", [0.0, 1.0, np.pi])
def test_a_copy_of_the_map_inside_itself_is_ambiguous(yaw: float) -> None:
    random = np.random.default_rng(5)
    seen = street(random, 250.0, begin=-50.0)
    one, other, b = (drive(seen, 0.0, 150.0, random) for _ in range(3))
    copy = other.moved(Pose.of_yaw(yaw, np.array([400.0, 300.0, 0.0])))
    assert aligned(one.with_(copy), b).reason == "ambiguous"
    assert aligned(b, one.with_(copy)).reason == "ambiguous"
    # Which is the copy, a part that was seen in one of them alone tells.
    assert_right(aligned(one, b), SAME)


@pytest.mark.parametrize("seed", range(10))
def test_pure_noise_is_not_aligned(seed: int) -> None:
    random = np.random.default_rng(seed)
    a, b = (drive(street(random, 250.0, begin=-50.0), 0.0, 150.0, random) for _ in range(2))
    found = aligned(a, b)
    assert found.reason == "inconsistent"
    # Nor is a map that is laid on one of the same places, but of other looks.
    unlike = MadeMap(a.view, random.normal(size=a.looks.shape), a.things)
    assert aligned(a, unlike).reason == "inconsistent"


def heap(
    count: int, box: tuple[float, ...], looks: Float64 | None = None, seed: int = 0
) -> MadeMap:
    """Return segments in a box, seen from its center; all alike if descriptors are given."""
    random = np.random.default_rng(seed)
    middle = np.array(box) * (0.5, 0.5, 0.0)
    looks = random.normal(size=(count, DIMENSION)) if looks is None else looks
    return MadeMap(
        MapView(random.uniform(0, 1, (count, 3)) * box, np.tile(middle, (count, 1))),
        np.broadcast_to(looks, (count, DIMENSION)),
        np.arange(count),
    )


ALIKE = np.ones(DIMENSION)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("count", "box"),
    [
        (1_000, (0.0, 0.0, 0.0)),
        (1_000, (20.0, 20.0, 2.0)),
        (1_000, (40.0, 40.0, 4.0)),
        (3_000, (20.0, 20.0, 2.0)),
        (1_000, (200.0, 0.0, 0.0)),
        (10_000, (1.0, 1.0, 1.0)),
    ],
)
def test_one_segment_a_thousand_times_is_not_aligned(count: int, box: tuple[float, ...]) -> None:
    a, b = heap(count, box, ALIKE), heap(count, box, ALIKE, seed=1)
    found = aligned(a, b)
    assert found.reason in {"ambiguous", "inconsistent"}
    assert found.detail
    # Nor is it on itself, but for about where it lies: nobody can tell one from its neighbor.
    itself = aligned(a, a)
    if itself.pose is not None:
        meters, degrees = off(itself, SAME)
        assert meters < 3.0
        assert degrees < 10.0


@pytest.mark.slow
def test_dense_similar_segments_are_not_aligned() -> None:
    # Of five kinds; wherever one is laid on the other, something of the kind is near.
    random = np.random.default_rng(0)
    kinds = random.normal(size=(5, DIMENSION))
    a, b = (
        heap(3_000, (20.0, 20.0, 2.0), kinds[random.integers(0, 5, 3_000)], seed) for seed in (1, 2)
    )
    assert aligned(a, b).reason in {"ambiguous", "inconsistent"}


def test_segments_on_a_line_give_the_right_rotation_or_none() -> None:
    line = heap(400, (100.0, 0.0, 0.0))
    viewpoints = line.view.centroids + (0.0, 0.0, 1.5)
    flat = MadeMap(MapView(line.view.centroids, viewpoints), line.looks, line.things)
    truth = Pose.of_yaw(2.0, np.array([50.0, 60.0, 7.0]))
    assert_right(aligned(flat, flat.moved(truth.inverse())), truth)
    # Upright it tells nothing of it.
    pole = np.zeros_like(flat.view.centroids)
    pole[:, 2] = flat.view.centroids[:, 0]
    upright = MadeMap(MapView(pole, pole), flat.looks, flat.things)
    assert aligned(upright, upright).reason == "inconsistent"


def test_coincident_centroids_are_not_aligned() -> None:
    point = heap(500, (0.0, 0.0, 0.0))
    assert aligned(point, point).reason == "inconsistent"
    made = pair(0)
    for one, other in ((point, made.b), (made.a, point)):
        assert aligned(one, other).reason == "inconsistent"


def measured(a: MadeMap, b: MadeMap) -> tuple[MapAlignment, ByDistance, float]:
    """Return the alignment, the used search and the peak of memory, bytes."""
    looks = ByDistance(a, b)
    tracemalloc.start()
    try:
        found = align(a.view, b.view, looks)
        return found, looks, tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_ten_thousand_segments_in_a_square_meter_are_not_all_compared() -> None:
    made = heap(10_000, (1.0, 1.0, 1.0))
    found, looks, memory = measured(made, made)
    # There are 10^8 pairs of them.
    assert looks.pairs <= 2 * AlignmentParameters().pairs
    assert memory < 1.5e9
    assert found.reason is not None


@pytest.mark.slow
def test_ten_thousand_segments_in_a_yard_are_aligned() -> None:
    made = heap(10_000, (20.0, 20.0, 2.0))
    truth = Pose.of_yaw(-2.0, np.array([3_000.0, 20.0, 1.0]))
    found, looks, memory = measured(made, made.moved(truth.inverse()))
    assert_right(found, truth)
    assert looks.pairs <= 5 * AlignmentParameters().pairs
    assert memory < 1.5e9


def drifting(made: MadeMap, random: np.random.Generator) -> MadeMap:
    """Return a map with odometry drift: 0.05 degrees per root meter, and a scale error of 1%."""
    order = np.unique(made.view.viewpoints[:, 0])
    steps = np.diff(order, prepend=order[0])
    heading = np.cumsum(random.normal(size=len(order)) * np.radians(0.05) * np.sqrt(steps))
    scale = 1.0 + random.choice([-0.01, 0.01])
    way = np.cumsum(
        scale * steps[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1), axis=0
    )
    moment = np.searchsorted(order, made.view.viewpoints[:, 0])
    ahead = made.view.centroids - made.view.viewpoints
    cos, sin = np.cos(heading[moment]), np.sin(heading[moment])
    centroids, viewpoints = made.view.centroids.copy(), made.view.viewpoints.copy()
    viewpoints[:, :2] = way[moment] + made.view.viewpoints[0, :2]
    centroids[:, 0] = viewpoints[:, 0] + cos * ahead[:, 0] - sin * ahead[:, 1]
    centroids[:, 1] = viewpoints[:, 1] + sin * ahead[:, 0] + cos * ahead[:, 1]
    return MadeMap(MapView(centroids, viewpoints), made.looks, made.things)


def laid_by_truth(a: MadeMap, b: MadeMap, things: Int64) -> Pose:
    """Return the transform from these landmarks of b to those of a."""
    means = [
        np.array([each.view.centroids[each.things == thing].mean(axis=0) for thing in things])
        for each in (b, a)
    ]
    return register_yaw(means[0], means[1], np.ones(len(things)))


@pytest.mark.slow
@pytest.mark.parametrize("shared", [60.0, 120.0, 250.0])
def test_maps_that_drift_are_right_at_the_overlap_or_not_aligned(shared: float) -> None:
    told = 0
    for seed in range(6):
        random = np.random.default_rng(seed)
        seen = street(random, 700.0, begin=-50.0)
        a = drifting(drive(seen, 0.0, 300.0, random), random)
        b = drifting(drive(seen, 300.0 - shared, 600.0 - shared, random), random)
        b = b.moved(a_pose(random))
        found = aligned(a, b)
        if found.pose is None or found.best is None:
            continue
        told += 1
        # Maps that are bent lie on each other in a part of the overlap: where they agree.
        here, there = a.things[found.best.rows_a], b.things[found.best.rows_b]
        assert (here == there).mean() > 0.95
        meters, degrees = off(found, laid_by_truth(a, b, np.unique(here[here == there])))
        assert meters < 0.5
        assert degrees < 1.0
    assert told >= (2 if shared < 200 else 1)
