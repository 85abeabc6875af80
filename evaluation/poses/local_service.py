"""The service's parts in this process: what its routes call, called without HTTP between."""

import asyncio
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter

import numpy as np
from numpy.typing import ArrayLike
from placecell_client import CompactMap, Description, Info, ItemError, encode

from placecell.core.types import Float64, Int8
from placecell.descriptors.manifest import Manifest
from placecell.localization import Localization, LocalizationParameters
from placecell.localization.evidence import Evidence
from placecell.map_alignment import AlignmentParameters, MapAlignment
from service.api.state import State, open_state
from service.core.auth import ANYONE
from service.core.preconditions import Preconditions
from service.core.settings import Settings
from service.core.timing import Timing
from service.inference.model_registry import Model
from service.inference.scan import Scan
from service.maps.writes.writer import MapWriter
from service.merging.alignment import MapSide, align_maps
from service.search.localization import localize_in


class Local:
    """A model at work, and maps in a folder that goes when the block ends."""

    def __init__(self, state: State, runner: asyncio.Runner) -> None:
        self._state = state
        self._runner = runner

    @classmethod
    @contextmanager
    def open(cls, model: Path) -> "Iterator[Local]":
        """With the model of a folder.

        Raises:
            ModelError: the folder holds no usable model.
        """
        Manifest.load(model)
        with tempfile.TemporaryDirectory(prefix="placecell-local-") as folder:
            settings = Settings(
                data_dir=Path(folder), models_dir=model.resolve().parent, model=model.name
            )
            with asyncio.Runner() as runner, open_state(settings) as state:
                yield cls(state, runner)

    @property
    def model(self) -> Model:
        """That describes."""
        return self._state.models.default

    def info(self) -> Info:
        """As `/info`, but for the limits."""
        manifest = self.model.manifest
        model = {"preprocessing": manifest.preprocessing}
        return Info("", manifest.model_id, model, {}, 0)

    def describe(self, segments: Sequence[ArrayLike], sensors: ArrayLike) -> Description:
        """As `/describe`."""
        scan = Scan(
            np.concatenate(segments, dtype=np.float64),
            np.array([len(np.asarray(cloud)) for cloud in segments]),
            np.asarray(sensors, dtype=np.float64),
            np.zeros(len(segments), dtype=np.int64),
        )
        describer, timing = self.model.describer, Timing()
        described = self._runner.run(describer.describe(describer.prepare(scan, timing), timing))
        good = [index for index, row in enumerate(described.rows) if isinstance(row, int)]
        manifest = self.model.manifest
        codes = np.zeros((len(segments), manifest.code_bytes), dtype=np.int8)
        descriptors = np.full((len(segments), manifest.dimension), np.nan, dtype=np.float32)
        centroids = np.full((len(segments), 3), np.nan)
        codes[good], descriptors[good] = described.codes, described.descriptors
        centroids[good] = described.centroids
        errors = {
            index: ItemError(row.error.type, row.error.title, row.error.detail)
            for index, row in enumerate(described.rows)
            if not isinstance(row, int)
        }
        return Description(manifest.model_id, codes, descriptors, centroids, errors)

    def put_map(self, name: str, compact_map: CompactMap) -> int:
        """As `PUT /maps/{map}`; the bytes of its file."""
        data = encode(compact_map)
        state = self._state
        MapWriter(state.maps, state.models, ANYONE, Preconditions()).put(name, data)
        return len(data)

    def replace_map(self, name: str, compact_map: CompactMap) -> None:
        """As `DELETE /maps/{map}`, if there is such a map, and `PUT`."""
        if self._state.maps.find(name) is not None:
            self._state.maps.delete(name)
        self.put_map(name, compact_map)

    def localize(
        self,
        codes: Int8,
        centroids: Float64,
        name: str,
        k: int,
        parameters: LocalizationParameters,
        evidence: Evidence | None = None,
    ) -> tuple[Localization, float]:
        """As `/localize` from codes in one map; and the milliseconds that it took."""
        started = perf_counter()
        stored = self._state.maps.get(name)
        found = localize_in(codes, centroids, self.model, stored, k, parameters, Timing(), evidence)
        return found, 1e3 * (perf_counter() - started)

    def align(self, name: str, other: str) -> tuple[MapAlignment, float]:
        """As `/maps/{map}/align/{other}`; and the milliseconds that it took."""
        started = perf_counter()
        one, another = (MapSide.of(self._state.maps.get(each)) for each in (name, other))
        found = align_maps(one, another, one.index(self.model), self.model, AlignmentParameters())
        return found, 1e3 * (perf_counter() - started)
