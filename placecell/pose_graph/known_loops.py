"""Loops of an earlier optimization: a map that grew is searched only where it grew."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from placecell.core.types import Int64
from placecell.pose_graph.frames import NO_TRACK, GraphFrames
from placecell.pose_graph.loops import FoundLoop
from placecell.pose_graph.parameters import PoseGraphParameters

CaptureKey = tuple[int, float]
"""Track and time of a capture, which stay when the map grows."""


@dataclass(frozen=True, slots=True, eq=False)
class KnownLoops:
    """Loops that were found in an earlier state of a map.

    Attributes:
        localized: captures that were localized, whether loops were found or not.
        loops: captures of each loop, and the loop.
    """

    localized: frozenset[CaptureKey]
    loops: tuple[tuple[CaptureKey, CaptureKey, FoundLoop], ...]

    @classmethod
    def of(cls, frames: GraphFrames, localized: Int64, loops: list[FoundLoop]) -> Self:
        """Remember loops, and the captures that were localized for them.

        Captures without odometry are not remembered, because nothing identifies them.
        """
        keys = _keys_of(frames)
        named = ((keys.get(each.one), keys.get(each.other), each) for each in loops)
        return cls(
            frozenset(keys[capture] for capture in localized.tolist() if capture in keys),
            tuple((one, other, each) for one, other, each in named if one and other),
        )

    def in_map(
        self, frames: GraphFrames, chosen: Int64, parameters: PoseGraphParameters
    ) -> tuple[list[FoundLoop], Int64, Int64]:
        """Return what is known of a map that may have grown.

        Args:
            frames: the captures of the map.
            chosen: captures to localize, if nothing was known.
            parameters: constants of the pose graph.

        Returns:
            The known loops between its captures; the captures that were localized before; and those
            that are left to localize: a capture that was localized stands for those beside it.
        """
        captures = {key: capture for capture, key in _keys_of(frames).items()}
        loops = [
            replace(each, one=captures[one], other=captures[other])
            for one, other, each in self.loops
            if one in captures and other in captures
        ]
        known = {captures[key] for key in self.localized if key in captures}
        before = np.array(sorted(known), dtype=np.int64)
        tracks, ways = frames.odometry.tracks, frames.ways
        is_known = np.zeros(len(chosen), dtype=bool)
        for track in np.unique(tracks[before]):
            at = np.sort(ways[before[tracks[before] == track]])
            rows = np.flatnonzero(tracks[chosen] == track)
            place = np.searchsorted(at, ways[chosen[rows]])
            apart = np.minimum(
                np.abs(ways[chosen[rows]] - at[np.maximum(place - 1, 0)]),
                np.abs(ways[chosen[rows]] - at[np.minimum(place, len(at) - 1)]),
            )
            is_known[rows] = apart < parameters.every / 2
        return loops, before, chosen[~is_known]


def _keys_of(frames: GraphFrames) -> dict[int, CaptureKey]:
    """Return the key of each capture that no other capture has."""
    pairs = list(zip(frames.odometry.tracks.tolist(), frames.times.tolist(), strict=True))
    captures: dict[CaptureKey, int] = {}
    repeated = set()
    for capture, key in enumerate(pairs):
        if key in captures:
            repeated.add(key)
        captures[key] = capture
    return {
        capture: key
        for key, capture in captures.items()
        if key[0] != NO_TRACK and key not in repeated
    }
