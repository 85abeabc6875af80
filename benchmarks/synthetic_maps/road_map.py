"""A synthetic map along a straight road, with given descriptors."""

import numpy as np
from placecell_client import CompactMap

from placecell.core.types import Int8
from placecell.descriptors.manifest import Manifest

SEGMENTS_PER_CAPTURE = 40
CAPTURE_SPACING_M = 1.0
LANE_LENGTH_M = 2000
LANE_SPACING_M = 50


def road_map(codes: Int8, manifest: Manifest, robot: str, seed: int = 0) -> CompactMap:
    """Return a map with these descriptors, on a road of parallel lanes of 2 km.

    The segments of a capture lie at random within 40 m of its sensor position.

    Args:
        codes: int8 (n, code bytes), one descriptor per segment.
        manifest: manifest of the model that made the descriptors.
        robot: name of the robot that made the map.
        seed: random seed of the segment positions.
    """
    random = np.random.default_rng(seed)
    count = len(codes)
    captures = -(-count // SEGMENTS_PER_CAPTURE)
    sensors = np.zeros((captures, 3))
    driven = CAPTURE_SPACING_M * np.arange(captures)
    sensors[:, 0] = driven % LANE_LENGTH_M
    sensors[:, 1] = LANE_SPACING_M * (driven // LANE_LENGTH_M)
    frame_index = np.arange(count) // SEGMENTS_PER_CAPTURE
    offsets = random.uniform([-40, -40, -2], [40, 40, 6], (count, 3))
    return CompactMap(
        model_id=manifest.model_id,
        preprocessing=manifest.preprocessing["version"],
        frame="bench",
        codes=codes,
        centroids=sensors[frame_index] + offsets,
        ids=np.arange(count, dtype=np.uint32),
        robots=(robot,),
        robot=np.zeros(count, np.uint16),
        frame_index=frame_index.astype(np.uint32),
        frame_times=np.arange(1e9, 1e9 + captures),
        frame_positions=sensors,
        frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (captures, 1)),
    )
