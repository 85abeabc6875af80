"""The training set: distinct segments of one or several recordings, with their groups."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from placecell.core.parameters import NeighborhoodParameters, Parameters
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Int64
from placecell.segmentation.recording import Recording


@dataclass(frozen=True, slots=True)
class Source:
    """A part of a recording: the groups that lie wholly within scans first to last."""

    recording: Recording
    first: int
    last: int

    @property
    def synthetic(self) -> bool:
        """Whether it is of a town that was made up, `town:SEED`."""
        return self.recording.name.startswith("town:")

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


def check_apart(sources: Sequence[Source]) -> None:
    """See that no scan stands in two of these.

    Raises:
        ValueError: one does.
    """
    seen: dict[str, str] = {}
    for source in sources:
        name = f"{source.recording.name} scans {source.first} to {source.last}"
        hashes = set(source.recording.scan_hashes[source.first : source.last + 1])
        for scan in hashes & seen.keys():
            raise ValueError(f"{name} shares scans with {seen[scan]}; take each scan once")
        seen |= dict.fromkeys(hashes, name)


@dataclass(frozen=True, slots=True)
class TrainingSet:
    """Distinct segments with labels.

    Attributes:
        segments: each drive's in its own frame.
        groups: int64 (segments,): from 0, different over drives.
        parameters: of the grid.
        neighborhood: float32 (segments, size): what stood around each in its frame, duplicates
            included, as in a robot's request; None if nobody asked.
        synthetic: bool (segments,): seen in a town that was made up; None: nobody knows.
    """

    segments: Segments
    groups: Int64
    parameters: Parameters
    neighborhood: Float32 | None = None
    synthetic: Bool | None = None

    @classmethod
    def of(
        cls, sources: Sequence[Source], neighborhood: NeighborhoodParameters | None = None
    ) -> "TrainingSet":
        """From parts of recordings.

        Args:
            neighborhood: how to describe them, if at all.

        Raises:
            ValueError: a scan stands in two of them, or they were cut with other constants.
        """
        check_apart(sources)
        if len({replace(source.recording.parameters, frame_step=1) for source in sources}) > 1:
            raise ValueError(
                "the recordings were cut with different constants; prepare them anew together"
            )
        parts, groups, count = [], [], 0
        around = []
        for source in sources:
            indices = source.indices()
            parts.append(source.recording.segments.take(indices))
            labels = np.unique(source.recording.groups[indices], return_inverse=True)[1]
            groups.append(labels + count)
            count += int(labels.max(initial=-1)) + 1
            if neighborhood is not None:
                around.append(source.recording.neighborhood(neighborhood)[indices])
        return cls(
            Segments.concatenate(parts),
            np.concatenate(groups),
            sources[0].recording.parameters,
            np.concatenate(around) if around else None,
            np.repeat([source.synthetic for source in sources], [len(part) for part in parts]),
        )

    def __len__(self) -> int:
        return len(self.segments)

    def recorded(self) -> "TrainingSet":
        """What was seen in real streets; all of it, if none was.

        Streets that were made up are as good to learn segments from, but what they look like as a
        whole is not: neither which directions a descriptor varies in nor what stands around.
        """
        if self.synthetic is None or self.synthetic.all():
            return self
        return self.take(np.flatnonzero(~self.synthetic))

    def take(self, indices: Int64) -> "TrainingSet":
        """These segments, their groups numbered anew from 0."""
        labels = np.unique(self.groups[indices], return_inverse=True)[1]
        around = None if self.neighborhood is None else self.neighborhood[indices]
        made_up = None if self.synthetic is None else self.synthetic[indices]
        return TrainingSet(self.segments.take(indices), labels, self.parameters, around, made_up)

    def group_sizes(self) -> Int64:
        """Segments of each group, int64 (groups,)."""
        return np.bincount(self.groups)

    def without_small_groups(self, fewest: int) -> "TrainingSet":
        """Only groups of at least so many segments (paper III-C)."""
        return self.take(np.flatnonzero(self.group_sizes()[self.groups] >= fewest))

    def split(self, share: float, seed: int) -> tuple["TrainingSet", "TrainingSet"]:
        """Training and validation set: a share of the groups, whole, is held out."""
        learned, held_out = self.halves(share, seed)
        return self.take(learned), self.take(held_out)

    def halves(self, share: float, seed: int) -> tuple[Int64, Int64]:
        """Indices of the segments of most groups, and of a share of the groups, drawn at random."""
        groups = np.random.default_rng(seed).permutation(len(self.group_sizes()))
        held_out = np.isin(self.groups, groups[: round(share * len(groups))])
        return np.flatnonzero(~held_out), np.flatnonzero(held_out)
