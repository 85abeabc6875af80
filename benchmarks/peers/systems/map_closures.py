"""MapClosures as a peer, with the package `map-closures`.

Gupta et al. 2024, *Effectively Detecting Loop Closures using Point Cloud Density Maps*. MapClosures
draws the density of a local map from above and detects ORB features. It searches them in a binary
search tree of all features of the map, and aligns the images by RANSAC. It finds gravity by a plane
fit to the ground. Its RANSAC has a random seed, so answers differ slightly between runs.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from map_closures.config import MapClosuresConfig
from map_closures.map_closures import ClosureCandidate, MapClosures
from map_closures.voxel_map import VoxelMap
from numpy.typing import NDArray

from benchmarks.peers.exchange import NOTHING, Cloud, Estimate, MapFrame, Pose

APART = 4
"""Step between the numbers of local maps. The package ignores maps whose numbers differ by three or
less as too recent."""

NO_NORMALS = np.zeros((0, 3))


@dataclass(frozen=True, slots=True)
class MapClosuresParameters:
    """Parameters of MapClosures; the defaults are those of the package."""

    clouds: str = "long"
    """Kind of the local maps; the paper's reach 100 m and cover 100 m of travel."""
    range_m: float = 100.0
    """Range of the local maps, meters."""
    density_map_resolution: float = 0.5
    """Size of a pixel, meters. ORB needs 31 pixels on each side of a feature."""
    density_threshold: float = 0.05
    hamming_distance_threshold: int = 50
    level: bool = False
    """Assume level local maps, as ours are, instead of the plane fit to the ground."""
    inliers_threshold: int = 5
    """Number of inliers that an accepted closure must exceed."""


class MapClosuresPeer:
    """Pose by the best closure with a local map of the map."""

    def __init__(self, parameters: MapClosuresParameters) -> None:
        self.parameters = parameters
        self.closures = MapClosures(config_of(parameters))

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""
        self.poses = {APART * index: frame.pose for index, frame in enumerate(frames)}
        for number, frame in zip(self.poses, frames, strict=True):
            self.closures.get_best_closure(number, *self.seen(frame.cloud))
        self.asked = APART * len(frames)

    def locate(self, cloud: Cloud) -> Estimate:
        """Return the pose of a local map in the map."""
        best = self.best_closure(cloud)
        if best is None:
            return NOTHING
        inliers = best.number_of_inliers
        sure = inliers > self.parameters.inliers_threshold
        return Estimate(self.pose_of(best), float(inliers), sure, {"inliers": float(inliers)})

    def best_closure(self, cloud: Cloud) -> ClosureCandidate | None:
        """Return the closure with most inliers with a local map of the map.

        The package adds each query to its maps; closures with queries are left out.
        """
        self.asked += APART
        found = [
            closure
            for closure in self.closures.get_closures(self.asked, *self.seen(cloud))
            if closure.source_id in self.poses
        ]
        return max(found, key=lambda closure: closure.number_of_inliers, default=None)

    def pose_of(self, closure: ClosureCandidate) -> Pose:
        """Return the pose of the query.

        The pose of a closure is the transform from the older map (source) to the newer one.
        """
        return np.asarray(self.poses[closure.source_id] @ np.linalg.inv(closure.pose))

    def seen(self, cloud: Cloud) -> tuple[NDArray[np.float64], ...]:
        """Return the package's arguments for a local map: its points, and normals if it is level.

        The points go through the voxel map of the authors' pipeline. The normals are empty, so the
        package skips the plane fit.
        """
        voxels = VoxelMap(self.parameters.density_map_resolution, self.parameters.range_m)
        voxels.integrate_frame(np.asarray(cloud, dtype=np.float64), np.eye(4))
        points = np.asarray(voxels.point_cloud())
        return (points, NO_NORMALS, NO_NORMALS) if self.parameters.level else (points,)


def config_of(parameters: MapClosuresParameters) -> MapClosuresConfig:
    """Return the configuration of the package."""
    return MapClosuresConfig(
        density_map_resolution=parameters.density_map_resolution,
        density_threshold=parameters.density_threshold,
        hamming_distance_threshold=parameters.hamming_distance_threshold,
        inliers_threshold=parameters.inliers_threshold,
    )
