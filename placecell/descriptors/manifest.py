"""A model's manifest: what it is, what it needs, what made it.

`models/NAME/manifest.json` beside `model.onnx`. The id is a hash of all that decides a descriptor's
value; descriptors, maps and responses carry it, and those of different ids are never compared.
"""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

from placecell.core.parameters import PREPROCESSING_VERSION, NeighborhoodParameters, Parameters
from placecell.descriptors.quantizer import Quantizer

FILE = "manifest.json"

PAIR_FILE = "pair.onnx"
"""The pair classifier judges descriptors, but does not decide them: no part of the id."""

FULL_FILE = "model-fp32.onnx"
"""Of a model that is served in 8-bit integers: what these were made from. No part of the id."""


JSON_KEYS = {"quantizer": "quantiser", "standardization": "standardisation"}
"""Keys of `manifest.json` that differ from the attribute's name; published models have them."""


class ModelError(ValueError):
    """A model folder that cannot be used; the message says which file and why."""


@dataclass(frozen=True, slots=True)
class Manifest:
    """What `manifest.json` holds.

    Attributes:
        name: as the folder in `models/`.
        method: how it was trained (`group`, ...), or `eigenvalue`.
        network: the network's name; empty for `eigenvalue`.
        dimension: of the descriptor.
        quantizer: to the stored form.
        preprocessing: the constants from points to the network's input.
        files: SHA-256 of each of the model's files, by name.
        standardization: mean and standard deviation of the eigenvalue features in training.
        pair_threshold: distance of stored descriptors below which a pair is called a match.
        pair: the pair classifier: its `kind`, the `threshold` of its probability, and how the
            kinds compared on validation; empty if there is none. Not part of the id.
        training: drives, scans and their hashes, seed, time, licenses: not part of the id.
        figures: measured; not part of the id.
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
    training: dict[str, Any] = field(default_factory=dict)
    figures: dict[str, Any] = field(default_factory=dict)

    @property
    def model_id(self) -> str:
        """The name and a hash of all that decides a descriptor's value."""
        decisive = {
            "method": self.method,
            "dimension": self.dimension,
            "quantiser": self.quantizer.as_dict(),
            "preprocessing": self.preprocessing,
            "files": {
                name: sha for name, sha in self.files.items() if name not in {PAIR_FILE, FULL_FILE}
            },
            "standardisation": self.standardization,
        }
        text = json.dumps(decisive, sort_keys=True, separators=(",", ":"))
        return f"{self.name}-{hashlib.sha256(text.encode()).hexdigest()[:16]}"

    def with_files(self, folder: Path, names: list[str]) -> "Manifest":
        """The same with the hashes of these files of the folder."""
        return replace(self, files={name: file_hash(folder / name) for name in names})

    def save(self, folder: Path) -> None:
        """Write `manifest.json`."""
        content = {"model_id": self.model_id} | {
            JSON_KEYS.get(name, name): value for name, value in asdict(self).items()
        }
        content["quantiser"] = self.quantizer.as_dict()
        (folder / FILE).write_text(json.dumps(content, indent=2) + "\n")

    @classmethod
    def load(cls, folder: Path) -> "Manifest":
        """Read `manifest.json` and check every file of the model against its hash.

        Raises:
            ModelError: missing, malformed, altered, or made for other preprocessing.
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
                raise ModelError(f"{path}: missing, but named in {file}")
            if file_hash(path) != stated:
                raise ModelError(f"{path}: its SHA-256 is not the one in {file}; get both anew")
        if manifest.model_id != stated_id:
            raise ModelError(f"{file}: states the id {stated_id}, but is {manifest.model_id}")
        if manifest.preprocessing.get("version") != PREPROCESSING_VERSION:
            raise ModelError(
                f"{file}: made for preprocessing version {manifest.preprocessing.get('version')}; "
                f"this program has version {PREPROCESSING_VERSION}: train the model again"
            )
        return manifest

    def has_seen(self, scan_hashes: Iterable[str]) -> bool:
        """Whether the model was trained on any of these scans, wherever they lay."""
        trained: set[str] = set()
        for source in self.training.get("sources", []):
            trained.update(source["scan_hashes"])
        return not trained.isdisjoint(scan_hashes)

    @property
    def code_bytes(self) -> int:
        """Bytes of a stored descriptor."""
        return self.quantizer.code_bytes(self.dimension)

    @property
    def neighborhood(self) -> NeighborhoodParameters | None:
        """How the surroundings are described; None if the model looks at each segment alone."""
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
        """Protocol v1 with this model's grid."""
        return Parameters(
            grid=tuple(self.preprocessing["grid"]), grid_voxel=self.preprocessing["grid_voxel"]
        )


def preprocessing_of(
    parameters: Parameters, neighborhood: NeighborhoodParameters | None = None
) -> dict[str, Any]:
    """The constants from a segment's points to the network's input, for a manifest."""
    constants: dict[str, Any] = {
        "version": PREPROCESSING_VERSION,
        "grid": list(parameters.grid),
        "grid_voxel": parameters.grid_voxel,
    }
    if neighborhood is not None:
        # As JSON has it, so that the id is the same before and after it was written.
        constants["surroundings"] = json.loads(json.dumps(asdict(neighborhood)))
    return constants


def file_hash(file: Path) -> str:
    """SHA-256 of a file, in hex."""
    return hashlib.sha256(file.read_bytes()).hexdigest()
