"""Files without a header: `.bin` files as KITTI, nuScenes, Waymo and others write them."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from placecell.sources.clouds.cloud import Cloud, read_content
from placecell.sources.errors import DriveError
from placecell.sources.point_layout import (
    ITEM_SIZES,
    TYPES,
    PointLayout,
    find_layout,
    implausible,
)
from placecell.sources.scan_options import ScanOptions

IMPLAUSIBLE = 0.4
"""Share of values that no sensor gives, from which a file is of another kind."""


def layout_of(files: Sequence[Path], options: ScanOptions) -> PointLayout:
    """Find the layout of files without a header.

    Raises:
        DriveError: the layout is not sure.
    """
    return find_layout(files, [file.stat().st_size for file in files], options)


def read_raw(file: Path, layout: PointLayout) -> Cloud:
    """Read a file without a header.

    A file of point times beside it, such as `times_00.bin` for `points_00.bin`, is read as well.

    Raises:
        DriveError: the file is cut short, or its values are no coordinates.
    """
    content = read_content(file)
    if len(content) % layout.point_bytes:
        raise DriveError(
            f"{file}: {len(content):,} bytes is no whole number of points ({layout.point_bytes} "
            f"bytes each: {layout}); the file is cut short or of another kind"
        )
    table = layout.as_table(np.frombuffer(content, TYPES[layout.dtype]))
    values = {name: table[:, index] for index, name in enumerate(layout.columns)}
    points = np.stack([values[axis] for axis in "xyz"])
    if implausible(points) > IMPLAUSIBLE:
        raise DriveError(
            f"{file}: most values are no coordinates as {layout}; the file is damaged or of "
            "another kind"
        )
    remarks: tuple[str, ...] = ()
    times = times_beside(file)
    if times is not None and "time" not in values:
        content = read_content(times)
        for kind, size in ITEM_SIZES.items():
            if len(content) == size * len(table):
                values["time"] = np.frombuffer(content, TYPES[kind])
                remarks = (f"the times of the points are in {times.name}",)
    return Cloud(values, tuple(values), remarks)


def times_beside(file: Path) -> Path | None:
    """Return the file of point times that belongs to a file of points, if there is one."""
    for word in ("points", "point", "cloud", "scan"):
        if word in file.name and "time" not in file.name:
            times = file.with_name(file.name.replace(word, "times"))
            if times.is_file():
                return times
    return None
