"""Options for reading the files of a drive that do not describe themselves."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from placecell.core.progress import Progress
from placecell.core.progress import silent as no_progress
from placecell.trajectories.times import TimeUnit

DType = Literal["float32", "float64"]
Order = Literal["rows", "columns"]
Unit = Literal["m", "cm", "mm", "ft", "us-ft"]

KISS_ICP, RKO_LIO, NO_ODOMETRY = "kiss-icp", "rko-lio", "none"
"""Values of `ScanOptions.odometry` that are no topic."""

METERS: dict[Unit, float] = {"m": 1.0, "cm": 0.01, "mm": 0.001, "ft": 0.3048, "us-ft": 1200 / 3937}
"""Meters in each unit; `ft` is the international foot, `us-ft` that of US surveys."""


def silent(message: str) -> None:
    """Ignore a message."""


@dataclass(frozen=True, slots=True)
class ScanOptions:
    """Options for reading a drive; the defaults infer everything from the files' content.

    Attributes:
        columns: names of a scan's columns, x, y and z among them; none: found from the content.
        dtype: type of a scan's values; none: found from the content.
        order: `rows` if a point's values follow each other, `columns` if a column's do.
        unit: unit of the scans' coordinates.
        time_unit: unit of `times.txt`.
        strict: refuse a drive with scans that cannot be used or points that are not finite.
        topic: topic of a bag with the clouds; none: the only one, or the one with the most points.
        poses: file of a trajectory; none: the source's own poses, or odometry.
        pose_offset: seconds to add to the times of `poses`; none: 0, or found if it is sure.
        odometry: topic of a bag with the poses, `kiss-icp`, `rko-lio`, or `none` to use none of
            them: then a bag needs `poses`; None: chosen from the source's content.
        extrinsic: mount of the sensor in the frame of the poses, as `parse_extrinsic` takes it;
            none: as the source states it, else identity.
        deskew: move points that have times to the scan's time.
        progress: shows the progress of odometry.
        tell: receives a line about what was found in the files and how it was handled.
    """

    columns: tuple[str, ...] | None = None
    dtype: DType | None = None
    order: Order = "rows"
    unit: Unit = "m"
    time_unit: TimeUnit = "s"
    strict: bool = False
    topic: str | None = None
    poses: Path | None = None
    pose_offset: float | None = None
    odometry: str | None = None
    extrinsic: str | None = None
    deskew: bool = True
    progress: Progress = no_progress
    tell: Callable[[str], None] = silent

    @property
    def states_layout(self) -> bool:
        """Return whether the options state the layout of scans."""
        return self.columns is not None or self.dtype is not None or self.order != "rows"

    @property
    def odometry_topic(self) -> str | None:
        """Topic of a bag with the poses, if the options state one."""
        return None if self.odometry in (None, KISS_ICP, RKO_LIO, NO_ODOMETRY) else self.odometry


_current: ContextVar[ScanOptions] = ContextVar("reading", default=ScanOptions())  # noqa: B039 -- frozen


def current_scan_options() -> ScanOptions:
    """Return the options that `open_drive` uses by default."""
    return _current.get()


@contextmanager
def use_scan_options(options: ScanOptions) -> Iterator[None]:
    """Use these options for all drives that are opened inside the block."""
    token = _current.set(options)
    try:
        yield
    finally:
        _current.reset(token)


def parse_columns(text: str) -> tuple[str, ...]:
    """Parse `x,y,z,intensity,ring`, or a number of columns of which the first are x, y, z.

    Raises:
        ValueError: x, y or z is missing or stands twice, or the number is not from 3 to 64.
    """
    if text.strip().isdecimal():
        count = int(text)
        if not 3 <= count <= 64:
            raise ValueError(f"--columns {count}: expected 3 to 64 columns")
        return ("x", "y", "z", *(f"column_{number}" for number in range(3, count)))
    names = tuple(name.strip().lower() for name in text.split(","))
    if not all(names.count(axis) == 1 for axis in "xyz") or len(names) > 64 or "" in names:
        raise ValueError(
            f"--columns {text!r}: expected a number of columns, or their names with x, y and z "
            "once each, such as x,y,z,intensity,ring"
        )
    return names
