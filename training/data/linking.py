"""Linking: groups of several drives that show the same thing.

Protocol v1 groups the segments of one drive. A robot that drives the other way, or has another
sensor, sees the same things from other sides and in other detail. Where the true transform between
two drives is known, as in a synthetic town, groups whose horizontal positions agree are one group.
Heights are not compared: a sensor that sees only the lower part of a house has its centroid lower.
"""

from dataclasses import dataclass, field

import numpy as np

from placecell.core.types import Float32, Float64, Int64
from placecell.segmentation.grouping import nearest_pairs

LINK_METERS = 1.0
"""Largest horizontal distance of two groups that are one, meters."""


@dataclass
class LinkedGroups:
    """Groups of the drives of one site.

    Attributes:
        numbers: int64 (groups,), number of each group among all groups of the training set.
        sums: float64 (groups, 2), sum of the horizontal positions that the drives have for each.
        drives: int64 (groups,), number of drives that see each.
    """

    numbers: Int64 = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    sums: Float64 = field(default_factory=lambda: np.zeros((0, 2)))
    drives: Int64 = field(default_factory=lambda: np.zeros(0, dtype=np.int64))


class Linker:
    """Numbers the groups of drives, one drive after the other.

    A group of a drive joins the group of earlier drives of the same site that is nearest, one to
    one. Otherwise it is a new group.
    """

    def __init__(self, limit: float) -> None:
        """Create a linker.

        Args:
            limit: largest horizontal distance of two groups that are one, meters.
        """
        self.limit = limit
        self.count = 0
        self._sites: dict[str, LinkedGroups] = {}

    def add(self, groups: Int64, centroids: Float32 | Float64, site: str = "") -> Int64:
        """Return the group of each segment of the next drive among all drives, int64 (segments,).

        Args:
            groups: int64 (segments,), group of each segment in its drive, from 0 without gaps.
            centroids: (segments, 3), meters, in the frame of the site.
            site: name of the place that the drive shows; "" if no other drive shows it.
        """
        sizes = np.bincount(groups)
        if not site:
            first, self.count = self.count, self.count + len(sizes)
            return groups + first
        positions = np.zeros((len(sizes), 2))
        np.add.at(positions, groups, centroids[:, :2])
        positions /= sizes[:, None]
        known = self._sites.setdefault(site, LinkedGroups())
        mine, theirs = nearest_pairs(positions, known.sums / known.drives[:, None], self.limit)
        numbers = np.full(len(sizes), -1)
        numbers[mine] = known.numbers[theirs]
        known.sums[theirs] += positions[mine]
        known.drives[theirs] += 1
        new = np.flatnonzero(numbers < 0)
        numbers[new] = self.count + np.arange(len(new))
        self.count += len(new)
        known.numbers = np.concatenate([known.numbers, numbers[new]])
        known.sums = np.concatenate([known.sums, positions[new]])
        known.drives = np.concatenate([known.drives, np.ones(len(new), dtype=np.int64)])
        return numbers[groups]
