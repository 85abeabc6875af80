"""Site calibrations of stored maps: derived from the segments, cached, never stored."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from hashlib import blake2b
from threading import Lock
from typing import Protocol
from weakref import ref

from placecell.core.types import Float64, Int8, Int64
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.site_calibration import (
    SiteCalibration,
    SiteConstants,
    calibrate,
)


@dataclass(frozen=True, slots=True, eq=False)
class SiteSample:
    """Segments of a map that its calibration reads, in the order of their ids.

    Attributes:
        codes: int8 (n, code bytes).
        centroids: float64 (n, 3), meters, in the frame of the map.
        captures: int64 (n,), number of the capture that each was seen in.
    """

    codes: Int8
    centroids: Float64
    captures: Int64

    def digest(self) -> bytes:
        """Return a hash of the sample."""
        state = blake2b(digest_size=16)
        for column in (self.codes, self.centroids, self.captures):
            state.update(column.tobytes())
        return state.digest()


class SampledLayers(Protocol):
    """Version of a map."""

    def __len__(self) -> int: ...

    def site_sample(self) -> SiteSample:
        """Return the segments that a calibration reads."""


class SiteCalibrations:
    """Calibration of a map, kept from version to version while its sample stays the same.

    Equal versions have equal calibrations, whatever was computed before. A map that grows has a new
    sample after each fifth, so writes of single segments do not calibrate it again and again.
    """

    def __init__(self) -> None:
        self._computing = Lock()
        self._known: tuple[str, bytes, SiteCalibration] | None = None
        self._latest: tuple[Callable[[], SampledLayers | None], str, SiteCalibration] | None = None

    @property
    def latest(self) -> SiteCalibration | None:
        """Return the newest calibration; None if none was needed yet."""
        return None if self._latest is None else self._latest[2]

    def of(self, layers: SampledLayers, manifest: Manifest) -> SiteCalibration | None:
        """Return the calibration of a version; None if the model has no site constants.

        Args:
            layers: segments of the version.
            manifest: manifest of the model that made them.
        """
        constants = SiteConstants.of(manifest)
        if constants is None:
            return None
        latest = self._latest
        if latest is not None and latest[0]() is layers and latest[1] == manifest.model_id:
            return latest[2]
        with self._computing:
            sample = layers.site_sample()
            digest = sample.digest()
            if self._known is None or self._known[:2] != (manifest.model_id, digest):
                site = calibrate(
                    sample.codes,
                    sample.centroids,
                    sample.captures,
                    manifest.quantizer,
                    constants,
                )
                self._known = (manifest.model_id, digest, site)
            site = replace(self._known[2], segments=len(layers))
            self._latest = (ref(layers), manifest.model_id, site)
            return site
