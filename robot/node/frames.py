"""Static transforms between the robot's base and its sensor."""

import numpy as np

from placecell.core.types import Float64
from robot.node.messages import StampedTransform


class StaticFrames:
    """Tree of coordinate frames that do not move against each other."""

    def __init__(self) -> None:
        self._parents: dict[str, tuple[str, Float64]] = {}

    def add(self, transform: StampedTransform) -> None:
        """Add or replace a frame's pose in its parent."""
        self._parents[transform.child] = transform.parent, transform.pose

    def pose(self, frame: str, base: str) -> Float64 | None:
        """Return the pose of a frame in another one, float64 (4, 4); None if it is not known."""
        if frame == base:
            return np.eye(4)
        of_frame, of_base = self._chain(frame), self._chain(base)
        for ancestor, pose in of_frame.items():
            if ancestor in of_base:
                return np.asarray(np.linalg.inv(of_base[ancestor]) @ pose)
        return None

    def _chain(self, frame: str) -> dict[str, Float64]:
        """Return the pose of a frame in each frame above it, nearest first."""
        chain = {frame: np.eye(4)}
        pose: Float64 = np.eye(4)
        while frame in self._parents:
            parent, above = self._parents[frame]
            if parent in chain:  # a loop of frames
                break
            pose = np.asarray(above @ pose)
            frame = parent
            chain[frame] = pose
        return chain
