"""Descriptors as they are stored: a dimension a byte, or several that share one."""

from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float32, Int8, Int64

LEVELS = {1: 255, 2: 15, 3: 6, 4: 4}
"""Of a dimension, by how many dimensions share a byte: their product fits into one."""

REACH = {1: 0.9995, 2: 0.99, 3: 0.94, 4: 0.85}
"""Share of the values seen in training that lie within reach: few levels are best spent near 0."""


@dataclass(frozen=True, slots=True)
class Quantizer:
    """Uniform levels, the same for every dimension, so that distances between levels are distances.

    Levels are whole numbers about 0: -127, -126, ..., 127 of a byte each; -7, -6, ..., 7 of two in
    a byte; -5, -3, ..., 5 of three; and -3, -1, 1, 3 of four.

    Attributes:
        step: what a level of 1 is worth, in the descriptor's unit.
        per_byte: how many dimensions share a byte, 1 to 4.
    """

    step: float
    per_byte: int = 1

    def __post_init__(self) -> None:
        if self.per_byte not in LEVELS:
            raise ValueError(f"{self.per_byte} dimensions in a byte; it holds 1 to 4")

    @classmethod
    def fit(
        cls, descriptors: Float32, per_byte: int = 1, quantile: float | None = None
    ) -> "Quantizer":
        """Steps that reach all but a few of the values seen in training; the rest saturate.

        Args:
            quantile: of the values' lengths, how many are within reach.
        """
        reach = float(np.quantile(np.abs(descriptors), quantile or REACH[per_byte]))
        return cls(max(reach, 1e-6) / cls(1.0, per_byte).highest, per_byte)

    @property
    def spacing(self) -> int:
        """Between levels: an even number of them lies about 0 at odd whole numbers."""
        return 1 + (LEVELS[self.per_byte] + 1) % 2

    @property
    def highest(self) -> int:
        """The highest level."""
        return (LEVELS[self.per_byte] - 1) * self.spacing // 2

    @property
    def _places(self) -> Int64:
        """What a level counts in its byte, as digits of a number."""
        return LEVELS[self.per_byte] ** np.arange(self.per_byte)

    def code_bytes(self, dimension: int) -> int:
        """Bytes of a stored descriptor."""
        return dimension // self.per_byte

    def as_dict(self) -> dict[str, float]:
        """For a manifest; of a byte each only the step is told, as before there were others."""
        return {"step": self.step} | ({} if self.per_byte == 1 else {"per_byte": self.per_byte})

    def encode(self, descriptors: Float32) -> Int8:
        """float32 (n, d) -> int8 (n, code bytes)."""
        count = LEVELS[self.per_byte]
        cells = np.floor(descriptors / (self.step * self.spacing) + count / 2)
        digits = cells.clip(0, count - 1).astype(np.int64)
        numbers = (
            digits.reshape(len(digits), digits.shape[1] // self.per_byte, self.per_byte)
            @ self._places
        )
        return np.asarray((numbers - count**self.per_byte // 2).astype(np.int8))

    def levels(self, codes: Int8) -> Int8:
        """int8 (n, code bytes) -> int8 (n, d)."""
        count = LEVELS[self.per_byte]
        every = np.arange(256, dtype=np.uint8).view(np.int8)[:, None].astype(np.int64)
        digits = (every + count**self.per_byte // 2) // self._places % count
        meaning = (digits * self.spacing - self.highest).astype(np.int8)
        return np.asarray(
            meaning[codes.view(np.uint8)].reshape(len(codes), codes.shape[1] * self.per_byte)
        )

    def rounded(self, descriptors: Float32) -> Float32:
        """Descriptors as levels, as the service compares them, float32 (n, d)."""
        return self.levels(self.encode(descriptors)).astype(np.float32)

    def decode(self, codes: Int8) -> Float32:
        """int8 (n, code bytes) -> float32 (n, d)."""
        return self.levels(codes).astype(np.float32) * np.float32(self.step)
