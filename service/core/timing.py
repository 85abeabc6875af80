"""How long the steps of a request take."""

from collections.abc import Iterator
from time import perf_counter

STAGES = (
    "receive",
    "decode",
    "look",
    "align",
    "voxelise",
    "queue",
    "infer",
    "search",
    "verify",
    "encode",
    "commit",
)
"""All steps that there are, in order.

`look`: what stands around each segment; `verify`: from candidates to a pose.
"""


class Timing:
    """A stopwatch: each lap is the time since the one before.

    A request passes from thread to thread, but is only ever in one of them.
    """

    def __init__(self) -> None:
        self._last = self.started = perf_counter()
        self._seconds: dict[str, float] = {}

    def lap(self, stage: str) -> None:
        """A step has ended; one of `STAGES`. Done twice, its times add up."""
        now = perf_counter()
        self._seconds[stage] = self._seconds.get(stage, 0.0) + now - self._last
        self._last = now

    def items(self) -> Iterator[tuple[str, float]]:
        """Steps with their seconds, in the order of their first laps."""
        return iter(self._seconds.items())

    def header(self) -> str:
        """For `Server-Timing`: milliseconds of each step."""
        return ", ".join(f"{stage};dur={1e3 * seconds:.2f}" for stage, seconds in self.items())
