"""Evidence of the last seconds: what a robot's earlier requests found supports what it finds now.

Requests of one session share the robot's odometry frame, and that frame's pose in the map stays
nearly constant, however far the robot drives in a few seconds.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

from segments.localisation.hypothesis import Hypothesis, same_place
from segments.localisation.parameters import LocalisationParameters
from segments.localisation.pose import Pose


@dataclass(frozen=True, slots=True)
class Past:
    """What is kept of a request.

    Attributes:
        time: seconds, of any clock that only grows.
        hypotheses: poses with their scores.
    """

    time: float
    hypotheses: tuple[tuple[Pose, float], ...]


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

    def guesses(self) -> list[Pose]:
        """Best poses of the past, the latest first: places to look at again."""
        return [request.hypotheses[0][0] for request in reversed(self.past) if request.hypotheses]


class History:
    """The last requests of one session. Not safe to use from two threads at once."""

    def __init__(self, parameters: LocalisationParameters) -> None:
        self._parameters = parameters
        self._past: deque[Past] = deque(maxlen=parameters.remembered)

    def at(self, time: float) -> Evidence:
        """What the past says now; what is older than the memory is forgotten."""
        oldest = time - self._parameters.memory
        return Evidence(
            tuple(each for each in self._past if each.time >= oldest), time, self._parameters
        )

    def add(self, time: float, hypotheses: Sequence[Hypothesis]) -> None:
        """Remember what a request found by itself."""
        found = tuple((each.pose, each.score) for each in hypotheses)
        self._past.append(Past(time, found))
