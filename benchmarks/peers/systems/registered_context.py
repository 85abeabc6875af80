"""Scan Context with its registration step, as in the authors' SC-A-LOAM.

Scan Context proposes the most similar local map of the map and the heading in it. ICP registers the
query with the part of the map around this local map. The pose is accepted if the contexts are near
enough and ICP ends with a small mean squared distance of the points. SC-A-LOAM starts ICP without
the heading; this peer starts with it, because its queries have any heading.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from benchmarks.peers.exchange import NOTHING, Cloud, Estimate, MapFrame, Pose
from benchmarks.peers.systems.registration import register
from benchmarks.peers.systems.scan_context import ScanContextParameters, ScanContexts, about_z

VOXEL = 0.4
"""Voxel size of the clouds of ICP, meters (`filter_size` of SC-A-LOAM)."""

AROUND = 50.0
"""Distance from the proposed local map up to which ICP's target reaches, meters: 25 keyframes at
2 m (`historyKeyframeSearchNum`, `keyframe_meter_gap`)."""

ITERATIONS = 100
"""Largest number of iterations of each step of ICP, as in SC-A-LOAM."""


@dataclass(frozen=True, slots=True)
class RegisteredContextParameters:
    """Parameters of Scan Context with registration. Lengths are in meters."""

    clouds: str = "submap"
    """Kind of the local maps."""
    radius: float = 80.0
    """Radius of the context."""
    method: str = "ICP"
    """Kind of ICP of the package `small-gicp`."""
    gates: Sequence[float] = (150.0,)
    """Largest distance of corresponding points, of each step of ICP; none: no registration."""
    sure_below: float = 0.2
    """Largest distance of two contexts of a loop (`sc_dist_thres`)."""
    largest_error: float = 0.3
    """Largest mean squared distance after ICP (`loopFitnessScoreThreshold`), square meters."""


class RegisteredContextPeer:
    """Pose by ICP with the most similar local map of the map."""

    def __init__(self, parameters: RegisteredContextParameters) -> None:
        self.parameters = parameters

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""
        self.frames = frames
        self.thinned = [thin(frame.cloud) for frame in frames]
        self.targets: dict[int, Cloud] = {}
        parameters = ScanContextParameters(radius=self.parameters.radius)
        self.contexts = ScanContexts([frame.cloud for frame in frames], parameters)

    def locate(self, cloud: Cloud) -> Estimate:
        """Return the pose of a local map in the map."""
        if not len(cloud):
            return NOTHING
        best = self.contexts.find(cloud)[0]
        frame, target = self.frames[best.frame], self.around(best.frame)
        transform = about_z(best.yaw)
        for gate in self.parameters.gates:
            transform = register(
                cloud,
                target,
                transform,
                method=self.parameters.method,
                voxel=VOXEL,
                gate=gate,
                iterations=ITERATIONS,
            ).transform
        error = mean_squared_distance(cloud, target, transform)
        near = best.distance < self.parameters.sure_below
        sure = near and error <= self.parameters.largest_error
        evidence = {"distance": best.distance, "error": error}
        return Estimate(frame.pose @ transform, -error, sure, evidence)

    def around(self, index: int) -> Cloud:
        """Return the part of the map around a local map, in the frame of the local map."""
        if index not in self.targets:
            to_frame = np.linalg.inv(self.frames[index].pose)
            moved = [to_frame @ frame.pose for frame in self.frames]
            near = [
                cloud @ pose[:3, :3].T + pose[:3, 3]
                for cloud, pose in zip(self.thinned, moved, strict=True)
                if np.linalg.norm(pose[:3, 3]) <= AROUND
            ]
            self.targets[index] = thin(np.concatenate(near).astype(np.float32))
        return self.targets[index]


def mean_squared_distance(source: Cloud, target: Cloud, transform: Pose) -> float:
    """Return the mean squared distance of a moved cloud's points to a target's nearest points.

    Args:
        source: float32 (n, 3), points to move, meters.
        target: float32 (n, 3), points that stay, meters.
        transform: transform (4, 4) of the source.
    """
    moved = thin(source) @ transform[:3, :3].T + transform[:3, 3]
    apart, _ = cKDTree(thin(target)).query(moved)
    return float(np.mean(apart**2))


def thin(cloud: Cloud) -> Cloud:
    """Return one point of each occupied voxel."""
    if not len(cloud):
        return cloud
    cells = np.floor(cloud / VOXEL).astype(np.int64)
    cells -= cells.min(axis=0)
    size = cells.max(axis=0) + 1
    _, first = np.unique(
        (cells[:, 0] * size[1] + cells[:, 1]) * size[2] + cells[:, 2], return_index=True
    )
    return np.asarray(cloud[first])
