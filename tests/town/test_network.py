import numpy as np
import pytest
from scipy.spatial import cKDTree

from town.streets.network import LONGEST, OWN, Network, arc_length, components, thinned


@pytest.fixture(scope="module")
def network() -> Network:
    return Network.draw(seed=7, meters=3000.0)


def test_same_seed_gives_the_same_network(network: Network) -> None:
    again = Network.draw(seed=7, meters=3000.0)
    assert np.array_equal(again.streets, network.streets)
    assert np.array_equal(again.designs, network.designs)
    assert np.array_equal(again.lengths, network.lengths)
    assert not np.array_equal(Network.draw(seed=8, meters=3000.0).lengths, network.lengths)


@pytest.mark.parametrize("meters", [1.0, 700.0, 3000.0, 20_000.0])
def test_network_has_the_requested_length(meters: float) -> None:
    drawn = Network.draw(seed=1, meters=meters)
    assert meters <= drawn.meters() < max(meters + 100.0, 700.0)


@pytest.mark.parametrize("meters", [0.0, -5.0, LONGEST + 1, np.nan, np.inf])
def test_impossible_sizes_are_refused(meters: float) -> None:
    with pytest.raises(ValueError, match="m of streets"):
        Network.draw(seed=1, meters=meters)


@pytest.mark.parametrize("seed", range(5))
def test_network_is_connected_without_dead_ends(seed: int) -> None:
    drawn = Network.draw(seed=seed, meters=2000.0)
    degrees = np.bincount(drawn.streets.ravel())
    assert degrees.min() >= 2
    assert degrees.max() >= 3  # no mere ring
    assert components(drawn.streets, len(degrees)) == 1


def test_streets_are_missing(network: Network) -> None:
    columns, rows = len(network.plan.easts), len(network.plan.norths)
    everything = columns * (rows - 1) + rows * (columns - 1)
    assert 0.6 * everything < len(network.streets) < 0.95 * everything


def test_thinning_stops_where_a_street_would_be_cut_off() -> None:
    """Two squares side by side: of their seven streets none can go but the one that they share,
    and then a ring would be left."""
    ladder = np.array([[0, 1], [2, 3], [4, 5], [0, 2], [2, 4], [1, 3], [3, 5]])
    kept = thinned(ladder, np.ones(7), meters=1.0, rng=np.random.default_rng(0))
    assert kept.tolist() == list(range(7))


def test_thinning_keeps_the_requested_length() -> None:
    grid = np.array(
        [(3 * i + j, 3 * i + j + 1) for i in range(3) for j in range(2)]
        + [(3 * i + j, 3 * i + j + 3) for i in range(2) for j in range(3)]
    )
    for wanted in (10.0, 11.0, 12.0):
        kept = thinned(grid, np.ones(12), wanted, np.random.default_rng(3))
        assert len(kept) >= wanted
    assert len(thinned(grid, np.ones(12), 11.0, np.random.default_rng(3))) == 11


def test_joins_says_which_crossings_a_street_joins(network: Network) -> None:
    one, other = (network.crossing(number) for number in network.streets[0])
    assert network.joins(one, other)
    assert network.joins(other, one)
    assert not network.joins(one, one)
    assert not network.joins((0, 0), (1, 1))
    assert not network.joins((0, 0), (-1, 0))  # beyond the town
    assert int(network.joined.sum()) == 2 * len(network.streets)


def test_numbers_and_crossings_correspond(network: Network) -> None:
    for number in range(len(network.joined)):
        assert network.number(network.crossing(number)) == number
    with pytest.raises(ValueError, match="no crossing"):
        network.number((len(network.plan.easts), 0))


def test_lengths_are_those_of_the_lines(network: Network) -> None:
    for line, length, ends in zip(network.lines(), network.lengths, network.streets, strict=True):
        assert arc_length(line) == pytest.approx(length)
        start = network.terrain.bend(network.plan.crossing(*network.crossing(ends[0])))
        assert line[0] == pytest.approx(start)


def test_streets_wind_and_none_is_squeezed(network: Network) -> None:
    on_plan = [
        np.linalg.norm(
            network.plan.crossing(*network.crossing(one))
            - network.plan.crossing(*network.crossing(other))
        )
        for one, other in network.streets
    ]
    stretched = network.lengths / on_plan
    assert stretched.min() > 0.94
    turned = [
        np.ptp(np.unwrap(np.arctan2(*np.diff(line, axis=0).T[::-1]))) for line in network.lines()
    ]
    assert np.degrees(np.max(turned)) > 3.0


def test_streets_do_not_run_into_each_other(network: Network) -> None:
    lines = list(network.lines())
    for number, line in enumerate(lines):
        inner = line[15:-15]
        others = np.concatenate(lines[:number] + lines[number + 1 :])
        assert cKDTree(others).query(inner)[0].min() > 12.0


def test_the_share_of_look_alikes_is_as_asked() -> None:
    large = Network.draw(seed=2, meters=20_000.0, look_alikes=0.4)
    assert np.mean(large.designs != OWN) == pytest.approx(0.4, abs=0.1)
    assert set(large.designs.tolist()) == {OWN, 0, 1, 2, 3}
    assert (Network.draw(seed=2, meters=2000.0, look_alikes=0.0).designs == OWN).all()
    with pytest.raises(ValueError, match="0 to 1"):
        Network.draw(seed=2, meters=2000.0, look_alikes=1.5)
    one, other = (large.crossing(number) for number in large.streets[3])
    assert large.design(other, one) == large.designs[3]
