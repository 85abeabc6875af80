"""What the peers' own systems do after them: generalised ICP, the package `small-gicp`."""

from collections.abc import Sequence

import numpy as np
import small_gicp

from benchmarks.peers.exchange import Cloud, Estimate, MapFrame, nearest_frame

GATES = (5.0, 1.0)
"""Greatest distances of corresponding points, metres: first from far off, then close by."""

VOXEL = 0.3
"""Metres, as the clouds are thinned out for it."""


def refine(estimate: Estimate, cloud: Cloud, frames: Sequence[MapFrame]) -> Estimate:
    """The estimate, its pose refined against the frame of the map that lies nearest to it."""
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
