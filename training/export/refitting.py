"""Refit: fits the neighborhood's part of a context model to further drives, and keeps its network.

The network takes most of the training time and gains little from drives that show the same place
from other sides. The neighborhood's part gains most of it, and has a closed form.
"""

import shutil
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import onnx
from onnx import numpy_helper

from placecell.core.types import Float32
from placecell.descriptors.extractor import MODEL_FILE, OnnxExtractor
from placecell.descriptors.manifest import FULL_FILE, Manifest, preprocessing_of
from placecell.descriptors.quantizer import Quantizer
from training.data.training_set import TrainingSet
from training.export.publishing import Data, finish, whole
from training.methods.context import (
    ContextRecipe,
    Projection,
    learn_neighborhood,
    learn_rotation,
)

FILES = (MODEL_FILE, FULL_FILE)


def publish_refit(
    folder: Path, kept: Path, data: Data, recipe: ContextRecipe | None = None
) -> Manifest:
    """Write a context model with the network of another one.

    The neighborhood's part, the rotation, the quantizer and the pair classifier are fitted anew.

    Args:
        folder: folder of the new model.
        kept: folder of the model whose network is kept.
        data: data of the new model.
        recipe: settings of the neighborhood's part; None for those of the shipped model.

    Raises:
        ValueError: the other model has no neighborhood, or other constants up to the network.
        ModelError: the other model cannot be loaded.
    """
    manifest = Manifest.load(kept)
    around = manifest.neighborhood
    if around is None or manifest.preprocessing != preprocessing_of(
        data.training.parameters, around
    ):
        raise ValueError(
            f"{kept}: the network cannot be kept: expected a model of the method context, with the "
            "constants of this version. Train without --keep-network."
        )
    commands = [manifest.training["command"], data.provenance["command"]]
    data = data.stating(
        command="\n".join(dict.fromkeys("\n".join(commands).splitlines())),
        seconds=manifest.training["seconds"],
    )
    projection = learn_neighborhood(data.training, recipe or ContextRecipe())
    with whole(folder) as unfinished:
        for name in FILES:
            shutil.copyfile(kept / name, unfinished / name)
        recorded = data.training.recorded()
        own = own_parts(unfinished, manifest, recorded)
        rows, per_byte = np.flatnonzero(own.any(axis=1)), manifest.quantizer.per_byte
        recorded = recorded.take(rows)
        assert recorded.neighborhood is not None
        parts = np.concatenate([own[rows], projection.part(recorded.neighborhood)], axis=1)
        write_projection(unfinished, projection, learn_rotation(parts, per_byte))
        manifest = Manifest(
            name=folder.name,
            method=manifest.method,
            network=manifest.network,
            dimension=manifest.dimension,
            quantizer=manifest.quantizer,
            preprocessing=manifest.preprocessing,
            training=data.provenance,
        ).with_files(unfinished, list(FILES))
        described = OnnxExtractor(unfinished, manifest).describe(
            recorded.segments, recorded.neighborhood
        )
        manifest = replace(manifest, quantizer=Quantizer.fit(described, per_byte))
        return finish(unfinished, manifest, data, head=None)


def own_parts(folder: Path, manifest: Manifest, data: TrainingSet) -> Float32:
    """Return the segment's own part of the descriptors, zeros for segments without a neighborhood.

    The copy of the network in the folder loses its rotation.

    Args:
        folder: folder with a copy of the network.
        manifest: manifest of the model.
        data: segments to describe.
    """
    replace_constants(folder / MODEL_FILE, {"rotation": np.eye(manifest.dimension)})
    copied = manifest.with_files(folder, list(FILES))
    assert data.neighborhood is not None
    described = OnnxExtractor(folder, copied).describe(data.segments, data.neighborhood)
    own: Float32 = described[:, : manifest.dimension - constant(folder, "axes").shape[1]]
    own[~data.neighborhood.any(axis=1)] = 0.0
    return own


def write_projection(folder: Path, projection: Projection, rotation: Float32) -> None:
    """Write the neighborhood's part and the rotation into the networks of a folder."""
    constants = {
        "mean": projection.mean,
        "axes": projection.axes,
        "center": projection.center,
        "rotation": rotation,
    }
    for name in FILES:
        replace_constants(folder / name, constants)


def constant(folder: Path, name: str) -> Float32:
    """Return a constant of the network in a folder, by its name in `ExportedContext`."""
    (found,) = (
        each for each in onnx.load(folder / MODEL_FILE).graph.initializer if each.name == name
    )
    return np.asarray(numpy_helper.to_array(found), dtype=np.float32)


def replace_constants(file: Path, constants: Mapping[str, np.ndarray]) -> None:
    """Replace constants of an ONNX network by others of the same shapes.

    Raises:
        ValueError: the network lacks one, or it has another shape.
    """
    model = onnx.load(file)
    found = {each.name: each for each in model.graph.initializer if each.name in constants}
    for name, values in constants.items():
        if name not in found or tuple(found[name].dims) != values.shape:
            raise ValueError(
                f"{file}: has no constant {name!r} of shape {values.shape}. Train without "
                "--keep-network."
            )
        found[name].CopyFrom(
            numpy_helper.from_array(np.ascontiguousarray(values, dtype=np.float32), name)
        )
    onnx.save(model, file)
