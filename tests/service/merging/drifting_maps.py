"""Maps of robots that drive around a block of landmarks with drifting odometry."""

from typing import Any

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.canonical import canonical
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64
from placecell.pose_graph.frames import rotated
from tests.placecell.map_alignment.map_builders import DIMENSION
from tests.placecell.pose_graph.graph_builders import drifted, square_path

SIDE = 24
"""Captures on each side of the block, 5 m apart."""

SEEN = 20.0
"""Distance up to which landmarks are seen, meters."""


def landmarks(seed: int = 0, side: int = SIDE) -> tuple[Float64, Float64]:
    """Return landmarks along the block's streets, (n, 3), and their descriptors."""
    rng = np.random.default_rng(seed)
    positions, yaws = square_path(side, 1)
    along = np.repeat(np.arange(len(positions)), 3)
    offsets = np.column_stack(
        [
            rng.uniform(-2.5, 2.5, len(along)),
            rng.choice([-1, 1], len(along)) * rng.uniform(4, 12, len(along)),
            rng.uniform(0, 4, len(along)),
        ]
    )
    places = positions[along] + rotated(offsets, yaws[along])
    return places, rng.normal(size=(len(along), DIMENSION))


def drifting_map(
    model_id: str,
    seed: int,
    laps: int = 2,
    meters: float = 0.05,
    degrees: float = 0.1,
    robot: str = "ann",
    odometry: bool = False,
    side: int = SIDE,
    block: int = 0,
) -> tuple[CompactMap, Float64]:
    """Return the map of a robot that drove around a block, and its true positions (f, 3).

    Args:
        model_id: id of the model.
        seed: seed of drift and noise.
        laps: number of laps.
        meters: drift after one meter, meters.
        degrees: the same of the heading.
        robot: name of the robot.
        odometry: whether the map states the odometry.
        side: number of captures on each side of the block.
        block: seed of the landmarks: another one is another place.
    """
    rng = np.random.default_rng(seed)
    places, looks = landmarks(block, side)
    true, headings = square_path(side, laps)
    positions, yaws = drifted(true, headings, rng, meters, degrees)
    centroids, codes, frames = [], [], []
    for capture, (spot, heading) in enumerate(zip(true, headings, strict=True)):
        near = np.flatnonzero(np.linalg.norm(places - spot, axis=1) <= SEEN)
        local = rotated(places[near] - spot, np.full(len(near), -heading))
        local += 0.05 * rng.standard_normal(local.shape)
        centroids.append(positions[capture] + rotated(local, np.full(len(near), yaws[capture])))
        codes.append(40 * (looks[near] + 0.1 * rng.standard_normal((len(near), DIMENSION))))
        frames.append(np.full(len(near), capture))
    count = sum(map(len, codes))
    extra: dict[str, Any] = {}
    if odometry:
        extra = {
            "frame_tracks": np.full(len(true), 1 + seed, np.uint32),
            "frame_odometry": np.column_stack([positions, yaws, np.zeros((len(true), 3))]),
        }
    content = CompactMap(
        model_id=model_id,
        preprocessing="1",
        frame=f"{robot}'s odometry",
        codes=np.concatenate(codes).round().clip(-127, 127).astype(np.int8),
        centroids=np.concatenate(centroids),
        ids=np.arange(count, dtype=np.uint32),
        robots=(robot,),
        robot=np.zeros(count, np.uint16),
        frame_index=np.concatenate(frames).astype(np.uint32),
        frame_times=1e9 + 5.0 * np.arange(len(true), dtype=np.float64),
        frame_positions=positions,
        frame_orientations=Rotation.from_euler("z", yaws[:, None]).as_quat().astype(np.float32),
        **extra,
    )
    return canonical(content), true
