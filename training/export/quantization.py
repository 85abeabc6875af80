"""Quantization of networks to 8-bit integers, which doubles their speed on a processor.

ONNX Runtime quantizes the convolutions statically, calibrated on segments of the training set. The
range of the activations decides how much is lost. With the outermost ones in the range, all others
share a few of the 256 levels: a voxel that is rarely occupied has a huge standardized value.
Without too many of them, what tells segments apart is clipped. So several ranges are tried, and
the one whose descriptors are nearest to those of the float32 network is kept.
"""

import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from placecell.core.types import Float32
from placecell.descriptors.voxels import voxelize
from training.data.training_set import TrainingSet
from training.methods.networks import batches

if TYPE_CHECKING:
    from onnxruntime.quantization.calibrate import TensorsData

CALIBRATION_SEGMENTS = 1024
"""Number of segments that the ranges of activations are measured on."""

BATCH = 64
"""Number of segments in a calibration batch."""

PERCENTS = (99.99, 99.9, 99.8)
"""Shares of the activations within the range of an 8-bit number, percent; the others are clipped.
All of them within it is the fourth that is tried.
"""

QUANTIZED = ["Conv", "MaxPool"]
"""Operators that compute with 8-bit numbers."""


def quantize(network: Path, data: TrainingSet, file: Path) -> None:
    """Quantize the convolutions of an exported network to 8 bits.

    Args:
        network: path of the float32 ONNX file.
        data: training set; a random part of it gives the ranges of activations.
        file: path of the 8-bit ONNX file to write.
    """
    from onnxruntime.quantization.shape_inference import quant_pre_process

    count = min(len(data), CALIBRATION_SEGMENTS)
    if count > BATCH:
        count -= count % BATCH  # ONNX Runtime needs batches of one size
    drawn = np.random.default_rng(0).permutation(len(data))[:count]
    some = data.take(np.sort(drawn))
    expected = described(network, some)
    with tempfile.TemporaryDirectory() as folder:
        prepared = Path(folder) / "prepared.onnx"
        quant_pre_process(str(network), str(prepared), skip_symbolic_shape=True)
        errors = {}
        for percent, ranges in measure_ranges(prepared, some, Path(folder)):
            candidate = Path(folder) / f"{percent}.onnx"
            quantize_with(prepared, ranges, candidate)
            errors[candidate] = float(np.square(described(candidate, some) - expected).mean())
        shutil.copyfile(min(errors, key=errors.__getitem__), file)


def measure_ranges(
    prepared: Path, data: TrainingSet, folder: Path
) -> Iterator[tuple[float, "TensorsData"]]:
    """Measure the activations once; yield their ranges for each share of `PERCENTS`, with it."""
    from onnxruntime.quantization import CalibrationMethod, create_calibrator

    for method in (CalibrationMethod.MinMax, CalibrationMethod.Percentile):
        calibrator = create_calibrator(
            prepared, QUANTIZED, str(folder / "measured.onnx"), calibrate_method=method
        )
        calibrator.collect_data(CalibrationBatches(data))
        if method is CalibrationMethod.MinMax:
            yield 100.0, calibrator.compute_data()
            continue
        for percent in PERCENTS:
            calibrator.collector.percentile = percent
            yield percent, calibrator.compute_data()


def quantize_with(prepared: Path, ranges: "TensorsData", file: Path) -> None:
    """Quantize a preprocessed network with measured ranges of its activations."""
    from onnxruntime.quantization import QuantType
    from onnxruntime.quantization.qdq_quantizer import QDQQuantizer
    from onnxruntime.quantization.quant_utils import load_model_with_shape_infer

    quantizer = QDQQuantizer(
        load_model_with_shape_infer(prepared),
        per_channel=True,
        # Weights have 7 bits, because some processors add two products in 16 bits.
        reduce_range=True,
        weight_qType=QuantType.QInt8,
        activation_qType=QuantType.QUInt8,
        tensors_range=ranges,
        nodes_to_quantize=[],
        nodes_to_exclude=[],
        op_types_to_quantize=QUANTIZED,
        extra_options={},
    )
    quantizer.quantize_model()
    quantizer.model.save_model_to_file(str(file))


def described(network: Path, data: TrainingSet) -> Float32:
    """Return the descriptors of an ONNX network, float32 (segments, dimension)."""
    from onnxruntime import InferenceSession

    session = InferenceSession(network)
    return np.concatenate([session.run(None, given)[0] for given in inputs(data)])


class CalibrationBatches:
    """Reader of calibration inputs, with the interface that ONNX Runtime expects."""

    def __init__(self, data: TrainingSet) -> None:
        self._inputs = inputs(data)

    def get_next(self) -> dict[str, Any] | None:
        """Return the next batch; None after the last one."""
        return next(self._inputs, None)


def inputs(data: TrainingSet) -> Iterator[dict[str, Any]]:
    """Yield the inputs of the network, one batch after another."""
    for batch in batches(data, BATCH):
        occupancy, extents = voxelize(batch.segments, data.parameters)
        given: dict[str, Any] = {"occupancy": occupancy, "extents": extents}
        if batch.neighborhood is not None:
            given["surroundings"] = batch.neighborhood
        yield given
