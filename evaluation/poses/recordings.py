"""Recordings: the segments of a whole drive, made now or prepared before."""

from pathlib import Path

import numpy as np

from placecell.core.parameters import PROTOCOL_V1, Parameters
from placecell.datasets import Drive
from placecell.segmentation.pipeline import Progress, record, silent
from placecell.segmentation.recording import Recording


def recording_of(
    drive: Drive,
    every: int | None = None,
    prepared: Path | None = None,
    progress: Progress = silent,
    protocol: Parameters = PROTOCOL_V1,
) -> Recording:
    """Return the segments of a drive by a protocol.

    Args:
        drive: the drive.
        every: scans from one capture to the next, as `Parameters.for_drive`.
        prepared: file of `placecell prepare`; None: segment the drive now.
        progress: wraps the loop.
        protocol: parameters of the segmentation.

    Raises:
        ValueError: the prepared file is of another drive or has other parameters.
    """
    parameters = protocol.for_drive(len(drive), every)
    if prepared is None:
        return record(drive, parameters, progress=progress)
    recording = Recording.load(prepared)
    if not is_of(recording, drive):
        raise ValueError(f"{prepared} is not a recording of {drive.folder}. Prepare this drive.")
    if recording.parameters != parameters:
        own = recording.parameters
        raise ValueError(
            f"{prepared} has other parameters (protocol {own.protocol}, --every {own.frame_step}) "
            f"than protocol {parameters.protocol} with --every {parameters.frame_step}. Prepare "
            "the drive again, or give its protocol with --segmentation."
        )
    return recording


def is_of(recording: Recording, drive: Drive) -> bool:
    """Return whether a recording is of a drive; compares the first and the last scan."""
    return (
        recording.scans == len(drive)
        and bool(np.isclose(recording.path_length, drive.path_length()))
        and all(recording.scan_hashes[at] == drive.scan_hash(at) for at in (0, -1))
    )
