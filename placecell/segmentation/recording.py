"""Recording: all segments of a drive, prepared for training and evaluation.

The file format is safetensors: columns are tensors, other values are JSON in the header's metadata.
It holds no code, so a recording from an unknown source is safe to load.
`docs/reference/recording-file.md` describes it.
"""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import safetensors
from numpy.typing import NDArray
from safetensors.numpy import save_file

from placecell.core.files import written_whole
from placecell.core.parameters import NeighborhoodParameters, Parameters
from placecell.core.segments import Segments
from placecell.core.types import Bool, Float32, Int64
from placecell.descriptors.neighborhood import describe_neighborhood

FORMAT = "placecell-recording"
VERSION = 1
COLUMNS = {
    "points": ("float32", (3,)),
    "ends": ("int64", ()),
    "sensors": ("float32", (3,)),
    "frames": ("int64", ()),
    "groups": ("int64", ()),
    "distinct": ("bool", ()),
}
"""Element type and row shape of each column. The keys are those of the file."""


LONGEST_HEADER = 100_000_000
"""Largest size of a safetensors header, bytes, as the library limits it."""


def is_recording(path: Path) -> bool:
    """Return whether a path is a file in the carrier format of recordings, by its first bytes."""
    try:
        with path.open("rb") as file:
            head = file.read(9)
    except OSError:
        return False
    return (
        len(head) == 9 and head[8:] == b"{" and int.from_bytes(head[:8], "little") <= LONGEST_HEADER
    )


class RecordingError(ValueError):
    """File that is no valid recording of this version."""


@dataclass(frozen=True, slots=True)
class Recording:
    """Segments of a drive in time order.

    Attributes:
        name: name of the drive.
        parameters: parameters of the segmentation, with the protocol's name.
        segments: segments in the drive's world frame.
        captures: int64 (segments,), index of the scan at which each segment was captured.
        groups: int64 (segments,), group of each segment, from 0.
        distinct: bool (segments,), false for duplicates within their group.
        scans: number of scans of the drive.
        scan_hashes: hash of each scan, which shows whether a model was trained on it.
        path_length: length of the path, meters.
        part: scans of the recording if it is a part of the drive; None for the whole drive.
        skipped_scans: indices of scans that could not be used.
        dropped_points: number of points of the other scans that were not finite.
    """

    name: str
    parameters: Parameters
    segments: Segments
    captures: Int64
    groups: Int64
    distinct: Bool
    scans: int
    scan_hashes: tuple[str, ...]
    path_length: float
    part: range | None = None
    skipped_scans: tuple[int, ...] = ()
    dropped_points: int = 0

    def __repr__(self) -> str:
        return (
            f"Recording({self.name!r}, {len(self.segments):,} segments, {self.scans:,} scans, "
            f"{self.path_length:.0f} m)"
        )

    @property
    def capture_scans(self) -> range:
        """Scans that are captures, with or without segments."""
        scans = range(self.scans) if self.part is None else self.part
        return scans[:: self.parameters.frame_step]

    def within(self, first: int, last: int) -> Bool:
        """Return whether each segment's group is entirely within the scans, bool (segments,).

        Args:
            first: index of the first scan.
            last: index of the last scan (included).
        """
        count = int(self.groups.max(initial=-1)) + 1
        earliest = np.full(count, np.iinfo(np.int64).max)
        latest = np.full(count, -1)
        np.minimum.at(earliest, self.groups, self.captures)
        np.maximum.at(latest, self.groups, self.captures)
        return ((earliest >= first) & (latest <= last))[self.groups]

    def neighborhood(self, parameters: NeighborhoodParameters) -> Float32:
        """Return the neighborhood of each segment in its capture, float32 (segments, size)."""
        return describe_neighborhood(self.segments, self.captures, parameters)

    def save(self, file: Path) -> None:
        """Write the recording as safetensors.

        Raises:
            RecordingError: The recording is a part of its drive, which the format cannot express.
        """
        if self.part is not None:
            raise RecordingError(
                f"{file}: a file holds a whole drive, not only scans {self.part.start} to "
                f"{self.part.stop - 1}. Record the drive without naming scans"
            )
        header = {
            "format": FORMAT,
            "version": VERSION,
            "name": self.name,
            "parameters": self.parameters.as_dict(),
            "scans": self.scans,
            "scan_hashes": list(self.scan_hashes),
            "path_length_m": self.path_length,
        }
        if self.skipped_scans or self.dropped_points:
            # Optional keys: the file of a drive without dropouts does not have them.
            header["skipped_scans"] = list(self.skipped_scans)
            header["dropped_points"] = self.dropped_points
        columns = {
            "points": self.segments.points,
            "ends": self.segments.ends,
            "sensors": self.segments.sensors,
            "frames": self.captures,
            "groups": self.groups,
            "distinct": self.distinct,
        }
        with written_whole(file) as unfinished:
            unfinished.touch()
            mode = unfinished.stat().st_mode  # that of any new file; safetensors writes 0600
            save_file(
                # safetensors writes the memory of a view without regard to its strides.
                {name: np.ascontiguousarray(column) for name, column in columns.items()},
                unfinished,
                metadata={"header": json.dumps(header, sort_keys=True)},
            )
            unfinished.chmod(mode)

    @classmethod
    def load(cls, file: Path) -> "Recording":
        """Read a recording.

        Raises:
            RecordingError: The file cannot be read, or has another format or version.
        """
        try:
            with safetensors.safe_open(file, framework="numpy") as content:
                header = json.loads((content.metadata() or {})["header"])
                columns = {name: content.get_tensor(name) for name in content.keys()}  # noqa: SIM118
            if header["format"] != FORMAT or header["version"] != VERSION:
                raise RecordingError(
                    f"{file}: has the format {header['format']} version {header['version']}; "
                    f"expected {FORMAT} version {VERSION}. Prepare the drive again"
                )
            check_columns(columns, file)
            parameters = header["parameters"]
            return cls(
                name=header["name"],
                parameters=Parameters(**parameters | {"grid": tuple(parameters["grid"])}),
                segments=Segments(columns["points"], columns["ends"], columns["sensors"]),
                captures=columns["frames"],
                groups=columns["groups"],
                distinct=columns["distinct"],
                scans=header["scans"],
                scan_hashes=tuple(header["scan_hashes"]),
                path_length=header["path_length_m"],
                skipped_scans=tuple(header.get("skipped_scans", ())),
                dropped_points=header.get("dropped_points", 0),
            )
        except (
            OSError,
            safetensors.SafetensorError,
            KeyError,
            TypeError,
            json.JSONDecodeError,
        ) as error:
            raise RecordingError(f"{file}: not a recording of segments ({error})") from error


def check_columns(columns: dict[str, NDArray[Any]], file: Path) -> None:
    """Check that columns fit together; otherwise they would be read as other segments.

    Raises:
        RecordingError: A column has another type, shape or length, or holds invalid values.
    """
    count = len(columns["ends"])
    for name, (kind, row) in COLUMNS.items():
        column = columns[name]
        if column.dtype != kind or column.shape[1:] != row:
            raise RecordingError(f"{file}: {name} is {column.dtype} {column.shape}, not {kind}")
        if name != "points" and len(column) != count:
            raise RecordingError(f"{file}: {name} has {len(column)} rows, ends has {count}")
    counts = np.diff(columns["ends"], prepend=0)
    if (counts <= 0).any() or counts.sum() != len(columns["points"]):
        raise RecordingError(f"{file}: ends do not divide the {len(columns['points'])} points")
    if (columns["groups"] < 0).any():
        raise RecordingError(f"{file}: groups has a negative number")
