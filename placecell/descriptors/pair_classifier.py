"""Pair classifier: match probability of two stored descriptors.

It is exported beside the extractor as `pair.onnx`. Inputs are the decoded descriptors `a` and `b`,
float32 (n, d) each; the output is `probability`, float32 (n,). The order of a pair is irrelevant.
"""

from pathlib import Path

import numpy as np

from placecell.core.cancellation import current
from placecell.core.types import Float64, Int8
from placecell.descriptors.extractor import one_thread_session
from placecell.descriptors.manifest import PAIR_FILE, Manifest, ModelError

PAIRS = 1 << 13
"""Pairs per inference: decoded, a pair of 128 dimensions takes kilobytes."""


class PairClassifier:
    """Classifier that returns the match probability of pairs of codes."""

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        self._quantizer = manifest.quantizer
        try:
            self._session = one_thread_session(folder / PAIR_FILE)
        # onnxruntime's exceptions share no narrower base class than this.
        except Exception as error:
            raise ModelError(f"{folder / PAIR_FILE}: cannot be loaded ({error})") from error

    def probabilities(self, a: Int8, b: Int8) -> Float64:
        """Return the match probability of each pair, float64 (n,).

        Args:
            a: codes, int8 (n, code bytes).
            b: codes, int8 (n, code bytes).

        Raises:
            Cancelled: The request is late, or its client disconnected.
        """
        probabilities = np.empty(len(a))
        for begin in range(0, len(a), PAIRS):
            current().check()
            some = slice(begin, begin + PAIRS)
            inputs = {"a": self._quantizer.decode(a[some]), "b": self._quantizer.decode(b[some])}
            (probabilities[some],) = self._session.run(["probability"], inputs)
        return probabilities


def load_pair_classifier(folder: Path, manifest: Manifest) -> PairClassifier | None:
    """Load the classifier of a model folder; return None if the model has none.

    Raises:
        ModelError: The classifier cannot be loaded.
    """
    return PairClassifier(folder, manifest) if PAIR_FILE in manifest.files else None
