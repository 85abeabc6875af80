"""Neighborhood histograms: values by hand, and invariances."""

import subprocess
import sys

import numpy as np
import pytest

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from placecell.core.parameters import NEIGHBORHOOD_V1, NeighborhoodParameters
from placecell.core.segments import Segments
from placecell.descriptors.neighborhood import (
    SEED,
    count_voxels,
    describe_neighborhood,
    slot_of,
    voxels_by_owner,
)

TWO_RINGS = NeighborhoodParameters(voxel=1.0, rings=(2, 5), heights=(0.0,))


def points(*rows: tuple[float, float, float]) -> np.ndarray:
    return np.array(rows, dtype=np.float32)


def scene(clouds: list[np.ndarray]) -> Segments:
    return Segments.of(clouds, np.zeros((len(clouds), 3)))


def street(seed: int = 0, count: int = 12) -> Segments:
    random = np.random.default_rng(seed)
    clouds = [
        random.normal(0, 0.8, (200, 3)) + [*random.uniform(-15, 15, 2), random.uniform(0, 2)]
        for _ in range(count)
    ]
    return scene([cloud.astype(np.float32) for cloud in clouds])


def test_values_match_those_by_hand() -> None:
    # Around the first, at its centroid's height or above: one voxel a meter east; two voxels, four
    # meters west, in one sector. Below: one voxel, four meters west. One is too far to count.
    segments = scene(
        [
            points((0.5, 0.5, 0.5)),
            points((1.5, 0.5, 0.5), (-3.5, 0.5, 0.6), (-3.5, 0.5, 1.6), (-3.5, 0.5, -0.5)),
            points((9.5, 0.5, 0.5)),
        ]
    )
    found = describe_neighborhood(segments, parameters=TWO_RINGS).reshape(3, 2, 2)
    one, two = np.log(2) / 16, np.log(3) / 16
    assert found[0] == pytest.approx(np.array([[0, one], [one, two]]))


def test_sectors_are_a_sixteenth_of_the_compass() -> None:
    # Voxels all around, one every 5 degrees, in one ring and layer: each sector has four or five.
    angles = np.radians(np.arange(2.5, 360, 5))
    around = np.stack([8 * np.cos(angles), 8 * np.sin(angles), np.zeros(72)], axis=1)
    segments = scene([points((0, 0, 0)), around.astype(np.float32)])
    wide = NeighborhoodParameters(voxel=0.1, rings=(20,), heights=())
    sectors = np.bincount((np.arange(2.5, 360, 5) / 22.5).astype(int))
    assert describe_neighborhood(segments, parameters=wide)[0] == pytest.approx(
        np.log1p(sectors).mean()
    )


def test_a_voxel_of_several_points_counts_once_at_their_mean() -> None:
    voxels, owners = voxels_by_owner(
        scene([points((0.9, 0.9, 0.1), (1.1, 1.1, 0.1)), points((0.2, 0, 0), (5.0, 0, 0))]), 1.0
    )
    # Though a grid of whole meters would part the first two.
    assert voxels == pytest.approx(np.array([[1.0, 1.0, 0.1], [0.2, 0, 0], [5.0, 0, 0]]))
    assert owners.tolist() == [0, 1, 1]


def test_a_segment_alone_has_no_neighborhood() -> None:
    assert not describe_neighborhood(street(count=1)).any()
    none = describe_neighborhood(scene([]))
    assert none.shape == (0, NEIGHBORHOOD_V1.size)


def test_captures_do_not_see_each_other() -> None:
    segments = street()
    captures = np.array([7, 3] * 6)
    found = describe_neighborhood(segments, captures)
    for frame in (3, 7):
        members = np.flatnonzero(captures == frame)
        assert (found[members] == describe_neighborhood(segments.take(members))).all()


def test_order_of_segments_makes_no_difference() -> None:
    segments = street()
    order = np.random.default_rng(1).permutation(len(segments))
    shuffled = describe_neighborhood(segments.take(order))
    assert shuffled == pytest.approx(describe_neighborhood(segments)[order], abs=1e-5)


@pytest.mark.parametrize("degrees", [90, 37, 180])
def test_rotation_changes_little(degrees: float) -> None:
    segments = street()
    angle = np.radians(degrees)
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    turned = Segments(
        (segments.points @ turn.T + [100, -50, 3]).astype(np.float32),
        segments.ends,
        segments.sensors,
    )
    before, after = describe_neighborhood(segments), describe_neighborhood(turned)
    own = [np.corrcoef(a, b)[0, 1] for a, b in zip(before, after, strict=True)]
    others = [np.corrcoef(a, b)[0, 1] for a, b in zip(before, np.roll(after, 1, 0), strict=True)]
    assert min(own) > 0.8
    assert min(own) > max(others)


def test_nan_and_unreachable_voxels_are_ignored() -> None:
    just_short = np.nextafter(np.float32(5), np.float32(0))
    found = describe_neighborhood(
        scene(
            [
                points((0, 0, 0)),
                points((np.nan, 0, 0), (0, np.inf, 0)),
                points((just_short, 0, 0)),
                points((5, 0, 0)),
            ]
        ),
        parameters=TWO_RINGS,
    ).reshape(4, 2, 2)
    assert found[0] == pytest.approx(np.array([[0, 0], [0, np.log(2) / 16]]))
    # The root of the largest number below 1,600 is 40 in float64.
    reach = NeighborhoodParameters(voxel=1.0, rings=(40,), heights=())
    for offset in (np.sqrt(np.nextafter(1600.0, 0)), 40.0):
        lone = Segments.of([points((0, 0, 0)), points((offset, 0, 0))], np.zeros((2, 3)))
        describe_neighborhood(lone, parameters=reach)
    with pytest.raises(ValueError, match="16"):
        NeighborhoodParameters(sectors=8)


def all_pairs(segments: Segments, parameters: NeighborhoodParameters) -> np.ndarray:
    """Compare each voxel with each centroid, as a reference."""
    voxels, owners = voxels_by_owner(segments, parameters.voxel)
    rings, reach = parameters.ring_of_meter(), parameters.rings[-1]
    logarithms = np.log1p(np.arange(len(voxels) + 1))
    found = np.zeros((len(segments), *parameters.shape), dtype=np.float32)
    for segment, centroid in enumerate(segments.centroids()):
        with np.errstate(invalid="ignore", over="ignore"):
            away = voxels - centroid
            x, y = np.abs(away[:, 0]), np.abs(away[:, 1])
            squared = x * x + y * y
            near = (owners != segment) & (squared < reach * reach)
            layers = (away[:, 2][:, None] >= np.array(parameters.heights)).sum(axis=1)
            sectors = (y > np.tan(np.pi / 8) * x) + 0 + (y > x) + (x < np.tan(np.pi / 8) * y)
            sectors += 4 * (voxels[:, 0] < centroid[0]) + 8 * (voxels[:, 1] < centroid[1])
        meters = np.minimum(np.sqrt(squared[near]).astype(int), reach - 1)
        counts = np.zeros((*parameters.shape, 16), dtype=np.int64)
        np.add.at(counts, (rings[meters], layers[near], sectors[near]), 1)
        total = np.zeros(parameters.shape)
        for sector in range(16):
            total = total + logarithms[counts[:, :, sector]]
        found[segment] = total / 16
    return found.reshape(len(segments), parameters.size)


def odd() -> Segments:
    segments = street(seed=5)
    segments.points[::17, 0] = np.nan
    segments.points[5::29, 2] = np.inf
    segments.points[7::31, 1] = 1e30
    return segments


def on_a_grid() -> Segments:
    segments = street(seed=6, count=40)
    points = (np.round(segments.points * 2) / 2).astype(np.float32)
    return Segments(points, segments.ends, segments.sensors)


@pytest.mark.parametrize(
    "segments",
    [
        pytest.param(street(count=60), id="street"),
        pytest.param(on_a_grid(), id="grid"),
        pytest.param(scene([each * 0 for each in np.split(street().points, 12)]), id="one-spot"),
        pytest.param(scene(list(np.split(street().points * 60, 12))), id="beyond-reach"),
        pytest.param(scene(list(np.split(street().points + 1e6, 12))), id="far-from-the-origin"),
        pytest.param(odd(), id="no-numbers"),
    ],
)
def test_A4_cells_give_what_all_pairs_give_bit_for_bit(segments: Segments) -> None:
    for parameters in (NEIGHBORHOOD_V1, TWO_RINGS):
        found = describe_neighborhood(segments, parameters=parameters)
        assert found.tobytes() == all_pairs(segments, parameters).tobytes()


def colliding(count: int) -> np.ndarray:
    """Return voxels, (count, 3), which the former unseeded hash put into one slot."""
    slots = 1
    while slots < 2 * count:
        slots *= 2
    y, x = np.meshgrid(np.arange(2048), np.arange(64))
    upper = (x.ravel() << 13) + y.ravel()
    lower = ((upper * 7) ^ ((upper >> 13) * 31)) & (slots - 1)
    # Of the slot's bits, z fills the lowest 13; the others are those of the key's upper part.
    rest = (lower >> 13) ^ (upper & ((slots - 1) >> 13))
    fits = np.flatnonzero(rest == 0)[:count]
    return np.stack([x.ravel()[fits], y.ravel()[fits], lower[fits] & 8191], axis=1)


def test_A4_crafted_voxels_do_not_collide() -> None:
    cells = colliding(10_000)
    keys = (cells[:, 0] << 26) + (cells[:, 1] << 13) + cells[:, 2]
    slots = 32_768
    before = (keys ^ (keys >> 13) * 7 ^ (keys >> 26) * 31) & (slots - 1)
    assert len(keys) == 10_000
    assert len(np.unique(before)) == 1  # they are crafted rightly
    now = np.array([slot_of(key, SEED, slots) for key in keys.tolist()])
    assert np.bincount(now).max() < 12
    other = np.array([slot_of(key, SEED + np.uint64(2), slots) for key in keys.tolist()])
    assert (now != other).mean() > 0.9


def test_A4_seed_makes_no_difference(monkeypatch: pytest.MonkeyPatch) -> None:
    segments = street(seed=9)
    before = describe_neighborhood(segments)
    voxels, owners = voxels_by_owner(segments, 0.6)
    monkeypatch.setattr("placecell.descriptors.neighborhood.SEED", SEED + np.uint64(12_346))
    again, owners_again = voxels_by_owner(segments, 0.6)
    assert describe_neighborhood(segments).tobytes() == before.tobytes()
    assert again.tobytes() == voxels.tobytes()
    assert owners_again.tolist() == owners.tolist()


def test_A4_seed_is_of_the_process() -> None:
    command = "from placecell.descriptors.neighborhood import SEED; print(SEED.tolist())"
    seeds = {
        subprocess.run(
            [sys.executable, "-c", command], check=True, capture_output=True, text=True
        ).stdout
        for _ in range(2)
    }
    assert len(seeds) == 2


def test_A4_cancelled_work_stops() -> None:
    segments = street()
    voxels, owners = voxels_by_owner(segments, 0.6)
    counted = np.zeros((len(segments), *NEIGHBORHOOD_V1.shape), dtype=np.float32)
    with cancelled_by(CancelToken()) as token:
        token.cancel()
        with pytest.raises(Cancelled):
            voxels_by_owner(segments, 0.6)
        with pytest.raises(Cancelled):
            count_voxels(voxels, owners, segments.centroids(), NEIGHBORHOOD_V1, counted)
    assert not counted.any()  # it did not go on to the end
