"""Pose refinement by generalized ICP (package `small-gicp`), as peers' own systems do it."""

from collections.abc import Sequence

import numpy as np
import small_gicp

from benchmarks.peers.exchange import Cloud, Estimate, MapFrame, nearest_frame

GATES = (5.0, 1.0)
"""Largest distances of corresponding points, meters: a coarse and a fine step."""

VOXEL = 0.3
"""Voxel size of the downsampled clouds, meters."""


def refine(estimate: Estimate, cloud: Cloud, frames: Sequence[MapFrame]) -> Estimate:
    """Refine the pose of an estimate against the nearest local map of the map."""
    if estimate.pose is None:
        return estimate
    frame = nearest_frame(frames, estimate.pose)
    source, target = cloud.astype(np.float64), frame.cloud.astype(np.float64)
    transform = np.linalg.inv(frame.pose) @ estimate.pose
    for gate in GATES:
        result = small_gicp.align(
            target,
            source,
            transform,
            registration_type="GICP",
            downsampling_resolution=VOXEL,
            max_correspondence_distance=gate,
            max_iterations=50,
        )
        transform = result.T_target_source
    return Estimate(frame.pose @ transform, estimate.score, estimate.sure)
