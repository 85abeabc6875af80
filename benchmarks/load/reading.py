"""Clouds a second that the readers of sources decode, beside kiss-icp's loaders."""

import contextlib
import io
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

from evaluation.machine import machine
from placecell.core.types import Float32, Float64
from placecell.sources.catalog import open_source

POINTS = 120_000
PERIOD_NS = 100_000_000
START_NS = 1_700_000_000_000_000_000
TOPIC = "/points"
FIELDS = (("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 12, 7), ("t", 16, 6))
"""Name, offset and data type of each value of a point."""
POINT = np.dtype([("x", "<f4"), ("y", "<f4"), ("z", "<f4"), ("intensity", "<f4"), ("t", "<u4")])
FORMATS = ("ROS 1 bag", "rosbag2 sqlite", "MCAP", "MCAP zstd", "PCD binary", ".bin")


def measure_reading(
    clouds: int, repeats: int, seed: int, folder: Path | None = None
) -> dict[str, Any]:
    """Write clouds in each format, and measure how many a second become arrays.

    Each reader runs on one core, and each file is in the page cache. The best of the repeats counts
    for both readers alike.

    Args:
        clouds: number of clouds in a file.
        repeats: number of measurements of each reader.
        seed: random seed of the points.
        folder: folder for the files; None for a temporary one.
    """
    scratch = Path(tempfile.mkdtemp(prefix="placecell-read-", dir=folder))
    try:
        tables = [drawn(seed + index) for index in range(clouds)]
        rows = {}
        for name in FORMATS:
            path = WRITERS[name](scratch / name.replace(" ", "_").strip("."), tables)
            rows[name] = measured(name, path, tables, repeats)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
    return {
        "rows": rows,
        "measured": "opening a source and reading all clouds to float32 arrays, in one thread",
        "peer": "the loaders of kiss-icp, on the same files in the same run",
        "points": POINTS,
        "clouds": clouds,
        "repeats": repeats,
        "seed": seed,
        "machine": machine(),
    }


def drawn(seed: int) -> np.ndarray:
    """Return a random cloud with times, in the order of a spinning sensor."""
    random = np.random.default_rng(seed)
    table = np.empty(POINTS, POINT)
    around = np.linspace(0, 2 * np.pi, POINTS)
    ranges = random.uniform(2, 60, POINTS)
    table["x"], table["y"] = ranges * np.cos(around), ranges * np.sin(around)
    table["z"] = random.normal(0, 1, POINTS)
    table["intensity"] = random.uniform(0, 1, POINTS)
    table["t"] = np.linspace(0, PERIOD_NS - 1, POINTS).astype(np.uint32)
    return table


def measured(name: str, path: Path, tables: list[np.ndarray], repeats: int) -> dict[str, Any]:
    """Measure both readers of a file."""
    ours = best(lambda: read_ours(path), tables, repeats)
    row: dict[str, Any] = {"megabytes": round(size_of(path) / 1e6, 1), "placecell": ours}
    printed = io.StringIO()
    try:
        with contextlib.redirect_stdout(printed):
            row["kiss_icp"] = best(lambda: read_theirs(name, path), tables, repeats)
        row["ratio"] = round(ours["clouds_per_second"] / row["kiss_icp"]["clouds_per_second"], 2)
    except (Exception, SystemExit) as error:  # A loader may fail in any way; the report says how.
        told = " ".join([f"{type(error).__name__}: {error}", *printed.getvalue().split()])
        row["kiss_icp"] = {"failed": told[:300]}
    return row


def best(
    read: Callable[[], Iterator[Float32 | Float64]], tables: list[np.ndarray], repeats: int
) -> dict[str, float]:
    """Return the clouds a second, of wall time and of processor time, in the best repeat.

    Raises:
        ValueError: the reader does not return the points that were written.
    """
    for points, table in zip(read(), tables, strict=True):
        written = np.stack([table[axis] for axis in "xyz"], axis=1)
        if points.shape != written.shape or not np.array_equal(points.astype("<f4"), written):
            raise ValueError(f"{points.shape} points are not the {written.shape} written")
    walls, processors = [], []
    for _ in range(repeats):
        wall, processor = time.perf_counter(), time.process_time()
        count = sum(1 for _ in read())
        walls.append((time.perf_counter() - wall) / count)
        processors.append((time.process_time() - processor) / count)
    return {
        "clouds_per_second": round(1 / min(walls), 1),
        "clouds_per_processor_second": round(1 / min(processors), 1),
    }


def read_ours(path: Path) -> Iterator[Float32]:
    """Yield the points of all scans, by Placecell."""
    source = open_source(path)
    for index in range(len(source)):
        yield source.scan(index).points


def read_theirs(name: str, path: Path) -> Iterator[Float64]:
    """Yield the points of all scans, by the loader of kiss-icp for this format."""
    from kiss_icp.datasets.generic import GenericDataset
    from kiss_icp.datasets.mcap import McapDataloader
    from kiss_icp.datasets.rosbag import RosbagDataset

    loader: Any
    if name.startswith("MCAP"):
        loader = McapDataloader(str(path), TOPIC)
    elif name in ("PCD binary", ".bin"):
        loader = GenericDataset(path)
    else:
        loader = RosbagDataset(path, TOPIC)
    for index in range(len(loader)):
        found = loader[index]
        yield found[0] if isinstance(found, tuple) else found


def size_of(path: Path) -> int:
    """Return the bytes of a file or of all files in a folder."""
    files = [path] if path.is_file() else [each for each in path.rglob("*") if each.is_file()]
    return sum(file.stat().st_size for file in files)


def write_bag(path: Path, tables: list[np.ndarray], ros1: bool) -> Path:
    """Write a ROS 1 bag or a rosbag2 folder with SQLite, by rosbags."""
    from rosbags import rosbag1, rosbag2
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    kind = "sensor_msgs/msg/PointCloud2"
    target = path.with_suffix(".bag") if ros1 else path
    writer: Any = rosbag1.Writer(target) if ros1 else rosbag2.Writer(target, version=9)
    with writer:
        connection = writer.add_connection(TOPIC, kind, typestore=store)
        for index, table in enumerate(tables):
            stamp = START_NS + index * PERIOD_NS
            message = message_of(store, table, stamp, ros1)
            data = (store.serialize_ros1 if ros1 else store.serialize_cdr)(message, kind)
            writer.write(connection, stamp, data)
    return target


def message_of(store: Any, table: np.ndarray, stamp: int, ros1: bool) -> Any:
    """Return a cloud as a message of rosbags."""
    types = store.types
    moment = types["builtin_interfaces/msg/Time"](sec=stamp // 10**9, nanosec=stamp % 10**9)
    counted = {"seq": 0} if ros1 else {}
    field = types["sensor_msgs/msg/PointField"]
    return types["sensor_msgs/msg/PointCloud2"](
        header=types["std_msgs/msg/Header"](stamp=moment, frame_id="lidar", **counted),
        height=1,
        width=len(table),
        fields=[field(name=n, offset=at, datatype=kind, count=1) for n, at, kind in FIELDS],
        is_bigendian=False,
        point_step=POINT.itemsize,
        row_step=POINT.itemsize * len(table),
        data=table.view(np.uint8),
        is_dense=True,
    )


def write_mcap(path: Path, tables: list[np.ndarray], compression: str) -> Path:
    """Write an MCAP file with the profile of ROS 2."""
    from mcap.writer import CompressionType, Writer
    from rosbags.typesys import Stores, get_typestore

    from placecell.export.mcap_file import CLOUD

    store = get_typestore(Stores.ROS2_HUMBLE)
    kind = "sensor_msgs/msg/PointCloud2"
    target = path.with_suffix(".mcap")
    with target.open("wb") as stream:
        writer = Writer(stream, compression=CompressionType[compression])
        writer.start(profile="ros2", library="placecell")
        schema = writer.register_schema(kind, "ros2msg", CLOUD.encode())
        channel = writer.register_channel(TOPIC, "cdr", schema)
        for index, table in enumerate(tables):
            stamp = START_NS + index * PERIOD_NS
            message = message_of(store, table, stamp, ros1=False)
            data = bytes(store.serialize_cdr(message, kind))
            writer.add_message(channel, stamp, data, stamp)
        writer.finish()  # type: ignore[no-untyped-call]
    return target


def write_pcd(path: Path, tables: list[np.ndarray]) -> Path:
    """Write a folder of binary PCD files."""
    path.mkdir()
    head = (
        "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity t\nSIZE 4 4 4 4 4\nTYPE F F F F U\n"
        f"COUNT 1 1 1 1 1\nWIDTH {POINTS}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
        f"POINTS {POINTS}\nDATA binary\n"
    ).encode()
    for index, table in enumerate(tables):
        (path / f"{index:06d}.pcd").write_bytes(head + table.tobytes())
    return path


def write_bin(path: Path, tables: list[np.ndarray]) -> Path:
    """Write a folder of KITTI's .bin files."""
    path.mkdir()
    for index, table in enumerate(tables):
        columns = np.stack([table[name] for name in ("x", "y", "z", "intensity")], axis=1)
        (path / f"{index:06d}.bin").write_bytes(columns.astype("<f4").tobytes())
    return path


WRITERS: dict[str, Callable[[Path, list[np.ndarray]], Path]] = {
    "ROS 1 bag": lambda path, tables: write_bag(path, tables, ros1=True),
    "rosbag2 sqlite": lambda path, tables: write_bag(path, tables, ros1=False),
    "MCAP": lambda path, tables: write_mcap(path, tables, "NONE"),
    "MCAP zstd": lambda path, tables: write_mcap(path, tables, "ZSTD"),
    "PCD binary": write_pcd,
    ".bin": write_bin,
}


@contextlib.contextmanager
def one_core() -> Iterator[None]:
    """Run on one core, where the system allows to choose it."""
    if not hasattr(os, "sched_setaffinity"):
        yield
        return
    allowed = os.sched_getaffinity(0)
    os.sched_setaffinity(0, {min(allowed)})
    try:
        yield
    finally:
        os.sched_setaffinity(0, allowed)
