"""Acceptance: the smallest probability of a returned pose, by conformal risk control.

The risk is the share of queries whose answer is a false pose: off by more than 3 m or 10 degrees.
On n calibration queries, whose probabilities come from models that were not fitted on them, k false
poses have a probability above a threshold. The smallest threshold is used for which

    (k + 1) / (n + 1) <= alpha

Then the expected risk of a further query is at most alpha, if it is like the calibration queries.
A user has one sensor in one place, so the same holds for the queries of each sensor alone and of
each kind of place alone, as far as their number allows: with fewer than 1 / alpha of them, none of
their false poses exceeds the threshold.
Source: Angelopoulos, Bates, Fisch, Lei, Schuster: *Conformal risk control*. ICLR 2024.
"""

from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from placecell.core.types import Bool, Float64

LARGEST_RISK = 0.5
"""Largest share of false poses that a caller may accept."""

KEPT = 2_000
"""Largest number of false poses whose probabilities a file keeps: the most probable ones."""


@dataclass(frozen=True, slots=True)
class Acceptance:
    """Calibration queries of a model.

    Attributes:
        queries: number of calibration queries.
        false: probabilities of the false poses, largest first; at most the `KEPT` largest.
        sensors: the queries of each sensor, by its name.
        places: the queries of each kind of place, by its name.
    """

    queries: int
    false: tuple[float, ...]
    sensors: tuple[tuple[str, "Acceptance"], ...] = ()
    places: tuple[tuple[str, "Acceptance"], ...] = ()

    @classmethod
    def of(cls, probabilities: Float64, false: Bool) -> Self:
        """Build from the queries' probabilities, float64 (n,), and which poses are false."""
        wrong = np.sort(probabilities[false])[::-1][:KEPT]
        # Rounded up, so that no threshold is below the probability that it excludes.
        return cls(len(probabilities), tuple((np.ceil(wrong * 1e9) / 1e9).tolist()))

    @classmethod
    def by_group(
        cls,
        probabilities: Float64,
        false: Bool,
        sensors: NDArray[Any],
        places: NDArray[Any],
    ) -> Self:
        """Build as `of`, with the queries of each sensor and of each place also by themselves.

        Args:
            probabilities: float64 (n,).
            false: bool (n,), which poses are false.
            sensors: (n,) or (n, m), names of the query's sensors: those of query and map.
            places: (n,), kind of the place.
        """
        return replace(
            cls.of(probabilities, false),
            sensors=_alone(probabilities, false, sensors),
            places=_alone(probabilities, false, places),
        )

    @property
    def smallest_risk(self) -> float:
        """Smallest `max_false_acceptance` that the number of queries supports."""
        return 1 / (self.queries + 1)

    def threshold(self, risk: float) -> float:
        """Return the probability that a pose must exceed for the risk to be at most `risk`.

        Args:
            risk: `max_false_acceptance`, more than 0 and at most 0.5.

        Raises:
            ValueError: The risk is out of range, or smaller than the queries support.
        """
        check_risk(risk)
        # The tolerance admits a risk of exactly 1 / (n + 1) in spite of rounding.
        allowed = int(np.floor(risk * (self.queries + 1) + 1e-9)) - 1
        if allowed < 0:
            raise ValueError(
                f"Invalid max_false_acceptance {risk:g}: the model's {self.queries:,} calibration "
                f"queries support {self.smallest_risk:.2g} or more."
            )
        if allowed < len(self.false):
            pooled = self.false[allowed]
        else:  # all false poses are allowed, or more than the file keeps
            pooled = self.false[-1] if len(self.false) == KEPT else 0.0
        groups = (*self.sensors, *self.places)
        alone = (each.threshold(max(risk, each.smallest_risk)) for _, each in groups)
        return max([pooled, *alone])

    def as_json(self) -> dict[str, Any]:
        """Return the content for `confidence.json`."""
        content: dict[str, Any] = {"queries": self.queries, "false": list(self.false)}
        for key, groups in (("sensors", self.sensors), ("places", self.places)):
            if groups:
                content[key] = {name: each.as_json() for name, each in groups}
        return content

    @classmethod
    def of_json(cls, content: dict[str, Any]) -> Self:
        """Read the content of `confidence.json`."""
        return cls(
            int(content["queries"]),
            tuple(float(each) for each in content["false"]),
            *(
                tuple((name, cls.of_json(each)) for name, each in content.get(key, {}).items())
                for key in ("sensors", "places")
            ),
        )


def _alone(
    probabilities: Float64, false: Bool, groups: NDArray[Any]
) -> tuple[tuple[str, Acceptance], ...]:
    """Return the queries of each group by themselves."""
    members = {
        name: (groups.reshape(len(probabilities), -1) == name).any(axis=1)
        for name in np.unique(groups).tolist()
    }
    return tuple(
        (name, Acceptance.of(probabilities[own], false[own])) for name, own in members.items()
    )


def check_risk(risk: float) -> None:
    """Check the range of `max_false_acceptance`.

    Raises:
        ValueError: It is not more than 0 and at most 0.5.
    """
    if not 0 < risk <= LARGEST_RISK:
        raise ValueError(
            f"Invalid max_false_acceptance {risk:g}: expected more than 0 and at most "
            f"{LARGEST_RISK:g}."
        )
