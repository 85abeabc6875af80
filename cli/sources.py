"""Input of the commands: drives and recordings, whole or in part, and towns."""

import re
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from cli.errors import clear_errors, fail
from cli.tables import show

if TYPE_CHECKING:
    from collections.abc import Sequence

    from placecell.core.parameters import Parameters
    from placecell.core.types import Float64
    from placecell.datasets import Drive
    from placecell.segmentation.recording import Recording
    from training.data.training_set import Source

__all__ = ["clear_errors", "fail", "load", "show", "source", "sources"]

SOURCE_HELP = (
    "Drive (a bag, an MCAP file, a folder of scans, or a folder in the KITTI, MulRan or HeLiPR "
    "layout) or recording file from 'placecell prepare'. "
    "@FIRST:LAST selects the groups that lie wholly within these scans, both included."
)

TOWN_HELP = (
    " town:SEED is a simulated drive through the synthetic town with that seed, and "
    "town:SEED:SENSOR:PLACE one with another sensor or in another place, such as town:11:vlp-16 or "
    "town:11:os1-64:campus."
)

ROBOT_B = "+robot-b"

ROBOT_B_HELP = (
    " With +robot-b at its end, such as town:11:vlp-16+robot-b, it is robot B's drive: the same "
    "way in the opposite direction, among other parked cars. Drives through one place share the "
    "groups of what they both see."
)

DEFAULT_SENSOR = "hdl-64e"

DEFAULT_PLACE = "streets"

TOWN_SCANS = 300
"""Number of scans of each robot's drive through a training town."""


def parse_scans(text: str) -> tuple[int, int]:
    """Parse FIRST:LAST, both included.

    Raises:
        ValueError: the text is not two ascending numbers.
    """
    match = re.fullmatch(r"(\d+):(\d+)", text)
    if not match or int(match[1]) > int(match[2]):
        raise ValueError(f"Invalid scans {text!r}: expected FIRST:LAST, such as 300:500.")
    return int(match[1]), int(match[2])


def protocol_named(name: str) -> "Parameters":
    """Return the parameters of a segmentation protocol.

    Raises:
        ValueError: there is no such protocol.
    """
    from placecell.core.parameters import PROTOCOLS

    if name not in PROTOCOLS:
        raise ValueError(f"Invalid --segmentation {name!r}: expected {' or '.join(PROTOCOLS)}.")
    return PROTOCOLS[name]


def load(path: Path, every: int | None = None, protocol: "Parameters | None" = None) -> "Recording":
    """Load a recording file, or segment a drive: a folder or a file, told by its content.

    Args:
        path: the file or the folder.
        every: scans from one capture to the next, as `Parameters.for_drive`.
        protocol: parameters of the segmentation; None for protocol v1, or those of the recording.

    Raises:
        ValueError: the recording has other parameters, or the drive has no segments.
    """
    from placecell.core.parameters import PROTOCOL_V1
    from placecell.datasets import open_drive
    from placecell.segmentation.pipeline import record
    from placecell.segmentation.recording import Recording, is_recording

    if is_recording(path) or path.suffix == ".safetensors":
        recording = Recording.load(path)
        step = recording.parameters.frame_step
        if every is not None and every != step:
            raise ValueError(
                f"{path} was prepared with --every {step}, not {every}; prepare the drive again"
            )
        own = recording.parameters.protocol
        if protocol is not None and protocol.protocol != own:
            raise ValueError(
                f"{path} was prepared with --segmentation {own}, not {protocol.protocol}. Prepare "
                "the drive again."
            )
        return recording
    drive = open_drive(path)
    parameters = (protocol or PROTOCOL_V1).for_drive(len(drive), every)
    recording = record(drive, parameters, progress=show)
    refuse_nothing(drive, [recording])
    return recording


def refuse_nothing(drive: "Drive", recordings: "Sequence[Recording]") -> None:
    """Refuse a drive without segments; the error describes its scans.

    Raises:
        ValueError: no recording holds a segment.
    """
    import numpy as np

    if any(len(recording.segments) for recording in recordings):
        return
    some = np.unique(np.linspace(0, len(drive) - 1, 8).astype(int))
    scans = [scan for scan in (drive.scan(int(index)) for index in some) if len(scan)]
    ranges = np.concatenate([np.linalg.norm(scan, axis=1) for scan in scans] or [np.zeros(1)])
    raise ValueError(
        f"{drive.folder}: no segments were found in {len(drive)} scans of "
        f"{np.mean([len(scan) for scan in scans] or [0]):,.0f} points (median range "
        f"{np.median(ranges):.1f} m), read as {drive.content}. A segment is an object of 100 "
        "points or more that stands on the ground within 60 m of the sensor. Check that z points "
        "up, the unit (--unit), the columns (--columns), and that the poses are sensor poses"
    )


def split_source(text: str) -> tuple[Path, tuple[int, int] | None]:
    """Split PATH or PATH@FIRST:LAST into path and scans."""
    path, at, scans = text.rpartition("@")
    if at and re.fullmatch(r"\d+:\d+", scans):
        return Path(path), parse_scans(scans)
    return Path(text), None


def sources(texts: Iterable[str]) -> "list[Source]":
    """Load drives, parts of drives, and towns.

    `town:SEED` is robot A's drive through that town, and `town:SEED+robot-b` robot B's. Both show
    the same site, so that training treats the same houses as the same groups.
    """
    return list(each_source(texts))


def each_source(texts: Iterable[str]) -> "Iterator[Source]":
    """Load drives, parts of drives, and towns, one after the other (see `sources`)."""
    for text in texts:
        yield town_source(text) if text.startswith("town:") else source(text)


def town_source(text: str) -> "Source":
    """Simulate and segment one robot's drive through a town, town:SEED:SENSOR:PLACE[+robot-b].

    Raises:
        ValueError: the text has another form, or the sensor or the place is unknown.
    """
    from training.data.training_set import Source

    seed, sensor, place = parse_town(text.removesuffix(ROBOT_B))
    recording, origin = town_drive(seed, TOWN_SCANS, sensor, place, opposite=text.endswith(ROBOT_B))
    site = f"town:{seed}:{place}"
    return Source(replace(recording, name=text), 0, recording.scans - 1, site, origin)


OTHER_CARS = "+other-cars"


def other_day(text: str) -> tuple[str, bool]:
    """Split town:SEED:SENSOR:PLACE+other-cars into the drive and whether it is another day."""
    return text.removesuffix(OTHER_CARS), text.endswith(OTHER_CARS)


def parse_town(text: str) -> tuple[int, str, str]:
    """Parse town:SEED, town:SEED:SENSOR or town:SEED:SENSOR:PLACE.

    Returns:
        The seed and the names of the sensor and the place.

    Raises:
        ValueError: the text has another form, or the sensor or the place is unknown.
    """
    from town import sensor
    from town.places.catalog import kind_of

    match = re.fullmatch(r"town:(\d+)(?::([^:]+))?(?::([^:]+))?", text)
    if not match:
        raise ValueError(
            f"Invalid town {text!r}: expected town:SEED, town:SEED:SENSOR or "
            "town:SEED:SENSOR:PLACE, such as town:11:vlp-16."
        )
    seed, name, place = match.groups(default="")
    sensor(name or DEFAULT_SENSOR)
    kind_of(place or DEFAULT_PLACE)
    return int(seed), name or DEFAULT_SENSOR, place or DEFAULT_PLACE


def town_recordings(
    seed: int, scans: int, sensor: str = DEFAULT_SENSOR, place: str = DEFAULT_PLACE
) -> "list[Recording]":
    """Simulate two robots in a synthetic town or place and return their recordings."""
    import town

    with tempfile.TemporaryDirectory(prefix="placecell-town-") as folder:
        lidar = town.sensor(sensor)
        drives = town.two_robots(
            Path(folder), seed=seed, scans=scans, place=place, lidar=lidar, progress=show
        )
        return [load(drive) for drive in drives]


def town_drive(
    seed: int, scans: int, sensor: str, place: str, *, opposite: bool
) -> "tuple[Recording, Float64]":
    """Simulate robot A or B in a synthetic town or place.

    Returns:
        The recording, and the transform from the drive's world to the town frame, (4, 4).
    """
    import town

    with simulated_drive(seed, scans, sensor, place, opposite=opposite) as drive:
        return load(drive), town.read_origin(drive)


@contextmanager
def simulated_drive(
    seed: int,
    scans: int,
    sensor: str,
    place: str,
    *,
    opposite: bool = False,
    labels: bool = False,
    other_cars: bool = False,
) -> "Iterator[Path]":
    """Simulate one robot's drive (see `town.one_robot`); its scans are deleted at the end."""
    import town

    with tempfile.TemporaryDirectory(prefix="placecell-town-") as folder:
        yield town.one_robot(
            Path(folder),
            seed,
            scans,
            place=place,
            lidar=town.sensor(sensor),
            opposite=opposite,
            labels=labels,
            other_cars=other_cars,
            progress=show,
        )


def source(text: str) -> "Source":
    """Load a drive or a part of it."""
    from training.data.training_set import Source

    path, scans = split_source(text)
    recording = load(path)
    return Source(recording, *(scans or (0, recording.scans - 1)))
