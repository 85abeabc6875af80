"""Descriptors as they are stored: one signed byte a dimension."""

from dataclasses import dataclass

import numpy as np

from segments.types import Float32, Int8


@dataclass(frozen=True, slots=True)
class Quantiser:
    """Uniform steps, the same for every dimension, so that distances between codes are distances.

    Attributes:
        step: what one code is worth, in the descriptor's unit.
    """

    step: float

    @classmethod
    def fit(cls, descriptors: Float32, quantile: float = 0.9995) -> "Quantiser":
        """Steps that reach all but a few of the values seen in training; the rest saturate."""
        reach = float(np.quantile(np.abs(descriptors), quantile))
        return cls(step=max(reach, 1e-6) / 127)

    def encode(self, descriptors: Float32) -> Int8:
        """float32 (n, d) -> int8 (n, d)."""
        codes = np.rint(descriptors / self.step).clip(-127, 127)
        return np.asarray(codes, dtype=np.int8)

    def decode(self, codes: Int8) -> Float32:
        """int8 (n, d) -> float32 (n, d)."""
        return codes.astype(np.float32) * np.float32(self.step)
