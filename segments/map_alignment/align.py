"""How two maps lie to each other: the way from their segments to a transform, step by step."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from segments.localisation import Pose
from segments.localisation.correspondences import correspond
from segments.localisation.hypothesis import find_hypotheses
from segments.localisation.voting import most_voted
from segments.map_alignment.consensus import Guess, common_pose, consensus
from segments.map_alignment.map_view import Looks, MapView
from segments.map_alignment.overlap import Overlap, overlap_of
from segments.map_alignment.parameters import AlignmentParameters
from segments.map_alignment.submaps import Submap, candidates_of, cut
from segments.types import Float64

Reason = Literal["too-few-segments", "inconsistent", "ambiguous"]

PARAMETERS = AlignmentParameters()


def align_all(
    a: MapView, b: MapView, looks: Looks, parameters: AlignmentParameters = PARAMETERS
) -> list[Overlap]:
    submaps = cut(b, parameters)
    guesses = guess(submaps, a, b, looks, parameters)
    return [
        overlap_of(a, b, common_pose(members, parameters), looks, parameters)
        for members in consensus(guesses, parameters)
    ]


def guess(
    submaps: Sequence[Submap], a: MapView, b: MapView, looks: Looks, parameters: AlignmentParameters
) -> list[Guess]:
    """Where each submap of b may be in a: the hypotheses of localisation."""
    guesses = []
    for number, submap in enumerate(submaps):
        candidates = candidates_of(submap, b, a, looks, parameters)
        voted = most_voted(correspond(candidates, parameters.local), parameters.local)
        guesses += [
            Guess(number, submap.middle, each.pose, each.score)
            for each in find_hypotheses(voted, parameters.local)
        ]
    return guesses
