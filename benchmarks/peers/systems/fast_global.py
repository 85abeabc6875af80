"""Fast Global Registration of FPFH features as a peer, with the package `open3d`.

Zhou, Park and Koltun 2016, *Fast Global Registration*, on the features of Rusu et al. 2009, with
the steps and ratios of Open3D's tutorial and reconstruction system. It registers the query with the
local maps that Scan Context retrieves; the result with the largest overlap counts. Point-to-plane
ICP refines it. The rule for loops is that of Open3D's `register_fragments.py`: the overlap must be
at least 0.3 of the smaller cloud.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import open3d
from open3d.geometry import KDTreeSearchParamHybrid, PointCloud
from open3d.pipelines import registration

from benchmarks.peers.exchange import NOTHING, Cloud, Estimate, MapFrame, Pose
from benchmarks.peers.systems.scan_context import ScanContextParameters, ScanContexts

GATE = 1.5
"""Distance of corresponding points in voxels, of the refinement and the overlap."""


@dataclass(frozen=True, slots=True)
class FastGlobalParameters:
    """Parameters of the registration. Lengths are in meters."""

    clouds: str = "submap"
    """Kind of the local maps."""
    voxel_size: float = 0.5
    """Voxel size; normals have a radius of 2 voxels, features of 5, as in the tutorial."""
    gate: float = 0.5
    """Distance of corresponding features, in voxels, as in the tutorial."""
    candidates: int = 3
    """Number of retrieved local maps to try."""
    least_overlap: float = 0.3
    """Least overlap of an accepted loop, as a share of the smaller cloud."""


@dataclass(frozen=True, slots=True)
class Featured:
    """Downsampled cloud with its features."""

    cloud: PointCloud
    features: registration.Feature


class FastGlobalPeer:
    """Pose by registration with the local maps that Scan Context finds."""

    def __init__(self, parameters: FastGlobalParameters) -> None:
        self.parameters = parameters

    def learn(self, frames: Sequence[MapFrame]) -> None:
        """Take in the map."""
        self.frames = frames
        self.featured = [self.describe(frame.cloud) for frame in frames]
        self.contexts = ScanContexts([frame.cloud for frame in frames], ScanContextParameters())

    def describe(self, cloud: Cloud) -> Featured:
        """Return the downsampled cloud with its features."""
        voxel = self.parameters.voxel_size
        points = open3d.utility.Vector3dVector(np.asarray(cloud, dtype=np.float64))
        thinned = PointCloud(points).voxel_down_sample(voxel)
        thinned.estimate_normals(KDTreeSearchParamHybrid(radius=2 * voxel, max_nn=30))
        near = KDTreeSearchParamHybrid(radius=5 * voxel, max_nn=100)
        return Featured(thinned, registration.compute_fpfh_feature(thinned, near))

    def locate(self, cloud: Cloud) -> Estimate:
        """Return the pose of a local map in the map."""
        if not len(cloud):
            return NOTHING
        query = self.describe(cloud)
        tried = self.contexts.find(cloud)[: self.parameters.candidates]
        found = [(*self.register(query, self.featured[one.frame]), one.frame) for one in tried]
        overlap, transform, frame = max(found, key=lambda each: each[0])
        sure = overlap >= self.parameters.least_overlap
        pose = self.frames[frame].pose @ transform
        return Estimate(pose, overlap, sure, {"overlap": overlap})

    def register(self, query: Featured, frame: Featured) -> tuple[float, Pose]:
        """Return the overlap and the transform of a query to a local map of the map."""
        voxel = self.parameters.voxel_size
        coarse = registration.registration_fgr_based_on_feature_matching(
            query.cloud,
            frame.cloud,
            query.features,
            frame.features,
            registration.FastGlobalRegistrationOption(
                maximum_correspondence_distance=self.parameters.gate * voxel
            ),
        )
        fine = registration.registration_icp(
            query.cloud,
            frame.cloud,
            GATE * voxel,
            coarse.transformation,
            registration.TransformationEstimationPointToPlane(),
        )
        information = registration.get_information_matrix_from_point_clouds(
            query.cloud, frame.cloud, GATE * voxel, fine.transformation
        )
        smaller = min(len(query.cloud.points), len(frame.cloud.points))
        return float(information[5, 5] / smaller), np.asarray(fine.transformation)
