from collections import Counter

import numpy as np
import pytest
from scipy.sparse.csgraph import connected_components
from scipy.spatial.distance import cdist

from placecell.core.parameters import Parameters
from placecell.core.types import Float32
from placecell.segmentation.region_growing import grow_regions, segment_indices


def points(*rows: tuple[float, float, float]) -> Float32:
    return np.array(rows, dtype=np.float32)


def slow_labels(cloud: Float32, radius: float) -> list[int]:
    """Label regions by comparing all points, as a reference."""
    linked = cdist(cloud.astype(np.float64), cloud.astype(np.float64)) <= radius
    _, labels = connected_components(linked, directed=False)
    first: dict[int, int] = {}
    return [first.setdefault(label, len(first)) for label in labels.tolist()]


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize(("radius", "half"), [(0.2, 1.2), (0.25, 1.5), (0.6, 4.0)])
def test_against_brute_force(seed: int, radius: float, half: float) -> None:
    generator = np.random.default_rng(seed)
    # About the origin, so that half of every coordinate is negative; dense enough to link.
    cloud = generator.uniform(-half, half, (1000, 3)).astype(np.float32)
    labels = grow_regions(cloud, radius)
    assert labels.tolist() == slow_labels(cloud, radius)
    assert len(set(labels.tolist())) > 1


def test_brute_force_on_a_flat_cloud_far_from_the_origin() -> None:
    generator = np.random.default_rng(9)
    cloud = (generator.uniform(0, 12, (1500, 3)) * [1, 1, 0] + [-300, 200, -7]).astype(np.float32)
    assert grow_regions(cloud, 0.25).tolist() == slow_labels(cloud, 0.25)


def test_exactly_at_the_radius_is_linked() -> None:
    # 0.25 and its multiples are exact in binary.
    assert grow_regions(points((0, 0, 0), (0.25, 0, 0)), 0.25).tolist() == [0, 0]
    beyond = float(np.nextafter(np.float32(0.25), np.float32(1)))
    assert grow_regions(points((0, 0, 0), (beyond, 0, 0)), 0.25).tolist() == [0, 1]


@pytest.mark.parametrize("direction", [d for d in np.ndindex(3, 3, 3) if d != (1, 1, 1)])
def test_linked_across_cell_borders_in_every_direction(direction: tuple[int, int, int]) -> None:
    # On either side of a border, or of several at once, 0.02 m per axis apart.
    step = np.array(direction) - 1
    for corner in ([0, 0, 0], [-0.25, 0.25, -0.5], [-7.25, -3.0, 2.0]):
        pair = np.array([corner - 0.01 * step, corner + 0.01 * step], dtype=np.float32)
        assert grow_regions(pair, 0.25).tolist() == [0, 0]


def test_first_layer_is_not_taken_for_the_neighbor_of_the_last() -> None:
    # Two cells that follow one another in the order of keys but lie far apart.
    cloud = points((0, 0, 3), (0, 0.3, 0), (0, 3, 0), (0.3, 0, 0), (0.3, 3, 3), (0.6, 0, 0))
    assert grow_regions(cloud, 0.25).tolist() == [0, 1, 2, 3, 4, 5]


def test_linked_step_by_step() -> None:
    chain = np.array([[0.2 * step, 0, 0] for step in range(50)], dtype=np.float32)
    assert set(grow_regions(chain, 0.25).tolist()) == {0}
    assert len(set(grow_regions(np.delete(chain, 20, axis=0), 0.25).tolist())) == 2


def test_labels_are_numbered_by_first_point() -> None:
    cloud = points((9, 0, 0), (-9, 0, 0), (9.1, 0, 0), (0, 0, 0), (-9.1, 0, 0))
    assert grow_regions(cloud, 0.25).tolist() == [0, 1, 0, 2, 1]


def test_order_of_points_changes_only_the_numbers() -> None:
    cloud = np.random.default_rng(3).uniform(-1, 1, (500, 3)).astype(np.float32)
    order = np.random.default_rng(4).permutation(len(cloud))
    labels, shuffled = grow_regions(cloud, 0.2), grow_regions(cloud[order], 0.2)
    pairs = set(zip(labels[order].tolist(), shuffled.tolist(), strict=True))
    assert len(pairs) == labels.max() + 1 == shuffled.max() + 1


def test_repeated_points_are_one_region() -> None:
    assert grow_regions(points(*[(1, 2, 3)] * 7), 0.25).tolist() == [0] * 7


def test_no_points() -> None:
    assert grow_regions(np.zeros((0, 3), np.float32), 0.25).shape == (0,)
    assert segment_indices(np.zeros((0, 3), np.float32), Parameters()) == []


def clusters(*sizes: int) -> Float32:
    """Return clusters of these sizes, 10 m apart, with interleaved points."""
    rows = [
        (float(10 * cluster), 0.001 * at, 0.0)
        for cluster, size in enumerate(sizes)
        for at in range(size)
    ]
    return points(*sorted(rows, key=lambda row: (row[1], row[0])))


def test_size_limits_are_inclusive() -> None:
    parameters = Parameters(min_points=10, max_points=20)
    cloud = clusters(9, 10, 15, 20, 21)
    found = segment_indices(cloud, parameters)
    assert [len(indices) for indices in found] == [10, 15, 20]


def test_segments_hold_their_own_points_in_order_of_first_points() -> None:
    cloud = clusters(12, 11, 14)[::-1].copy()
    found = segment_indices(cloud, Parameters(min_points=10, max_points=20))
    assert [Counter(cloud[indices, 0].tolist()) for indices in found] == [
        {20.0: 14},
        {0.0: 12},
        {10.0: 11},
    ]
    assert all((np.diff(indices) > 0).all() for indices in found)
    assert [indices[0] for indices in found] == sorted(indices[0] for indices in found)


def test_limits_of_protocol_v1() -> None:
    assert [len(indices) for indices in segment_indices(clusters(99, 100), Parameters())] == [100]
