"""Publishing of a head: `classes.onnx` and the manifest's entry `classes`."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import onnx
from onnx import TensorProto, helper, numpy_helper
from torch import nn

from evaluation.segments.classes import class_figures
from placecell.core.segment_classes import CLASSES, encoded
from placecell.descriptors.class_features import FEATURES, VERSION
from placecell.descriptors.class_head import ClassHead
from placecell.descriptors.manifest import CLASSES_FILE, Manifest, file_hash
from training.classes.examples import LabeledDrive
from training.classes.learning import HeadNetwork, TrainedHead

OPSET = 20


def publish_head(
    folder: Path, trained: TrainedHead, drives: Sequence[LabeledDrive], facts: dict[str, Any]
) -> Manifest:
    """Write the head of a model beside its network, and return the new manifest.

    Args:
        folder: folder of the model.
        trained: trained head.
        drives: drives of the training.
        facts: further facts for the manifest: `seed`, `command`, `licence`.
    """
    manifest = Manifest.load(folder)
    onnx.save(graph_of(trained.network, manifest.dimension), folder / CLASSES_FILE)
    files = manifest.files | {CLASSES_FILE: file_hash(folder / CLASSES_FILE)}
    entry: dict[str, Any] = {
        "features_version": VERSION,
        "names": list(CLASSES),
        "sources": [
            {
                "drive": drive.recording.name,
                "segments": len(drive.recording.segments),
                "labeled": drive.classes is not None,
            }
            for drive in drives
        ],
        **facts,
    }
    manifest = replace(manifest, files=files, classes=entry)
    head = ClassHead(folder, manifest, threads=1)
    held_out = trained.held_out
    found = head.probabilities(
        held_out.inputs[:, : manifest.dimension], held_out.inputs[:, manifest.dimension :]
    )
    stated = encoded(found.argmax(axis=1), found.max(axis=1).clip(max=1.0))
    figures = class_figures(held_out.classes, stated)
    kept = ("labeled", "accuracy", "macro_f1", "calibration_error")
    manifest = replace(
        manifest, classes=entry | {"held_out": {name: figures[name] for name in kept}}
    )
    manifest.save(folder)
    return manifest


def graph_of(network: HeadNetwork, dimension: int) -> onnx.ModelProto:
    """Return the network as an ONNX model with probabilities as its output."""
    constants: dict[str, Any] = {
        "mean": network.mean.numpy(),
        "scale": network.scale.numpy(),
        "temperature": network.temperature.numpy(),
    }
    nodes = [
        helper.make_node("Concat", ["descriptor", "features"], ["inputs"], axis=1),
        helper.make_node("Sub", ["inputs", "mean"], ["centered"]),
        helper.make_node("Mul", ["centered", "scale"], ["value0"]),
    ]
    value = "value0"
    for number, layer in enumerate(network.layers, 1):
        if isinstance(layer, nn.Linear):
            names = [f"weight{number}", f"bias{number}"]
            constants |= dict(
                zip(names, (each.detach().numpy() for each in (layer.weight, layer.bias)),
                    strict=True)
            )  # fmt: skip
            nodes.append(helper.make_node("Gemm", [value, *names], [f"value{number}"], transB=1))
        elif isinstance(layer, nn.GELU):
            nodes.append(helper.make_node("Gelu", [value], [f"value{number}"]))
        else:
            continue  # Dropout
        value = f"value{number}"
    nodes += [
        helper.make_node("Div", [value, "temperature"], ["logits"]),
        helper.make_node("Softmax", ["logits"], ["probabilities"], axis=1),
    ]
    sizes = {"descriptor": dimension, "features": FEATURES, "probabilities": len(CLASSES)}
    values = {
        name: helper.make_tensor_value_info(name, TensorProto.FLOAT, ["n", size])
        for name, size in sizes.items()
    }
    graph = helper.make_graph(
        nodes,
        "classes",
        [values["descriptor"], values["features"]],
        [values["probabilities"]],
        [
            numpy_helper.from_array(np.asarray(value, np.float32), name)
            for name, value in constants.items()
        ],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", OPSET)], ir_version=9)
    onnx.checker.check_model(model)
    return model
