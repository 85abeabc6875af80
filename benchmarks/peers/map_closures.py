"""MapClosures as a peer, the package `map-closures`.

Gupta et al. 2024, *Effectively Detecting Loop Closures using Point Cloud Density Maps*. It draws a
local map's density from above, finds ORB features in it, looks them up in a binary search tree over
all of the map's features, and aligns the images by RANSAC. Gravity is found by fitting a plane to
the ground. Its RANSAC takes its seed from the machine: answers differ a little from run to run.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from map_closures.config import MapClosuresConfig
from map_closures.map_closures import MapClosures
from numpy.typing import NDArray

from benchmarks.peers.exchange import NOTHING, Cloud, Estimate, MapFrame

APART = 4
"""It ignores maps whose numbers differ by three or less, as too recent; ours lie further apart."""

NO_NORMALS = np.zeros((0, 3))


@dataclass(frozen=True, slots=True)
class MapClosuresParameters:
    """Constants; the defaults are the package's own."""

    density_map_resolution: float = 0.5
    """Metres a pixel. ORB needs 31 pixels to each side, and local maps of 40 m have 160 in all."""
    density_threshold: float = 0.05
    hamming_distance_threshold: int = 50
    level: bool = False
    """Take local maps to be level, as ours are, where it would fit a plane to the ground. The fit
    wants ten points in a voxel as large as a pixel, and turns some maps of few scans over."""
    inliers_threshold: int = 5
    """Its own pipeline takes a closure for one if it has more inliers."""


class MapClosuresPeer:
    """A pose by the best closure with a frame of the map."""

    def __init__(self, parameters: MapClosuresParameters) -> None:
        self.parameters = parameters
        self.closures = MapClosures(
            MapClosuresConfig(
                density_map_resolution=parameters.density_map_resolution,
                density_threshold=parameters.density_threshold,
                hamming_distance_threshold=parameters.hamming_distance_threshold,
                inliers_threshold=parameters.inliers_threshold,
            )
        )

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""
        self.poses = {APART * index: frame.pose for index, frame in enumerate(frames)}
        for number, frame in zip(self.poses, frames, strict=True):
            self.closures.get_best_closure(number, *self.seen(frame.cloud))
        self.asked = APART * len(frames)

    def locate(self, cloud: Cloud) -> Estimate:
        """The pose of a local map in the map.

        The package keeps each query as a further map: closures with those are left out here.
        """
        self.asked += APART
        found = [
            closure
            for closure in self.closures.get_closures(self.asked, *self.seen(cloud))
            if closure.source_id in self.poses
        ]
        if not found:
            return NOTHING
        best = max(found, key=lambda closure: closure.number_of_inliers)
        # A closure's pose goes from the older map, the source, to the newer one.
        pose = self.poses[best.source_id] @ np.linalg.inv(best.pose)
        inliers = best.number_of_inliers
        return Estimate(pose, float(inliers), inliers > self.parameters.inliers_threshold)

    def seen(self, cloud: Cloud) -> tuple[NDArray[np.float64], ...]:
        """A local map as it takes it: its points, and the normals of the ground if not its own."""
        points = cloud.astype(np.float64)
        # Of no normals at all it fits no plane.
        return (points, NO_NORMALS, NO_NORMALS) if self.parameters.level else (points,)
