"""Difference of two maps of one place: what appeared, is gone, changed, or stayed."""

from collections.abc import Callable
from dataclasses import dataclass

from placecell.core.types import Int8
from placecell.lasting.judgment import ABSENT, CHANGED, CONFIRMED, UNSEEN, ObservedSegments, judge


@dataclass(frozen=True, slots=True, eq=False)
class WorldDifference:
    """Difference between an earlier and a later map of one place.

    Attributes:
        before: int8 (n,), verdict of each segment of the earlier map by the later one.
        after: int8 (m,), verdict of each segment of the later map by the earlier one.
    """

    before: Int8
    after: Int8

    @property
    def counts(self) -> dict[str, int]:
        """Number of segments by outcome.

        `appeared` counts segments of the later map where the earlier one saw nothing, `new_place`
        those where it did not look; `unseen` counts segments of the earlier map where the later one
        did not look.
        """
        return {
            "kept": int((self.before == CONFIRMED).sum()),
            "changed": int((self.before == CHANGED).sum()),
            "gone": int((self.before == ABSENT).sum()),
            "unseen": int((self.before == UNSEEN).sum()),
            "appeared": int((self.after == ABSENT).sum()),
            "new_place": int((self.after == UNSEEN).sum()),
        }


def world_difference(
    before: ObservedSegments, after: ObservedSegments, check: Callable[[], None] = lambda: None
) -> WorldDifference:
    """Compare two maps in one coordinate frame by what each of them should have seen.

    Args:
        before: segments of the earlier map.
        after: segments of the later map.
        check: is called often; it may raise to cancel the work.
    """
    return WorldDifference(judge(before, after, check), judge(after, before, check))
