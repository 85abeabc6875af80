"""Pairs of maps of one town, with a chosen overlap or none, to evaluate map alignment.

A map is a stretch of a drive. So two drives through all streets of a town give any number of pairs,
and their segments are extracted only once.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.spatial import cKDTree

from placecell.core.types import Bool, Float64, Int64
from town.city import City
from town.drives.pair import StretchPair
from town.drives.traversal import Traversal
from town.streets.network import OWN

SAME_STREET = 7.0
"""Largest distance between scans of two drives in the same street, meters."""

APART = 100.0
"""Smallest distance between the scans of maps without overlap, meters. A scan reaches 40 m."""

TOLERANCE = 0.02
"""Largest difference from the chosen overlap, unless half a scan is more."""

TRIES = 100
"""Largest number of stretches of the first drive that are tried for one pair."""

COMPARED = 5
"""Number of pairs among which the most similar one is chosen."""

FARTHEST = 5000.0
"""Largest distance along x and y of a map's origin from its drive's origin, meters."""


def draw_pairs(
    city: City, a: Traversal, b: Traversal, count: int, meters: float, seed: int = 0
) -> tuple[list[StretchPair], list[StretchPair]]:
    """Draw pairs of maps: `count` with an overlap of 10% to 100%, and as many without.

    Half of the pairs without overlap are chosen for similar streets.

    Args:
        city: town of the drives.
        a, b: two drives through the town.
        count: number of pairs with overlap, and of pairs without.
        meters: length of each map's path, meters.
        seed: seed of the choice.

    Raises:
        ValueError: The drives are too short, or too near to each other.
    """
    if count < 1:
        raise ValueError(f"Invalid number of pairs: expected at least 1, not {count}")
    drawer = StretchPairDrawer.of(city, a, b, meters, np.random.default_rng([seed, 10]))
    overlapping = [drawer.overlapping(float(share)) for share in np.linspace(0.1, 1.0, count)]
    apart = [drawer.apart(alike=number % 2 == 0) for number in range(count)]
    return overlapping, apart


@dataclass(frozen=True)
class StretchPairDrawer:
    """Draws pairs of stretches at random.

    Attributes:
        a, b: the drives.
        designs_a, designs_b: design of the houses at each scan.
        scans_a, scans_b: number of scans of a stretch.
        rng: random number generator.
    """

    a: Traversal
    b: Traversal
    designs_a: Int64
    designs_b: Int64
    scans_a: int
    scans_b: int
    rng: np.random.Generator

    @classmethod
    def of(
        cls, city: City, a: Traversal, b: Traversal, meters: float, rng: np.random.Generator
    ) -> Self:
        """Create the drawer for stretches of a length, meters.

        Raises:
            ValueError: A drive is shorter.
        """
        return cls(
            a,
            b,
            city.designs_at(a.places),
            city.designs_at(b.places),
            a.scans_in(meters),
            b.scans_in(meters),
            rng,
        )

    def overlapping(self, share: float) -> StretchPair:
        """Draw a pair whose second stretch overlaps the first by a share, 0 to 1.

        Raises:
            ValueError: No such pair was found.
        """
        for _ in range(TRIES):
            first_a, distance = self._stretch_of_a()
            shared = means(distance <= SAME_STREET, self.scans_b)
            fitting = np.flatnonzero(np.abs(shared - share) <= max(TOLERANCE, 0.51 / self.scans_b))
            if len(fitting):
                first_b = int(self.rng.choice(fitting))
                return self._pair(first_a, first_b, float(shared[first_b]))
        raise ValueError(f"found no two stretches of the drives that share {share:.0%}")

    def apart(self, alike: bool) -> StretchPair:
        """Draw a pair without overlap.

        Args:
            alike: choose the most similar one of several.

        Raises:
            ValueError: No such pair was found.
        """
        found = []
        for _ in range(TRIES):
            first_a, distance = self._stretch_of_a()
            clear = np.flatnonzero(means(distance <= APART, self.scans_b) == 0)
            if len(clear):
                likeness = self._likeness(first_a)[clear]
                best = likeness.argmax() if alike else self.rng.integers(len(clear))
                found.append((float(likeness[best]), first_a, int(clear[best])))
            if len(found) == (COMPARED if alike else 1):
                break
        if not found:
            raise ValueError(f"found no two stretches of the drives that are {APART:.0f} m apart")
        _, first_a, first_b = max(found)
        return self._pair(first_a, first_b, 0.0)

    def _stretch_of_a(self) -> tuple[int, Float64]:
        """Draw a stretch of a; return its first scan and the distance of each scan of b, meters."""
        first = int(self.rng.integers(len(self.a.poses) - self.scans_a + 1))
        tree = cKDTree(self.a.places[first : first + self.scans_a])
        return first, tree.query(self.b.places)[0]

    def _likeness(self, first_a: int) -> Float64:
        """Return the share of scans with a's identical houses, for each stretch of b."""
        designs = self.designs_a[first_a : first_a + self.scans_a]
        alike = (self.designs_b != OWN) & np.isin(self.designs_b, designs)
        return means(alike, self.scans_b)

    def _pair(self, first_a: int, first_b: int, overlap: float) -> StretchPair:
        frame_a, frame_b = self._frame(), self._frame()
        b_in_town = self.b.origin @ np.linalg.inv(frame_b)
        return StretchPair(
            scans_a=(first_a, first_a + self.scans_a - 1),
            scans_b=(first_b, first_b + self.scans_b - 1),
            overlap=overlap,
            look_alike=float(self._likeness(first_a)[first_b]),
            frame_a=frame_a,
            frame_b=frame_b,
            b_to_a=frame_a @ np.linalg.inv(self.a.origin) @ b_in_town,
        )

    def _frame(self) -> Float64:
        heading = self.rng.uniform(-np.pi, np.pi)
        frame = np.eye(4)
        frame[:2, :2] = [[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]]
        frame[:3, 3] = self.rng.uniform(-1, 1, size=3) * (FARTHEST, FARTHEST, 50.0)
        return frame


def means(flags: Bool, window: int) -> Float64:
    """Return the share of true flags in each window, (flags - window + 1,)."""
    sums = np.concatenate([[0], np.cumsum(flags)])
    return np.asarray((sums[window:] - sums[:-window]) / window)
