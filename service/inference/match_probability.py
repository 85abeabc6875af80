"""How likely pairs of descriptors are of one segment."""

import numpy as np

from placecell.core.types import Float64, Int8
from service.inference.model_registry import Model


def likely(model: Model, one: Int8, other: Int8) -> Float64:
    """Of each pair of codes, int8 (n, code bytes) each, float64 (n,).

    By the model's classifier; without one, a normal distribution of distances whose deviation is
    the distance of a match, a step of the quantiser at least.
    """
    if model.classifier is not None:
        return model.classifier.probabilities(one, other)
    quantizer = model.manifest.quantizer
    levels = quantizer.levels(one).astype(np.float64) - quantizer.levels(other)
    distances = quantizer.step * np.linalg.norm(levels, axis=1)
    deviation = max(model.manifest.pair_threshold, quantizer.step)
    return np.asarray(np.exp(-0.5 * (distances / deviation) ** 2))
