"""Container of map and delta files: columns in safetensors, with a header and a checksum."""

import hashlib
import json
from dataclasses import dataclass
from typing import Any

import numpy as np
import safetensors
import safetensors.numpy
from numpy.typing import NDArray

from placecell_client.maps.compact_map import MapFileError

METADATA_KEY = "placecell"
HEADER_LIMIT = 1 << 20
"""Largest header, bytes; 1 kB is common. Parsed JSON takes twenty times its size in memory."""

Columns = dict[str, NDArray[Any]]

DTYPES = {
    # Order of the tensors in a file: wide elements first, so that all are aligned.
    "frame_positions": ("F64",),
    "frame_times": ("F64",),
    "frame_odometry": ("F64",),
    "moved_positions": ("F64",),
    "moved_odometry": ("F64",),
    "frame_orientations": ("F32",),
    "moved_orientations": ("F32",),
    "ids": ("U32",),
    "frame_tracks": ("U32",),
    "views": ("U32",),
    "seen": ("U32",),
    "missed": ("U32",),
    "source_ids": ("U32",),
    "removed": ("U32",),
    "moved_ids": ("U32",),
    "moved_tracks": ("U32",),
    "frame_index": ("U16", "U32"),
    "centroids": ("I16",),
    "points": ("U16",),
    "source": ("U16",),
    "robot": ("U8", "U16"),
    "extents": ("U8",),
    "classes": ("U8",),
    "confirmed": ("U8",),
    "absent": ("U8",),
    "codes": ("I8",),
}
_NAMES = {
    np.dtype(dtype): name
    for dtype, name in {
        "<f8": "F64", "<f4": "F32", "<u4": "U32", "<u2": "U16", "<i2": "I16", "u1": "U8", "i1": "I8"
    }.items()
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class FileFormat:
    """File format that a reader expects.

    Attributes:
        name: Format name in the header.
        noun: Name of the file in error messages.
        version: Version in the header.
        required: Required columns.
        optional: Optional columns.
    """

    name: str
    noun: str
    version: int
    required: frozenset[str]
    optional: frozenset[str]


@dataclass(frozen=True, slots=True)
class Content:
    """Content of a file: its header without the checksum, and its columns, little-endian."""

    header: dict[str, Any]
    columns: Columns


def write(content: Content) -> bytes:
    """Encode a file in the safetensors format.

    The library reads files, but does not write them here: a later release might order or pad
    differently, and the bytes must never change.

    Raises:
        MapFileError: The header is too long.
    """
    parts: list[bytes | memoryview] = [_head(content, _checksum(content))]
    parts += [np.ascontiguousarray(column).data for column in _in_order(content.columns).values()]
    return b"".join(parts)


def read(data: bytes, expected: FileFormat) -> tuple[Content, str]:
    """Decode a file and verify its checksum.

    Returns:
        The content and the checksum.

    Raises:
        MapFileError: The file is cut, altered, or has another format or version.
    """
    outer = _outer_header(data, expected)
    header = _header(outer, expected)
    columns = _columns(data, outer, expected)
    stated = header.pop("sha256", None)
    content = Content(header, columns)
    checksum = _checksum(content)
    if stated != checksum:
        raise MapFileError("the SHA-256 differs from the one in the header: the file was altered")
    return content, checksum


def is_file_of(data: bytes, content: Content, checksum: str) -> bool:
    """Return whether `write` encodes a content with this checksum to exactly these bytes."""
    head = _head(content, checksum)
    if not data.startswith(head):
        return False
    begin = len(head)
    for column in _in_order(content.columns).values():
        given = np.frombuffer(data, np.uint8, column.nbytes, begin)
        if not np.array_equal(given, np.ascontiguousarray(column).reshape(-1).view(np.uint8)):
            return False
        begin += column.nbytes
    return begin == len(data)


def _in_order(columns: Columns) -> Columns:
    return {name: columns[name] for name in DTYPES if name in columns}


def _canonical_json(value: object) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"))


def _checksum(content: Content) -> str:
    digest = hashlib.sha256(_canonical_json(content.header).encode())
    for name, column in sorted(content.columns.items()):
        shape = ",".join(map(str, column.shape))
        digest.update(f"\n{name} {_NAMES[column.dtype]} {shape}\n".encode())
        digest.update(np.ascontiguousarray(column).data)
    return digest.hexdigest()


def _head(content: Content, checksum: str) -> bytes:
    """Return the bytes before the columns."""
    inner = _canonical_json(content.header | {"sha256": checksum})
    outer: dict[str, Any] = {"__metadata__": {METADATA_KEY: inner}}
    end = 0
    for name, column in _in_order(content.columns).items():
        begin, end = end, end + column.nbytes
        outer[name] = {
            "dtype": _NAMES[column.dtype],
            "shape": list(column.shape),
            "data_offsets": [begin, end],
        }
    text = json.dumps(outer, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    if len(text) > HEADER_LIMIT:
        raise MapFileError(
            f"header: {len(text)} bytes with the names of maps and robots; "
            f"the limit is {HEADER_LIMIT}"
        )
    return len(text).to_bytes(8, "little") + text


def _outer_header(data: bytes, expected: FileFormat) -> dict[str, Any]:
    """Return the safetensors header after a check of its length."""
    if len(data) < 8:
        raise MapFileError(f"the file has {len(data)} bytes, too few for a {expected.noun}")
    length = int.from_bytes(data[:8], "little")
    if length > len(data) - 8:
        raise MapFileError(
            f"the file is not a {expected.noun}, or it is cut: its header is longer than the file"
        )
    if length > HEADER_LIMIT:
        raise MapFileError(f"header: {length} bytes; the limit is {HEADER_LIMIT}")
    return _json(data[8 : 8 + length], expected)


def _header(outer: dict[str, Any], expected: FileFormat) -> dict[str, Any]:
    """Return Placecell's own header after a check of format and version."""
    metadata = outer.get("__metadata__")
    if not isinstance(metadata, dict) or not isinstance(metadata.get(METADATA_KEY), str):
        raise MapFileError(
            f"the file is not a {expected.noun}: it has no header under {METADATA_KEY!r}"
        )
    header = _json(metadata[METADATA_KEY].encode(errors="replace"), expected)
    if header.get("format") != expected.name:
        raise MapFileError(
            f"the file is not a {expected.noun}: the format in its header is not {expected.name!r}"
        )
    version = header.get("version")
    if version != expected.version or isinstance(version, bool):
        raise MapFileError(
            f"the {expected.noun} has version {version!r:.40}; "
            f"this program reads version {expected.version}"
        )
    return header


def _columns(data: bytes, outer: dict[str, Any], expected: FileFormat) -> Columns:
    names = set(outer) - {"__metadata__"}
    if not expected.required <= names <= expected.required | expected.optional:
        raise MapFileError(f"the file is not a {expected.noun}: it has missing or unknown columns")
    for name in names:
        entry = outer[name]
        if not isinstance(entry, dict) or entry.get("dtype") not in DTYPES[name]:
            raise MapFileError(f"{name}: expected type {' or '.join(DTYPES[name])}")
    try:
        # The library checks shapes and offsets against the length of `data` before it allocates.
        loaded = safetensors.numpy.load(data)
    except (safetensors.SafetensorError, ValueError) as error:
        raise MapFileError(f"the file is cut, too long, or not safetensors: {error}") from error
    return {
        name: column.astype(column.dtype.newbyteorder("<"), copy=False)
        for name, column in loaded.items()
    }


def _json(text: bytes, expected: FileFormat) -> dict[str, Any]:
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise MapFileError(
            f"the file is not a {expected.noun}: its header is not JSON ({error})"
        ) from error
    if not isinstance(value, dict):
        raise MapFileError(f"the file is not a {expected.noun}: its header is not a JSON object")
    return value
