"""Writes files with other headers without the codec."""

import hashlib
import json
from typing import Any


def header_length(data: bytes) -> int:
    return 8 + int.from_bytes(data[:8], "little")


def outer_header(data: bytes) -> dict[str, Any]:
    outer: dict[str, Any] = json.loads(data[8 : header_length(data)])
    return outer


def inner_header(data: bytes) -> dict[str, Any]:
    inner: dict[str, Any] = json.loads(outer_header(data)["__metadata__"]["placecell"])
    return inner


def with_outer_header(data: bytes, outer: dict[str, Any]) -> bytes:
    text = json.dumps(outer, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    return len(text).to_bytes(8, "little") + text + data[header_length(data) :]


def checksum(data: bytes, header: dict[str, Any]) -> str:
    """Compute the checksum as docs/reference/map-file.md defines it, with another header."""
    digest = hashlib.sha256(compact_json(header).encode())
    outer, length = outer_header(data), header_length(data)
    for name in sorted(set(outer) - {"__metadata__"}):
        entry = outer[name]
        shape = ",".join(map(str, entry["shape"]))
        digest.update(f"\n{name} {entry['dtype']} {shape}\n".encode())
        begin, end = entry["data_offsets"]
        digest.update(data[length + begin : length + end])
    return digest.hexdigest()


def with_inner_header(data: bytes, *without: str, **changes: object) -> bytes:
    """Change or remove values of a file's header and correct its checksum."""
    header = inner_header(data) | changes
    for key in (*without, "sha256"):
        del header[key]
    header["sha256"] = checksum(data, header)
    outer = outer_header(data)
    outer["__metadata__"]["placecell"] = compact_json(header)
    return with_outer_header(data, outer)


def compact_json(value: object) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"))
