"""Settings of the agent."""

from dataclasses import dataclass
from pathlib import Path

from placecell.core.parameters import PROTOCOL_V1, Parameters


@dataclass(frozen=True, slots=True)
class AgentSettings:
    """Settings of the agent of one robot. Lengths are in meters, times in seconds.

    Attributes:
        map: name of the map on the service.
        robot: name of the robot, stored with its segments.
        session: id of the odometry frame. A restarted agent continues the session of its state
            folder if this id is the same; odometry that restarts needs a new id.
        state: folder for the spool, the last pose and the pulled map; None keeps nothing, and what
            was not sent is lost with the process.
        localize: localize in a map.
        upload: send the robot's segments to the service.
        localize_map: map to localize in; None: `map`.
        keyframe_meters: distance between two keyframes, at which segments are extracted.
        localize_meters: distance between two requests while tracking; until then each keyframe
            makes one.
        spool_bytes: largest size of the spool.
        pull_seconds: time between two updates of the pulled map, on the scans' clock.
        parameters: parameters of the segmentation.
    """

    map: str
    robot: str = "robot"
    session: str = "session"
    state: Path | None = None
    localize: bool = True
    upload: bool = True
    localize_map: str | None = None
    keyframe_meters: float = 2.0
    localize_meters: float = 4.0
    spool_bytes: int = 1 << 30
    pull_seconds: float = 60.0
    parameters: Parameters = PROTOCOL_V1

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            ValueError: a name is empty, or a number is not positive.
        """
        for name in ("map", "robot", "session"):
            if not getattr(self, name):
                raise ValueError(f"Invalid {name} '': expected a name.")
        for name in ("keyframe_meters", "localize_meters", "spool_bytes", "pull_seconds"):
            value = getattr(self, name)
            if not value > 0:
                raise ValueError(f"Invalid {name} {value}: expected a positive number.")

    @property
    def searched_map(self) -> str:
        """Name of the map to localize in."""
        return self.localize_map or self.map
