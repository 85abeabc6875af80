"""From candidates to a pose: where in a map the robot is, how sure that is, or "I do not know".

    localization = localize(candidates)

goes step by step (`localize.py`): correspondences and their weights, the graph of consistent
distances, its heaviest clique, a rigid transform, refinement with all that agrees, a second look
for another place that fits, and a probability. No step knows of models, maps or requests.
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
