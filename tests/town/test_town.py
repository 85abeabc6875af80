from collections import Counter
from itertools import pairwise

import numpy as np
import pytest

from placecell.core.types import Float64
from town import Town


@pytest.fixture(scope="module")
def town() -> Town:
    return Town.build(seed=3, streets=(3, 2))


def places(town: Town, kind: str, seed: int) -> Float64:
    return np.array(
        [thing.mesh.bounds().mean(axis=0) for thing in town.traffic(seed) if thing.kind == kind]
    )


def test_same_seed_gives_the_same_town(town: Town) -> None:
    again = Town.build(seed=3, streets=(3, 2))
    assert (again.mesh(1).triangles == town.mesh(1).triangles).all()
    assert (again.mesh(1).reflectance == town.mesh(1).reflectance).all()


def test_other_seed_gives_another_town(town: Town) -> None:
    other = Town.build(seed=4, streets=(3, 2))
    assert not np.array_equal(other.plan.easts, town.plan.easts)
    assert len(other.mesh(1)) != len(town.mesh(1))


def test_streets_are_furnished_with_many_kinds(town: Town) -> None:
    kinds = Counter(thing.kind for thing in town.objects)
    for kind in ("house", "tree", "hedge", "fence", "garden wall", "lamp post", "dustbins"):
        assert kinds[kind] >= 3, kinds
    assert len(kinds) >= 11


def test_meshes_are_finite_and_near_the_ground(town: Town) -> None:
    for thing in town.objects + town.traffic(1):
        assert np.isfinite(thing.mesh.triangles).all()
        low, high = thing.mesh.bounds()
        ground = float(town.terrain.height((low + high)[:2] / 2))
        assert low[2] < ground + 0.6, thing.kind
        assert high[2] - ground < 18.0, thing.kind
    reflectance = town.mesh(1).reflectance
    assert 0 < reflectance.min() <= reflectance.max() <= 1


def test_no_two_houses_are_alike(town: Town) -> None:
    sizes = [len(thing.mesh) for thing in town.objects if thing.kind == "house"]
    widths = [np.ptp(thing.mesh.bounds(), axis=0).max() for thing in town.objects
              if thing.kind == "house"]  # fmt: skip
    assert len(set(zip(sizes, widths, strict=True))) == len(sizes)


def test_houses_on_one_side_are_apart(town: Town) -> None:
    """The gap between facades is wider than the growing radius, so they are separate segments."""
    houses = [thing.mesh.triangles.reshape(-1, 3)[:, :2] for thing in town.objects
              if thing.kind == "house"]  # fmt: skip
    for one, other in pairwise(houses):
        # Separating axes: in some direction there is a gap between them.
        angles = np.linspace(0, 2 * np.pi, 240, endpoint=False)
        axes = np.stack([np.cos(angles), np.sin(angles)])
        gaps = (other @ axes).min(axis=0) - (one @ axes).max(axis=0)
        assert gaps.max() > 0.3


def test_parked_cars_change_with_the_traffic_seed(town: Town) -> None:
    one, other = places(town, "parked car", 1), places(town, "parked car", 2)
    assert len(one) > 20
    assert np.array_equal(one, places(town, "parked car", 1))
    nearest = np.linalg.norm(one[:, None, :2] - other[None, :, :2], axis=2).min(axis=1)
    # About half of the bays are taken: half of the cars stand where none stood.
    assert 0.25 < np.mean(nearest > 2.0) < 0.75
    assert nearest.min() > 0  # and none stands exactly where one stood


def test_the_ground_is_gentle(town: Town) -> None:
    area = np.random.default_rng(0).uniform(-30, 200, size=(2000, 2))
    steepest = np.tan(np.arccos(town.terrain.normals(area)[:, 2])).max()
    assert 0.005 < steepest <= 0.03
    step = np.array([0.01, 0.0])
    slope = (town.terrain.height(area + step) - town.terrain.height(area - step)) / 0.02
    normals = town.terrain.normals(area)
    assert -normals[:, 0] / normals[:, 2] == pytest.approx(slope, abs=1e-6)


def test_a_town_needs_streets_both_ways() -> None:
    with pytest.raises(ValueError, match="expected at least 2 per direction"):
        Town.build(seed=1, streets=(1, 3))
