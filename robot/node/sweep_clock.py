"""Clock of the points' times of a live topic, found from its first clouds."""

from placecell.sources.bags.pointcloud2 import PointCloud2, TimeField, cloud_clock
from placecell.sources.point_clock import PointClock

ENOUGH = 5
"""Clouds after which a topic without usable times is taken to have none."""


class SweepClock:
    """Finder of the field with the points' times, and of their unit and origin."""

    def __init__(self) -> None:
        self._clouds: list[PointCloud2] = []
        self.found: tuple[TimeField, PointClock] | None = None

    @property
    def is_searching(self) -> bool:
        """Whether more clouds may tell the clock."""
        return self.found is None and len(self._clouds) < ENOUGH

    def add(self, cloud: PointCloud2, where: str) -> tuple[TimeField, PointClock] | None:
        """Return the clock for a cloud; None if the points have no times, or it is not known yet.

        Raises:
            DriveError: the cloud's header contradicts itself or the data.
        """
        if self.is_searching and cloud.count:
            self._clouds.append(cloud)
            self.found = cloud_clock(self._clouds, where)
            if not self.is_searching:
                self._clouds = self._clouds[-1:] * ENOUGH  # the points are not needed any more
        return self.found
