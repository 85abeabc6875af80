from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from placecell.core.grid_cells import neighboring
from placecell.core.types import Float64
from placecell.localization.candidates import Candidates
from placecell.localization.correspondences import Correspondences, correspond, number_places
from placecell.localization.parameters import LocalizationParameters
from tests.placecell.localization.scene_builders import take

PARAMETERS = LocalizationParameters()


def candidates(
    places: Sequence[Sequence[tuple[float, float, float]]], probabilities: list[list[float]]
) -> Candidates:
    """Return candidates; query i is at (i, 0, 0), and equal places have equal rows."""
    targets = np.array(places, dtype=float)
    n, k, _ = targets.shape
    _, rows = np.unique(targets.reshape(-1, 3), axis=0, return_inverse=True)
    return Candidates(
        np.stack([np.arange(n), np.zeros(n), np.zeros(n)], axis=1).astype(float),
        rows.reshape(n, k),
        targets,
        np.array(probabilities),
    )


def weight(share: float, claims: float = 1.0) -> float:
    return float(np.log1p(share / (0.01 * claims)))


def of_query(found: Correspondences, query: int) -> dict[float, float]:
    """Return the weight of each place by its x."""
    mine = found.queries == query
    return dict(zip(found.target[mine, 0].tolist(), found.weights[mine].tolist(), strict=True))


def test_weights_by_hand() -> None:
    found = correspond(candidates([[(0, 0, 0), (50, 0, 0)]], [[0.6, 0.2]]), PARAMETERS)
    assert of_query(found, 0) == pytest.approx({0.0: weight(0.75), 50.0: weight(0.25)})
    assert found.usable == 1


def test_views_of_one_place_are_one_correspondence() -> None:
    places = [[(0.0, 0, 0), (50, 0, 0), (0.9, 0, 0), (0, 0.5, 0)]]
    found = correspond(candidates(places, [[0.1, 0.5, 0.3, 0.1]]), PARAMETERS)
    # Told by the likeliest of them.
    assert of_query(found, 0) == pytest.approx({0.9: weight(0.5), 50.0: weight(0.5)})


def test_place_claimed_by_many_queries_weighs_less() -> None:
    lonely = [(100.0 * i, 0.0, 0.0) for i in (1, 2, 3)]
    places = [[(0.0, 0.0, 0.0), place] for place in lonely]
    found = correspond(candidates(places, [[0.5, 0.5]] * 3), PARAMETERS)
    for query in range(3):
        weights = of_query(found, query)
        assert weights.pop(0.0) == pytest.approx(weight(0.5, claims=1.5))
        assert list(weights.values()) == pytest.approx([weight(0.5)])


def test_look_alikes_weigh_less() -> None:
    alike = [[(100.0 * i, 0.0, 0.0) for i in range(10)]]
    clear = of_query(correspond(candidates(alike, [[0.9] + [0.01] * 9]), PARAMETERS), 0)
    vague = of_query(correspond(candidates(alike, [[0.9] * 10]), PARAMETERS), 0)
    assert clear[0.0] > vague[0.0]


NAN = float("nan")


def test_nan_is_ignored() -> None:
    good = [(0.0, 0.0, 0.0), (50.0, 0.0, 0.0)]
    places = [[(NAN, 0.0, 0.0), (50.0, 0.0, 0.0)], good, good]
    given = candidates(places, [[0.5, 0.5], [NAN, 0.5], [0.5, 0.5]])
    centroids: Float64 = given.centroids.copy()
    centroids[2, 1] = np.inf
    found = correspond(
        Candidates(centroids, given.rows, given.places, given.probabilities),
        PARAMETERS,
    )
    assert found.usable == 2
    assert found.queries.tolist() == [0, 1]
    assert found.target[:, 0].tolist() == [50, 50]


def test_no_candidates_are_no_correspondences() -> None:
    for n, k in ((0, 3), (3, 0)):
        none = Candidates(
            np.zeros((n, 3)), np.zeros((n, k), np.int64), np.zeros((n, k, 3)), np.zeros((n, k))
        )
        found = correspond(none, PARAMETERS)
        assert len(found) == found.usable == 0


def test_arrays_that_do_not_fit_are_refused() -> None:
    rows = np.zeros((2, 3), dtype=np.int64)
    good = Candidates(np.zeros((2, 3)), rows, np.zeros((2, 3, 3)), np.zeros((2, 3)))
    for name in ("centroids", "places", "probabilities"):
        with pytest.raises(ValueError, match=name):
            replace(good, **{name: np.zeros((2, 4))})  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="centroids"):
        replace(good, rows=rows[0])


def test_near_rows_belong_to_one_place() -> None:
    points = np.array([[0.0, 0, 0], [0.6, 0, 0], [1.2, 0, 0], [9, 0, 0], [0.0, 0, 0]])
    rows = np.array([7, 3, 5, 1, 7])
    numbers = number_places(rows, points, 1.0)
    # The second belongs to the first, so the third, within reach of it alone, stands by itself.
    assert numbers[0] == numbers[1] == numbers[4]
    assert len({numbers[0], numbers[2], numbers[3]}) == 3


def test_the_order_of_queries_makes_no_difference() -> None:
    random = np.random.default_rng(0)
    n, k = 30, 8
    rows = random.integers(0, 100, (n, k))
    map_ = random.uniform(0, 60, (100, 3))
    given = Candidates(random.uniform(0, 60, (n, 3)), rows, map_[rows], random.uniform(size=(n, k)))
    order = random.permutation(n)
    other = take(given, order)
    one, two = correspond(given, PARAMETERS), correspond(other, PARAMETERS)
    np.testing.assert_array_equal(one.source, two.source)
    np.testing.assert_array_equal(one.rows, two.rows)
    np.testing.assert_allclose(one.weights, two.weights, rtol=1e-12)
    np.testing.assert_array_equal(one.queries, order[two.queries])


def test_too_many_candidates_keep_the_most_probable() -> None:
    places = [[(10.0 * i, 0.0, 0.0) for i in range(6)]]
    given = candidates(places, [[0.1, 0.9, 0.3, 0.8, 0.2, 0.7]])
    found = correspond(given, LocalizationParameters(most_candidates=3))
    assert sorted(found.target[:, 0].tolist()) == [10, 30, 50]


def test_a_map_in_one_point_is_one_place() -> None:
    """All segments are near each other, which makes 50 million pairs."""
    points = np.random.default_rng(1).normal(scale=0.01, size=(10_000, 3))
    assert set(number_places(np.arange(10_000), points, 1.0).tolist()) == {0}


def test_places_do_not_depend_on_how_rows_are_numbered() -> None:
    random = np.random.default_rng(2)
    points = random.uniform(0, 12, (300, 3))
    order = random.permutation(300)
    one = number_places(np.arange(300), points, 1.0)
    other = number_places(np.arange(300), points[order], 1.0)
    np.testing.assert_array_equal(one[order], other)
    # Two of one place are at most two radii apart, and their leader is within one of each.
    apart = np.linalg.norm(points[:, None] - points, axis=2)
    assert apart[one[:, None] == one].max() < 2
    # Two leaders are never closer than the radius.
    by_x = np.lexsort(points.T[::-1])
    _, first = np.unique(one[by_x], return_index=True)
    leads = by_x[first]
    among = apart[np.ix_(leads, leads)] + 9 * np.eye(len(leads))
    assert among.min() >= 1


def numbered_plainly(points: np.ndarray, radius: float) -> list[int]:
    """Return place numbers by comparing each point with all leaders, as a reference."""
    numbers, leaders = np.zeros(len(points), dtype=np.int64), np.zeros((0, 3))
    for point in np.lexsort(points.T[::-1]):
        near = ((leaders - points[point]) ** 2).sum(axis=1) < radius * radius
        numbers[point] = near.argmax() if near.any() else len(leaders)
        if not near.any():
            leaders = np.vstack([leaders, points[point]])
    return numbers.tolist()


@pytest.mark.parametrize("extent", [0.5, 3.0, 30.0])
@pytest.mark.parametrize("kind", ["anywhere", "grid", "line", "no-numbers"])
def test_A13_places_are_numbered_as_by_comparing_all(extent: float, kind: str) -> None:
    for seed in range(5):
        points = np.random.default_rng(seed).uniform(-extent, extent, (150, 3)) * (1, 1, 0.3)
        if kind == "grid":
            points = np.round(points * 4) / 4
        elif kind == "line":
            points = points * (0, 1, 0)
        elif kind == "no-numbers":
            points[::7] = np.nan
            points[::11, 1] = np.inf
        with np.errstate(invalid="ignore"):
            expected = numbered_plainly(points, 1.0)
        assert number_places(np.arange(150), points, 1.0).tolist() == expected


@pytest.mark.parametrize(
    "direction", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 0), (0, 0, 0)], ids=str
)
def test_A13_each_point_is_compared_with_few(
    direction: tuple[int, int, int],
) -> None:
    points = np.outer(np.arange(2_000) * 1.5, direction)
    numbers, around = neighboring(points, 1.0)
    # Leaders of a cell are apart, so what a point may be held against is bounded by the cells.
    compared = np.bincount(numbers, minlength=len(around))
    compared[:] = np.minimum(compared, 8)
    assert np.where(around < 0, 0, compared[around]).sum(axis=1).max() <= 30


def test_A13_numbering_stops_when_cancelled() -> None:
    with cancelled_by(CancelToken()) as token:
        token.cancel()
        with pytest.raises(Cancelled):
            number_places(np.arange(10), np.zeros((10, 3)), 1.0)
