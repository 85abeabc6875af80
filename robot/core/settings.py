"""Settings of the agent."""

import math
import re
import uuid
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from placecell_client.seen import MAP_NAME

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.core.segment_classes import ClassFilter
from placecell.core.types import Float64
from placecell.descriptors.shipped_models import DEFAULT_MODEL


@dataclass(frozen=True, slots=True)
class DriftRates:
    """Drift of the odometry that the covariance allows for.

    Attributes:
        position: error of the position for each meter driven.
        yaw: error of the heading for the square root of each meter driven, radians.
        tilt: standard deviation of roll and pitch, radians.
    """

    position: float = 0.02
    yaw: float = float(np.radians(0.1))
    tilt: float = float(np.radians(1.0))

    def grown(self, covariance: Float64, meters: float) -> Float64:
        """Return the covariance of the pose after a distance without a fix, float64 (6, 6).

        Args:
            covariance: covariance at the fix, (6, 6).
            meters: distance driven since.
        """
        yaw = self.yaw**2 * meters
        # An error of the heading moves the position sideways; the rest comes with the distance.
        sideways = covariance[5, 5] * meters**2 + yaw * meters**2 / 3
        grown = covariance.copy()
        grown[[0, 1], [0, 1]] += (self.position * meters) ** 2 + sideways
        grown[2, 2] += (self.position * meters) ** 2 + (self.tilt * min(meters, 20.0)) ** 2
        grown[5, 5] += yaw
        return grown


@dataclass(frozen=True, slots=True)
class AgentSettings:
    """Settings of the agent of one robot. Lengths are in meters, times in seconds.

    Attributes:
        map: name of the map on the service.
        robot: name of the robot, stored with its segments.
        session: id of the odometry frame; a new one unless given. A restarted agent continues the
            session of its state folder if this id is the same; odometry that restarts needs a new
            id. Two sessions never write one map, so their segments cannot take each other's ids.
        state: folder for the spool, the last pose and the pulled map; None keeps nothing, and what
            was not sent is lost with the process.
        maps_folder: folder of the pulled map; None: in the state folder.
        localize: localize in a map.
        upload: send the robot's segments to the service.
        localize_map: map to localize in; None: `map`.
        upload_map: map that receives the segments; None: `map`. If a map of that name is another's,
            the robot begins one with the next free name, such as `map-robot`.
        keep_moving: store and localize segments that move while they are seen, such as cars.
        ignore: classes of segments to leave out of localization, in the map and in the requests;
            `movable` names vehicles and persons.
        unmapped: classes of segments that are not stored.
        keyframe_meters: distance between two keyframes, at which segments are extracted.
        localize_meters: distance between two requests while tracking; until then each keyframe
            makes one.
        spool_bytes: largest size of the spool.
        pull_seconds: time between two updates of the pulled map, on the scans' clock.
        model: name of a shipped model, or folder of a model; the map must have the same.
        drift: drift of the odometry that the covariance allows for.
        parameters: parameters of the segmentation.
    """

    map: str
    robot: str = "robot"
    session: str = field(default_factory=lambda: uuid.uuid4().hex[:16])
    state: Path | None = None
    maps_folder: Path | None = None
    localize: bool = True
    upload: bool = True
    localize_map: str | None = None
    upload_map: str | None = None
    keep_moving: bool = False
    ignore: tuple[str, ...] = ()
    unmapped: tuple[str, ...] = ()
    keyframe_meters: float = 2.0
    localize_meters: float = 4.0
    spool_bytes: int = 1 << 30
    pull_seconds: float = 60.0
    model: str = DEFAULT_MODEL
    drift: DriftRates = DriftRates()
    parameters: Parameters = PROTOCOL_V1

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            ValueError: a name is empty, no map's name or no class, or a number is not positive and
                finite.
        """
        for classes in (self.ignore, self.unmapped):
            ClassFilter.of(None, classes)
        for name in ("map", "robot", "session"):
            if not getattr(self, name):
                raise ValueError(f"Invalid {name} '': expected a name.")
        for name in ("map", "localize_map", "upload_map"):
            found = getattr(self, name)
            # The service would refuse each edit, and the robot would lose it.
            if found is not None and not re.fullmatch(MAP_NAME, found):
                raise ValueError(
                    f"Invalid {name} {found!r:.80}: expected 1 to 64 letters, digits, dots, dashes "
                    "or underscores, beginning with a letter or digit."
                )
        for name in ("keyframe_meters", "localize_meters", "spool_bytes", "pull_seconds"):
            value = getattr(self, name)
            if not 0 < value < math.inf:
                raise ValueError(f"Invalid {name} {value}: expected a positive number.")

    @property
    def searched_map(self) -> str:
        """Name of the map to localize in."""
        return self.localize_map or self.map

    @property
    def written_map(self) -> str:
        """Wanted name of the map that receives the segments."""
        return self.upload_map or self.map
