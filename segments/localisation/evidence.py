"""Evidence of the last seconds: what a robot's earlier requests found supports what it finds now.

Requests of one session share the robot's odometry frame, and that frame's pose in the map stays
nearly constant, however far the robot drives in a few seconds.
"""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from segments.localisation.hypothesis import Hypothesis, same_place
from segments.localisation.parameters import LocalisationParameters
from segments.localisation.pose import Pose
from segments.types import Float64


@dataclass(frozen=True, slots=True)
class Past:
    """What is kept of a request.

    Attributes:
        time: seconds, of any clock that only grows.
        hypotheses: poses with their scores.
        digest: of what it asked; None: it is not known, and counts as unlike any other's.
    """

    time: float
    hypotheses: tuple[tuple[Pose, float], ...]
    digest: bytes | None


@dataclass(frozen=True, slots=True)
class Evidence:
    """What earlier requests say, at one moment.

    Attributes:
        past: of the requests that still count.
        time: of the moment, seconds.
        parameters: say what the same place is, and what the past is worth.
    """

    past: tuple[Past, ...]
    time: float
    parameters: LocalisationParameters

    def support(self, hypothesis: Hypothesis) -> float:
        """Score that earlier requests add to a hypothesis.

        Of each, the score of its best hypothesis at the same place; less, the longer ago. And less
        than the whole: successive requests see much the same, look-alikes too.
        """
        middle = hypothesis.source.mean(axis=0)
        total = 0.0
        for request in self.past:
            agreeing = [
                score
                for pose, score in request.hypotheses
                if same_place(hypothesis.pose, pose, middle, self.parameters)
            ]
            fading = 0.5 ** ((self.time - request.time) / self.parameters.half_life)
            total += fading * max(agreeing, default=0.0)
        return self.parameters.past_weight * total

    def guesses(self, at: Float64) -> list[Pose]:
        """Places to look at again: the best ones of the past, each once, the latest first.

        Args:
            at: a point (3,) in the midst of what the robot sees now, metres, in its frame.
        """
        places: list[Pose] = []
        for request in reversed(self.past):
            for pose, _ in request.hypotheses[:1]:
                if not any(same_place(pose, other, at, self.parameters) for other in places):
                    places.append(pose)
        return places


class History:
    """The last requests of one session. Not safe to use from two threads at once."""

    def __init__(self, parameters: LocalisationParameters) -> None:
        self._parameters = parameters
        self._past: deque[Past] = deque(maxlen=parameters.remembered)

    def at(self, time: float, digest: bytes | None = None) -> Evidence:
        """What the past says now; what is older than the memory is forgotten.

        Args:
            time: seconds.
            digest: of what is asked now; the same request, sent again, is no evidence of its own.
        """
        oldest = time - self._parameters.memory
        past = tuple(each for each in self._others(digest) if each.time >= oldest)
        return Evidence(past, time, self._parameters)

    def add(
        self, time: float, hypotheses: Sequence[Hypothesis], digest: bytes | None = None
    ) -> None:
        """Remember what a request found by itself; sent again, it takes its own place."""
        found = tuple((each.pose, each.score) for each in hypotheses)
        self._past = deque(self._others(digest), self._past.maxlen)
        self._past.append(Past(time, found, digest))

    def _others(self, digest: bytes | None) -> Iterator[Past]:
        return (each for each in self._past if digest is None or each.digest != digest)
