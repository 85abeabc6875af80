"""The pair classifier: how likely two stored descriptors are of the same group.

Exported beside the extractor as `pair.onnx`: decoded descriptors `a` and `b`, float32 (n, d) each,
to `probability`, float32 (n,). It does not depend on the order of the pair.
"""

from pathlib import Path

import numpy as np

from placecell.core.cancellation import current
from placecell.core.types import Float64, Int8
from placecell.descriptors.extractor import one_thread_session
from placecell.descriptors.manifest import PAIR_FILE, Manifest, ModelError

PAIRS = 1 << 13
"""Pairs decoded and classified at once: as floats, a pair of 128 dimensions takes kilobytes."""


class PairClassifier:
    """Gives the probability of a match from descriptors as they are stored."""

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        self._quantizer = manifest.quantizer
        try:
            self._session = one_thread_session(folder / PAIR_FILE)
        # onnxruntime's exceptions share no narrower base class than this.
        except Exception as error:
            raise ModelError(f"{folder / PAIR_FILE}: cannot be loaded ({error})") from error

    def probabilities(self, a: Int8, b: Int8) -> Float64:
        """Return the match probabilities, float64 (n,), of codes int8 (n, code bytes) each.

        Raises:
            Cancelled: the work is to stop.
        """
        probabilities = np.empty(len(a))
        for begin in range(0, len(a), PAIRS):
            current().check()
            some = slice(begin, begin + PAIRS)
            inputs = {"a": self._quantizer.decode(a[some]), "b": self._quantizer.decode(b[some])}
            (probabilities[some],) = self._session.run(["probability"], inputs)
        return probabilities


def load_pair_classifier(folder: Path, manifest: Manifest) -> PairClassifier | None:
    """The classifier of a model's folder; None if it has none.

    Raises:
        ModelError: it cannot be loaded.
    """
    return PairClassifier(folder, manifest) if PAIR_FILE in manifest.files else None
