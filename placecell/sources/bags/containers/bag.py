"""A bag: one recording, in one file or several."""

import re
import shutil
import tempfile
import weakref
from collections.abc import Iterator, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from placecell.core.files import natural_key
from placecell.sources.bags.containers import mcap_file, ros1_file, sqlite_file
from placecell.sources.bags.containers.compression import ZSTD_MAGIC, decompress
from placecell.sources.bags.containers.container import BagTopic, Container, runs
from placecell.sources.errors import DriveError

KINDS: dict[bytes, type[Container]] = {
    ros1_file.MAGIC: ros1_file.Ros1File,
    sqlite_file.MAGIC: sqlite_file.SqliteFile,
    mcap_file.MAGIC: mcap_file.McapFile,
}
SUFFIXES: dict[str, type[Container]] = {
    ".bag": ros1_file.Ros1File,
    ".db3": sqlite_file.SqliteFile,
    ".mcap": mcap_file.McapFile,
}
COMPRESSED = (".zstd", ".zst")
LONGEST_GAP = 60.0
"""Longest gap between the parts of one recording that needs no remark, seconds."""
METADATA = "metadata.yaml"
LISTED = re.compile(
    r"^\s*-\s+(?:path:\s*)?[\"']?([^\"'\n]+?\.(?:db3|mcap)(?:\.zstd)?)[\"']?\s*$", re.MULTILINE
)
"""A file's name in `metadata.yaml` of a ROS 2 bag."""


def kind_of(file: Path) -> type[Container] | None:
    """Return the class that reads a file: by its first bytes, else by its name."""
    suffix = plain_suffix(file)
    if file.suffix in COMPRESSED:
        return SUFFIXES.get(suffix)
    try:
        with file.open("rb") as opened:
            begin = opened.read(16)
    except OSError:
        return None
    for magic, kind in KINDS.items():
        if begin.startswith(magic) and (kind is not sqlite_file.SqliteFile or suffix in SUFFIXES):
            return kind
    return SUFFIXES.get(suffix)


def plain_suffix(file: Path) -> str:
    """Return the suffix of a file's name, without that of a compression."""
    name = file.with_suffix("") if file.suffix in COMPRESSED else file
    return name.suffix.lower()


def bag_files(path: Path) -> list[Path]:
    """Return the files of a bag: itself, or those of the folder, in their order."""
    if path.is_file():
        return [path]
    try:
        files = [
            file
            for file in path.iterdir()
            if plain_suffix(file) in SUFFIXES and file.is_file() and not file.name.startswith(".")
        ]
    except OSError:
        return []
    names = {file.name for file in files}
    # Tools that decompress a bag leave the compressed file beside it.
    plain = [
        file
        for file in files
        if file.suffix not in COMPRESSED or file.with_suffix("").name not in names
    ]
    return sorted(plain, key=natural_key)


class Bag:
    """All messages of a recording, found by topic and number.

    Attributes:
        path: file or folder.
        files: files with messages, in their order.
        topics: all topics, ordered by name.
        remarks: what was odd about the files.

    Raises:
        DriveError: there is no bag, or no file of it can be read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.files = bag_files(path)
        if not self.files:
            absent = "".join(f" ({remark})" for remark in self.missing())
            raise DriveError(
                f"{path}: no file of a bag is there{absent}. Expected .bag, .db3 or .mcap files"
            )
        kinds = {kind for file in self.files if (kind := kind_of(file))}
        if len(kinds) != 1:
            names = ", ".join(file.name for file in self.files[:6])
            raise DriveError(
                f"{path}: files of {len(kinds)} formats ({names}); expected one recording. Open "
                "one of the files"
            )
        kind = kinds.pop()
        self.remarks = list(self.missing())
        self.containers: list[Container] = []
        failed: list[str] = []
        for file in self.files:
            try:
                self.containers.append(kind(self.plain(file)))
            except DriveError as error:
                failed.append(str(error))
        if not self.containers:
            raise DriveError(failed[0])
        self.remarks += [f"{error}. The file is left out" for error in failed]
        for container in self.containers:
            self.remarks += container.remarks
        self.remarks += gaps(self.containers)
        self.topics = joined_topics([container.topics for container in self.containers])

    def missing(self) -> Iterator[str]:
        """Yield a remark if `metadata.yaml` lists files that are not there."""
        metadata = self.path / METADATA
        if self.path.is_file() or not metadata.is_file():
            return
        listed = LISTED.findall(metadata.read_text(encoding="utf-8", errors="replace"))
        there = {file.name.removesuffix(".zstd") for file in self.files}
        absent = sorted({Path(name).name.removesuffix(".zstd") for name in listed} - there)
        if absent:
            yield f"{metadata}: lists {', '.join(absent)}, which are not there"

    def plain(self, file: Path) -> Path:
        """Return the file, or a temporary copy if it is compressed as a whole."""
        if file.suffix not in COMPRESSED:
            return file
        import zstandard

        folder = Path(tempfile.mkdtemp(prefix="placecell-bag-"))
        weakref.finalize(self, shutil.rmtree, folder, ignore_errors=True)
        copy = folder / file.with_suffix("").name
        try:
            with file.open("rb") as source, copy.open("wb") as target:
                zstandard.ZstdDecompressor().copy_stream(source, target)
        except (OSError, zstandard.ZstdError) as error:
            raise DriveError(
                f"{file}: cannot be decompressed ({error}). Copy the file again, or free space in "
                f"{tempfile.gettempdir()}"
            ) from error
        return copy

    def topic(self, name: str) -> BagTopic | None:
        """Return the topic with this name, written with or without the leading slash."""
        for topic in self.topics:
            if topic.name.strip("/") == name.strip("/"):
                return topic
        return None

    def where(self, topic: BagTopic, index: int) -> str:
        """Return file, topic and number of a message, for errors."""
        file = self.containers[int(topic.places[index, 0])].path
        return f"{file}: topic {topic.name!r}, message {index}"

    def read(self, topic: BagTopic, index: int) -> bytes | memoryview:
        """Return a message.

        Raises:
            DriveError: the file is damaged there.
        """
        place = topic.places[index].tolist()
        return self.expanded(self.containers[place[0]].read(place), self.where(topic, index))

    def expanded(self, data: bytes | memoryview, where: str) -> bytes | memoryview:
        """Decompress a message of a bag in which each message is compressed."""
        if data[:4] == ZSTD_MAGIC:
            return decompress(bytes(data), "zstd", 0, where)
        return data

    def contents(
        self, topic: BagTopic, length: int | None = None
    ) -> Iterator[bytes | memoryview | None]:
        """Yield all messages of a topic in their order; None for a damaged one.

        Args:
            topic: the topic.
            length: bytes of each that are needed, from its begin; None: all.
        """
        files = topic.places[:, 0]
        for start, end in pairwise(runs(files)):
            container = self.containers[int(files[start])]
            for index, data in enumerate(
                container.contents(topic.places[start:end], length), start
            ):
                if data is None or data[:4] != ZSTD_MAGIC:
                    yield data
                    continue
                try:
                    yield self.read(topic, index)[:length]
                except DriveError:
                    yield None


def gaps(containers: Sequence[Container]) -> Iterator[str]:
    """Yield a remark on each long gap between the files: they may be several recordings."""
    ranges = sorted(
        (min(int(topic.times[0]) for topic in there), max(int(topic.times[-1]) for topic in there))
        + (container.path.name,)
        for container in containers
        if (there := [topic for topic in container.topics if len(topic)])
    )
    for (_, end, before), (begin, _, after) in pairwise(ranges):
        seconds = (begin - end) * 1e-9
        if seconds > LONGEST_GAP:
            yield (
                f"{before} and {after} are read as one recording, but {seconds:,.0f} s lie between "
                "them. Open one of the files, if they are several recordings"
            )


def joined_topics(files: Sequence[Sequence[BagTopic]]) -> list[BagTopic]:
    """Join the topics of several files; the messages of each are ordered by time."""
    parts: dict[tuple[str, str, str], list[tuple[int, BagTopic]]] = {}
    for number, topics in enumerate(files):
        for topic in topics:
            key = (topic.name, topic.type, topic.encoding)
            parts.setdefault(key, []).append((number, topic))
    joined = []
    for (name, kind, encoding), found in sorted(parts.items()):
        times = np.concatenate([topic.times for _, topic in found])
        places = np.concatenate([topic.places for _, topic in found])
        places[:, 0] = np.repeat([number for number, _ in found], [len(t) for _, t in found])
        order = np.argsort(times, kind="stable")
        joined.append(BagTopic(name, kind, encoding, times[order], places[order]))
    return joined
