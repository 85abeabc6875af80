"""Files of bags that are odd in their own ways."""

import sqlite3
import struct
from contextlib import closing
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from placecell.sources.bags import Bag
from placecell.sources.bags.containers.compression import decompress
from placecell.sources.bags.containers.container import plain_type
from placecell.sources.bags.containers.ros1_file import header_fields
from placecell.sources.errors import DriveError
from tests.placecell.sources.bags.bag_builders import (
    START_NS,
    Message,
    cloud_message,
    cloud_of,
    write_mcap,
    write_ros1,
    write_ros2,
    xyz,
)


def messages(encoding: str, count: int = 3) -> list[Message]:
    points = np.random.default_rng(0).normal(size=(9, 3))
    made: list[Message] = []
    for stamp in range(START_NS, START_NS + count):
        cloud = cloud_of(xyz(points), stamp_ns=stamp)
        made.append(("/points", stamp, cloud_message(cloud, encoding)))
    return made


@pytest.mark.parametrize(
    ("name", "plain"),
    [
        ("sensor_msgs/msg/PointCloud2", "sensor_msgs/PointCloud2"),
        ("sensor_msgs/PointCloud2", "sensor_msgs/PointCloud2"),
        ("sensor_msgs::msg::PointCloud2", "sensor_msgs/PointCloud2"),
        ("sensor_msgs::msg::dds_::PointCloud2_", "sensor_msgs/PointCloud2"),
        ("foxglove.PointCloud", "foxglove.PointCloud"),
    ],
)
def test_type_has_one_name(name: str, plain: str) -> None:
    assert plain_type(name) == plain


def test_encrypted_bag_is_refused(tmp_path: Path) -> None:
    fields = [
        b"op=\x03",
        b"index_pos=" + bytes(8),
        b"conn_count=" + bytes(4),
        b"chunk_count=" + bytes(4),
        b"encryptor=rosbag/AesCbcEncryptor",
    ]
    header = b"".join(struct.pack("<I", len(field)) + field for field in fields)
    path = tmp_path / "a.bag"
    path.write_bytes(
        b"#ROSBAG V2.0\n" + struct.pack("<I", len(header)) + header + struct.pack("<I", 0)
    )
    with pytest.raises(DriveError, match=r"is encrypted\. Decrypt it with 'rosbag decrypt'"):
        Bag(path)


def test_damaged_header_of_a_bag_is_refused(tmp_path: Path) -> None:
    path = write_ros1(tmp_path / "a.bag", messages("ros1"))
    content = path.read_bytes()
    for damaged in (
        content[:15],
        content[:40],
        content.replace(b"op=\x03", b"op=\x02", 1),
        content.replace(b"op=\x03", b"op#\x03", 1),
    ):
        path.write_bytes(damaged)
        with pytest.raises(DriveError, match=r"the bag's header is damaged"):
            Bag(path)


def test_unknown_compression_of_a_bag_is_told(tmp_path: Path) -> None:
    path = write_ros1(tmp_path / "a.bag", messages("ros1"))
    path.write_bytes(path.read_bytes().replace(b"compression=none", b"compression=zlib"))
    bag = Bag(path)
    assert bag.topics == []
    assert "unknown compression 'zlib'" in bag.remarks[0]


def test_damaged_message_of_a_bag_is_told(tmp_path: Path) -> None:
    for compression in ("none", "lz4"):
        path = write_ros1(tmp_path / f"{compression}.bag", messages("ros1"), compression)
        bag = Bag(path)
        (topic,) = bag.topics
        topic.places[1, 2] += 3
        with pytest.raises(DriveError, match=r"the message at offset \d+ is damaged"):
            bag.read(topic, 1)
        assert [data is None for data in bag.contents(topic)] == [False, True, False]


def test_file_that_vanishes_is_told(tmp_path: Path) -> None:
    for path in (
        write_ros1(tmp_path / "a.bag", messages("ros1")),
        write_mcap(tmp_path / "a.mcap", messages("cdr")),
    ):
        bag = Bag(path)
        path.unlink()
        with pytest.raises(DriveError, match=r"cannot be read \(No such file"):
            bag.read(bag.topics[0], 0)


def test_header_that_is_cut_is_no_header() -> None:
    with pytest.raises(ValueError, match="damaged"):
        header_fields(struct.pack("<I", 9) + b"op=")


def database(tmp_path: Path) -> Path:
    folder = write_ros2(tmp_path / "run", messages("cdr"))
    (file,) = folder.glob("*.db3")
    return file


def test_log_of_a_database_that_was_not_merged_is_read(tmp_path: Path) -> None:
    """A recorder that was killed leaves its last messages in the write-ahead log."""
    file = database(tmp_path)
    with closing(sqlite3.connect(file)) as recorder:
        recorder.execute("PRAGMA journal_mode=WAL")
        data = recorder.execute("SELECT data FROM messages").fetchone()[0]
        recorder.execute(
            "INSERT INTO messages(topic_id, timestamp, data) VALUES (1, ?, ?)", (START_NS + 9, data)
        )
        recorder.commit()
        assert len(Bag(file).topics[0]) == 4


def test_rows_of_a_database_that_are_no_messages_are_passed_over(tmp_path: Path) -> None:
    file = database(tmp_path)
    with closing(sqlite3.connect(file)) as database_:
        database_.execute("UPDATE messages SET data = 'text' WHERE id = 2")
        database_.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES (77, 1, x'00')")
        database_.commit()
    bag = Bag(file)
    (topic,) = bag.topics
    assert [data is None for data in bag.contents(topic)] == [False, True, False]
    with pytest.raises(DriveError, match="message 2 cannot be read"):
        bag.read(topic, 1)


def test_database_without_the_tables_of_a_bag_is_refused(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / "a.db3")) as other:
        other.execute("CREATE TABLE fruit(name TEXT)")
    with pytest.raises(DriveError, match=r"cannot be read \(no such table: topics\)"):
        Bag(tmp_path / "a.db3")


def test_unknown_compression_of_a_chunk_is_told(tmp_path: Path) -> None:
    path = write_mcap(tmp_path / "a.mcap", messages("cdr"), compression="lz4")
    path.write_bytes(path.read_bytes().replace(b"\x03\0\0\0lz4", b"\x03\0\0\0lz5"))
    bag = Bag(path)
    with pytest.raises(DriveError, match="compressed by 'lz5'; expected lz4 or zstd"):
        bag.read(bag.topics[0], 0)


def test_files_of_two_formats_are_refused(tmp_path: Path) -> None:
    write_mcap(tmp_path / "a.mcap", messages("cdr"))
    write_ros1(tmp_path / "b.bag", messages("ros1"))
    with pytest.raises(DriveError, match=r"files of 2 formats \(a.mcap, b.bag\)"):
        Bag(tmp_path)


def test_damaged_part_of_a_recording_is_left_out_and_told(tmp_path: Path) -> None:
    write_mcap(tmp_path / "a_0.mcap", messages("cdr"))
    (tmp_path / "a_1.mcap").write_bytes(b"nothing")
    bag = Bag(tmp_path)
    assert len(bag.topics[0]) == 3
    assert any("a_1.mcap" in remark and "is left out" in remark for remark in bag.remarks)


def test_long_gap_between_files_is_told(tmp_path: Path) -> None:
    write_mcap(tmp_path / "a.mcap", messages("cdr"))
    later = [(topic, time + 3600 * 10**9, message) for topic, time, message in messages("cdr")]
    write_mcap(tmp_path / "b.mcap", later)
    (remark,) = Bag(tmp_path).remarks
    assert remark.startswith("a.mcap and b.mcap are read as one recording, but 3,600 s lie betw")


def test_compressed_file_that_is_damaged_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.mcap.zstd").write_bytes(b"nothing of the kind")
    with pytest.raises(DriveError, match=r"a.mcap.zstd: cannot be decompressed"):
        Bag(tmp_path / "a.mcap.zstd")


def test_output_of_decompression_is_bounded() -> None:
    import zstandard

    data = zstandard.compress(bytes(1000))
    assert decompress(data, "zstd", 1000, "test") == bytes(1000)
    assert decompress(data, "zstd", 0, "test") == bytes(1000)
    with pytest.raises(DriveError, match="gives more than 999 bytes; expected 999"):
        decompress(data, "zstd", 999, "test")
    with pytest.raises(DriveError, match="gives 1000 bytes; expected 1001"):
        decompress(data, "zstd", 1001, "test")
    with pytest.raises(DriveError, match="the bz2 data is damaged"):
        decompress(b"nothing", "bz2", 9, "test")


@pytest.mark.parametrize("name", ["a_lz4.bag", "a_lz4.mcap", "a_zstd.mcap"])
def test_stamps_are_read_without_decompressing_whole_chunks(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first cloud is large and in a chunk of its own; only its begin is needed."""
    points = np.random.default_rng(0).normal(size=(50_000, 3)).astype(np.float32)
    encoding = "ros1" if name.endswith(".bag") else "cdr"
    cloud = cloud_message(cloud_of(xyz(points), stamp_ns=START_NS), encoding)
    made: list[Message] = [("/points", START_NS, cloud), *messages(encoding)]
    if encoding == "ros1":
        path = write_ros1(tmp_path / name, made, "lz4", 99_000)
    else:
        kind: Literal["lz4", "zstd"] = "lz4" if "lz4" in name else "zstd"
        path = write_mcap(tmp_path / name, made, compression=kind)
    bag = Bag(path)
    (container,) = bag.containers

    def never(*arguments: object) -> bytes:
        raise AssertionError("a whole chunk was read")

    monkeypatch.setattr(type(container), "read", never)
    (topic,) = bag.topics
    heads = list(bag.contents(topic, 16))
    assert len(heads) == 4
    for head in heads:
        assert head is not None
        assert struct.unpack_from("<I", head, 4)[0] == START_NS // 10**9
