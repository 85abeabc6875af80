"""Extractors: from segments to descriptors, the same in training's evaluation and in serving."""

from pathlib import Path
from typing import Protocol

import numpy as np
import onnxruntime

from segments.eigenvalue import FEATURES, eigenvalue_descriptors
from segments.manifest import FILE, Manifest, ModelError
from segments.segments import Segments
from segments.types import Float32
from segments.voxels import voxelise

MODEL_FILE = "model.onnx"
BATCH = 64
"""Segments an inference; larger batches are slower on a CPU (their activations leave the cache)."""


class Extractor(Protocol):
    """Describes segments."""

    manifest: Manifest

    def describe(self, segments: Segments) -> Float32:
        """Descriptors, float32 (segments, dimension)."""


class EigenvalueExtractor:
    """The baseline: seven features, standardised on the training statistics."""

    def __init__(self, manifest: Manifest) -> None:
        self.manifest = manifest
        self._mean = np.array(manifest.standardisation["mean"], dtype=np.float32)
        self._deviation = np.array(manifest.standardisation["deviation"], dtype=np.float32)

    def describe(self, segments: Segments) -> Float32:
        """Descriptors, float32 (segments, 7)."""
        return (eigenvalue_descriptors(segments) - self._mean) / self._deviation


class OnnxExtractor:
    """A learned extractor: align, voxelise, and run the exported network."""

    def __init__(self, folder: Path, manifest: Manifest, threads: int = 0) -> None:
        if MODEL_FILE not in manifest.files:
            # Neither the model's id nor the check of its files would cover the network.
            raise ModelError(f"{folder / FILE}: does not give the SHA-256 of {MODEL_FILE}")
        self.manifest = manifest
        options = onnxruntime.SessionOptions()
        options.intra_op_num_threads = threads
        options.log_severity_level = 3
        try:
            self._session = onnxruntime.InferenceSession(
                folder / MODEL_FILE, options, providers=["CPUExecutionProvider"]
            )
        # onnxruntime's exceptions share no narrower base class than this.
        except Exception as error:
            raise ModelError(f"{folder / MODEL_FILE}: cannot be loaded ({error})") from error

    def describe(self, segments: Segments) -> Float32:
        """Descriptors, float32 (segments, dimension)."""
        parts = [np.zeros((0, self.manifest.dimension), dtype=np.float32)]
        for first in range(0, len(segments), BATCH):
            some = segments.take(np.arange(first, min(first + BATCH, len(segments))))
            occupancy, extents = voxelise(some, self.manifest.parameters)
            inputs = {"occupancy": occupancy, "extents": extents}
            parts.append(self._session.run(["descriptor"], inputs)[0])
        return np.concatenate(parts)


def load_extractor(folder: Path, threads: int = 0) -> Extractor:
    """Load the model of a folder.

    Args:
        folder: with `manifest.json` and what it names.
        threads: for inference; 0: as many as there are cores.

    Raises:
        ModelError: the folder holds no usable model.
    """
    manifest = Manifest.load(folder)
    if manifest.method == "eigenvalue":
        lengths = [len(manifest.standardisation.get(name, ())) for name in ("mean", "deviation")]
        if lengths != [len(FEATURES)] * 2:
            raise ModelError(
                f"{folder / FILE}: its standardisation needs 'mean' and 'deviation', "
                f"{len(FEATURES)} numbers each"
            )
        return EigenvalueExtractor(manifest)
    return OnnxExtractor(folder, manifest, threads)
