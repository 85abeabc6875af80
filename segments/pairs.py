"""The pair classifier: how likely two stored descriptors are of the same group.

Exported beside the extractor as `pair.onnx`: decoded descriptors `a` and `b`, float32 (n, d) each,
to `probability`, float32 (n,). It does not depend on the order of the pair.
"""

from pathlib import Path

import numpy as np

from segments.extractor import one_thread_session
from segments.manifest import PAIR_FILE, Manifest, ModelError
from segments.types import Float64, Int8


class PairClassifier:
    """Gives the probability of a match from descriptors as they are stored."""

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        self._quantiser = manifest.quantiser
        try:
            self._session = one_thread_session(folder / PAIR_FILE)
        # onnxruntime's exceptions share no narrower base class than this.
        except Exception as error:
            raise ModelError(f"{folder / PAIR_FILE}: cannot be loaded ({error})") from error

    def probabilities(self, a: Int8, b: Int8) -> Float64:
        """Of a match, float64 (n,), for codes int8 (n, code bytes) each."""
        if not len(a):
            return np.zeros(0)
        inputs = {"a": self._quantiser.decode(a), "b": self._quantiser.decode(b)}
        (probability,) = self._session.run(["probability"], inputs)
        return np.asarray(probability, dtype=np.float64)


def load_pair_classifier(folder: Path, manifest: Manifest) -> PairClassifier | None:
    """The classifier of a model's folder; None if it has none.

    Raises:
        ModelError: it cannot be loaded.
    """
    return PairClassifier(folder, manifest) if PAIR_FILE in manifest.files else None
