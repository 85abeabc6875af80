"""Settings of the node."""

from dataclasses import dataclass

from placecell.core.types import Float64


@dataclass(frozen=True, slots=True, eq=False)
class NodeSettings:
    """Settings of the node. Times are in seconds.

    Attributes:
        map_frame: name of the map's frame in what is published.
        mount: pose of the sensor in the frame of the odometry, float64 (4, 4); None: from the
            transforms.
        deskew: move the points of a sweep to the scan's time by the odometry, if they have times.
        queue: scans that may wait for the odometry; the oldest is dropped for a new one.
        odometry_wait: longest wait for the odometry of a scan; then the scan is dropped.
        publish_transform: publish `map -> odom`.
        transform_hz: largest rate of `map -> odom`.
        transform_tolerance: time that `map -> odom` is dated ahead, so that it holds until the
            next one.
        diagnostics_seconds: time between two diagnostics.
        silence_seconds: time without messages after which the diagnostics report the topic.
    """

    map_frame: str = "map"
    mount: Float64 | None = None
    deskew: bool = True
    queue: int = 2
    odometry_wait: float = 0.3
    publish_transform: bool = True
    transform_hz: float = 20.0
    transform_tolerance: float = 0.2
    diagnostics_seconds: float = 1.0
    silence_seconds: float = 3.0

    def __post_init__(self) -> None:
        """Check the values.

        Raises:
            ValueError: a name is empty, or a number is out of its range.
        """
        if not self.map_frame:
            raise ValueError("Invalid map_frame '': expected the name of a frame.")
        if self.queue < 1:
            raise ValueError(f"Invalid queue {self.queue}: expected 1 or more.")
        for name in ("transform_hz", "diagnostics_seconds", "silence_seconds"):
            if not getattr(self, name) > 0:
                raise ValueError(
                    f"Invalid {name} {getattr(self, name)}: expected a positive number."
                )
        for name in ("odometry_wait", "transform_tolerance"):
            if not getattr(self, name) >= 0:
                raise ValueError(f"Invalid {name} {getattr(self, name)}: expected 0 or more.")
