"""Damaged bags of all kinds give a result or a clear error."""

from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from placecell.sources.bags import BagSource, Mcap, Ros1Bag, Ros2Bag
from placecell.sources.errors import DriveError
from tests.placecell.sources.bags.bag_builders import (
    PERIOD_NS,
    START_NS,
    BagWriter,
    Layout,
    Message,
    cloud_message,
    cloud_of,
    livox_message,
    odometry_message,
    transforms_message,
    write_mcap,
    write_ros1,
    write_ros2,
    xyz,
)
from tests.placecell.sources.mutations import check_reader

LAYOUT = Layout({"x": "f4", "y": "f4", "z": "f8", "t": "u4"}, gap=2, row_gap=3, rows=2)
CLASSES: dict[str, Callable[[Path], BagSource]] = {".bag": Ros1Bag, ".db3": Ros2Bag, ".mcap": Mcap}

SMALL_CHUNKS = 500
FORMATS: dict[str, tuple[str, BagWriter]] = {
    "none.bag": ("ros1", lambda p, m: write_ros1(p, m, chunk_bytes=SMALL_CHUNKS)),
    "lz4.bag": ("ros1", lambda p, m: write_ros1(p, m, "lz4", SMALL_CHUNKS)),
    "bz2.bag": ("ros1", lambda p, m: write_ros1(p, m, "bz2", SMALL_CHUNKS)),
    "plain.db3": ("cdr", lambda p, m: only(write_ros2(p.parent / "bag", m))),
    "message.db3": (
        "cdr",
        lambda p, m: only(write_ros2(p.parent / "bag", m, "sqlite3", "message")),
    ),
    "none.mcap": ("cdr", lambda p, m: write_mcap(p, m, compression="none")),
    "zstd.mcap": ("cdr", lambda p, m: write_mcap(p, m, chunk_bytes=SMALL_CHUNKS)),
    "lz4.mcap": ("ros1", lambda p, m: write_mcap(p, m, "ros1", "lz4", chunk_bytes=SMALL_CHUNKS)),
    "no_index.mcap": ("cdr", lambda p, m: write_mcap(p, m, indexed=False)),
    "no_chunks.mcap": ("cdr", lambda p, m: write_mcap(p, m, chunked=False)),
}


def only(folder: Path) -> Path:
    (file,) = folder.glob("*.db3*")
    return file


def messages(encoding: str) -> Sequence[Message]:
    """Return three clouds, a message of Livox, odometry and transforms."""
    random = np.random.default_rng(0)
    made: list[Message] = []
    mount = np.eye(4)
    made.append(
        ("/tf_static", START_NS, transforms_message([("base_link", "lidar", mount)], 1, encoding))
    )
    for n in range(3):
        stamp = START_NS + n * PERIOD_NS
        points = random.normal(0, 9, (10, 3))
        columns = xyz(points) | {"t": np.arange(10) * 10**7}
        made.append(("/points", stamp, cloud_message(cloud_of(columns, LAYOUT, stamp), encoding)))
        pose = np.eye(4)
        pose[0, 3] = n
        made.append(("/odom", stamp, odometry_message(pose, stamp, encoding)))
        moved = transforms_message(
            [("map", "odom", mount), ("odom", "base_link", pose)], stamp, encoding
        )
        made.append(("/tf", stamp, moved))
    livox = livox_message(
        random.normal(0, 9, (5, 3)).astype(np.float32),
        np.arange(5, dtype=np.uint32),
        stamp,
        encoding,
    )
    made.append(("/livox", stamp, livox))
    return made


def read_all(source: BagSource) -> None:
    """Read all that a source has."""
    for index in range(min(len(source), 50)):
        with suppress(DriveError):  # Other scans may be whole.
            scan = source.scan(index)
            assert np.isfinite(scan.points).all()
            assert scan.times is None or len(scan.times) == len(scan.points)
    trajectory = source.trajectory()
    if trajectory is not None:
        assert np.isfinite(trajectory.poses).all()
    source.notes()
    for topic in source.topics():
        assert topic.rate_hz >= 0


@pytest.mark.slow
@pytest.mark.parametrize("name", FORMATS)
def test_mutated_bag_gives_a_result_or_a_clear_error(name: str, tmp_path: Path) -> None:
    encoding, write = FORMATS[name]
    content = write(tmp_path / name, messages(encoding)).read_bytes()
    file = tmp_path / f"mutated{Path(name).suffix}"

    def read(damaged: bytes) -> None:
        file.write_bytes(damaged)
        read_all(CLASSES[file.suffix](file))

    assert check_reader(content, read, name) > 0
