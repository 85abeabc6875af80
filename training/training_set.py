"""The training set: distinct segments of one or several recordings, with their groups."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from segments.parameters import Parameters
from segments.recording import Recording
from segments.segments import Segments
from segments.types import Int64


@dataclass(frozen=True, slots=True)
class Source:
    """A part of a recording: the groups that lie wholly within scans first to last."""

    recording: Recording
    first: int
    last: int

    def indices(self) -> Int64:
        """Distinct segments of those groups."""
        inside = self.recording.within(self.first, self.last)
        return np.flatnonzero(inside & self.recording.distinct)

    def describe(self) -> dict[str, Any]:
        """For a manifest: which drive and scans, with the hashes of the scans."""
        return {
            "drive": self.recording.name,
            "scans": [self.first, self.last],
            "frame_step": self.recording.parameters.frame_step,
            "segments": len(self.indices()),
            "scan_hashes": list(self.recording.scan_hashes[self.first : self.last + 1]),
        }


@dataclass(frozen=True, slots=True)
class TrainingSet:
    """Distinct segments with labels.

    Attributes:
        segments: each drive's in its own frame.
        groups: int64 (segments,): from 0, different over drives.
        parameters: of the grid.
    """

    segments: Segments
    groups: Int64
    parameters: Parameters

    @classmethod
    def of(cls, sources: Sequence[Source]) -> "TrainingSet":
        """From parts of recordings."""
        parts, groups, count = [], [], 0
        for source in sources:
            indices = source.indices()
            parts.append(source.recording.segments.take(indices))
            labels = np.unique(source.recording.groups[indices], return_inverse=True)[1]
            groups.append(labels + count)
            count += int(labels.max(initial=-1)) + 1
        return cls(
            Segments.concatenate(parts), np.concatenate(groups), sources[0].recording.parameters
        )

    def __len__(self) -> int:
        return len(self.segments)

    def take(self, indices: Int64) -> "TrainingSet":
        """These segments, their groups numbered anew from 0."""
        labels = np.unique(self.groups[indices], return_inverse=True)[1]
        return TrainingSet(self.segments.take(indices), labels, self.parameters)

    def group_sizes(self) -> Int64:
        """Segments of each group, int64 (groups,)."""
        return np.bincount(self.groups)

    def without_small_groups(self, fewest: int) -> "TrainingSet":
        """Only groups of at least so many segments (paper III-C)."""
        return self.take(np.flatnonzero(self.group_sizes()[self.groups] >= fewest))

    def split(self, share: float, seed: int) -> tuple["TrainingSet", "TrainingSet"]:
        """Training and validation set: a share of the groups, whole, is held out."""
        groups = np.random.default_rng(seed).permutation(len(self.group_sizes()))
        held_out = np.isin(self.groups, groups[: round(share * len(groups))])
        return self.take(np.flatnonzero(~held_out)), self.take(np.flatnonzero(held_out))
