"""A13: an alignment searches in parts and can be cancelled between them."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from placecell.core.cancellation import Cancelled
from placecell.core.types import Float64, Int8, Int64
from service.merging import alignment
from service.merging.alignment import StoredDescriptorSearch


class Index:
    """Index whose nearest row to a query is the row that the query's code names."""

    def __init__(self) -> None:
        self.searched: list[int] = []

    def search(self, codes: Int8, k: int) -> tuple[Float64, Int64]:
        del k
        self.searched.append(len(codes))
        return np.zeros((len(codes), 1)), codes[:, :1].astype(np.int64)


@pytest.fixture
def looks(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return `MapLooks` of two maps, the index, and the remaining number of cancellation checks."""
    monkeypatch.setattr(alignment, "SEARCHED", 10)
    monkeypatch.setattr(alignment, "BLOCK", 10)
    monkeypatch.setattr(
        alignment, "match_probabilities", lambda model, one, other: (one == other).mean(axis=1)
    )
    patience = SimpleNamespace(left=100)

    def check() -> None:
        patience.left -= 1
        if patience.left < 0:
            raise Cancelled

    codes = np.arange(60, dtype=np.int8)[:, None]
    maps: Any = SimpleNamespace(codes=codes)
    index: Any = Index()
    model: Any = None
    return StoredDescriptorSearch(model, maps, maps, index, check), index, patience


def test_A13_search_in_parts_finds_the_same(looks: Any) -> None:
    looks, index, _ = looks
    rows = np.array([3, 3, 59, 0, *range(20, 45)])
    found, match_probabilities = looks.nearest(rows)
    assert found.ravel().tolist() == rows.tolist()
    assert (match_probabilities == 1.0).all()
    assert index.searched == [10, 10, 8]
    found, match_probabilities = looks.nearest(rows[:0])
    assert found.shape == (0, 1)
    assert match_probabilities.shape == (0, 1)


def test_A13_search_and_comparison_stop_between_parts(looks: Any) -> None:
    looks, index, patience = looks
    patience.left = 2
    with pytest.raises(Cancelled):
        looks.nearest(np.arange(60))
    assert index.searched == [10, 10]
    patience.left = 3
    with pytest.raises(Cancelled):
        looks.match_probabilities(np.arange(60), np.arange(60))
    assert patience.left == -1
