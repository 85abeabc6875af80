"""Conversion between a compact map and the columns and header of a file."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps.canonical import centimeters
from placecell_client.maps.compact_map import (
    ODOMETRY_COLUMNS,
    OPTIONAL,
    CompactMap,
    MapFileError,
)
from placecell_client.maps.container import Columns

REQUIRED = frozenset(
    {
        "frame_positions", "frame_times", "frame_orientations",
        "ids", "frame_index", "centroids", "robot", "codes",
    }
)  # fmt: skip
SCALE_CM = 1
"""Unit of the centroids in a file, centimeters."""
REACH_CM = 32_767
"""Largest offset from a sensor to its segment along an axis, cm: the range of int16."""


def columns_of(ordered: CompactMap) -> Columns:
    """Return the columns of a canonical map.

    Raises:
        MapFileError: A segment is too far from its sensor.
    """
    columns: Columns = {
        "frame_positions": ordered.frame_positions.astype("<f8", copy=False),
        "frame_times": ordered.frame_times.astype("<f8", copy=False),
        "frame_orientations": ordered.frame_orientations.astype("<f4", copy=False),
        "ids": ordered.ids.astype("<u4", copy=False),
        "frame_index": ordered.frame_index.astype(
            "<u2" if len(ordered.frame_times) <= 1 << 16 else "<u4"
        ),
        "centroids": _from_sensors(ordered),
        "robot": ordered.robot.astype("u1" if len(ordered.robots) <= 1 << 8 else "<u2"),
        "codes": ordered.codes,
    }
    for name in ordered.optional:
        column: NDArray[Any] = getattr(ordered, name)
        columns[name] = column.astype(column.dtype.newbyteorder("<"), copy=False)
    if ordered.frame_tracks is not None and ordered.frame_odometry is not None:
        columns["frame_tracks"] = ordered.frame_tracks.astype("<u4", copy=False)
        columns["frame_odometry"] = ordered.frame_odometry.astype("<f8", copy=False)
    return columns


def header_of(ordered: CompactMap) -> dict[str, Any]:
    """Return the header fields of a canonical map."""
    span = ordered.time_span
    sources = {"sources": list(ordered.sources)} if ordered.source is not None else {}
    return sources | {
        "model_id": ordered.model_id,
        "preprocessing": ordered.preprocessing,
        "frame": ordered.frame,
        "robots": list(ordered.robots),
        "count": len(ordered),
        "time_span_us": [int(np.floor(span[0] * 1e6)), int(np.ceil(span[1] * 1e6))] if span else [],
        "scale_cm": SCALE_CM,
    }


def map_of(header: dict[str, Any], columns: Columns) -> CompactMap:
    """Build a map from a header and columns; the map is not yet checked.

    Raises:
        MapFileError: A field or column is missing or has a wrong type.
    """
    try:
        if header["scale_cm"] != SCALE_CM or isinstance(header["scale_cm"], bool):
            raise MapFileError(
                f"header: scale_cm is {header['scale_cm']!r:.40}, expected {SCALE_CM}"
            )
        return CompactMap(
            model_id=_text(header, "model_id"),
            preprocessing=_text(header, "preprocessing"),
            frame=_text(header, "frame"),
            codes=columns["codes"],
            centroids=_in_frame(columns),
            ids=columns["ids"].astype(np.uint32, copy=False),
            robots=tuple(_text({"robots": name}, "robots") for name in header["robots"]),
            robot=columns["robot"].astype(np.uint16, copy=False),
            frame_index=columns["frame_index"].astype(np.uint32, copy=False),
            frame_times=columns["frame_times"].astype(np.float64, copy=False),
            frame_positions=columns["frame_positions"].astype(np.float64, copy=False),
            frame_orientations=columns["frame_orientations"].astype(np.float32, copy=False),
            sources=tuple(
                _text({"sources": name}, "sources") for name in header.get("sources", ())
            ),
            **{
                name: columns[name].astype(dtype, copy=False)
                for name, (dtype, _) in OPTIONAL.items()
                if name in columns
            },
            **{
                name: columns[name].astype(dtype, copy=False)
                for name, dtype in zip(ODOMETRY_COLUMNS, (np.uint32, np.float64), strict=True)
                if name in columns
            },
        )
    except MapFileError:
        raise
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise MapFileError(f"header: a value is missing or has a wrong type ({error})") from error


def _from_sensors(ordered: CompactMap) -> NDArray[np.int16]:
    """Return the centroids as whole centimeters from their frame's sensor."""
    sensors = centimeters(ordered.frame_positions)
    steps = np.empty(ordered.centroids.shape, dtype="<i2")
    for axis in range(3):  # one axis at a time needs a third of the memory
        offsets = centimeters(ordered.centroids[:, axis]) - sensors[ordered.frame_index, axis]
        far = np.flatnonzero(np.abs(offsets) > REACH_CM)
        if len(far):
            raise MapFileError(
                f"centroids: segment {ordered.ids[far[0]]} is {abs(offsets[far[0]]) / 100:.2f} m "
                f"from its frame's sensor along axis {axis}; the limit is {REACH_CM / 100} m"
            )
        steps[:, axis] = offsets
    return steps


def _in_frame(columns: Columns) -> NDArray[np.float64]:
    """Return the centroids in the coordinate frame, meters."""
    steps, positions, index = (
        columns[name] for name in ("centroids", "frame_positions", "frame_index")
    )
    # Check shapes before any arithmetic, which would broadcast.
    for name, shape in {
        "centroids": (len(index), 3),
        "frame_positions": (len(positions), 3),
    }.items():
        if columns[name].shape != shape:
            raise MapFileError(f"{name}: shape {columns[name].shape}, expected {shape}")
    if index.ndim != 1:
        raise MapFileError(f"frame_index: shape {index.shape}, expected one number per segment")
    if len(index) and int(index.max()) >= len(positions):
        raise MapFileError(
            f"frame_index: index {int(index.max())}, but the table has {len(positions)} entries"
        )
    with np.errstate(all="ignore"):  # the map's check refuses values that are not finite
        centroids = centimeters(positions)[index]
        centroids += steps
        centroids /= 100
    return centroids


def _text(header: dict[str, Any], key: str) -> str:
    if not isinstance(header[key], str):
        raise MapFileError(f"header: {key} is not a string")
    return str(header[key])
