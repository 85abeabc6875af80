"""Local engine: describes segments and localizes in a pulled map, in this process."""

from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike
from placecell_client import CompactMap
from scipy.spatial import cKDTree

from placecell.core.segment_classes import ClassFilter
from placecell.core.types import Float64
from placecell.descriptors.shipped_models import DEFAULT_MODEL, model_folder
from robot.core.link import FixAnswer, FixRequest
from robot.core.usable_segments import UsableSegments
from robot.localization.rigid import covariance_at_sensor

if TYPE_CHECKING:
    from collections.abc import Sequence


FLOOR = np.array([0.1, 0.1, 0.1, 0.02, 0.02, 0.01])
"""Standard deviations that no fix is better than: meters, and radians. Segments are seen from other
sides than when the map was made."""


class LocalEngine:
    """Model and pulled map of the robot: the engine of the service without a server.

    Attributes:
        etag: version of the map that is searched; "" before the first one.
    """

    def __init__(self, model: str | Path = DEFAULT_MODEL) -> None:
        """Load the model.

        Args:
            model: name of a shipped model, or folder of a model.

        Raises:
            ModelError: the model cannot be used.
        """
        from service.engine import Engine

        self._engine: Engine = Engine.temporary(model_folder(str(model)))
        self.etag = ""
        self._name = ""
        self._positions: cKDTree | None = None
        self._content: CompactMap | None = None
        self._replaced: tuple[CompactMap, CompactMap] | None = None
        self._lock = Lock()

    @property
    def model_id(self) -> str:
        """Return the id of the model."""
        return self._engine.model.id

    @property
    def preprocessing(self) -> str:
        """Return the version of the steps from points to the model's input."""
        return str(self._engine.model.manifest.preprocessing["version"])

    def close(self) -> None:
        """Remove the map and the model from memory."""
        self._engine.close()

    def describe(
        self, clouds: "Sequence[ArrayLike]", sensors: ArrayLike, classified: bool = True
    ) -> UsableSegments:
        """Describe the segments of one capture.

        Args:
            clouds: points of each segment, (n, 3), meters, in one z-up frame.
            sensors: position of the sensor for each segment, (segments, 3).
            classified: state the class of each segment, if the model has a semantic head.

        Returns:
            The segments that have a descriptor.
        """
        from service.core.problems import Problem

        codes = np.zeros((0, self._engine.model.manifest.code_bytes), np.int8)
        none = UsableSegments(codes, np.zeros((0, 3)), np.zeros(0, np.int64))
        if not len(clouds):
            return none
        try:
            found = self._engine.describe(clouds, sensors, classified=classified)
        except Problem:  # No segment can be described.
            return none
        usable = found.usable
        assert found.centroids is not None
        return UsableSegments(
            found.codes[usable],
            found.centroids[usable],
            usable,
            None if found.classes is None else found.classes[usable],
        )

    def set_map(self, content: CompactMap, etag: str) -> None:
        """Search another version of the map from now on.

        Raises:
            ValueError: the map has another model, or is damaged.
        """
        from service.core.problems import Problem

        if etag == self.etag:
            return
        if content.model_id != self.model_id:
            raise ValueError(
                f"The map has model {content.model_id}, but this robot describes segments with "
                f"{self.model_id}. State the map's model with --model."
            )
        name = f"map-{etag.rpartition('-')[2]}-{len(etag)}"
        if name == self._name:
            name += "-b"
        try:
            self._engine.put_map(name, content)
        except Problem as error:
            raise ValueError(f"The pulled map cannot be used: {error}") from error
        tree = cKDTree(content.frame_positions[:, :2]) if len(content.frame_positions) else None
        with self._lock:
            before, self._name, self.etag, self._positions = self._name, name, etag, tree
            if self._content is not None:
                # A version that nobody took is skipped: the oldest one is compared.
                first = self._content if self._replaced is None else self._replaced[0]
                self._replaced = first, content
            self._content = content
        if before:
            self._engine.delete_map(before)

    def take_replaced(self) -> tuple[CompactMap, CompactMap] | None:
        """Return the map before and after its last replacement, once; None if it stayed."""
        with self._lock:
            replaced, self._replaced = self._replaced, None
        return replaced

    @property
    def has_map(self) -> bool:
        """Whether there is a map to localize in."""
        return bool(self._name)

    def meters_from_map(self, position: Float64) -> float | None:
        """Return the distance from a position to the path of the robots that made the map, meters.

        Args:
            position: position in the map, (3,), meters.

        Returns:
            None if there is no map, or nothing in it.
        """
        with self._lock:
            tree = self._positions
        return None if tree is None else float(tree.query(position[:2])[0])

    def localize(self, request: FixRequest) -> FixAnswer:
        """Localize in the pulled map, as the service does in its own."""
        from service.core.problems import Problem
        from service.inference.describer import Descriptors

        with self._lock:
            name = self._name
        if not name:
            return FixAnswer(request, "local", None, None, 0.0, "no map was pulled")
        seen = Descriptors(
            request.model_id,
            request.codes,
            None,
            request.centroids,
            {},
            classes=request.classes,
            heights=request.heights,
        )
        wanted = ClassFilter.of(None, request.ignore)
        try:
            found = self._engine.localize(
                seen, maps=[name], session=request.session, hints=request.hints, wanted=wanted
            )
        except Problem as error:
            return FixAnswer(request, "local", None, None, 0.0, str(error))
        best = found[0].localization if len(found) else None
        if best is None or best.pose is None or best.best is None:
            reason = "no map was searched" if best is None else best.detail or str(best.reason)
            probability = 0.0 if best is None else best.probability
            return FixAnswer(request, "local", None, None, probability, reason)
        transform = best.pose.matrix
        covariance = covariance_at_sensor(
            best.best.covariance, transform, request.odom_pose[:3, 3], FLOOR
        )
        return FixAnswer(request, "local", transform, covariance, best.probability, "")
