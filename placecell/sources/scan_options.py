"""Options for reading the files of a drive that do not describe themselves."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import Literal

DType = Literal["float32", "float64"]
Order = Literal["rows", "columns"]
Unit = Literal["m", "cm", "mm"]
TimeUnit = Literal["s", "ms", "us", "ns"]

METERS: dict[Unit, float] = {"m": 1.0, "cm": 0.01, "mm": 0.001}
SECONDS: dict[TimeUnit, float] = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}


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
        odometry: topic of a bag with the poses; none: chosen from the bag's content.
        tell: receives a line about what was found in the files and how it was handled.
    """

    columns: tuple[str, ...] | None = None
    dtype: DType | None = None
    order: Order = "rows"
    unit: Unit = "m"
    time_unit: TimeUnit = "s"
    strict: bool = False
    topic: str | None = None
    odometry: str | None = None
    tell: Callable[[str], None] = silent

    @property
    def states_layout(self) -> bool:
        """Return whether the options state the layout of scans."""
        return self.columns is not None or self.dtype is not None or self.order != "rows"


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
