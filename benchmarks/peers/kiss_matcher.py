"""KISS-Matcher as a peer, with the package `kiss-matcher`.

Lim et al. 2025, *KISS-Matcher: Fast and Robust Point Cloud Registration Revisited*. KISS-Matcher
registers two clouds; it does not retrieve. It therefore registers the query with the local maps
that Scan Context retrieves, and the result with most inliers counts. Or it registers the query with
the whole map as one cloud. Its Python interface computes the features of both clouds per pair.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import kiss_matcher
import numpy as np

from benchmarks.peers.exchange import NOTHING, Cloud, Estimate, MapFrame, Pose
from benchmarks.peers.scan_context import ScanContexts


@dataclass(frozen=True, slots=True)
class KissMatcherParameters:
    """Parameters of KISS-Matcher; the defaults are those of the package and its example."""

    voxel_size: float = 0.3
    """Voxel size, meters; features have radii of 3 and 5 voxels."""
    use_quatro: bool = False
    """Solve for yaw only (Quatro), instead of any rotation."""
    candidates: int = 1
    """Number of retrieved local maps to try; 0: the whole map at once."""
    least_inliers: int = 5
    """Least number of final inliers of a success, as in the package's example."""


class KissMatcherPeer:
    """Pose by registration with the local maps that Scan Context finds, or with the whole map."""

    def __init__(self, parameters: KissMatcherParameters) -> None:
        self.parameters = parameters
        self.matcher = kiss_matcher.KISSMatcher(
            kiss_matcher.KISSMatcherConfig(
                voxel_size=parameters.voxel_size, use_quatro=parameters.use_quatro
            )
        )

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""
        self.frames = frames if self.parameters.candidates else [merged_frames(frames)]
        self.contexts = ScanContexts([frame.cloud for frame in self.frames])

    def locate(self, cloud: Cloud) -> Estimate:
        """Return the pose of a local map in the map."""
        tried = [0]
        if self.parameters.candidates:
            found = self.contexts.find(cloud)
            tried = [one.frame for one in found[: self.parameters.candidates]]
        registered = (self.register(cloud, self.frames[frame]) for frame in tried)
        return max(registered, key=lambda estimate: estimate.score)

    def register(self, cloud: Cloud, frame: MapFrame) -> Estimate:
        """Return the pose of a local map by registration with one cloud of the map."""
        solution = self.matcher.estimate(cloud, frame.cloud)
        if not solution.valid:
            return NOTHING
        inliers = int(self.matcher.get_num_final_inliers())
        pose = frame.pose @ transform_of(solution)
        return Estimate(pose, float(inliers), inliers >= self.parameters.least_inliers)


def transform_of(solution: kiss_matcher.RegistrationSolution) -> Pose:
    """Return a solution as a transform (4, 4)."""
    transform = np.eye(4)
    transform[:3, :3] = solution.rotation
    transform[:3, 3] = np.ravel(solution.translation)
    return transform


def merged_frames(frames: Sequence[MapFrame]) -> MapFrame:
    """Return all local maps of the map as one cloud, in the map's frame."""
    clouds = [frame.cloud @ frame.pose[:3, :3].T + frame.pose[:3, 3] for frame in frames]
    return MapFrame(np.eye(4), np.concatenate(clouds).astype(np.float32))
