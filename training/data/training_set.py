"""Training set: distinct segments of recordings, with their groups as labels."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from placecell.core.parameters import NeighborhoodParameters, Parameters
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Float64, Int64
from placecell.segmentation.recording import Recording
from training.data.linking import LINK_METERS, Linker


@dataclass(frozen=True, slots=True, eq=False)
class Source:
    """Part of a recording: the groups that lie completely within the scans first to last.

    Attributes:
        recording: segments of the drive.
        first: index of the first scan.
        last: index of the last scan (included).
        site: name of the place that the drive shows, if other sources may show it, too, and the
            true transform is known. Sources of one site share groups. "": shares with none.
        to_site: float64 (4, 4), transform from the drive's world to the frame of the site.
    """

    recording: Recording
    first: int
    last: int
    site: str = ""
    to_site: Float64 = field(default_factory=lambda: np.eye(4))

    @property
    def synthetic(self) -> bool:
        """Return whether the recording shows a synthetic town, `town:SEED`."""
        return self.recording.name.startswith("town:")

    def indices(self) -> Int64:
        """Return the indices of the distinct segments of these groups."""
        inside = self.recording.within(self.first, self.last)
        return np.flatnonzero(inside & self.recording.distinct)

    def segments(self, *, to_site: bool = False) -> Segments:
        """Return the distinct segments of these groups.

        Args:
            to_site: return them in the frame of the site, not of the drive's world.
        """
        segments = self.recording.segments.take(self.indices())
        if not to_site:
            return segments
        turn, shift = self.to_site[:3, :3], self.to_site[:3, 3]
        points, sensors = (
            (values.astype(np.float64) @ turn.T + shift).astype(np.float32)
            for values in (segments.points, segments.sensors)
        )
        return Segments(points, segments.ends, sensors)

    def describe(self) -> dict[str, Any]:
        """Return the entry of a manifest: drive, scans and the hashes of the scans."""
        return {
            "drive": self.recording.name,
            "scans": [self.first, self.last],
            "frame_step": self.recording.parameters.frame_step,
            "segments": len(self.indices()),
            "scan_hashes": list(self.recording.scan_hashes[self.first : self.last + 1]),
        }


def check_apart(sources: Sequence[Source]) -> None:
    """Check that no two sources share a scan.

    Raises:
        ValueError: two sources share a scan.
    """
    seen: dict[str, str] = {}
    for source in sources:
        name = f"{source.recording.name} scans {source.first} to {source.last}"
        hashes = set(source.recording.scan_hashes[source.first : source.last + 1])
        for scan in hashes & seen.keys():
            raise ValueError(f"{name} shares scans with {seen[scan]}. Use each scan only once.")
        seen |= dict.fromkeys(hashes, name)


@dataclass(frozen=True, slots=True)
class TrainingSet:
    """Distinct segments with labels.

    Attributes:
        segments: segments; coordinates are in the frame of each drive or of its site, meters.
        groups: int64 (segments,): group of each segment, from 0. Drives of one site share groups
            (`training.data.linking`); others do not.
        parameters: parameters of the voxel grid.
        neighborhood: float32 (segments, size): neighborhood of each segment in its capture,
            duplicates included, as in a robot's request; None if it was not computed.
        synthetic: bool (segments,): True for segments of synthetic towns; None if unknown.
        drives: int64 (segments,): index of each segment's source; None if unknown.
    """

    segments: Segments
    groups: Int64
    parameters: Parameters
    neighborhood: Float32 | None = None
    synthetic: Bool | None = None
    drives: Int64 | None = None

    @classmethod
    def of(
        cls, sources: Sequence[Source], neighborhood: NeighborhoodParameters | None = None
    ) -> "TrainingSet":
        """Build a training set from parts of recordings.

        Args:
            sources: parts of recordings.
            neighborhood: parameters of the neighborhood; None to leave the neighborhood out.

        Raises:
            ValueError: two sources share a scan, or they were segmented by different parameters.
        """
        check_apart(sources)
        if len({replace(source.recording.parameters, frame_step=1) for source in sources}) > 1:
            raise ValueError(
                "The recordings were segmented by different parameters. Prepare all of them again."
            )
        parts, groups = [], []
        around = []
        linker = Linker(LINK_METERS)
        shown = Counter(source.site for source in sources)
        for source in sources:
            # A site that one drive shows needs no links, so the drive keeps its frame.
            site = source.site if shown[source.site] > 1 else ""
            indices = source.indices()
            parts.append(source.segments(to_site=bool(site)))
            labels = np.unique(source.recording.groups[indices], return_inverse=True)[1]
            groups.append(linker.add(labels, parts[-1].centroids(), site))
            if neighborhood is not None:
                around.append(source.recording.neighborhood(neighborhood)[indices])
        return cls(
            Segments.concatenate(parts),
            np.concatenate(groups),
            sources[0].recording.parameters,
            np.concatenate(around) if around else None,
            np.repeat([source.synthetic for source in sources], [len(part) for part in parts]),
            np.repeat(np.arange(len(sources)), [len(part) for part in parts]),
        )

    def __len__(self) -> int:
        return len(self.segments)

    def recorded(self) -> "TrainingSet":
        """Return the segments of real streets; all segments if none is real.

        Synthetic streets teach single segments as well as real streets. They do not teach the
        principal axes of descriptors or the quantizer's step.
        """
        if self.synthetic is None or self.synthetic.all():
            return self
        return self.take(np.flatnonzero(~self.synthetic))

    def take(self, indices: Int64) -> "TrainingSet":
        """Return some of the segments, with groups renumbered from 0."""
        labels = np.unique(self.groups[indices], return_inverse=True)[1]
        around = None if self.neighborhood is None else self.neighborhood[indices]
        made_up = None if self.synthetic is None else self.synthetic[indices]
        drives = None if self.drives is None else self.drives[indices]
        return TrainingSet(
            self.segments.take(indices), labels, self.parameters, around, made_up, drives
        )

    def group_sizes(self) -> Int64:
        """Return the number of segments of each group, int64 (groups,)."""
        return np.bincount(self.groups)

    def without_small_groups(self, fewest: int) -> "TrainingSet":
        """Return the groups of at least `fewest` segments (paper III-C)."""
        return self.take(np.flatnonzero(self.group_sizes()[self.groups] >= fewest))

    def split(self, share: float, seed: int) -> tuple["TrainingSet", "TrainingSet"]:
        """Split into training and validation set; a share of the groups is held out."""
        learned, held_out = self.halves(share, seed)
        return self.take(learned), self.take(held_out)

    def halves(self, share: float, seed: int) -> tuple[Int64, Int64]:
        """Return the indices of kept and of held-out segments; groups are drawn at random."""
        groups = np.random.default_rng(seed).permutation(len(self.group_sizes()))
        held_out = np.isin(self.groups, groups[: round(share * len(groups))])
        return np.flatnonzero(~held_out), np.flatnonzero(held_out)
