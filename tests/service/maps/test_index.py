"""Index: a search equals the comparison of every pair, for all kinds of codes."""

import numpy as np
import pytest

from placecell.core.types import Bool, Float64, Int8, Int64
from placecell.descriptors.quantizer import LEVELS, Quantizer
from service.maps import index as map_index
from service.maps.index import MARGIN, FlatIndex, NibbleIndex, index_of


def codes_of(rows: int, per_byte: int, width: int = 12, seed: int = 0) -> Int8:
    """Return random codes of a quantizer with a number of dimensions per byte."""
    most = LEVELS[per_byte] ** per_byte
    drawn = np.random.default_rng(seed).integers(0, most, (rows, width)) - most // 2
    return np.asarray(drawn, np.int8)


def by_hand(
    stored: Int8, asked: Int8, quantizer: Quantizer, k: int, gone: Bool | None = None
) -> tuple[Float64, Int64]:
    """Compare every pair; order ties by row."""
    levels = quantizer.levels(stored).astype(np.int64)
    apart = quantizer.levels(asked).astype(np.int64)[:, None] - levels[None]
    squared = (apart**2).sum(axis=2).astype(float)
    if gone is not None:
        squared[:, gone] = np.inf
    rows = np.argsort(squared, axis=1, kind="stable")[:, :k]
    return np.sqrt(np.take_along_axis(squared, rows, axis=1)), rows


@pytest.mark.parametrize("per_byte", [1, 2, 3, 4])
@pytest.mark.parametrize("rows", [1, 5, MARGIN + 9, 3000])
@pytest.mark.parametrize("queries", [1, 19, 64])
def test_search_equals_comparison_with_all_rows(per_byte: int, rows: int, queries: int) -> None:
    quantizer = Quantizer(0.01, per_byte)
    stored = codes_of(rows, per_byte)
    asked = codes_of(queries, per_byte, seed=1)
    asked[:rows:2] = stored[: len(asked[:rows:2])]
    distances, found = index_of(stored, quantizer).search(asked, 10)
    wanted, places = by_hand(stored, asked, quantizer, min(10, rows))
    np.testing.assert_array_equal(found, places)
    np.testing.assert_allclose(distances, wanted)


@pytest.mark.parametrize("per_byte", [1, 4])
@pytest.mark.parametrize("queries", [1, 2, 31])
def test_search_on_several_cores_equals_search_on_one(
    per_byte: int, queries: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    stored, asked = codes_of(3000, per_byte), codes_of(queries, per_byte, seed=1)
    index = index_of(stored, Quantizer(0.01, per_byte))
    one = index.search(asked, 10)
    monkeypatch.setattr(map_index, "PARALLEL", 1)
    monkeypatch.setattr(map_index, "CORES", 3)
    several = index.search(asked, 10)
    np.testing.assert_array_equal(several[0], one[0])
    np.testing.assert_array_equal(several[1], one[1])


@pytest.mark.parametrize("per_byte", [1, 2, 4])
def test_search_orders_ties_by_row(per_byte: int) -> None:
    # There are more ties than rows fetched at first.
    quantizer = Quantizer(1.0, per_byte)
    stored = np.repeat(codes_of(4, per_byte), 200, axis=0)
    stored[::200] = stored[0] * 0 - 100  # the farthest corner: sums as large as they can be
    asked = stored[[1, 201, 401]]
    _, found = index_of(stored, quantizer).search(asked, 25)
    np.testing.assert_array_equal(found, by_hand(stored, asked, quantizer, 25)[1])


def test_search_with_too_many_ties_returns_any_of_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(map_index, "MOST", 64)
    stored = np.repeat(codes_of(1, 4), 5000, axis=0)
    distances, found = index_of(stored, Quantizer(1.0, 4)).search(stored[:2], 40)
    assert (distances == 0).all()
    assert len(np.unique(found[0])) == 40


@pytest.mark.parametrize("per_byte", [1, 2, 4])
@pytest.mark.parametrize("share", [0.1, 0.9, 0.999])
def test_search_excludes_gone_rows(per_byte: int, share: float) -> None:
    quantizer = Quantizer(1.0, per_byte)
    stored, asked = codes_of(3000, per_byte), codes_of(8, per_byte, seed=2)
    gone = np.random.default_rng(3).random(3000) < share
    gone[7] = False
    k = min(10, int((~gone).sum()))
    distances, found = index_of(stored, quantizer).search(asked, 10, gone)
    wanted, places = by_hand(stored, asked, quantizer, k, gone)
    np.testing.assert_array_equal(found, places)
    np.testing.assert_allclose(distances, wanted)


def test_search_of_empty_index_finds_nothing() -> None:
    quantizer = Quantizer(1.0, 4)
    stored = codes_of(3, 4)
    for k, gone, queries in ((0, None, 2), (5, np.ones(3, bool), 2), (5, None, 0)):
        distances, rows = index_of(stored, quantizer).search(stored[:queries], k, gone)
        assert distances.shape == rows.shape
        assert not rows.size
    assert not index_of(stored[:0], quantizer).search(stored, 5)[1].size


def test_search_is_independent_of_batch_and_order() -> None:
    stored, asked = codes_of(2000, 4, 32), codes_of(30, 4, 32, seed=4)
    index = index_of(stored, Quantizer(1.0, 4))
    together = index.search(asked, 10)
    for row in range(len(asked)):
        alone = index.search(asked[row : row + 1], 10)
        np.testing.assert_array_equal(alone[0][0], together[0][row])
        np.testing.assert_array_equal(alone[1][0], together[1][row])


@pytest.mark.parametrize("dimension", [7, 258])
def test_float_sums_are_exact(dimension: int) -> None:
    stored = codes_of(400, 1, dimension)
    stored[::10] = -127
    quantizer = Quantizer(0.01)
    distances, rows = FlatIndex(stored, quantizer).search(stored[:20], 25)
    wanted, places = by_hand(stored, stored[:20], quantizer, 25)
    np.testing.assert_array_equal(rows, places)
    np.testing.assert_allclose(distances, wanted)


def test_codes_of_nibbles_get_a_nibble_index() -> None:
    kinds = {per_byte: type(index_of(codes_of(9, per_byte), Quantizer(1.0, per_byte)))
             for per_byte in LEVELS}  # fmt: skip
    assert kinds == {1: FlatIndex, 2: NibbleIndex, 3: FlatIndex, 4: NibbleIndex}
