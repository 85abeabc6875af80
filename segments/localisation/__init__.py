"""From candidates to a pose: where in a map the robot is, how sure that is, or "I do not know".

    localisation = localise(candidates)

goes step by step (`localise.py`): correspondences and their weights, the graph of consistent
distances, its heaviest clique, a rigid transform, refinement with all that agrees, a second look
for another place that fits, and a probability. No step knows of models, maps or requests.
"""

from segments.localisation.candidates import Candidates
from segments.localisation.confidence import Confidence
from segments.localisation.hypothesis import Hypothesis
from segments.localisation.localise import Localisation, localise
from segments.localisation.parameters import LocalisationParameters
from segments.localisation.pose import Pose

__all__ = [
    "Candidates",
    "Confidence",
    "Hypothesis",
    "Localisation",
    "LocalisationParameters",
    "Pose",
    "localise",
]
