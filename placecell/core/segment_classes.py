"""Classes of segments, and the byte that stores a class and its probability.

Byte 0 is unknown. Byte 1 + 31 * class + step is a class, by its place in `CLASSES`, and its
probability, step / 30. `placecell_client.classes` reads the same bytes.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import ArrayLike

from placecell.core.types import Bool, Float32, Int64, UInt8

CLASSES = ("building", "vegetation", "pole", "vehicle", "person", "fence", "sign", "other")
"""Names in the order of the bytes: a pole may be a trunk, a fence may be a wall."""
MOVABLE = ("vehicle", "person")
"""Classes that may stand elsewhere tomorrow."""
UNKNOWN = 0
"""Byte of a segment without a class."""
STEPS = 30
"""Steps of the probability between 0 and 1."""
HIGHEST = len(CLASSES) * (STEPS + 1)
"""Largest valid byte."""


def encoded(classes: ArrayLike, probabilities: ArrayLike) -> UInt8:
    """Return the byte of each segment.

    Args:
        classes: Place of each class in `CLASSES`, or -1 for unknown, (n,).
        probabilities: Probability of that class, 0 to 1, (n,); ignored where it is unknown.

    Raises:
        ValueError: A class or a probability is out of range.
    """
    indices, shares = np.asarray(classes, np.int64), np.asarray(probabilities, np.float64)
    known = indices >= 0
    if indices.shape != shares.shape:
        raise ValueError(f"Found {shares.shape} probabilities, expected {indices.shape}.")
    if np.any((indices < -1) | (indices >= len(CLASSES))):
        raise ValueError(f"Invalid class: expected -1 to {len(CLASSES) - 1}.")
    if not np.all((shares[known] >= 0) & (shares[known] <= 1)):
        raise ValueError("Invalid probability of a class: expected 0 to 1.")
    steps = np.rint(np.where(known, shares, 0) * STEPS).astype(np.int64)
    return np.where(known, 1 + (STEPS + 1) * indices + steps, UNKNOWN).astype(np.uint8)


def class_indices(codes: UInt8) -> Int64:
    """Return the place of each class in `CLASSES`; -1 for unknown.

    Raises:
        ValueError: A byte is above `HIGHEST`.
    """
    if np.any(codes > HIGHEST):
        raise ValueError(f"Invalid class {int(codes.max())}: expected a byte of 0 to {HIGHEST}.")
    return (codes.astype(np.int64) + STEPS) // (STEPS + 1) - 1


def class_probabilities(codes: UInt8) -> Float32:
    """Return the probability of each class; 0 for unknown."""
    steps = (codes.astype(np.int64) - 1) % (STEPS + 1)
    return np.where(codes == UNKNOWN, 0, steps / STEPS).astype(np.float32)


def class_names(codes: UInt8) -> list[str | None]:
    """Return the name of each class; None for unknown."""
    names = (*CLASSES, None)
    return [names[index] for index in class_indices(codes).tolist()]


def is_class(codes: UInt8, names: Iterable[str]) -> Bool:
    """Return whether each segment has one of the named classes; unknown has none.

    Raises:
        ValueError: A name is not a class.
    """
    known = np.zeros(len(CLASSES) + 1, dtype=bool)  # the last entry, also -1, is unknown
    for name in names:
        if name not in CLASSES:
            raise ValueError(f"Invalid class {name!r:.40}: expected {', '.join(CLASSES)}.")
        known[CLASSES.index(name)] = True
    return known[class_indices(codes)]


def most_probable(one: UInt8, other: UInt8) -> UInt8:
    """Return the more probable of two classes of each segment; of equals, the first."""
    is_more = class_probabilities(other) > class_probabilities(one)
    return np.where(is_more | ((one == UNKNOWN) & (other != UNKNOWN)), other, one)


def movable(codes: UInt8) -> Bool:
    """Return whether each segment has a class that may stand elsewhere tomorrow."""
    return is_class(codes, MOVABLE)


@dataclass(frozen=True, slots=True)
class ClassFilter:
    """Filter of segments by their class. Equal filters keep the same segments.

    Attributes:
        kept: names of the classes to keep.
        keeps_unknown: whether to keep segments without a class.
    """

    kept: frozenset[str]
    keeps_unknown: bool

    @classmethod
    def of(cls, classes: Iterable[str] | None, ignore: Iterable[str] = ()) -> Self | None:
        """Return the filter of a request; None if it keeps all segments.

        Args:
            classes: names of the classes to keep. None: all, and segments without a class.
            ignore: names of the classes to leave out; `movable` names `MOVABLE`. A segment without
                a class is never left out by it.

        Raises:
            ValueError: a name is not a class.
        """
        wanted = frozenset(CLASSES if classes is None else classes)
        unwanted = {each for name in ignore for each in (MOVABLE if name == "movable" else (name,))}
        for name in sorted(wanted | unwanted):
            if name not in CLASSES:
                names = ", ".join(CLASSES)
                extra = ", or movable" if name in unwanted else ""
                raise ValueError(f"Invalid class {name!r:.40}. Expected {names}{extra}.")
        if classes is None and not unwanted:
            return None
        return cls(wanted - unwanted, classes is None)

    @property
    def label(self) -> str:
        """Name of the filter; equal filters have equal names."""
        return ".".join([*sorted(self.kept), *["unknown"] * self.keeps_unknown])

    def keeps(self, codes: UInt8) -> Bool:
        """Return whether to keep each segment of a map."""
        if self.keeps_unknown:
            return ~is_class(codes, frozenset(CLASSES) - self.kept)
        return is_class(codes, self.kept)

    def keeps_query(self, codes: UInt8) -> Bool:
        """Return whether to search for each segment of a request; unknown ones always are."""
        return np.asarray((codes == UNKNOWN) | is_class(codes, self.kept))
