"""Descriptors as they are stored: a signed byte a dimension, or half of one."""

from dataclasses import dataclass

import numpy as np

from segments.types import Float32, Int8


@dataclass(frozen=True, slots=True)
class Quantiser:
    """Uniform steps, the same for every dimension, so that distances between levels are distances.

    Attributes:
        step: what one level is worth, in the descriptor's unit.
        bits: of a level, 8 or 4. Of 4, two levels share a byte: an even dimension and, in the upper
            half, the odd one after it.
    """

    step: float
    bits: int = 8

    def __post_init__(self) -> None:
        if self.bits not in (4, 8):
            raise ValueError(f"levels of {self.bits} bits; there are 4 and 8")

    @classmethod
    def fit(cls, descriptors: Float32, bits: int = 8, quantile: float | None = None) -> "Quantiser":
        """Steps that reach all but a few of the values seen in training; the rest saturate.

        Args:
            quantile: of the values, how many are within reach. Few levels are better spent near 0.
        """
        if quantile is None:
            quantile = 0.9995 if bits == 8 else 0.997
        reach = float(np.quantile(np.abs(descriptors), quantile))
        return cls(step=max(reach, 1e-6) / (2 ** (bits - 1) - 1), bits=bits)

    def code_bytes(self, dimension: int) -> int:
        """Bytes of a stored descriptor."""
        return dimension * self.bits // 8

    def as_dict(self) -> dict[str, float]:
        """For a manifest; of 8 bits only the step is told, as it was before there were others."""
        return {"step": self.step} | ({} if self.bits == 8 else {"bits": self.bits})

    def encode(self, descriptors: Float32) -> Int8:
        """float32 (n, d) -> int8 (n, code bytes)."""
        highest = 2 ** (self.bits - 1) - 1
        levels = np.rint(descriptors / self.step).clip(-highest, highest).astype(np.int8)
        if self.bits == 8:
            return np.asarray(levels)
        return np.asarray((levels[:, 0::2] & 0x0F) | (levels[:, 1::2] << 4))

    def levels(self, codes: Int8) -> Int8:
        """int8 (n, code bytes) -> int8 (n, d): whole steps."""
        if self.bits == 8:
            return codes
        levels = np.empty((len(codes), 2 * codes.shape[1]), dtype=np.int8)
        levels[:, 0::2] = (codes << 4) >> 4  # the shift back keeps the sign
        levels[:, 1::2] = codes >> 4
        return levels

    def rounded(self, descriptors: Float32) -> Float32:
        """Descriptors in whole steps, as the service compares them, float32 (n, d)."""
        return self.levels(self.encode(descriptors)).astype(np.float32)

    def decode(self, codes: Int8) -> Float32:
        """int8 (n, code bytes) -> float32 (n, d)."""
        return self.levels(codes).astype(np.float32) * np.float32(self.step)
