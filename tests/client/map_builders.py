"""Random maps."""

import numpy as np
from placecell_client import CompactMap


def random_map(
    segments: int = 20,
    dimension: int = 4,
    frames: int = 5,
    extent: float = 300.0,
    seed: int = 0,
    robots: tuple[str, ...] = ("zoe", "ann"),
) -> CompactMap:
    random = np.random.default_rng(seed)
    quaternions = random.normal(size=(frames, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    return CompactMap(
        model_id="tiny-0123456789abcdef",
        preprocessing="1",
        frame="town",
        codes=random.integers(-127, 128, (segments, dimension)).astype(np.int8),
        centroids=random.uniform(-extent / 2, extent / 2, (segments, 3)),
        ids=random.permutation(segments * 3)[:segments].astype(np.uint32),
        robots=robots,
        robot=(np.arange(segments) % len(robots)).astype(np.uint16),
        frame_index=(np.arange(segments) % frames).astype(np.uint32),
        frame_times=1.7e9 + np.sort(random.uniform(0, 100, frames)),
        frame_positions=random.uniform(-extent / 2, extent / 2, (frames, 3)),
        frame_orientations=quaternions.astype(np.float32),
    )
