import numpy as np
import pytest

from placecell.core.radix_sort import stable_order


@pytest.mark.parametrize("bits", [0, 1, 11, 12, 26, 50, 62])
@pytest.mark.parametrize("count", [0, 1, 2, 100, 5000])
def test_order_is_the_stable_order(bits: int, count: int) -> None:
    keys = np.random.default_rng(bits).integers(0, 2**bits, count, dtype=np.int64)
    assert stable_order(keys).tolist() == np.argsort(keys, kind="stable").tolist()


def test_equal_keys_keep_their_order() -> None:
    assert stable_order(np.array([3, 1, 3, 1, 3])).tolist() == [1, 3, 0, 2, 4]


def test_keys_that_leave_no_bits_for_rows_are_sorted_as_well() -> None:
    keys = np.array([2**62, 0, 2**62 + 1, 5], dtype=np.int64)
    assert stable_order(keys).tolist() == [1, 3, 0, 2]
