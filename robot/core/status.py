"""State of the agent, as outputs and other programs see it."""

from dataclasses import dataclass, field
from enum import StrEnum
from typing import Literal

from placecell.core.types import Float64

FixSource = Literal["service", "local", "operator"]
"""Origin of a fix: the service, the pulled map in this process, or a pose that a person gave."""


class AgentState(StrEnum):
    """State of localization; `docs/explanation/robot-agent.md` draws the transitions."""

    STARTING = "starting"
    """No scan has been processed."""
    LOCALIZING = "localizing"
    """The pose in the map is not known yet."""
    TRACKING = "tracking"
    """The pose is known: fixes confirm the odometry."""
    OUTSIDE = "outside"
    """The robot has left the mapped area; the pose is that of the odometry since the last fix."""
    LOST = "lost"
    """Fixes are missing inside the mapped area, or contradict the odometry."""
    KIDNAPPED = "kidnapped"
    """The scans show another place than the odometry: the robot was carried away."""
    MAPPING = "mapping"
    """The robot does not localize: its odometry frame is the frame of the map that it makes."""


class LinkState(StrEnum):
    """State of the link to the service."""

    UNKNOWN = "unknown"
    ONLINE = "online"
    OFFLINE = "offline"


@dataclass(frozen=True, slots=True, eq=False)
class Fix:
    """Pose in the map from one localization.

    Attributes:
        time: time of the scan, seconds.
        map: name of the map.
        pose: pose of the sensor in the map, float64 (4, 4).
        covariance: covariance of x, y, z and the rotations about the map's axes, float64 (6, 6).
        probability: probability that the pose is right.
        source: origin of the fix.
        meters: distance driven until the scan.
        accepted: whether the agent uses the fix.
        reason: why it is not used; empty if it is.
    """

    time: float
    map: str
    pose: Float64
    covariance: Float64
    probability: float
    source: FixSource
    meters: float
    accepted: bool
    reason: str = ""


@dataclass(frozen=True, slots=True)
class SpoolStatus:
    """Content of the spool.

    Attributes:
        entries: edits that are not sent yet.
        bytes: their size on disk.
        dropped_segments: segments that were not stored, because the spool or the disk was full.
    """

    entries: int = 0
    bytes: int = 0
    dropped_segments: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class AgentStatus:
    """State of the agent at a scan.

    Attributes:
        time: time of the last scan, seconds.
        state: state of localization.
        reason: why it is so, in words.
        link: state of the link.
        map: map to localize in.
        upload_map: map that receives the robot's segments; empty until the first upload.
        scans: number of scans.
        scans_dropped: number of scans that came too late and were not processed.
        meters: distance driven.
        fixes: number of accepted fixes.
        last_fix: last accepted fix.
        spool: content of the spool.
    """

    time: float = 0.0
    state: AgentState = AgentState.STARTING
    reason: str = ""
    link: LinkState = LinkState.UNKNOWN
    map: str = ""
    upload_map: str = ""
    scans: int = 0
    scans_dropped: int = 0
    meters: float = 0.0
    fixes: int = 0
    last_fix: Fix | None = None
    spool: SpoolStatus = field(default_factory=SpoolStatus)

    @property
    def is_sure(self) -> bool:
        """Whether the pose in the map can be relied on."""
        return self.state in (AgentState.TRACKING, AgentState.MAPPING)


@dataclass(frozen=True, slots=True)
class Summary:
    """Summary of a run.

    Attributes:
        meters: distance driven.
        scans: scans that were processed.
        scans_dropped: scans that came too late and were not processed.
        keyframes: scans at which segments were extracted.
        segments: segments that were given to the spool.
        fixes: accepted fixes.
        fixes_refused: fixes that the agent did not use.
        meters_until_first_fix: distance until the pose was known; None if it never was.
        kidnaps: number of times the robot was carried away.
        uploads: edits that the service stored.
        spool: content of the spool at the end.
        upload_maps: maps that received the robot's segments.
        state: state at the end.
        link: state of the link at the end.
    """

    meters: float
    scans: int
    scans_dropped: int
    keyframes: int
    segments: int
    fixes: int
    fixes_refused: int
    meters_until_first_fix: float | None
    kidnaps: int
    uploads: int
    spool: SpoolStatus
    upload_maps: tuple[str, ...]
    state: AgentState
    link: LinkState
