"""Timing of the steps of a request."""

from collections.abc import Iterator
from time import perf_counter

STAGES = (
    "receive",
    "decode",
    "segment",
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
"""All steps, in order.

`segment` segments a point cloud file, `look` describes the neighborhood of each segment, `verify`
finds a pose from candidates.
"""


LAPS = 64
"""Largest number of laps that are kept one by one."""


class Timing:
    """Stopwatch of a request: each lap is the time since the previous one.

    A request passes from thread to thread, but only one thread works on it at a time.

    Attributes:
        started: begin of the request, seconds of `perf_counter`.
        laps: the first laps one by one: step, begin and end.
    """

    def __init__(self) -> None:
        self._last = self.started = perf_counter()
        self._seconds: dict[str, float] = {}
        self.laps: list[tuple[str, float, float]] = []

    def lap(self, stage: str) -> None:
        """Record the end of a step, one of `STAGES`; times of a repeated step add up."""
        now = perf_counter()
        self._seconds[stage] = self._seconds.get(stage, 0.0) + now - self._last
        if len(self.laps) < LAPS:
            self.laps.append((stage, self._last, now))
        self._last = now

    def items(self) -> Iterator[tuple[str, float]]:
        """Return the steps with their seconds, in the order of their first laps."""
        return iter(self._seconds.items())

    def header(self) -> str:
        """Return the value of the `Server-Timing` header: milliseconds of each step."""
        return ", ".join(f"{stage};dur={1e3 * seconds:.2f}" for stage, seconds in self.items())
