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
from typing import Any

import numpy as np

from placecell.core.types import Float32
from placecell.descriptors.voxels import voxelize
from training.data.training_set import TrainingSet
from training.methods.networks import batches

CALIBRATION_SEGMENTS = 1024
"""Number of segments that the ranges of activations are measured on."""

BATCH = 64
"""Number of segments in a calibration batch."""

PERCENTS = (100.0, 99.99, 99.9, 99.8)
"""Shares of the activations within the range of an 8-bit number, percent; the others are clipped.
"""


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
        for percent in PERCENTS:
            candidate = Path(folder) / f"{percent}.onnx"
            quantize_with(prepared, some, candidate, percent)
            errors[candidate] = float(np.square(described(candidate, some) - expected).mean())
        shutil.copyfile(min(errors, key=errors.__getitem__), file)


def quantize_with(prepared: Path, data: TrainingSet, file: Path, percent: float) -> None:
    """Quantize a preprocessed network, with ranges that hold `percent` of the activations."""
    from onnxruntime.quantization import (
        CalibrationMethod,
        QuantFormat,
        QuantType,
        quantize_static,
    )

    whole = percent == 100
    quantize_static(
        str(prepared),
        str(file),
        CalibrationBatches(data),
        quant_format=QuantFormat.QDQ,
        per_channel=True,
        # Weights have 7 bits, because some processors add two products in 16 bits.
        reduce_range=True,
        activation_type=QuantType.QUInt8,
        weight_type=QuantType.QInt8,
        op_types_to_quantize=["Conv", "MaxPool"],
        calibrate_method=CalibrationMethod.MinMax if whole else CalibrationMethod.Percentile,
        extra_options={} if whole else {"CalibPercentile": percent},
    )


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
