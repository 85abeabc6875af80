import numpy as np
import pytest

from placecell.core.bits import packed, unpacked, words_of


@pytest.mark.parametrize("count", [0, 1, 63, 64, 65, 200])
def test_unpacked_bits_are_the_members(count: int) -> None:
    members = np.random.default_rng(0).uniform(size=(3, count)) < 0.5
    bits = packed(members)
    assert bits.shape == (3, words_of(count))
    np.testing.assert_array_equal(unpacked(bits, count), members)


def test_member_is_a_bit_of_its_word() -> None:
    members = np.zeros(130, dtype=bool)
    members[[0, 3, 64, 129]] = True
    assert packed(members).tolist() == [9, 1, 2]
