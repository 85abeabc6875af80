import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from placecell.core.segment_classes import (
    CLASSES,
    class_indices,
    class_names,
    class_probabilities,
    encoded,
    is_class,
    most_probable,
    movable,
)


def test_bytes_by_hand() -> None:
    codes = encoded([-1, 0, 0, 1, 3, 7], [0.7, 0, 1, 0.5, 0.9, 1])
    assert codes.dtype == np.uint8
    assert codes.tolist() == [0, 1, 31, 1 + 31 + 15, 1 + 93 + 27, 248]


def test_probability_is_rounded_to_the_nearest_step() -> None:
    codes = encoded([2, 2, 2], [0.016, 0.017, 0.99])
    assert codes.tolist() == [63, 64, 93]
    assert np.allclose(class_probabilities(codes), [0, 1 / 30, 1])


def test_every_byte_survives_decoding_and_encoding() -> None:
    codes = np.arange(249, dtype=np.uint8)
    assert np.array_equal(encoded(class_indices(codes), class_probabilities(codes)), codes)


def test_names_and_movable_classes() -> None:
    codes = encoded([-1, *range(8)], np.full(9, 0.5))
    assert class_names(codes) == [None, *CLASSES]
    assert [name for name, moves in zip(class_names(codes), movable(codes), strict=True) if moves] \
        == ["vehicle", "person"]  # fmt: skip
    assert is_class(codes, ["pole", "other"]).tolist() == [0, 0, 0, 1, 0, 0, 0, 0, 1]
    assert not is_class(codes, []).any()


def test_unknown_name_is_refused() -> None:
    with pytest.raises(ValueError, match="'car': expected building, vegetation, pole"):
        is_class(np.zeros(1, np.uint8), ["car"])


def test_byte_above_the_last_class_is_refused() -> None:
    with pytest.raises(ValueError, match="class 249: expected a byte of 0 to 248"):
        class_indices(np.array([3, 249], np.uint8))


@pytest.mark.parametrize(
    ("classes", "probabilities"),
    [([8], [0.5]), ([-2], [0.5]), ([0], [1.1]), ([0], [-0.1]), ([0], [np.nan]), ([0, 1], [0.5])],
)
def test_values_out_of_range_are_refused(classes: list[int], probabilities: list[float]) -> None:
    with pytest.raises(ValueError, match=r"Invalid|expected"):
        encoded(classes, probabilities)


def test_unknown_class_needs_no_probability() -> None:
    assert encoded([-1], [np.nan]).tolist() == [0]


COLUMN = st.lists(st.integers(0, 248), min_size=5, max_size=5).map(lambda c: np.array(c, np.uint8))


@given(COLUMN, COLUMN, COLUMN)
def test_merged_classes_depend_on_probability_and_not_on_who_came_how_often(
    one: np.ndarray, two: np.ndarray, three: np.ndarray
) -> None:
    merged = most_probable(one, two)
    # Again adds nothing, and the order of three parts in a row does not depend on the brackets.
    np.testing.assert_array_equal(most_probable(merged, two), merged)
    np.testing.assert_array_equal(most_probable(merged, one), merged)
    np.testing.assert_array_equal(
        most_probable(merged, three), most_probable(one, most_probable(two, three))
    )
    # A known class is never lost, and its probability never falls.
    assert ((merged != 0) == ((one != 0) | (two != 0))).all()
    highest = np.maximum(class_probabilities(one), class_probabilities(two))
    np.testing.assert_array_equal(class_probabilities(merged), highest)
    # Only a tie of two known classes depends on the order.
    differs = merged != most_probable(two, one)
    assert (class_probabilities(one) == class_probabilities(two))[differs].all()
    assert ((one != 0) & (two != 0))[differs].all()
