"""Descriptor extractors, used by both evaluation and service."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Any

import numpy as np
import onnxruntime
from numpy.typing import NDArray

from placecell.core.processors import available_cores
from placecell.core.segments import Segments
from placecell.core.types import Float32, UInt8
from placecell.descriptors.class_features import class_features
from placecell.descriptors.class_head import ClassHead
from placecell.descriptors.eigenvalue import FEATURES, eigenvalue_descriptors
from placecell.descriptors.manifest import CLASSES_FILE, FILE, Manifest, ModelError
from placecell.descriptors.neighborhood import describe_neighborhood
from placecell.descriptors.orientation import orient
from placecell.descriptors.voxels import voxelize_oriented

MODEL_FILE = "model.onnx"
CLASS_FEATURES = "class_features"
"""Input of the head for classes, beside those of the network."""

BATCH = 16
"""Segments per inference. Larger batches are slower on a CPU: their activations leave the cache."""


Inputs = dict[str, NDArray[Any]]
"""Inputs of a model by name. The rows of each array are the segments."""

Lap = Callable[[str], None]
"""Callback that receives the name of each step when the step ends."""


def unwatched(step: str) -> None:
    """Ignore the end of a step."""
    del step


@dataclass(frozen=True, slots=True)
class Description:
    """Description of segments.

    Attributes:
        values: descriptors, float32 (segments, dimension).
        classes: class and probability of each segment, uint8 (segments,)
            (`placecell.core.segment_classes`); None if the model has no head for classes.
    """

    values: Float32
    classes: UInt8 | None = None


class Extractor(ABC):
    """Extractor of descriptors: prepares a model's inputs and infers descriptors from them."""

    manifest: Manifest
    has_classes = False
    """Whether the model has a semantic head, so that `classify` returns classes."""

    @abstractmethod
    def prepare(
        self,
        segments: Segments,
        neighborhood: Float32 | None = None,
        lap: Lap = unwatched,
        classified: bool = True,
    ) -> Inputs:
        """Return the model's inputs.

        Args:
            segments: see `describe`.
            neighborhood: see `describe`.
            lap: receives the name of each step when it ends.
            classified: also prepare what `classify` needs, if the model has a semantic head.
        """

    @abstractmethod
    def infer(self, inputs: Inputs) -> Float32:
        """Return descriptors, float32 (rows, dimension). Rows do not influence each other."""

    def classify(self, inputs: Inputs, descriptors: Float32) -> UInt8 | None:
        """Return class and probability of each row, uint8 (rows,); None without a head.

        Args:
            inputs: result of `prepare` with `classified`.
            descriptors: result of `infer` for these inputs.
        """
        del inputs, descriptors
        return None

    def description(self, segments: Segments, neighborhood: Float32 | None = None) -> Description:
        """Return descriptors and classes of segments; see `describe`."""
        return Description(self.describe(segments, neighborhood))

    def describe(self, segments: Segments, neighborhood: Float32 | None = None) -> Float32:
        """Return descriptors, float32 (segments, dimension).

        Args:
            segments: segments in one z-up frame.
            neighborhood: neighborhood of each segment (`describe_neighborhood`). None: all segments
                belong to one capture and form each other's neighborhood. Models without
                neighborhood ignore it.
        """
        return self.infer(self.prepare(segments, neighborhood))


class EigenvalueExtractor(Extractor):
    """Extractor of the baseline: seven eigenvalue features, standardized by training statistics."""

    def __init__(self, manifest: Manifest) -> None:
        self.manifest = manifest
        self._mean = np.array(manifest.standardization["mean"], dtype=np.float32)
        self._deviation = np.array(manifest.standardization["deviation"], dtype=np.float32)

    def prepare(
        self,
        segments: Segments,
        neighborhood: Float32 | None = None,
        lap: Lap = unwatched,
        classified: bool = True,
    ) -> Inputs:
        """Return the features, float32 (segments, 7)."""
        del neighborhood, lap, classified  # not used by these features
        return {"features": eigenvalue_descriptors(segments)}

    def infer(self, inputs: Inputs) -> Float32:
        """Return descriptors, float32 (rows, 7)."""
        return np.asarray((inputs["features"] - self._mean) / self._deviation, dtype=np.float32)


class OnnxExtractor(Extractor):
    """Learned extractor: orients and voxelizes segments, then runs the exported network.

    The batches of a call are distributed over the cores. Each core has a session with one thread:
    threads of one inference wait for each other at every layer, and inferences of one session wait
    for its memory.
    """

    def __init__(self, folder: Path, manifest: Manifest, threads: int = 0) -> None:
        if MODEL_FILE not in manifest.files:
            # Neither the model's id nor the check of the files would cover the network.
            raise ModelError(f"{folder / FILE}: the SHA-256 of {MODEL_FILE} is missing")
        self.manifest = manifest
        threads = threads or available_cores()
        self._pool = ThreadPoolExecutor(threads, thread_name_prefix="describe")
        self._head = None
        if CLASSES_FILE in manifest.files:
            self._head = ClassHead(folder, manifest, threads)
            self.has_classes = True
        self._idle: SimpleQueue[onnxruntime.InferenceSession] = SimpleQueue()
        try:
            for _ in range(threads):
                self._idle.put(one_thread_session(folder / MODEL_FILE))
            # Compile now, not while a robot waits.
            self.describe(Segments.of([np.zeros((1, 3), np.float32)], np.zeros((1, 3))))
        # onnxruntime's exceptions share no narrower base class than this.
        except Exception as error:
            raise ModelError(f"{folder / MODEL_FILE}: cannot be loaded ({error})") from error

    def prepare(
        self,
        segments: Segments,
        neighborhood: Float32 | None = None,
        lap: Lap = unwatched,
        classified: bool = True,
    ) -> Inputs:
        """Return occupancy grids, extents and, if the model uses them, neighborhood and features.

        The features are those of the head for classes.
        """
        inputs = self._network_inputs(segments, neighborhood, lap)
        if self._head is not None and classified:
            inputs[CLASS_FEATURES] = class_features(segments)
            lap("voxelise")
        return inputs

    def _network_inputs(self, segments: Segments, neighborhood: Float32 | None, lap: Lap) -> Inputs:
        inputs: Inputs = {}
        parameters = self.manifest.neighborhood
        if parameters is not None:
            inputs["surroundings"] = (
                describe_neighborhood(segments, None, parameters)
                if neighborhood is None
                else neighborhood
            )
            lap("look")
        oriented = orient(segments)
        lap("align")
        inputs["occupancy"], inputs["extents"] = voxelize_oriented(
            oriented, segments.ends, self.manifest.parameters
        )
        lap("voxelise")
        return inputs

    def infer(self, inputs: Inputs) -> Float32:
        """Return descriptors, float32 (rows, dimension), for any number of threads the same."""
        network = network_inputs(inputs)

        def some(first: int, end: int) -> Float32:
            return self._run({name: rows[first:end] for name, rows in network.items()})

        return self._in_batches(some, len(inputs["extents"]))

    def describe(self, segments: Segments, neighborhood: Float32 | None = None) -> Float32:
        """Return descriptors, float32 (segments, dimension), batch by batch: grids are large."""
        parameters = self.manifest.neighborhood
        if parameters is not None and neighborhood is None:
            neighborhood = describe_neighborhood(segments, None, parameters)

        def some(first: int, end: int) -> Float32:
            rows = np.arange(first, end)
            around = None if neighborhood is None else neighborhood[rows]
            return self._run(self._network_inputs(segments.take(rows), around, unwatched))

        return self._in_batches(some, len(segments))

    def classify(self, inputs: Inputs, descriptors: Float32) -> UInt8 | None:
        """Return class and probability of each row; see `Extractor.classify`."""
        if self._head is None:
            return None
        return self._head.classify(descriptors, inputs[CLASS_FEATURES])

    def description(self, segments: Segments, neighborhood: Float32 | None = None) -> Description:
        """Return descriptors and classes of segments; see `describe`."""
        values = self.describe(segments, neighborhood)
        if self._head is None:
            return Description(values)
        return Description(values, self._head.classify(values, class_features(segments)))

    def _in_batches(self, some: Callable[[int, int], Float32], count: int) -> Float32:
        """Apply `some` to batches of rows and concatenate the descriptors."""
        # Batches of one size, so that no core waits for another's last batch.
        bounds = np.linspace(0, count, -(-count // BATCH) + 1).astype(int).tolist()
        batches = bounds[:-1], bounds[1:]
        # A single batch runs in this thread.
        parts = self._pool.map(some, *batches) if len(bounds) > 2 else map(some, *batches)
        return np.concatenate([np.zeros((0, self.manifest.dimension), np.float32), *parts])

    def _run(self, inputs: Inputs) -> Float32:
        session = self._idle.get()
        try:
            descriptors: Float32 = session.run(["descriptor"], inputs)[0]
        finally:
            self._idle.put(session)
        return descriptors


def network_inputs(inputs: Inputs) -> Inputs:
    """Return the inputs of the network alone, without those of the head for classes."""
    return {name: rows for name, rows in inputs.items() if name != CLASS_FEATURES}


def one_thread_session(file: Path) -> onnxruntime.InferenceSession:
    """Return a session that computes each inference in the calling thread."""
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    options.log_severity_level = 3
    return onnxruntime.InferenceSession(file, options, providers=["CPUExecutionProvider"])


def load_extractor(folder: Path, threads: int = 0) -> Extractor:
    """Load a model.

    Args:
        folder: model folder, with `manifest.json` and the files that it names.
        threads: number of cores to use; 0 for all available cores.

    Raises:
        ModelError: The folder holds no usable model.
    """
    manifest = Manifest.load(folder)
    if manifest.method == "eigenvalue":
        lengths = [len(manifest.standardization.get(name, ())) for name in ("mean", "deviation")]
        if lengths != [len(FEATURES)] * 2:
            raise ModelError(
                f"{folder / FILE}: 'standardisation' must have 'mean' and 'deviation' with "
                f"{len(FEATURES)} numbers each. Use an unchanged manifest"
            )
        return EigenvalueExtractor(manifest)
    return OnnxExtractor(folder, manifest, threads)
