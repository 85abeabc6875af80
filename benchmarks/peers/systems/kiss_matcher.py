"""KISS-Matcher as a peer, with the package `kiss-matcher`.

Lim et al. 2025, *KISS-Matcher: Fast and Robust Point Cloud Registration Revisited*. KISS-Matcher
registers two clouds; it does not retrieve. It therefore registers the query with the local maps
that Scan Context retrieves, and the result with most inliers counts. The steps after that, and the
acceptance rule, are those of the authors' program for loops, KISS-Matcher-SAM: submaps of eleven
keyframes, a least number of final inliers, then GICP and a least share of overlapping points.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import kiss_matcher
import numpy as np

from benchmarks.peers.exchange import NOTHING, Cloud, Estimate, MapFrame, Pose
from benchmarks.peers.systems.registration import register
from benchmarks.peers.systems.scan_context import ScanContextParameters, ScanContexts

GATE = 5.0
"""Largest distance of corresponding points in voxels (`scale_factor_for_corr_dist`)."""

ITERATIONS = 32
"""Largest number of iterations of GICP (`max_num_iter`)."""


@dataclass(frozen=True, slots=True)
class KissMatcherParameters:
    """Parameters of KISS-Matcher; the defaults are those of KISS-Matcher-SAM."""

    clouds: str = "submap"
    """Kind of the local maps."""
    voxel_size: float = 0.3
    """Voxel size, meters; features have radii of 3 and 5 voxels."""
    use_quatro: bool = True
    """Solve for yaw only (Quatro): gravity is known, as it is for our localization."""
    candidates: int = 3
    """Number of retrieved local maps to try."""
    least_inliers: int = 100
    """Least number of final inliers (`num_inliers_threshold`)."""
    least_overlap: float = 0.65
    """Least share of overlapping points after GICP (`overlap_threshold`)."""


class KissMatcherPeer:
    """Pose by registration with the local maps that Scan Context finds."""

    def __init__(self, parameters: KissMatcherParameters) -> None:
        self.parameters = parameters
        self.matcher = kiss_matcher.KISSMatcher(
            kiss_matcher.KISSMatcherConfig(
                voxel_size=parameters.voxel_size, use_quatro=parameters.use_quatro
            )
        )

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""
        self.frames = frames
        self.contexts = ScanContexts([frame.cloud for frame in frames], ScanContextParameters())

    def locate(self, cloud: Cloud) -> Estimate:
        """Return the pose of a local map in the map."""
        if not len(cloud):
            return NOTHING
        tried = self.contexts.find(cloud)[: self.parameters.candidates]
        found = [(self.match(cloud, self.frames[each.frame]), each.frame) for each in tried]
        (inliers, transform), best = max(found, key=lambda each: each[0][0])
        if transform is None:
            return NOTHING
        return self.verify(cloud, self.frames[best], inliers, transform)

    def match(self, cloud: Cloud, frame: MapFrame) -> tuple[int, Pose | None]:
        """Return the final inliers and the transform of a local map to one of the map."""
        solution = self.matcher.estimate(np.asarray(cloud), np.asarray(frame.cloud))
        if not solution.valid:
            return 0, None
        return int(self.matcher.get_num_final_inliers()), transform_of(solution)

    def verify(self, cloud: Cloud, frame: MapFrame, inliers: int, transform: Pose) -> Estimate:
        """Refine a transform by GICP, and apply the authors' rule for loops."""
        voxel = self.parameters.voxel_size
        refined = register(
            cloud,
            frame.cloud,
            transform,
            method="GICP",
            voxel=voxel,
            gate=GATE * voxel,
            iterations=ITERATIONS,
        )
        sure = (
            inliers >= self.parameters.least_inliers
            and refined.overlap > self.parameters.least_overlap
        )
        evidence = {"inliers": float(inliers), "overlap": refined.overlap}
        return Estimate(frame.pose @ refined.transform, float(inliers), sure, evidence)


def transform_of(solution: kiss_matcher.RegistrationSolution) -> Pose:
    """Return a solution as a transform (4, 4)."""
    transform = np.eye(4)
    transform[:3, :3] = solution.rotation
    transform[:3, 3] = np.ravel(solution.translation)
    return transform
