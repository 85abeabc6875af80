"""Examples of the classes: descriptors and features of segments, with and without labels."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from placecell.core.segments import Segments
from placecell.core.types import Float32, Int64, UInt8
from placecell.datasets.labels import NO_CLASS
from placecell.descriptors.class_features import class_features
from placecell.descriptors.extractor import Extractor
from placecell.segmentation.recording import Recording
from training.classes.augmentation import lossy, varied
from training.classes.placing import placed_things

RECORDED_COPIES, SIMULATED_COPIES, UNLABELED_COPIES = 4, 1, 1
"""Number of altered copies of each segment of recorded, simulated and unlabeled drives."""


@dataclass(frozen=True, slots=True)
class LabeledDrive:
    """Drive for the training.

    Attributes:
        recording: segments of the drive.
        classes: class index of each segment, uint8 (segments,); None for a drive without labels.
    """

    recording: Recording
    classes: UInt8 | None = None

    def rows(self) -> Int64:
        """Return the rows of the segments that are used; of an unlabeled drive, distinct ones."""
        recording = self.recording
        every = np.arange(len(recording.segments))
        return every if self.classes is not None else np.flatnonzero(recording.distinct)

    @property
    def is_simulated(self) -> bool:
        """Return whether the drive is simulated."""
        return self.recording.name.startswith("town:")


@dataclass(frozen=True, slots=True)
class Examples:
    """Segments and altered copies of them.

    Attributes:
        inputs: descriptor and features side by side, float32 (n, inputs).
        classes: class index, uint8 (n,); `NO_CLASS` for an unlabeled one.
        groups: group of each example over all drives, int64 (n,).
        simulated: whether it is of a simulated drive, float32 (n,), 0 or 1.
        is_copy: whether it is an altered copy, float32 (n,), 0 or 1.
        is_cast: whether it is a thing that was cast, float32 (n,), 0 or 1.
    """

    inputs: Float32
    classes: UInt8
    groups: Int64
    simulated: Float32
    is_copy: Float32
    is_cast: Float32

    def __len__(self) -> int:
        return len(self.classes)

    def take(self, rows: Int64) -> "Examples":
        """Return some of the examples."""
        return Examples(
            self.inputs[rows],
            self.classes[rows],
            self.groups[rows],
            self.simulated[rows],
            self.is_copy[rows],
            self.is_cast[rows],
        )

    def labeled_as(self, classes: UInt8) -> "Examples":
        """Return the examples with other classes, without those that have none."""
        rows = np.flatnonzero(classes != NO_CLASS)
        some = self.take(rows)
        return replace(some, classes=classes[rows])

    @classmethod
    def joined(cls, parts: Sequence["Examples"]) -> "Examples":
        """Concatenate examples."""
        return cls(
            np.concatenate([part.inputs for part in parts]),
            np.concatenate([part.classes for part in parts]),
            np.concatenate([part.groups for part in parts]),
            np.concatenate([part.simulated for part in parts]),
            np.concatenate([part.is_copy for part in parts]),
            np.concatenate([part.is_cast for part in parts]),
        )


def examples_of(drives: Sequence[LabeledDrive], extractor: Extractor, seed: int) -> Examples:
    """Return the segments of drives, their altered copies, and things cast in simulated drives.

    Args:
        drives: drives, of which no two share a group.
        extractor: extractor of the frozen model.
        seed: seed of the copies.
    """
    parts, groups = [], 0
    for number, drive in enumerate(drives):
        some = examples_of_drive(drive, extractor, np.random.default_rng([seed, number]))
        parts.append(replace(some, groups=some.groups + groups))
        groups += int(drive.recording.groups.max(initial=-1)) + 1
    return Examples.joined(parts)


def examples_of_drive(
    drive: LabeledDrive, extractor: Extractor, rng: np.random.Generator
) -> Examples:
    """Return the segments of a drive, altered copies, and things cast if it is simulated.

    Args:
        drive: drive.
        extractor: extractor of the frozen model.
        rng: random number generator of the copies and the things.
    """
    recording, rows = drive.recording, drive.rows()
    count, parts = len(rows), []
    classes = np.full(count, NO_CLASS, np.uint8)
    if drive.classes is not None:
        classes = drive.classes[rows]
    around = extractor.manifest.neighborhood
    seen = None if around is None else recording.neighborhood(around)[rows]
    for copy, segments in enumerate(altered(drive, classes, rng)):
        parts.append(
            Examples(
                inputs_of(extractor, segments, seen),
                classes,
                recording.groups[rows],
                simulated=np.full(count, drive.is_simulated, np.float32),
                is_copy=np.full(count, copy > 0, np.float32),
                is_cast=np.zeros(count, np.float32),
            )
        )
    if drive.is_simulated and drive.classes is not None:
        placed = placed_things(recording.segments, classes, rng)
        beside = None if seen is None else seen[placed.places]
        ones = np.ones(len(placed.classes), np.float32)
        parts.append(
            Examples(
                inputs_of(extractor, placed.segments, beside),
                placed.classes,
                recording.groups[placed.places],
                simulated=ones,
                is_copy=ones,
                is_cast=ones,
            )
        )
    return Examples.joined(parts)


def altered(drive: LabeledDrive, classes: UInt8, rng: np.random.Generator) -> list[Segments]:
    """Return the segments of a drive, and altered copies of them."""
    segments = drive.recording.segments.take(drive.rows())
    if drive.is_simulated:
        captures = drive.recording.captures[drive.rows()]
        copies = [varied(segments, classes, captures, rng) for _ in range(SIMULATED_COPIES)]
    else:
        number = UNLABELED_COPIES if drive.classes is None else RECORDED_COPIES
        copies = [lossy(segments, rng) for _ in range(number)]
    return [segments, *copies]


def inputs_of(extractor: Extractor, segments: Segments, neighborhood: Float32 | None) -> Float32:
    """Return the inputs of the head side by side: descriptor and features."""
    described = extractor.describe(segments, neighborhood)
    return np.concatenate([described, class_features(segments)], axis=1)
