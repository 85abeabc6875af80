"""Registration of two clouds by ICP, as peers' own systems do it, with the package `small-gicp`."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from benchmarks.peers.exchange import Cloud, Estimate, MapFrame, Pose, nearest_frame

GATES = (5.0, 1.0)
"""Largest distances of corresponding points, meters: a coarse and a fine step."""

VOXEL = 0.3
"""Voxel size of the downsampled clouds, meters."""


@dataclass(frozen=True, slots=True)
class Registered:
    """Result of a registration.

    Attributes:
        transform: transform (4, 4) from the source's frame to the target's.
        overlap: share of the source's points with a corresponding point.
        converged: whether the optimization converged.
    """

    transform: Pose
    overlap: float
    converged: bool


def register(
    source: Cloud,
    target: Cloud,
    guess: Pose,
    *,
    method: str,
    voxel: float,
    gate: float,
    iterations: int,
) -> Registered:
    """Register two clouds from an initial guess.

    Args:
        source: float32 (n, 3), points to move, meters.
        target: float32 (n, 3), points that stay, meters.
        guess: initial transform (4, 4).
        method: ICP, PLANE_ICP, GICP or VGICP.
        voxel: voxel size of the downsampled clouds, meters.
        gate: largest distance of corresponding points, meters.
        iterations: largest number of iterations.
    """
    # Scan Context without registration runs in environments that lack the package.
    import small_gicp

    thinned = small_gicp.voxelgrid_sampling(source.astype(np.float64), voxel)
    result = small_gicp.align(
        target.astype(np.float64),
        source.astype(np.float64),
        guess,
        registration_type=method,
        voxel_resolution=voxel,
        downsampling_resolution=voxel,
        max_correspondence_distance=gate,
        max_iterations=iterations,
    )
    share = result.num_inliers / max(thinned.size(), 1)
    return Registered(np.asarray(result.T_target_source), share, bool(result.converged))


def refine(estimate: Estimate, cloud: Cloud, frames: Sequence[MapFrame]) -> Estimate:
    """Refine the pose of an estimate against the nearest local map of the map."""
    if estimate.pose is None:
        return estimate
    frame = nearest_frame(frames, estimate.pose)
    transform = np.linalg.inv(frame.pose) @ estimate.pose
    for gate in GATES:
        transform = register(
            cloud, frame.cloud, transform, method="GICP", voxel=VOXEL, gate=gate, iterations=50
        ).transform
    return replace(estimate, pose=frame.pose @ transform)
