"""Quantizer: encodes descriptors into codes, one dimension per byte or several per byte."""

from dataclasses import dataclass
from functools import cache
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Float32, Int8, Int64

Value = TypeVar("Value", bound=np.generic)

LEVELS = {1: 255, 2: 15, 3: 6, 4: 4}
"""Number of levels of a dimension by the number of dimensions that share a byte."""

REACH = {1: 0.9995, 2: 0.99, 3: 0.94, 4: 0.85}
"""Share of the training values within the range of the levels, by dimensions per byte.

With few levels, a smaller range with finer steps near 0 is better.
"""


@dataclass(frozen=True, slots=True)
class Quantizer:
    """Uniform quantizer with the same levels in all dimensions.

    Distances between levels are therefore proportional to distances between descriptors. Levels are
    integers around 0: -127, -126, ..., 127 with one dimension per byte; -7, -6, ..., 7 with two;
    -5, -3, ..., 5 with three; and -3, -1, 1, 3 with four.

    Attributes:
        step: descriptor value of level 1.
        per_byte: number of dimensions that share a byte, 1 to 4.
    """

    step: float
    per_byte: int = 1

    def __post_init__(self) -> None:
        if self.per_byte not in LEVELS:
            raise ValueError(
                f"Invalid number of dimensions per byte {self.per_byte}: expected 1 to 4"
            )

    @classmethod
    def fit(
        cls, descriptors: Float32, per_byte: int = 1, quantile: float | None = None
    ) -> "Quantizer":
        """Choose the step so that all but a few training values are in range; the others saturate.

        Args:
            descriptors: training descriptors, float32 (n, d).
            per_byte: number of dimensions that share a byte.
            quantile: share of the absolute values in range; None for the default of `REACH`.
        """
        reach = float(np.quantile(np.abs(descriptors), quantile or REACH[per_byte]))
        return cls(max(reach, 1e-6) / cls(1.0, per_byte).highest, per_byte)

    @property
    def spacing(self) -> int:
        """Difference between neighboring levels: 1, or 2 if the number of levels is even."""
        return 1 + (LEVELS[self.per_byte] + 1) % 2

    @property
    def highest(self) -> int:
        """Highest level."""
        return (LEVELS[self.per_byte] - 1) * self.spacing // 2

    @property
    def _places(self) -> Int64:
        """Weight of each dimension's digit in the byte's value, int64 (per_byte,)."""
        return LEVELS[self.per_byte] ** np.arange(self.per_byte)

    def code_bytes(self, dimension: int) -> int:
        """Return the number of bytes of a code.

        Args:
            dimension: number of values of the descriptor.
        """
        return dimension // self.per_byte

    def as_dict(self) -> dict[str, float]:
        """Return the values for a manifest. With one dimension per byte it has the step only."""
        return {"step": self.step} | ({} if self.per_byte == 1 else {"per_byte": self.per_byte})

    def encode(self, descriptors: Float32) -> Int8:
        """Encode descriptors, float32 (n, d), into codes, int8 (n, code bytes)."""
        count = LEVELS[self.per_byte]
        cells = np.floor(descriptors / (self.step * self.spacing) + count / 2)
        digits = cells.clip(0, count - 1).astype(np.int64)
        numbers = (
            digits.reshape(len(digits), digits.shape[1] // self.per_byte, self.per_byte)
            @ self._places
        )
        return np.asarray((numbers - count**self.per_byte // 2).astype(np.int8))

    def levels(self, codes: Int8) -> Int8:
        """Return the levels, int8 (n, d), of codes, int8 (n, code bytes)."""
        return looked_up(levels_of_bytes(self.per_byte), codes)

    def rounded(self, descriptors: Float32) -> Float32:
        """Round descriptors to levels, float32 (n, d), as the service compares them."""
        return self.levels(self.encode(descriptors)).astype(np.float32)

    def decode(self, codes: Int8) -> Float32:
        """Decode codes, int8 (n, code bytes), into descriptors, float32 (n, d)."""
        values = levels_of_bytes(self.per_byte).astype(np.float32) * np.float32(self.step)
        return looked_up(values, codes)


@cache
def levels_of_bytes(per_byte: int) -> Int8:
    """Return the levels of each byte of a code, int8 (256, per_byte), in the order of uint8."""
    quantizer, count = Quantizer(1.0, per_byte), LEVELS[per_byte]
    every = np.arange(256, dtype=np.uint8).view(np.int8)[:, None].astype(np.int64)
    digits = (every + count**per_byte // 2) // quantizer._places % count
    return np.asarray((digits * quantizer.spacing - quantizer.highest).astype(np.int8))


def looked_up(table: NDArray[Value], codes: Int8) -> NDArray[Value]:
    """Return the values of each byte of the codes, (n, d), from a table (256, per_byte)."""
    # No byte is outside of the table; without the check, `take` is nine times faster.
    values = np.take(table, codes.view(np.uint8), axis=0, mode="clip")
    return np.asarray(values.reshape(len(codes), codes.shape[1] * table.shape[1]))
