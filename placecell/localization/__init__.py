"""Localization: the robot's pose in a map, its probability, or the reason why it is unknown.

    localization = localize(candidates)

The steps are in `localize.py`: weighted correspondences, the graph of consistent distances, its
heaviest clique, a rigid transform, refinement with all inliers, guided matching, and a probability.
No step depends on models, map files or requests.
"""

from placecell.localization.candidates import Candidates
from placecell.localization.confidence import Confidence
from placecell.localization.hypothesis import Hypothesis
from placecell.localization.localize import Localization, localize
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose

__all__ = [
    "Candidates",
    "Confidence",
    "Hypothesis",
    "Localization",
    "LocalizationParameters",
    "Pose",
    "localize",
]
