"""Last pose: where the robot was in the map, in a file, as a first guess after a restart."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np

from placecell.core.types import Float64

FILE = "last_pose.json"
"""Name of the file in the state folder."""


@dataclass(frozen=True, slots=True, eq=False)
class LastPose:
    """Pose of a robot in a map when it was last known.

    Attributes:
        map: name of the map.
        session: session of the agent: the odometry frame.
        part: number of jumps of the odometry frame.
        pose: pose of the sensor in the map, float64 (4, 4).
        odom_pose: its pose in the odometry frame, float64 (4, 4).
        covariance: covariance of the pose in the map, float64 (6, 6).
        time: time of the scan, seconds.
    """

    map: str
    session: str
    part: int
    pose: Float64
    odom_pose: Float64
    covariance: Float64
    time: float

    @classmethod
    def load(cls, folder: Path) -> Self | None:
        """Return the last pose of a state folder; None if there is none, or it is damaged."""
        try:
            content = json.loads((folder / FILE).read_text(encoding="utf-8"))
            pose, odom_pose, covariance = (
                np.array(content[name], dtype=np.float64)
                for name in ("pose", "odom_pose", "covariance")
            )
            if pose.shape != (4, 4) or odom_pose.shape != (4, 4) or covariance.shape != (6, 6):
                return None
            if not all(np.isfinite(each).all() for each in (pose, odom_pose, covariance)):
                return None
            return cls(
                str(content["map"]),
                str(content["session"]),
                int(content["part"]),
                pose,
                odom_pose,
                covariance,
                float(content["time"]),
            )
        except (OSError, ValueError, KeyError, TypeError):
            return None

    def save(self, folder: Path) -> bool:
        """Write the pose as a whole or not at all; return whether it could be written."""
        content = {
            "map": self.map,
            "session": self.session,
            "part": self.part,
            "pose": self.pose.tolist(),
            "odom_pose": self.odom_pose.tolist(),
            "covariance": self.covariance.tolist(),
            "time": self.time,
        }
        unfinished = folder / f"{FILE}.unfinished"
        try:
            unfinished.write_text(json.dumps(content), encoding="utf-8")
            unfinished.replace(folder / FILE)
        except OSError:
            return False
        return True
