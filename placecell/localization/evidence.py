"""Evidence of earlier requests: hypotheses of the last seconds support the current ones.

Requests of one session share the robot's odometry frame. The frame's pose in the map is nearly
constant over a few seconds, however far the robot drives.
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
    """Earlier request of a session.

    Attributes:
        time: time of a monotonic clock, seconds.
        middle: (3,), meters, mean centroid of its segments in the robot's frame.
        hypotheses: poses with their scores.
    """

    time: float
    middle: Float64
    hypotheses: tuple[tuple[Pose, float], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """Evidence of a session's earlier requests at one time.

    Attributes:
        past: requests of the last seconds.
        independent: requests of `past` from other positions, which count as support.
        time: current time, seconds.
        parameters: tolerances of the same place, and weight and half-life of the support.
    """

    past: tuple[PastRequest, ...]
    independent: tuple[PastRequest, ...]
    time: float
    parameters: LocalizationParameters

    def support(self, hypothesis: Hypothesis) -> float:
        """Return the score that earlier requests add to a hypothesis.

        Each request adds the score of its best hypothesis at the same place, reduced by its age.
        The sum is weighted by less than 1, because successive requests see much the same, including
        similar places.
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
        """Variance of the support, relative to that of one request's score."""
        return self.parameters.past_weight**2 * len(self.independent)

    def guesses(self, at: Float64) -> list[Pose]:
        """Return the best poses of earlier requests, each place once, the latest first.

        Args:
            at: point (3,) near the middle of the current segments, meters, in the robot's frame.
        """
        places: list[Pose] = []
        for request in reversed(self.past):
            for pose, _ in request.hypotheses[:1]:
                if not any(same_place(pose, other, at, self.parameters) for other in places):
                    places.append(pose)
        return places


class RequestHistory:
    """History of one session's last requests. Not safe for concurrent use."""

    def __init__(self, parameters: LocalizationParameters) -> None:
        self._parameters = parameters
        self._past: deque[PastRequest] = deque(maxlen=parameters.remembered)

    def at(self, time: float, middle: Float64) -> Evidence:
        """Return the evidence at a time. Requests older than the memory are ignored.

        A robot that stands still sees the same again, which is no new evidence. So only requests
        from other positions count as independent.

        Args:
            time: current time, seconds.
            middle: (3,), meters, mean centroid of the current segments in the robot's frame.
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
        """Add a request with the hypotheses that it found without earlier evidence.

        Args:
            time: time of the request, seconds.
            middle: (3,), meters, mean centroid of its segments in the robot's frame.
            hypotheses: its hypotheses.
        """
        found = tuple((each.pose, each.score) for each in hypotheses)
        self._past.append(PastRequest(time, middle, found))


def middle_of(centroids: Float64) -> Float64:
    """Return the mean (3,) of the finite centroids (n, 3); NaN if none is finite."""
    finite = centroids[np.isfinite(centroids).all(axis=1)]
    return finite.mean(axis=0) if len(finite) else np.full(3, np.nan)
