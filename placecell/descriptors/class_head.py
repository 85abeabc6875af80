"""Head of a model that tells a segment's class and its calibrated probability.

The head is a small network in its own file beside `model.onnx`. Its inputs are the descriptor
before quantization and the features of `class_features`. The descriptors do not depend on it.
"""

from pathlib import Path
from queue import SimpleQueue

import numpy as np
import onnxruntime

from placecell.core.segment_classes import CLASSES, encoded
from placecell.core.types import Bool, Float32, UInt8
from placecell.descriptors.class_features import FEATURES, VERSION
from placecell.descriptors.manifest import CLASSES_FILE, FILE, Manifest, ModelError

BLOCK = 64
"""Rows of an inference. All have the same number of rows, so that the other segments of a request
do not change the rounding of a segment's probability."""


class ClassHead:
    """Head of a model, with one session per thread that may use it at a time."""

    def __init__(self, folder: Path, manifest: Manifest, threads: int) -> None:
        """Load the head of a model.

        Raises:
            ModelError: The head cannot be loaded, or was trained with other features or classes.
        """
        stated = manifest.classes.get("features_version"), manifest.classes.get("names")
        if stated != (VERSION, list(CLASSES)):
            raise ModelError(
                f"{folder / FILE}: the head has the features and classes {stated}, expected "
                f"{(VERSION, list(CLASSES))}. Train it again with 'placecell train-classes'"
            )
        self._idle: SimpleQueue[onnxruntime.InferenceSession] = SimpleQueue()
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = 1
        options.log_severity_level = 3
        try:
            for _ in range(threads):
                self._idle.put(
                    onnxruntime.InferenceSession(
                        folder / CLASSES_FILE, options, providers=["CPUExecutionProvider"]
                    )
                )
            self.probabilities(
                np.zeros((1, manifest.dimension), np.float32), np.zeros((1, FEATURES), np.float32)
            )
        # onnxruntime's exceptions share no narrower base class than this.
        except Exception as error:
            raise ModelError(f"{folder / CLASSES_FILE}: cannot be loaded ({error})") from error

    def classify(self, descriptors: Float32, features: Float32) -> UInt8:
        """Return the most probable class of each segment and its probability, uint8 (n,).

        A segment whose descriptor or features are not finite has no class.
        """
        finite = np.isfinite(descriptors).all(axis=1) & np.isfinite(features).all(axis=1)
        known: Bool = np.asarray(finite)
        found = self.probabilities(
            np.where(known[:, None], descriptors, 0), np.where(known[:, None], features, 0)
        )
        classes = np.where(known, found.argmax(axis=1), -1)
        return encoded(classes, found.max(axis=1, initial=0.0).clip(max=1.0))

    def probabilities(self, descriptors: Float32, features: Float32) -> Float32:
        """Return the probability of each class, float32 (n, classes)."""
        parts = [np.zeros((0, len(CLASSES)), np.float32)]
        session = self._idle.get()
        try:
            for first in range(0, len(features), BLOCK):
                rows = slice(first, first + BLOCK)
                inputs = {"descriptor": descriptors[rows], "features": features[rows]}
                count = len(inputs["features"])
                padded = {name: _padded(each) for name, each in inputs.items()}
                parts.append(session.run(["probabilities"], padded)[0][:count])
        finally:
            self._idle.put(session)
        return np.concatenate(parts)


def _padded(rows: Float32) -> Float32:
    """Return rows, float32 (`BLOCK`, size), with zeros behind those that are given."""
    block = np.zeros((BLOCK, rows.shape[1]), np.float32)
    block[: len(rows)] = rows
    return block
