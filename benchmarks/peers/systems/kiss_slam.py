"""Loop closures of KISS-SLAM as a peer, with the package `kiss-slam`.

Guadagnino et al. 2025, *KISS-SLAM: A Simple, Robust, and Accurate 3D LiDAR SLAM System With
Enhanced Generalization Capabilities*. MapClosures proposes a closure between local maps of 100 m of
travel. Point-to-plane ICP refines it, and it is accepted if the voxels of both local maps overlap
enough.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from kiss_slam.config import LoopCloserConfig
from kiss_slam.loop_closer import LoopCloser
from kiss_slam.voxel_map import VoxelMap

from benchmarks.peers.exchange import NOTHING, Cloud, Estimate, MapFrame
from benchmarks.peers.systems.map_closures import (
    MapClosuresParameters,
    MapClosuresPeer,
    config_of,
)


@dataclass(frozen=True, slots=True)
class KissSlamParameters:
    """Parameters of KISS-SLAM's loop closures; the defaults are those of the package."""

    clouds: str = "long"
    """Kind of the local maps (`splitting_distance` 100 m)."""
    overlap_threshold: float = 0.4
    """Overlap that an accepted closure must exceed, as a share of the smaller local map."""
    density_map_resolution: float = 0.5
    """Size of a pixel of MapClosures and of a voxel of the local maps, meters. The package has 0.5
    for both (`local_mapper.voxel_size`)."""
    level: bool = False
    """Assume level local maps, as ours are, instead of the plane fit to the ground."""


class KissSlamPeer:
    """Pose by a closure that ICP refined and the overlap confirmed."""

    def __init__(self, parameters: KissSlamParameters) -> None:
        self.parameters = parameters
        detector = MapClosuresParameters(
            density_map_resolution=parameters.density_map_resolution, level=parameters.level
        )
        self.detector = MapClosuresPeer(detector)
        self.closer = LoopCloser(
            LoopCloserConfig(
                detector=config_of(detector), overlap_threshold=parameters.overlap_threshold
            )
        )

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""
        self.detector.learn(frames)
        self.clouds = {
            number: self.with_normals(frame.cloud)
            for number, frame in zip(self.detector.poses, frames, strict=True)
        }

    def with_normals(self, cloud: Cloud) -> Any:
        """Return a local map as KISS-SLAM stores it: a point and a normal per voxel."""
        voxels = VoxelMap(self.parameters.density_map_resolution)
        voxels.integrate_frame(np.asarray(cloud), np.eye(4))
        return voxels.open3d_pcd_with_normals()

    def locate(self, cloud: Cloud) -> Estimate:
        """Return the pose of a local map in the map."""
        best = self.detector.best_closure(cloud)
        if best is None:
            return NOTHING
        inliers = best.number_of_inliers
        found = Estimate(self.detector.pose_of(best), float(inliers), sure=False)
        if inliers < self.detector.parameters.inliers_threshold:
            return found
        accepted, transform = self.closer.validate_closure(
            self.clouds[best.source_id], self.with_normals(cloud), best.pose
        )
        pose = self.detector.poses[best.source_id] @ np.linalg.inv(transform)
        return replace(found, pose=pose, sure=bool(accepted))
