"""Loops of an earlier optimization: a map that grew is searched only where it grew."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

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

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Return all of it as arrays, to store it."""
        localized = np.array(sorted(self.localized), dtype=np.float64).reshape(-1, 2)
        ends = np.array([each[:2] for each in self.loops], dtype=np.float64).reshape(-1, 2, 2)
        loops = [each for _, _, each in self.loops]
        return {
            "localized_tracks": localized[:, 0].astype(np.int64),
            "localized_times": localized[:, 1],
            "tracks": ends[:, :, 0].astype(np.int64),
            "times": ends[:, :, 1],
            "positions": np.array([each.position for each in loops]).reshape(-1, 3),
            "yaws": np.array([each.yaw for each in loops], dtype=np.float64),
            "covariances": np.array([each.covariance for each in loops]).reshape(-1, 4, 4),
            "probabilities": np.array([each.probability for each in loops], dtype=np.float64),
            "inliers": np.array([each.inliers for each in loops], dtype=np.int64),
        }

    @classmethod
    def of_arrays(cls, arrays: Mapping[str, NDArray[Any]]) -> Self:
        """Return what `arrays` returned.

        Raises:
            KeyError: An array is missing.
            ValueError: The arrays do not fit each other.
        """
        tracks, times = arrays["tracks"], arrays["times"]
        names = ("positions", "yaws", "covariances", "probabilities", "inliers")
        columns = [arrays[name] for name in names]
        shapes = [(len(tracks), *shape) for shape in ((3,), (), (4, 4), (), ())]
        if tracks.shape != (len(tracks), 2) or times.shape != tracks.shape:
            raise ValueError("a loop has two captures")
        if [each.shape for each in columns] != shapes:
            raise ValueError("the columns of the loops have other lengths")
        loops = []
        for pair, moments, position, yaw, covariance, probability, inliers in zip(
            tracks.tolist(), times.tolist(), *columns, strict=True
        ):
            one, other = zip(pair, moments, strict=True)
            found = FoundLoop(
                -1, -1, position, float(yaw), covariance, float(probability), int(inliers)
            )
            loops.append((one, other, found))
        localized = zip(
            arrays["localized_tracks"].tolist(), arrays["localized_times"].tolist(), strict=True
        )
        return cls(frozenset(localized), tuple(loops))

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
