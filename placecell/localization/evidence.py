"""Evidence of the last seconds: what a robot's earlier requests found supports what it finds now.

Requests of one session share the robot's odometry frame, and that frame's pose in the map stays
nearly constant, however far the robot drives in a few seconds.
"""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from placecell.core.types import Float64
from placecell.localization.hypothesis import Hypothesis, same_place
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose


@dataclass(frozen=True, slots=True, eq=False)
class PastRequest:
    """What is kept of a request.

    Attributes:
        time: seconds, of any clock that only grows.
        middle: (3,), of what was seen, meters, in the robot's frame.
        hypotheses: poses with their scores.
    """

    time: float
    middle: Float64
    hypotheses: tuple[tuple[Pose, float], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """What earlier requests say, at one moment.

    Attributes:
        past: requests of the last seconds.
        independent: those of them that speak for or against a place.
        time: of the moment, seconds.
        parameters: say what the same place is, and what the past is worth.
    """

    past: tuple[PastRequest, ...]
    independent: tuple[PastRequest, ...]
    time: float
    parameters: LocalizationParameters

    def support(self, hypothesis: Hypothesis) -> float:
        """Score that earlier requests add to a hypothesis.

        Of each, the score of its best hypothesis at the same place; less, the longer ago. And less
        than the whole: successive requests see much the same, look-alikes too.
        """
        middle = hypothesis.source.mean(axis=0)
        total = 0.0
        for request in self.independent:
            agreeing = [
                score
                for pose, score in request.hypotheses
                if same_place(hypothesis.pose, pose, middle, self.parameters)
            ]
            fading = 0.5 ** ((self.time - request.time) / self.parameters.half_life)
            total += fading * max(agreeing, default=0.0)
        return self.parameters.past_weight * total

    @property
    def weight(self) -> float:
        """Return the variance of the support, as a share of that of one request's score."""
        return self.parameters.past_weight**2 * len(self.independent)

    def guesses(self, at: Float64) -> list[Pose]:
        """Places to look at again: the best ones of the past, each once, the latest first.

        Args:
            at: a point (3,) in the midst of what the robot sees now, meters, in its frame.
        """
        places: list[Pose] = []
        for request in reversed(self.past):
            for pose, _ in request.hypotheses[:1]:
                if not any(same_place(pose, other, at, self.parameters) for other in places):
                    places.append(pose)
        return places


class RequestHistory:
    """The last requests of one session. Not safe to use from two threads at once."""

    def __init__(self, parameters: LocalizationParameters) -> None:
        self._parameters = parameters
        self._past: deque[PastRequest] = deque(maxlen=parameters.remembered)

    def at(self, time: float, middle: Float64) -> Evidence:
        """What the past says now; what is older than the memory is forgotten.

        A robot that stands sees the same again, and learns nothing from it. So those count that
        were asked from elsewhere than now, and than each other.

        Args:
            time: seconds.
            middle: (3,), of what is seen now, meters, in the robot's frame.
        """
        oldest = time - self._parameters.memory
        past = tuple(each for each in self._past if each.time >= oldest)
        places, independent = [middle], []
        for request in reversed(past):
            away = np.linalg.norm(np.array(places) - request.middle, axis=1).min()
            if away >= self._parameters.apart:
                places.append(request.middle)
                independent.append(request)
        return Evidence(past, tuple(independent), time, self._parameters)

    def add(self, time: float, middle: Float64, hypotheses: Sequence[Hypothesis]) -> None:
        """Remember what a request found by itself."""
        found = tuple((each.pose, each.score) for each in hypotheses)
        self._past.append(PastRequest(time, middle, found))


def middle_of(centroids: Float64) -> Float64:
    """Mean (3,) of centroids (n, 3), without those that are no numbers; NaN if there is none."""
    finite = centroids[np.isfinite(centroids).all(axis=1)]
    return finite.mean(axis=0) if len(finite) else np.full(3, np.nan)
