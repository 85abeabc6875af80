"""The models at work: the one that describes by default, and those that stored maps need."""

import logging
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.manifest import FILE, Manifest, ModelError
from placecell.descriptors.pair_classifier import PairClassifier, load_pair_classifier
from placecell.localization.confidence import NAME, Confidence, shipped
from service.core.metrics import Metrics
from service.core.problems import Problem
from service.core.settings import Settings
from service.inference.describer import Describer

logger = logging.getLogger("placecell")


@dataclass(frozen=True, slots=True, eq=False)
class Model:
    """A loaded model.

    Attributes:
        describer: that runs it.
        classifier: its pair classifier, if it has one.
        confidence: how probable a pose is that was found from its descriptors.
    """

    describer: Describer
    classifier: PairClassifier | None
    confidence: Confidence

    @property
    def manifest(self) -> Manifest:
        """What the model is."""
        return self.describer.manifest

    @property
    def id(self) -> str:
        """Of the model, as maps and codes name it."""
        return self.manifest.model_id


class Models:
    """All loaded models by id. What is loaded stays, so that no map is stranded."""

    def __init__(self, settings: Settings, metrics: Metrics) -> None:
        """Load the default model, and those that the settings name beside it.

        Raises:
            ModelError: one of them cannot be loaded.
        """
        self._settings = settings
        self._metrics = metrics
        self._loading = Lock()
        self._by_id: dict[str, Model] = {}
        self.default = self.reload()

    def all(self) -> list[Model]:
        """The default first."""
        default = self.default
        return [default, *(model for model in self._by_id.values() if model is not default)]

    def find(self, model_id: str) -> Model | None:
        """The model of this id, if it is loaded."""
        return self._by_id.get(model_id)

    def named(self, wanted: str | None) -> Model:
        """The model of this id or name; the default unless one is wanted.

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
        """The problem of a model that is not loaded."""
        return Problem(
            409,
            "other-model",
            f"Model {wanted!r:.100} is not loaded; the default is {self.default.id}, /info "
            "shows all.",
        )

    def reload(self) -> Model:
        """Load anew what has changed on disk, and what is needed; all of it, or nothing.

        Requests at work go on with the model that they began with.

        Returns:
            The default model.

        Raises:
            ModelError: a model cannot be used; those that were loaded go on.
        """
        settings = self._settings
        with self._loading:
            default = self._load(settings.models_dir / settings.model)
            others = [self._load(settings.models_dir / name) for name in settings.also]
            # A new dictionary, so that a reader in the midst of the old one is not disturbed.
            self._by_id = self._by_id | {model.id: model for model in [default, *others]}
            self.default = default
            self._tell()
        return default

    def want(self, model_ids: Iterable[str]) -> None:
        """Load the models that maps were made with, where a folder holds them.

        A model that cannot be loaded is left out, with a line in the log: its maps stay stored.
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
        )

    def _tell(self) -> None:
        self._metrics.models.clear()
        for model in self.all():
            role = "default" if model is self.default else "beside"
            self._metrics.models.labels(model.id, role).set(1)


def _confidence_of(folder: Path, manifest: Manifest) -> Confidence:
    """The folder's own, if it was fitted for this model; else the default model's."""
    file = folder / NAME
    if not file.is_file():
        return shipped()
    try:
        return Confidence.load(file, manifest.model_id)
    except (ValueError, KeyError, TypeError) as error:
        logger.warning("probabilities of poses are by the default model's constants: %s", error)
        return shipped()
