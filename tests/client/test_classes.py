"""The client reads the same classes as the service writes."""

import numpy as np
import pytest
from placecell_client.classes import (
    CLASSES,
    MOVABLE,
    class_names,
    class_probabilities,
    is_class,
)

from placecell.core import segment_classes

BYTES = np.arange(249, dtype=np.uint8)


def test_client_and_service_agree_on_every_byte() -> None:
    assert (CLASSES, MOVABLE) == (segment_classes.CLASSES, segment_classes.MOVABLE)
    assert class_names(BYTES) == segment_classes.class_names(BYTES)
    np.testing.assert_array_equal(
        class_probabilities(BYTES), segment_classes.class_probabilities(BYTES)
    )
    for name in CLASSES:
        np.testing.assert_array_equal(
            is_class(BYTES, [name]), segment_classes.is_class(BYTES, [name])
        )


def test_names_by_hand() -> None:
    classes = np.array([0, 1, 31, 32, 94, 125, 248], np.uint8)
    assert class_names(classes) == [
        None, "building", "building", "vegetation", "vehicle", "person", "other"
    ]  # fmt: skip
    assert is_class(classes, MOVABLE).tolist() == [False] * 4 + [True, True, False]


def test_unknown_name_is_refused() -> None:
    with pytest.raises(ValueError, match="Invalid class 'car': expected building, vegetation"):
        is_class(BYTES, ["car"])


def test_byte_above_the_last_class_is_refused() -> None:
    with pytest.raises(ValueError, match="Invalid class 255: expected a byte of 0 to 248"):
        class_names(np.array([255], np.uint8))
