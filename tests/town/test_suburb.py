"""Tests of the suburb: what mixes in a segment there."""

from collections import Counter

import numpy as np
import pytest

from placecell.datasets.labels import CODES, class_of_code
from town.geometry.scene import Scene
from town.objects.car import car
from town.objects.labels import CODE_OF_KIND
from town.places import Place
from town.places.builder import Make
from town.places.suburb.plan import suburb
from town.places.suburb.plants import grown_hedge, old_tree
from town.places.suburb.things import bank, mesh_fence, used_car


@pytest.fixture(scope="module")
def place() -> Place:
    return suburb(seed=5, meters=60.0)[0]


def test_suburb_has_plants_banks_and_overgrown_boundaries(place: Place) -> None:
    kinds = Counter(thing.kind for thing in place.objects)
    for kind in ("house", "garage", "tree", "bush", "undergrowth", "hedge", "fence", "bank"):
        assert kinds[kind] >= 5, kinds
    fences, hedges = (
        np.array(
            [thing.mesh.bounds().mean(axis=0) for thing in place.objects if thing.kind == kind]
        )
        for kind in ("fence", "hedge")
    )
    nearest = np.linalg.norm(fences[:, None, :2] - hedges[None, :, :2], axis=2).min(axis=1)
    assert (nearest < 1.5).sum() >= 3


def test_each_kind_has_its_class(place: Place) -> None:
    codes = {code for thing in place.objects for code in np.unique(place_codes(thing.kind))}
    assert codes <= set(CODES)
    assert place_codes("bank") == ["other"]
    assert place_codes("undergrowth") == ["vegetation"]


def place_codes(kind: str) -> list[str]:
    code = CODE_OF_KIND.get(kind, CODES["other"][0])
    return [list(CODES)[class_of_code()[code]]]


def test_bank_is_low_and_ends_on_the_ground() -> None:
    mesh = bank(np.random.default_rng(1), 10.0, 2.0, 0.6)
    low, high = mesh.bounds()
    assert 0.4 < high[2] < 1.0
    assert low[2] > -0.3
    edge = mesh.triangles.reshape(-1, 3)
    assert np.abs(edge[edge[:, 0] == 0.0, 2]).max() < 0.2


def test_rays_pass_a_mesh_fence_and_a_crown_but_no_hedge() -> None:
    rng = np.random.default_rng(2)
    shares = []
    for mesh, heights in (
        (mesh_fence(rng, 8.0), (0.2, 0.7)),
        (old_tree(rng).moved(x=4.0), (4.5, 6.0)),
        (grown_hedge(rng, 8.0), (0.2, 0.6)),
    ):
        count = 2000
        origins = np.column_stack(
            [rng.uniform(3.0, 5.0, count), np.full(count, -9.0), rng.uniform(*heights, count)]
        ).astype(np.float32)
        ahead = np.tile(np.array([[0, 1, 0]], np.float32), (count, 1))
        ranges, _ = Scene(mesh).cast(origins, ahead)
        shares.append(float(np.isfinite(ranges).mean()))
    wires, crown, hedge = shares
    assert 0.05 < wires < 0.6
    assert 0.2 < crown < 0.999
    assert hedge > 0.7


def test_cabin_of_a_used_car_returns_rays() -> None:
    """The glass of other cars returns none from afar, so that only their bodies are seen."""
    dark: dict[Make, list[int]] = {make: [] for make in (car, used_car)}
    for make, shares in dark.items():
        for seed in range(20):
            shades = make(np.random.default_rng(seed)).reflectance
            shares.append(int((shades < 0.05).sum()))
    assert 0 < sum(dark[used_car]) < 0.5 * sum(dark[car])
