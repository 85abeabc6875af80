"""A trajectory: poses over time."""

from dataclasses import dataclass, replace

from placecell.core.types import Float64
from placecell.trajectories.covariance import mounted


@dataclass(frozen=True, slots=True)
class Trajectory:
    """Poses over time.

    Attributes:
        poses: transforms from `frame` to the world, float64 (poses, 4, 4), meters.
        stamps: time of each pose, float64 (poses,), seconds, ascending; None if the file has no
            times, so that its poses belong to the scans in their order.
        frame: name of the frame whose poses these are, such as "base_link"; "" if not stated.
        world: name of the frame that the poses lead to, such as "odom"; "" if not stated.
        remarks: how the file was read where it leaves a choice, for the user.
        covariances: covariance of each pose, of x, y, z and the rotations about the axes of the
            world, float64 (poses, 6, 6); None if they are not known.
    """

    poses: Float64
    stamps: Float64 | None = None
    frame: str = ""
    world: str = ""
    remarks: tuple[str, ...] = ()
    covariances: Float64 | None = None

    def __len__(self) -> int:
        return len(self.poses)

    def mounted(self, mount: Float64) -> "Trajectory":
        """Return the trajectory of a sensor.

        Args:
            mount: pose of the sensor in `frame`, float64 (4, 4).
        """
        covariances = self.covariances
        if covariances is not None:
            covariances = mounted(covariances, self.poses, mount)
        return replace(self, poses=self.poses @ mount, covariances=covariances)
