"""Registration of points by the ICP of KISS-ICP (Vizzo et al. 2023)."""

from placecell.core.errors import DriveError
from placecell.core.types import Float64

REACH = 1.0
"""Largest distance of corresponding points, meters."""

KERNEL = 0.2
"""Scale of the robust kernel (Geman-McClure), meters."""

CELL = 0.4
"""Edge length of the cells of the target in which neighbors are searched, meters."""


class Registration:
    """Point-to-point ICP with a robust kernel, in six degrees of freedom."""

    def __init__(self) -> None:
        """Load the package.

        Raises:
            DriveError: the package is not installed.
        """
        try:
            from kiss_icp import mapping, registration
        except ModuleNotFoundError as error:
            raise DriveError(
                f"{error.name} is not installed. Install it with 'pip install placecell[odometry]'"
            ) from error
        self._voxels = mapping.VoxelHashMap
        # One thread, so that sums do not differ from run to run.
        self._registration = registration.Registration(
            max_num_iterations=100, convergence_criterion=1e-5, max_num_threads=1
        )

    def align(self, source: Float64, target: Float64, guess: Float64) -> Float64:
        """Return the transform that lays the source on the target, float64 (4, 4).

        Args:
            source: float64 (n, 3), points, meters.
            target: float64 (m, 3), points, meters.
            guess: float64 (4, 4), transform to begin with.
        """
        voxels = self._voxels(voxel_size=CELL, max_distance=1e9, max_points_per_voxel=20)
        voxels.add_points(target)
        found: Float64 = self._registration.align_points_to_map(
            source, voxels, guess, max_correspondance_distance=REACH, kernel=KERNEL
        )
        return found
