"""Drives with the true class of each segment: simulated ones, and folders with labels."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from cli.sources import (
    TOWN_SCANS,
    load,
    other_day,
    parse_town,
    protocol_named,
    refuse_nothing,
    show,
    simulated_drive,
    split_source,
)

if TYPE_CHECKING:
    from placecell.core.types import UInt8
    from placecell.datasets import Drive
    from placecell.segmentation.recording import Recording

AUTO = "auto"


def load_labeled(
    text: str, every: int | None = None, segmentation: str = AUTO, scans: int | None = None
) -> "tuple[Recording, UInt8 | None]":
    """Return the segments of a drive, and the class index of each if the drive has labels.

    Args:
        text: path of a drive or a recording, PATH@FIRST:LAST, or town:SEED:SENSOR:PLACE, with
            `+other-cars` for the same drive on another day.
        every: scans from one capture to the next.
        segmentation: name of the protocol; `auto` for the one that suits the drive.
        scans: number of scans of a simulated drive.

    Raises:
        ValueError: The drive has no segments, or an option does not suit it.
    """
    from placecell.datasets import open_drive
    from placecell.segmentation.recording import is_recording

    if text.startswith("town:"):
        return simulated(text, every, segmentation, scans or TOWN_SCANS)
    if scans is not None:
        raise ValueError("--scans needs a simulated drive, such as town:901.")
    path, part = split_source(text)
    if is_recording(path) or path.suffix == ".safetensors":
        if part:
            raise ValueError(f"{text}: name scans of a drive, not of a recording.")
        wanted = None if segmentation == AUTO else protocol_named(segmentation)
        return load(path, every, wanted), None
    drive = open_drive(path)
    if part and part[1] >= len(drive):
        raise ValueError(f"{text}: the last scan of {path} is {len(drive) - 1}.")
    chosen = range(part[0], part[1] + 1) if part else None
    return segmented_with_labels(drive, every, segmentation, chosen)


def simulated(
    text: str, every: int | None, segmentation: str, scans: int
) -> "tuple[Recording, UInt8 | None]":
    """Simulate robot A's drive of town:SEED:SENSOR:PLACE with labels."""
    from placecell.datasets import open_drive

    name, other_cars = other_day(text)
    seed, sensor, place = parse_town(name)
    with simulated_drive(seed, scans, sensor, place, labels=True, other_cars=other_cars) as drive:
        recording, labels = segmented_with_labels(open_drive(drive), every, segmentation)
    return replace(recording, name=text), labels


def segmented_with_labels(
    drive: "Drive", every: int | None, segmentation: str, scans: range | None = None
) -> "tuple[Recording, UInt8 | None]":
    """Segment a drive, and read the class of each segment if the drive has labels."""
    from placecell.core.parameters import PROTOCOL_SPARSE, PROTOCOL_V1
    from placecell.datasets.labels import has_labels
    from placecell.segmentation.pipeline import record
    from placecell.segmentation.protocol_choice import is_sparse
    from placecell.segmentation.segment_labels import segment_classes

    protocol = PROTOCOL_V1 if segmentation == AUTO else protocol_named(segmentation)
    recording = record(drive, protocol.for_drive(len(drive), every), scans, show)
    if segmentation == AUTO and is_sparse([recording]):
        protocol = PROTOCOL_SPARSE
        recording = record(drive, protocol.for_drive(len(drive), every), scans, show)
    refuse_nothing(drive, [recording])
    return recording, segment_classes(drive, recording, show) if has_labels(drive) else None


def cached_labeled(
    text: str, every: int | None, scans: int | None, cache: Path | None
) -> "tuple[Recording, UInt8 | None]":
    """Return the result of `load_labeled`; simulated drives are kept in a folder.

    Args:
        text, every, scans: see `load_labeled`.
        cache: folder of the kept drives; None to keep none.
    """
    import numpy as np

    from placecell.segmentation.recording import Recording

    if cache is None or not text.startswith("town:"):
        return load_labeled(text, every, AUTO, scans)
    file = cache / f"{text.replace(':', '-')}-{scans}-{every}.safetensors"
    if file.exists() and file.with_suffix(".npy").exists():
        return replace(Recording.load(file), name=text), np.load(file.with_suffix(".npy"))
    recording, classes = load_labeled(text, every, AUTO, scans)
    cache.mkdir(parents=True, exist_ok=True)
    assert classes is not None
    np.save(file.with_suffix(".npy"), classes)
    recording.save(file)
    return recording, classes
