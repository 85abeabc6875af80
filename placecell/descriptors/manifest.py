"""Model manifest: identity, preprocessing, files, training and figures of a model.

The manifest is `models/NAME/manifest.json`, beside `model.onnx`. The model's id is a hash of
everything that determines the values of descriptors. Descriptors, maps and responses carry the id;
descriptors of different ids are never compared.
"""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from placecell.core.parameters import PREPROCESSING_VERSIONS, NeighborhoodParameters, Parameters
from placecell.descriptors.quantizer import Quantizer

FILE = "manifest.json"

PAIR_FILE = "pair.onnx"
"""File of the pair classifier. It does not influence descriptors, so it is not part of the id."""

FULL_FILE = "model-fp32.onnx"
"""File of the float32 network of a model that is served with 8-bit integers. Not part of the id."""

SHAPE_FILE = "shape.onnx"
"""Optional file of the shape decoder (`placecell.shapes`). It is not part of the id."""

CLASSES_FILE = "classes.onnx"
"""File of the head that tells a segment's class. Not part of the id."""

BESIDE = frozenset({PAIR_FILE, FULL_FILE, SHAPE_FILE, CLASSES_FILE})
"""Files that do not influence descriptors."""

CALIBRATION_FILE = "calibration.json"
"""Optional file of `placecell calibrate`; its site constants replace those of the manifest."""

JSON_KEYS = {"quantizer": "quantiser", "standardization": "standardisation"}
"""Keys of `manifest.json` that differ from the attribute's name, kept for published models."""

OPTIONAL_KEYS = frozenset({"shape", "classes"})
"""Keys that are left out if they are empty, so that earlier versions read the manifest."""


class ModelError(ValueError):
    """Model folder that cannot be used. The message names the file and the reason."""


@dataclass(frozen=True)
class Manifest:
    """Content of `manifest.json`.

    Attributes:
        name: name of the folder in `models/`.
        method: training method (`group`, ...), or `eigenvalue`.
        network: name of the network; empty for `eigenvalue`.
        dimension: number of values of a descriptor.
        quantizer: encoder of descriptors into codes.
        preprocessing: constants from points to the network's input.
        files: SHA-256 of each file of the model, by name.
        standardization: mean and standard deviation of the eigenvalue features in training.
        pair_threshold: distance of decoded descriptors below which a pair is a match.
        pair: the pair classifier's `kind`, the `threshold` of its probability and the comparison of
            the kinds on validation; empty without a classifier. Not part of the id.
        classes: version of the features of the head for classes, its training and its figures;
            empty without a head. Not part of the id.
        training: drives, scans and their hashes, seed, time and licenses. Not part of the id.
        figures: measured results. Not part of the id.
        shape: training and figures of the shape decoder; empty without one. Not part of the id.
    """

    name: str
    method: str
    network: str
    dimension: int
    quantizer: Quantizer
    preprocessing: dict[str, Any]
    files: dict[str, str] = field(default_factory=dict)
    standardization: dict[str, list[float]] = field(default_factory=dict)
    pair_threshold: float = 0.0
    pair: dict[str, Any] = field(default_factory=dict)
    classes: dict[str, Any] = field(default_factory=dict)
    training: dict[str, Any] = field(default_factory=dict)
    figures: dict[str, Any] = field(default_factory=dict)
    shape: dict[str, Any] = field(default_factory=dict)

    @cached_property
    def model_id(self) -> str:
        """Name and hash of everything that determines a descriptor's values."""
        decisive = {
            "method": self.method,
            "dimension": self.dimension,
            "quantiser": self.quantizer.as_dict(),
            "preprocessing": self.preprocessing,
            "files": {name: sha for name, sha in self.files.items() if name not in BESIDE},
            "standardisation": self.standardization,
        }
        text = json.dumps(decisive, sort_keys=True, separators=(",", ":"))
        return f"{self.name}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"

    def with_files(self, folder: Path, names: list[str]) -> "Manifest":
        """Return a copy with the hashes of these files of the folder."""
        return replace(self, files={name: file_hash(folder / name) for name in names})

    def save(self, folder: Path) -> None:
        """Write `manifest.json`."""
        content = {"model_id": self.model_id} | {
            JSON_KEYS.get(name, name): value
            for name, value in asdict(self).items()
            if value or name not in OPTIONAL_KEYS
        }
        content["quantiser"] = self.quantizer.as_dict()
        (folder / FILE).write_text(json.dumps(content, indent=2) + "\n")

    @classmethod
    def load(cls, folder: Path) -> "Manifest":
        """Read `manifest.json` and check every file of the model against its hash.

        Raises:
            ModelError: A file is missing, malformed or altered, or the preprocessing differs.
        """
        file = folder / FILE
        try:
            content = json.loads(file.read_text())
            stated_id = content.pop("model_id")
            quantizer = Quantizer(**content.pop("quantiser"))
            standardization = content.pop("standardisation", {})
            manifest = cls(quantizer=quantizer, standardization=standardization, **content)
            if manifest.dimension % quantizer.per_byte:
                raise ValueError(f"{manifest.dimension} dimensions do not fill whole bytes")
        except FileNotFoundError as error:
            raise ModelError(f"{file}: missing; {folder} is not a model's folder") from error
        except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
            raise ModelError(f"{file}: not a model's manifest ({error})") from error
        for name, stated in manifest.files.items():
            path = folder / name
            if Path(name).name != name or not path.is_file():
                raise ModelError(f"{path}: missing, but named in {file}. Get the model again")
            if file_hash(path) != stated:
                raise ModelError(
                    f"{path}: its SHA-256 differs from the one in {file}. Get both again"
                )
        if manifest.model_id != stated_id:
            raise ModelError(
                f"{file}: states the id {stated_id}, but its content has the id "
                f"{manifest.model_id}. Get the model again"
            )
        version = manifest.preprocessing.get("version")
        expected = PREPROCESSING_VERSIONS.get(manifest.preprocessing.get("voxel_parts", 1))
        if version is None or version != expected:
            raise ModelError(
                f"{file}: made for preprocessing version {version}, expected {expected}. Train the "
                "model again"
            )
        return manifest.with_calibration(folder / CALIBRATION_FILE)

    def with_calibration(self, file: Path) -> "Manifest":
        """Return the manifest with the constants of a calibration file; as it is without one.

        Raises:
            ModelError: The file is malformed, or was made for another model.
        """
        try:
            content = json.loads(file.read_text())
            model_id = content["model_id"]
            site = {
                name: float(content["site"][name])
                for name in ("slope", "offset", "mean", "deviation")
            }
        except FileNotFoundError:
            return self
        except (OSError, ValueError, KeyError, TypeError) as error:
            raise ModelError(f"{file}: not a calibration file ({error})") from error
        if model_id != self.model_id:
            raise ModelError(
                f"{file}: made for model {model_id}, expected {self.model_id}. Run 'placecell "
                "calibrate' again, or delete the file"
            )
        return replace(self, pair=self.pair | {"site": site})

    def has_seen(self, scan_hashes: Iterable[str]) -> bool:
        """Return whether the model was trained on any of these scans, in whichever folder.

        Args:
            scan_hashes: hashes of scans (`Drive.scan_hash`).
        """
        trained: set[str] = set()
        for source in self.training.get("sources", []):
            trained.update(source["scan_hashes"])
        return not trained.isdisjoint(scan_hashes)

    @property
    def code_bytes(self) -> int:
        """Number of bytes of a code."""
        return self.quantizer.code_bytes(self.dimension)

    @property
    def neighborhood(self) -> NeighborhoodParameters | None:
        """Parameters of the neighborhood; None if the model uses each segment alone."""
        constants = self.preprocessing.get("surroundings")
        if constants is None:
            return None
        return NeighborhoodParameters(
            constants["voxel"],
            tuple(constants["rings"]),
            tuple(constants["heights"]),
            constants["sectors"],
        )

    @property
    def parameters(self) -> Parameters:
        """Parameters of protocol v1 with this model's grid."""
        return Parameters(
            grid=tuple(self.preprocessing["grid"]),
            grid_voxel=self.preprocessing["grid_voxel"],
            voxel_parts=self.preprocessing.get("voxel_parts", 1),
        )


def preprocessing_of(
    parameters: Parameters, neighborhood: NeighborhoodParameters | None = None
) -> dict[str, Any]:
    """Return the constants from a segment's points to the network's input, for a manifest."""
    constants: dict[str, Any] = {
        "version": PREPROCESSING_VERSIONS[parameters.voxel_parts],
        "grid": list(parameters.grid),
        "grid_voxel": parameters.grid_voxel,
    }
    if parameters.voxel_parts > 1:
        constants["voxel_parts"] = parameters.voxel_parts
    if neighborhood is not None:
        # Through JSON, so that the id is the same before writing and after reading.
        constants["surroundings"] = json.loads(json.dumps(asdict(neighborhood)))
    return constants


def file_hash(file: Path) -> str:
    """Return the SHA-256 of a file, in hex."""
    return hashlib.sha256(file.read_bytes()).hexdigest()
