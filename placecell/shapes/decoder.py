"""Shape decoder: occupancy grids of segments from their stored codes.

The decoder is an optional file beside the model, named in the manifest. It reads only what a map
holds: the code, the place of the centroid relative to the sensor and, if the map has them, the
extents of the box and the number of points.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from onnxruntime import InferenceSession

from placecell.core.types import Bool, Float32, Float64, Int8, Int64, UInt8
from placecell.descriptors.extractor import BATCH, one_thread_session
from placecell.descriptors.manifest import SHAPE_FILE, Manifest, ModelError
from placecell.descriptors.orientation import bearings_of

LIKELY = 0.0
"""Smallest logit of an occupied voxel; the export moves the best threshold here."""


@dataclass(frozen=True, slots=True, eq=False)
class StoredSegments:
    """Segments as a map stores them, for the decoder.

    Attributes:
        codes: stored descriptors, int8 (n, code bytes).
        centroids: centroids in the map's frame, meters, float64 (n, 3).
        sensors: sensor position at each segment's capture, meters, float64 (n, 3).
        extents: box along the frame's axes, decimeters, uint8 (n, 3); three zeros: unknown. None:
            all are unknown.
        counts: number of points, int64 (n,); 0: unknown. None: all are unknown.
    """

    codes: Int8
    centroids: Float64
    sensors: Float64
    extents: UInt8 | None = None
    counts: Int64 | None = None

    def __len__(self) -> int:
        return len(self.codes)

    def part(self, first: int, end: int) -> "StoredSegments":
        """Return the segments `first` to `end` - 1."""
        return StoredSegments(
            self.codes[first:end],
            self.centroids[first:end],
            self.sensors[first:end],
            None if self.extents is None else self.extents[first:end],
            None if self.counts is None else self.counts[first:end],
        )


@dataclass(frozen=True, slots=True, eq=False)
class Shapes:
    """Decoded shapes of segments.

    Attributes:
        occupancy: occupied voxels of each oriented grid, bool (n, x, y, z).
        centers: place of each grid's center, float64 (n, 3), meters, in the map's frame.
        bearings: bearing of the sensor from each centroid, float64 (n,), radians: the direction of
            the grid's x axis in the map's frame.
        voxel: edge length of a voxel, meters.
    """

    occupancy: Bool
    centers: Float64
    bearings: Float64
    voxel: float

    def __len__(self) -> int:
        return len(self.occupancy)


class ShapeDecoder:
    """Decoder of the shapes of one model's segments. Threads may share it."""

    def __init__(self, folder: Path, manifest: Manifest) -> None:
        """Load the decoder of a model.

        Raises:
            ModelError: the model has no decoder, or the file cannot be loaded.
        """
        if SHAPE_FILE not in manifest.files:
            raise ModelError(
                f"{folder}: model {manifest.name} has no shape decoder ({SHAPE_FILE}). Use a model "
                "that has one, or train one with 'placecell train-shapes'"
            )
        self.manifest = manifest
        try:
            self._session: InferenceSession = one_thread_session(folder / SHAPE_FILE)
        # onnxruntime's exceptions share no narrower base class than this.
        except Exception as error:
            raise ModelError(f"{folder / SHAPE_FILE}: cannot be loaded ({error})") from error

    @property
    def voxel(self) -> float:
        """Edge length of a voxel, meters."""
        return float(self.manifest.preprocessing["grid_voxel"])

    def logits(self, stored: StoredSegments) -> tuple[Float32, Float32]:
        """Return the logits of the grids and the places of their centers.

        Args:
            stored: segments of a map of this model.

        Returns:
            Logits of occupancy, float32 (n, x, y, z), occupied from `LIKELY`; and the vector from
            the centroid to the grid's center, float32 (n, 3), meters, with the sensor on the
            positive x axis.
        """
        offsets = stored.centroids - stored.sensors
        count = len(stored)
        extents = np.zeros((count, 3)) if stored.extents is None else stored.extents / 10.0
        counts = np.zeros(count) if stored.counts is None else stored.counts
        inputs = {
            "descriptor": self.manifest.quantizer.decode(np.ascontiguousarray(stored.codes)),
            "offset": np.stack([np.hypot(*offsets[:, :2].T), offsets[:, 2]], axis=1).astype(
                np.float32
            ),
            "bearing": bearings_of(-offsets).astype(np.float32),
            "extents": extents.astype(np.float32),
            "points": counts.astype(np.float32),
        }
        grids, centers = self._session.run(["occupancy", "center"], inputs)
        return np.asarray(grids), np.asarray(centers)

    def decode(self, stored: StoredSegments) -> Shapes:
        """Return the shapes of segments.

        Args:
            stored: segments of a map of this model.
        """
        grid = tuple(self.manifest.preprocessing["grid"])
        occupied = np.zeros((len(stored), *grid), dtype=bool)
        centers = np.zeros((len(stored), 3))
        # Logits are large, so only those of a batch are in memory.
        for first in range(0, len(stored), BATCH):
            end = min(first + BATCH, len(stored))
            logits, centers[first:end] = self.logits(stored.part(first, end))
            occupied[first:end] = logits >= LIKELY
        bearings = bearings_of(stored.sensors - stored.centroids)
        placed = stored.centroids + turned(centers, bearings)
        return Shapes(occupied, placed, bearings, self.voxel)


def load_shape_decoder(folder: Path, manifest: Manifest) -> ShapeDecoder | None:
    """Return the shape decoder of a model; None if the model has none.

    Raises:
        ModelError: the file cannot be loaded.
    """
    return ShapeDecoder(folder, manifest) if SHAPE_FILE in manifest.files else None


def turned(vectors: Float64, angles: Float64) -> Float64:
    """Return vectors, (n, 3), turned about z by one angle each, radians."""
    cosine, sine = np.cos(angles), np.sin(angles)
    x, y, z = vectors.T
    return np.stack([cosine * x - sine * y, sine * x + cosine * y, z], axis=1)
