"""Match probability: the probability that two descriptors show the same segment."""

import numpy as np

from placecell.core.types import Float64, Int8
from service.inference.model_registry import Model


def match_probabilities(model: Model, one: Int8, other: Int8) -> Float64:
    """Return the match probability of each pair of codes, float64 (n,).

    The model's classifier gives it. Without a classifier it is a normal distribution of descriptor
    distances; its deviation is the model's match distance, at least one quantizer step.

    Args:
        model: model that made all codes.
        one: first code of each pair, int8 (n, code bytes).
        other: second code of each pair, int8 (n, code bytes).
    """
    if model.classifier is not None:
        return model.classifier.probabilities(one, other)
    quantizer = model.manifest.quantizer
    levels = quantizer.levels(one).astype(np.float64) - quantizer.levels(other)
    distances = quantizer.step * np.linalg.norm(levels, axis=1)
    deviation = max(model.manifest.pair_threshold, quantizer.step)
    return np.asarray(np.exp(-0.5 * (distances / deviation) ** 2))
