import numpy as np
import pytest

from placecell.core.segment_classes import (
    CLASSES,
    class_indices,
    class_names,
    class_probabilities,
    encoded,
    is_class,
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
