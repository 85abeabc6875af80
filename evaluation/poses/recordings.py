"""The segments of a whole drive: made now, or prepared before."""

from pathlib import Path

import numpy as np

from placecell.core.parameters import PROTOCOL_V1
from placecell.datasets import Drive
from placecell.segmentation.pipeline import Progress, record, silent
from placecell.segmentation.recording import Recording


def recording_of(
    drive: Drive,
    every: int | None = None,
    prepared: Path | None = None,
    progress: Progress = silent,
) -> Recording:
    """A drive's segments by protocol v1.

    Args:
        every: a frame every so many scans, as `Parameters.for_drive`.
        prepared: what `placecell prepare` made of this drive; made now unless given.

    Raises:
        ValueError: what is prepared is of another drive, or by other parameters.
    """
    parameters = PROTOCOL_V1.for_drive(len(drive), every)
    if prepared is None:
        return record(drive, parameters, progress=progress)
    recording = Recording.load(prepared)
    if not is_of(recording, drive):
        raise ValueError(f"{prepared}: is of another drive than {drive.folder}")
    if recording.parameters != parameters:
        raise ValueError(
            f"{prepared}: prepared by other parameters than protocol {parameters.protocol} with "
            f"--every {parameters.frame_step}; prepare the drive again"
        )
    return recording


def is_of(recording: Recording, drive: Drive) -> bool:
    """Whether a recording was made of a drive; of its scans the first and the last are read."""
    return (
        recording.scans == len(drive)
        and bool(np.isclose(recording.path_length, drive.path_length()))
        and all(recording.scan_hashes[at] == drive.scan_hash(at) for at in (0, -1))
    )
