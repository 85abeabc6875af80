"""Random maps."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from placecell_client import CompactMap


def random_map(
    segments: int = 20,
    dimension: int = 4,
    frames: int = 5,
    extent: float = 300.0,
    seed: int = 0,
    robots: tuple[str, ...] = ("zoe", "ann"),
    optional: Iterable[str] = (),
) -> CompactMap:
    """A map whose sensors lie anywhere within `extent`, and whose segments within 40 m of them."""
    random = np.random.default_rng(seed)
    quaternions = random.normal(size=(frames, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    positions = random.uniform(-extent / 2, extent / 2, (frames, 3))
    frame_index = (np.arange(segments) % frames).astype(np.uint32)
    given = CompactMap(
        model_id="tiny-0123456789abcdef",
        preprocessing="1",
        frame="town",
        codes=random.integers(-127, 128, (segments, dimension)).astype(np.int8),
        centroids=positions[frame_index] + random.uniform(-40, 40, (segments, 3)),
        ids=random.permutation(segments * 3)[:segments].astype(np.uint32),
        robots=robots,
        robot=(np.arange(segments) % len(robots)).astype(np.uint16),
        frame_index=frame_index,
        frame_times=1.7e9 + np.sort(random.uniform(0, 100, frames)),
        frame_positions=positions,
        frame_orientations=quaternions.astype(np.float32),
    )
    columns: dict[str, Any] = {
        "extents": random.integers(0, 256, (segments, 3)).astype(np.uint8),
        "points": random.integers(0, 1 << 16, segments).astype(np.uint16),
        "views": given.ids[random.integers(0, segments, segments)] if segments else given.ids,
        "seen": random.integers(0, 1 << 32, segments).astype(np.uint32),
    }
    return replace(given, **{name: columns[name] for name in optional})
