"""How many segments may be stored: by a robot over all maps, and in a map."""

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from service.problems import Problem
from service.stored_map import StoredMap


@dataclass(frozen=True, slots=True)
class Quotas:
    """Of live segments, at most.

    Attributes:
        robot: of one robot, over all maps.
        map: in one map.
    """

    robot: int
    map: int

    def check(self, maps: Iterable[StoredMap], old: StoredMap | None, new: Counter[str]) -> None:
        """See that a write stays within the quotas. What makes a map smaller is never refused.

        Args:
            maps: all that there are, `old` among them.
            old: the map before the write; None if there was none.
            new: how many segments each robot will have in it.

        Raises:
            Problem: 507 if it does not.
        """
        before = old.layers.robots if old is not None else Counter[str]()
        if new.total() > max(self.map, before.total()):
            raise _exceeded(f"The map would have {new.total()} segments; {self.map} is the limit.")
        others = [stored.layers.robots for stored in maps if stored is not old]
        for robot in new:
            if new[robot] <= before[robot]:
                continue
            total = new[robot] + sum(counts[robot] for counts in others)
            if total > self.robot:
                raise _exceeded(
                    f"{robot!r:.80} would have {total} segments in all maps; {self.robot} is the "
                    "limit."
                )


def _exceeded(detail: str) -> Problem:
    return Problem(507, "quota-exceeded", detail)
