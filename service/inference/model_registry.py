"""Model registry: the default model, and the models that stored maps need."""

import logging
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.manifest import FILE, SHAPE_FILE, Manifest, ModelError
from placecell.descriptors.pair_classifier import PairClassifier, load_pair_classifier
from placecell.localization.confidence import NAME, Confidence, shipped
from placecell.shapes.decoder import ShapeDecoder, load_shape_decoder
from service.core.metrics import Metrics
from service.core.problems import Problem
from service.core.settings import Settings
from service.inference.describer import Describer

logger = logging.getLogger("placecell")


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """Loaded model.

    Attributes:
        describer: runs the model.
        classifier: pair classifier; None if the model has none.
        confidence: gives the probability that a pose found from its descriptors is right.
        folder: folder of the model.
    """

    describer: Describer
    classifier: PairClassifier | None
    confidence: Confidence
    folder: Path

    @property
    def manifest(self) -> Manifest:
        """Return the manifest."""
        return self.describer.manifest

    @property
    def id(self) -> str:
        """Return the id by which maps and codes name the model."""
        return self.manifest.model_id

    @property
    def has_shapes(self) -> bool:
        """Return whether the model has a shape decoder."""
        return SHAPE_FILE in self.manifest.files


class Models:
    """Loaded models by id. A loaded model stays, so that its maps stay searchable."""

    def __init__(self, settings: Settings, metrics: Metrics) -> None:
        """Load the default model and the other models of the settings.

        Raises:
            ModelError: one of them cannot be loaded.
        """
        self._settings = settings
        self._metrics = metrics
        self._loading = Lock()
        self._by_id: dict[str, Model] = {}
        self._decoders: dict[str, ShapeDecoder | None] = {}
        self.default = self.reload()

    def all(self) -> list[Model]:
        """Return all models, the default model first."""
        default = self.default
        return [default, *(model for model in self._by_id.values() if model is not default)]

    def find(self, model_id: str) -> Model | None:
        """Return the model of this id; None if it is not loaded."""
        return self._by_id.get(model_id)

    def named(self, wanted: str | None) -> Model:
        """Return the model of this id or name; the default model for None.

        Raises:
            Problem: 409 if it is not loaded.
        """
        if wanted is None:
            return self.default
        for model in self.all():
            if wanted in {model.id, model.manifest.name}:
                return model
        raise self.unknown(wanted)

    def unknown(self, wanted: str) -> Problem:
        """Return the problem of a model that is not loaded."""
        return Problem(
            409,
            "other-model",
            f"Model {wanted!r:.100} is not loaded. The default model is {self.default.id}; /info "
            "lists all loaded models.",
        )

    def shape_decoder(self, model: Model) -> ShapeDecoder | None:
        """Return the shape decoder of a model, loaded by the first call; None if it has none.

        Raises:
            ModelError: its file cannot be loaded.
        """
        with self._loading:
            if model.id not in self._decoders:
                self._decoders[model.id] = load_shape_decoder(model.folder, model.manifest)
            return self._decoders[model.id]

    def reload(self) -> Model:
        """Load the models of the settings that changed on disk, all of them or none.

        Requests in progress keep the model that they began with.

        Returns:
            The default model.

        Raises:
            ModelError: a model cannot be loaded; the loaded models stay in use.
        """
        settings = self._settings
        with self._loading:
            default = self._load(settings.models_dir / settings.model)
            others = [self._load(settings.models_dir / name) for name in settings.also]
            # A new dictionary, so that readers of the old one are undisturbed.
            self._by_id = self._by_id | {model.id: model for model in [default, *others]}
            self.default = default
            self._tell()
        return default

    def want(self, model_ids: Iterable[str]) -> None:
        """Load the models of these ids that the models folder holds.

        A model that cannot be loaded is left out, with a line in the log. Its maps stay stored.
        """
        with self._loading:
            missing = set(model_ids) - set(self._by_id)
            for file in sorted(self._settings.models_dir.glob(f"*/{FILE}")) if missing else ():
                try:
                    if Manifest.load(file.parent).model_id in missing:
                        model = self._load(file.parent)
                        self._by_id = self._by_id | {model.id: model}
                except ModelError as error:
                    logger.warning("model left out: %s", error)
            self._tell()

    def _load(self, folder: Path) -> Model:
        known = self._by_id.get(Manifest.load(folder).model_id)
        if known is not None:
            return known
        extractor = load_extractor(folder, self._settings.threads)
        return Model(
            Describer(extractor, self._settings.limits, self._metrics),
            load_pair_classifier(folder, extractor.manifest),
            _confidence_of(folder, extractor.manifest),
            folder,
        )

    def _tell(self) -> None:
        self._metrics.models.clear()
        for model in self.all():
            role = "default" if model is self.default else "beside"
            self._metrics.models.labels(model.id, role).set(1)


def _confidence_of(folder: Path, manifest: Manifest) -> Confidence:
    """Return the confidence of a model's folder; the default model's if it does not fit."""
    file = folder / NAME
    if not file.is_file():
        return shipped()
    try:
        return Confidence.load(file, manifest.model_id)
    except (ValueError, KeyError, TypeError) as error:
        logger.warning("probabilities of poses use the default model's constants: %s", error)
        return shipped()
