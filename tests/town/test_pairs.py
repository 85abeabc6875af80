import numpy as np
import pytest
from scipy.spatial import cKDTree

from placecell.core.types import Float64
from town import City, Route, StretchPair, Traversal, draw_pairs
from town.drives.pairs import APART, StretchPairDrawer, means
from town.streets.network import OWN

METERS = 150.0
COUNT = 12


def traversal(route: Route) -> Traversal:
    return Traversal.of(route, int(route.length() / 1.5), spacing=1.5)


@pytest.fixture(scope="module")
def city() -> City:
    return City.build(seed=7, meters=4000.0, look_alikes=0.4)


@pytest.fixture(scope="module")
def drives(city: City) -> tuple[Traversal, Traversal]:
    route = city.route(city.planner.every_street())
    return traversal(route), traversal(route.reversed())


@pytest.fixture(scope="module")
def pairs(
    city: City, drives: tuple[Traversal, Traversal]
) -> tuple[list[StretchPair], list[StretchPair]]:
    return draw_pairs(city, *drives, COUNT, METERS, seed=1)


def places(drive: Traversal, scans: tuple[int, int]) -> Float64:
    return drive.places[scans[0] : scans[1] + 1]


def test_stretches_are_as_long_as_asked(
    drives: tuple[Traversal, Traversal], pairs: tuple[list[StretchPair], list[StretchPair]]
) -> None:
    for pair in pairs[0] + pairs[1]:
        for drive, scans in zip(drives, (pair.scans_a, pair.scans_b), strict=True):
            steps = np.linalg.norm(np.diff(places(drive, scans), axis=0), axis=1)
            assert steps.sum() == pytest.approx(METERS, abs=4.0)


def test_overlaps_are_those_asked_for(
    drives: tuple[Traversal, Traversal], pairs: tuple[list[StretchPair], list[StretchPair]]
) -> None:
    overlapping, _ = pairs
    assert len(overlapping) == COUNT
    for wanted, pair in zip(np.linspace(0.1, 1.0, COUNT), overlapping, strict=True):
        assert pair.overlap == pytest.approx(wanted, abs=0.021)
        near = cKDTree(places(drives[0], pair.scans_a)).query(places(drives[1], pair.scans_b))[0]
        assert np.mean(near < 7.0) == pytest.approx(pair.overlap)


def test_maps_without_overlap_are_far_apart(
    drives: tuple[Traversal, Traversal], pairs: tuple[list[StretchPair], list[StretchPair]]
) -> None:
    _, apart = pairs
    assert len(apart) == COUNT
    for pair in apart:
        near = cKDTree(places(drives[0], pair.scans_a)).query(places(drives[1], pair.scans_b))[0]
        assert near.min() > APART
        assert pair.overlap == 0.0


def test_half_of_the_pairs_without_overlap_are_similar(
    city: City,
    drives: tuple[Traversal, Traversal],
    pairs: tuple[list[StretchPair], list[StretchPair]],
) -> None:
    _, apart = pairs
    for pair in apart:
        one, other = (
            city.designs_at(places(drive, scans))
            for drive, scans in zip(drives, (pair.scans_a, pair.scans_b), strict=True)
        )
        shared = set(one.tolist()) & set(other.tolist()) - {OWN}
        assert pair.look_alike == pytest.approx(np.mean(np.isin(other, list(shared))))
    chosen, others = apart[::2], apart[1::2]
    assert min(pair.look_alike for pair in chosen) > 0.2
    assert np.mean([pair.look_alike for pair in others]) < 0.2


def test_true_transform_aligns_the_maps(
    drives: tuple[Traversal, Traversal], pairs: tuple[list[StretchPair], list[StretchPair]]
) -> None:
    a, b = drives
    for pair in pairs[0] + pairs[1]:
        # The town's middle, as either map's frame has it.
        place = np.array([200.0, 150.0, 2.0, 1.0])
        in_a = pair.frame_a @ np.linalg.inv(a.origin) @ place
        in_b = pair.frame_b @ np.linalg.inv(b.origin) @ place
        assert pair.b_to_a @ in_b == pytest.approx(in_a, abs=1e-6)
        assert pair.b_to_a[2, :3] == pytest.approx([0, 0, 1])
    headings = [np.arctan2(pair.b_to_a[1, 0], pair.b_to_a[0, 0]) for pair in pairs[0] + pairs[1]]
    assert np.ptp(headings) > 4.0
    shifts = [np.linalg.norm(pair.b_to_a[:2, 3]) for pair in pairs[0] + pairs[1]]
    assert np.median(shifts) > 1000.0


def test_same_seed_gives_the_same_pairs(city: City, drives: tuple[Traversal, Traversal]) -> None:
    one, other = (draw_pairs(city, *drives, 2, METERS, seed=5)[1][0] for _ in range(2))
    assert one.as_dict() == other.as_dict()
    another = draw_pairs(city, *drives, 2, METERS, seed=6)[1][0]
    assert another.as_dict() != one.as_dict()


def test_impossible_pairs_are_refused(city: City, drives: tuple[Traversal, Traversal]) -> None:
    a, b = drives
    with pytest.raises(ValueError, match="expected at least 1"):
        draw_pairs(city, a, b, 0, METERS)
    with pytest.raises(ValueError, match="has no stretch of"):
        draw_pairs(city, a, b, 1, 1e6)
    here = Traversal(a.poses[:110], a.origin)
    drawer = StretchPairDrawer.of(city, here, here, METERS, np.random.default_rng(0))
    for alike in (True, False):
        with pytest.raises(ValueError, match="100 m apart"):
            drawer.apart(alike)
    far = Traversal(b.poses + 0.0, b.origin)
    far.poses[:, :2, 3] += 5000.0
    with pytest.raises(ValueError, match="share 10%"):
        draw_pairs(city, a, far, 1, METERS)


def test_means_of_windows() -> None:
    flags = np.array([True, False, True, True])
    assert means(flags, 2) == pytest.approx([0.5, 0.5, 1.0])
    assert means(flags, 4) == pytest.approx([0.75])
