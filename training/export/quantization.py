"""Quantization of networks to 8-bit integers, which doubles their speed on a processor.

ONNX Runtime quantizes the convolutions statically, calibrated on segments of the training set.
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from placecell.descriptors.voxels import voxelize
from training.data.training_set import TrainingSet
from training.methods.networks import batches

CALIBRATION_SEGMENTS = 1024
"""Number of segments that the ranges of activations are measured on."""


def quantize(network: Path, data: TrainingSet, file: Path) -> None:
    """Quantize the convolutions of an exported network to 8 bits.

    Args:
        network: path of the float32 ONNX file.
        data: training set; a random part of it gives the ranges of activations.
        file: path of the 8-bit ONNX file to write.
    """
    from onnxruntime.quantization import QuantFormat, QuantType, quantize_static
    from onnxruntime.quantization.shape_inference import quant_pre_process

    drawn = np.random.default_rng(0).permutation(len(data))[:CALIBRATION_SEGMENTS]
    with tempfile.TemporaryDirectory() as folder:
        prepared = Path(folder) / "prepared.onnx"
        quant_pre_process(str(network), str(prepared), skip_symbolic_shape=True)
        quantize_static(
            str(prepared),
            str(file),
            CalibrationBatches(data.take(np.sort(drawn))),
            quant_format=QuantFormat.QDQ,
            per_channel=True,
            # Weights have 7 bits, because some processors add two products in 16 bits.
            reduce_range=True,
            activation_type=QuantType.QUInt8,
            weight_type=QuantType.QInt8,
            op_types_to_quantize=["Conv", "MaxPool"],
        )


class CalibrationBatches:
    """Reader of calibration inputs, with the interface that ONNX Runtime expects."""

    def __init__(self, data: TrainingSet) -> None:
        self._inputs = inputs(data)

    def get_next(self) -> dict[str, Any] | None:
        """Return the next batch; None after the last one."""
        return next(self._inputs, None)


def inputs(data: TrainingSet) -> Iterator[dict[str, Any]]:
    """Yield the inputs of the network, 64 segments at a time."""
    for batch in batches(data, 64):
        occupancy, extents = voxelize(batch.segments, data.parameters)
        given: dict[str, Any] = {"occupancy": occupancy, "extents": extents}
        if batch.neighborhood is not None:
            given["surroundings"] = batch.neighborhood
        yield given
