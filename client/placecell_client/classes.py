"""Classes of segments, and the byte that stores a class and its probability in a map.

Byte 0 is unknown. Byte 1 + 31 * class + step is a class, by its place in `CLASSES`, and its
probability, step / 30.
"""

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

CLASSES = ("building", "vegetation", "pole", "vehicle", "person", "fence", "sign", "other")
"""Names in the order of the bytes: a pole may be a trunk, a fence may be a wall."""
MOVABLE = ("vehicle", "person")
"""Classes that may stand elsewhere tomorrow; `ignore="movable"` names them."""
STEPS = 30
"""Steps of the probability between 0 and 1."""


def packed(name: str, probability: float) -> int:
    """Return the byte of a class and its probability, 0 to 1.

    Raises:
        ValueError: The name is not a class, or the probability is out of range.
    """
    if name not in CLASSES:
        raise ValueError(f"Invalid class {name!r:.40}: expected {', '.join(CLASSES)}.")
    if not 0 <= probability <= 1:
        raise ValueError(f"Invalid probability {probability}: expected 0 to 1.")
    return 1 + (STEPS + 1) * CLASSES.index(name) + round(STEPS * probability)


def class_names(classes: NDArray[np.uint8]) -> list[str | None]:
    """Return the name of each segment's class; None for unknown."""
    names = (*CLASSES, None)
    return [names[index] for index in _indices(classes).tolist()]


def class_probabilities(classes: NDArray[np.uint8]) -> NDArray[np.float32]:
    """Return the probability of each segment's class; 0 for unknown."""
    steps = (classes.astype(np.int64) - 1) % (STEPS + 1)
    return np.where(classes == 0, 0, steps / STEPS).astype(np.float32)


def is_class(classes: NDArray[np.uint8], names: Iterable[str]) -> NDArray[np.bool_]:
    """Return whether each segment has one of the named classes; unknown has none.

    Raises:
        ValueError: A name is not a class.
    """
    wanted = np.zeros(len(CLASSES) + 1, dtype=bool)  # the last entry, also -1, is unknown
    for name in names:
        if name not in CLASSES:
            raise ValueError(f"Invalid class {name!r:.40}: expected {', '.join(CLASSES)}.")
        wanted[CLASSES.index(name)] = True
    return wanted[_indices(classes)]


def _indices(classes: NDArray[np.uint8]) -> NDArray[np.int64]:
    """Return the place of each class in `CLASSES`; -1 for unknown."""
    indices = (classes.astype(np.int64) + STEPS) // (STEPS + 1) - 1
    if len(indices) and indices.max() >= len(CLASSES):
        raise ValueError(f"Invalid class {int(classes.max())}: expected a byte of 0 to 248.")
    return indices
