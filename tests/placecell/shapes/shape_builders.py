"""Segments of a yard as a map stores them, for the tests of shapes."""

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.canonical import canonical

from placecell.core.segments import Segments
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER

FOLDER = MODELS_FOLDER / DEFAULT_MODEL


def walls(count: int = 4, seed: int = 0) -> Segments:
    """Return walls of several sizes around a sensor."""
    random = np.random.default_rng(seed)
    clouds = []
    for number in range(count):
        across, up = np.meshgrid(np.arange(0, 2 + number % 3, 0.1), np.arange(0, 1.5, 0.1))
        wall = np.column_stack([np.zeros(across.size), across.ravel(), up.ravel()])
        place = [8 + 3 * number, 4 - 5 * number, 0]
        clouds.append((wall + place + random.normal(0, 0.02, wall.shape)).astype(np.float32))
    return Segments.of(clouds, np.tile([0.0, 0, 1.7], (count, 1)).astype(np.float32))


def map_of(segments: Segments, *, extents: bool = True) -> CompactMap:
    """Return the map of one capture."""
    extractor = load_extractor(FOLDER)
    manifest = extractor.manifest
    low, high = segments.bounds()
    count = len(segments)
    return canonical(
        CompactMap(
            model_id=manifest.model_id,
            preprocessing=str(manifest.preprocessing["version"]),
            frame="yard",
            codes=manifest.quantizer.encode(extractor.describe(segments)),
            centroids=segments.centroids(),
            ids=np.arange(10, 10 + count, dtype=np.uint32),
            robots=("ann",),
            robot=np.zeros(count, np.uint16),
            frame_index=np.zeros(count, np.uint32),
            frame_times=np.array([5.0]),
            frame_positions=segments.sensors[:1].astype(np.float64),
            frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
            extents=np.ceil((high - low) * 10).clip(1, 255).astype(np.uint8) if extents else None,
            classes=np.full(count, 1, np.uint8),
        )
    )
