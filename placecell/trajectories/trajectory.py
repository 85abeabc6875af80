"""A trajectory: poses over time."""

from dataclasses import dataclass

from placecell.core.types import Float64


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
    """

    poses: Float64
    stamps: Float64 | None = None
    frame: str = ""
    world: str = ""
    remarks: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.poses)
