"""The compact map file, version 0: a `CompactMap` in at most 48 bytes a segment.

`MAP_FILE.md` describes it byte by byte, for readers in any language. `decode` takes exactly what
`encode` gives: equal maps are equal files, and any other bytes are refused.
"""

import hashlib
import json
from typing import Any

import numpy as np
import safetensors
import safetensors.numpy
from numpy.typing import NDArray

from placecell_client.canonical import canonical, choose_scale
from placecell_client.compact_map import CompactMap, MapFileError

__all__ = ["FORMAT", "MEDIA_TYPE", "VERSION", "CompactMap", "MapFileError", "decode", "encode"]

FORMAT = "placecell-map"
VERSION = 0
MEDIA_TYPE = "application/vnd.placecell.map"
METADATA_KEY = "placecell"
HEADER_LIMIT = 100_000_000
"""Bytes; safetensors' own limit for its JSON header."""

Columns = dict[str, NDArray[Any]]

_DTYPES = {
    # In the order of the tensors in the file: wide elements first, so that all are aligned.
    "frame_positions": ("F64",),
    "frame_times": ("F64",),
    "frame_orientations": ("F32",),
    "ids": ("U32",),
    "frame_index": ("U16", "U32"),
    "centroids": ("I16",),
    "robot": ("U8", "U16"),
    "codes": ("I8",),
}
_NAMES = {
    np.dtype(dtype): name
    for dtype, name in {
        "<f8": "F64", "<f4": "F32", "<u4": "U32", "<u2": "U16", "<i2": "I16", "u1": "U8", "i1": "I8"
    }.items()
}  # fmt: skip


def encode(compact_map: CompactMap) -> bytes:
    """The map as a file.

    Rows are sorted by id; robots and frames are sorted, merged where equal, and left out where no
    segment names them; centroids are rounded to the file's resolution: 1 cm in maps of up to
    655 m, twice that for each doubling.

    Raises:
        MapFileError: the map is not valid.
    """
    compact_map.check()
    ordered = canonical(compact_map)
    scale_cm = choose_scale(ordered.centroids)
    steps = np.rint(ordered.centroids * 100 / scale_cm).astype(np.int64)
    middle = (steps.min(axis=0) + steps.max(axis=0)) // 2 if len(steps) else np.zeros(3, np.int64)
    columns: Columns = {
        "frame_positions": ordered.frame_positions.astype("<f8"),
        "frame_times": ordered.frame_times.astype("<f8"),
        "frame_orientations": ordered.frame_orientations.astype("<f4"),
        "ids": ordered.ids.astype("<u4"),
        "frame_index": ordered.frame_index.astype(
            "<u2" if len(ordered.frame_times) <= 1 << 16 else "<u4"
        ),
        "centroids": (steps - middle).astype("<i2"),
        "robot": ordered.robot.astype("u1" if len(ordered.robots) <= 1 << 8 else "<u2"),
        "codes": ordered.codes,
    }
    span = ordered.time_span
    header = {
        "format": FORMAT,
        "version": VERSION,
        "model_id": ordered.model_id,
        "preprocessing": ordered.preprocessing,
        "frame": ordered.frame,
        "robots": list(ordered.robots),
        "count": len(ordered),
        "time_span_us": [int(np.floor(span[0] * 1e6)), int(np.ceil(span[1] * 1e6))] if span else [],
        "scale_cm": scale_cm,
        "origin_cm": [int(value) for value in middle * scale_cm],
    }
    header["sha256"] = _checksum(header, columns)
    return _carry(header, columns)


def decode(data: bytes) -> CompactMap:
    """The map of a file.

    Raises:
        MapFileError: the bytes are not exactly what `encode` makes of a map.
    """
    outer = _outer_header(data)
    header = _header(outer)
    columns = _columns(data, outer)
    stated = header.pop("sha256", None)
    if stated != _checksum(header, columns):
        raise MapFileError("its SHA-256 is not the one in its header: the file was altered")
    try:
        scale_cm, origin_cm = int(header["scale_cm"]), np.array(header["origin_cm"], np.int64)
        if not 1 <= scale_cm <= 1 << 20 or origin_cm.shape != (3,):
            raise MapFileError("header: scale_cm or origin_cm is out of range")
        compact_map = CompactMap(
            model_id=_text(header, "model_id"),
            preprocessing=_text(header, "preprocessing"),
            frame=_text(header, "frame"),
            codes=columns["codes"],
            centroids=(origin_cm + scale_cm * columns["centroids"].astype(np.int64)) / 100,
            ids=columns["ids"].astype(np.uint32),
            robots=tuple(_text({"robots": name}, "robots") for name in header["robots"]),
            robot=columns["robot"].astype(np.uint16),
            frame_index=columns["frame_index"].astype(np.uint32),
            frame_times=columns["frame_times"].astype(np.float64),
            frame_positions=columns["frame_positions"].astype(np.float64),
            frame_orientations=columns["frame_orientations"].astype(np.float32),
        )
    except MapFileError:
        raise
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise MapFileError(f"header: a value is missing or of a wrong type ({error})") from error
    # One rule for all that is left: order, widths, rounding, spelling of the header.
    if encode(compact_map) != data:
        raise MapFileError("the file is not in canonical form: encode the map again")
    return compact_map


def _text(header: dict[str, Any], key: str) -> str:
    if not isinstance(header[key], str):
        raise MapFileError(f"header: {key} is not a text")
    return str(header[key])


def _canonical_json(value: object) -> str:
    return json.dumps(value, sort_keys=True, separators=(",", ":"))


def _checksum(header: dict[str, Any], columns: Columns) -> str:
    digest = hashlib.sha256(_canonical_json(header).encode())
    for name in sorted(columns):
        column = columns[name]
        shape = ",".join(map(str, column.shape))
        digest.update(f"\n{name} {_NAMES[column.dtype]} {shape}\n".encode())
        digest.update(np.ascontiguousarray(column).data)
    return digest.hexdigest()


def _carry(header: dict[str, Any], columns: Columns) -> bytes:
    """The safetensors file.

    Written here, though read with the library, because its bytes must never change: the library's
    writer is free to order and pad anew in a later release.
    """
    outer: dict[str, Any] = {"__metadata__": {METADATA_KEY: _canonical_json(header)}}
    end = 0
    for name in _DTYPES:
        begin, end = end, end + columns[name].nbytes
        outer[name] = {
            "dtype": _NAMES[columns[name].dtype],
            "shape": list(columns[name].shape),
            "data_offsets": [begin, end],
        }
    text = json.dumps(outer, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 8)
    body = [np.ascontiguousarray(columns[name]).tobytes() for name in _DTYPES]
    return b"".join([len(text).to_bytes(8, "little"), text, *body])


def _outer_header(data: bytes) -> dict[str, Any]:
    """The safetensors header, after a check of its stated length."""
    if len(data) < 8:
        raise MapFileError(f"{len(data)} bytes are too few for a map file")
    length = int.from_bytes(data[:8], "little")
    if length > min(len(data) - 8, HEADER_LIMIT):
        raise MapFileError("not a map file, or cut short: its header is longer than the file")
    outer = _json(data[8 : 8 + length])
    if set(outer) != {"__metadata__", *_DTYPES}:
        raise MapFileError("not a map file: it does not hold exactly a map's columns")
    return outer


def _header(outer: dict[str, Any]) -> dict[str, Any]:
    """Placecell's own header, of a format and version that this program reads."""
    metadata = outer["__metadata__"]
    if not isinstance(metadata, dict) or not isinstance(metadata.get(METADATA_KEY), str):
        raise MapFileError(f"not a map file: no header under {METADATA_KEY!r}")
    header = _json(metadata[METADATA_KEY].encode(errors="replace"))
    if header.get("format") != FORMAT:
        raise MapFileError(f"not a map file: its header's format is not {FORMAT!r}")
    if header.get("version") != VERSION or isinstance(header.get("version"), bool):
        raise MapFileError(
            f"map file of version {header.get('version')!r:.40}; this program reads {VERSION}"
        )
    return header


def _columns(data: bytes, outer: dict[str, Any]) -> Columns:
    for name, dtypes in _DTYPES.items():
        entry = outer[name]
        if not isinstance(entry, dict) or entry.get("dtype") not in dtypes:
            raise MapFileError(f"{name}: not of type {' or '.join(dtypes)}")
    try:
        # Checks shapes and offsets against the length of `data` before it allocates.
        loaded = safetensors.numpy.load(data)
    except (safetensors.SafetensorError, ValueError) as error:
        raise MapFileError(f"cut short, too long, or not safetensors: {error}") from error
    columns = {
        name: column.astype(column.dtype.newbyteorder("<"), copy=False)
        for name, column in loaded.items()
    }
    if columns["centroids"].shape[1:] != (3,):
        raise MapFileError("centroids: not of shape (n, 3)")
    return columns


def _json(text: bytes) -> dict[str, Any]:
    try:
        value = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise MapFileError(f"not a map file: its header is not JSON ({error})") from error
    if not isinstance(value, dict):
        raise MapFileError("not a map file: its header is not a JSON object")
    return value
