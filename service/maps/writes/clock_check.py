"""Clock check: refuse segments that were seen after the service's present time."""

import time
from datetime import UTC, datetime

import numpy as np
from placecell_client import CompactMap

from service.core.problems import Problem

AHEAD = 300.0
"""Seconds by which a robot's clock may be ahead."""

SET_SINCE = datetime(2025, 1, 1, tzinfo=UTC).timestamp()
"""Earliest time of a clock that was set. Before it, as on a computer without a battery, nothing is
checked."""


def check_times(content: CompactMap) -> None:
    """Check that no segment's frame time or `seen` is in the future; 422 if one is.

    A segment from the future would never be pruned. Times of the past are all taken: recorded
    drives have them, and drives that count from zero.
    """
    now = time.time()
    if now < SET_SINCE or not len(content):
        return
    latest = float(content.frame_times[np.unique(content.frame_index)].max())
    if content.seen is not None:
        latest = max(latest, float(content.seen.max()))
    if latest > now + AHEAD:
        raise Problem(
            422,
            "time-in-future",
            f"Segments were seen at {latest:.0f} s, {latest - now:,.0f} s after the service's "
            f"clock ({now:.0f} s). At most {AHEAD:.0f} s are allowed. Correct the robot's clock.",
        )
