"""A compact map as the columns and header of a file, and back."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps.canonical import centimeters
from placecell_client.maps.compact_map import OPTIONAL, CompactMap, MapFileError
from placecell_client.maps.container import Columns

REQUIRED = frozenset(
    {
        "frame_positions", "frame_times", "frame_orientations",
        "ids", "frame_index", "centroids", "robot", "codes",
    }
)  # fmt: skip
SCALE_CM = 1
REACH_CM = 32_767
"""From a sensor to its segment, along each axis: what an int16 holds of either sign."""


def columns_of(ordered: CompactMap) -> Columns:
    """The columns of a canonical map.

    Raises:
        MapFileError: a segment is too far from its sensor.
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
    return columns


def header_of(ordered: CompactMap) -> dict[str, Any]:
    """The header's part that tells of a canonical map."""
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
    """The map of a header and columns.

    Raises:
        MapFileError: they are not a map's; the map that is returned is not yet checked.
    """
    try:
        if header["scale_cm"] != SCALE_CM or isinstance(header["scale_cm"], bool):
            raise MapFileError(
                f"header: scale_cm is {header['scale_cm']!r:.40}; this program reads {SCALE_CM}"
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
        )
    except MapFileError:
        raise
    except (KeyError, TypeError, ValueError, OverflowError) as error:
        raise MapFileError(f"header: a value is missing or of a wrong type ({error})") from error


def _from_sensors(ordered: CompactMap) -> NDArray[np.int16]:
    """Centroids as whole centimetres from their frame's sensor."""
    sensors = centimeters(ordered.frame_positions)
    steps = np.empty(ordered.centroids.shape, dtype="<i2")
    for axis in range(3):  # one at a time: a third of the memory
        offsets = centimeters(ordered.centroids[:, axis]) - sensors[ordered.frame_index, axis]
        far = np.flatnonzero(np.abs(offsets) > REACH_CM)
        if len(far):
            raise MapFileError(
                f"centroids: segment {ordered.ids[far[0]]} is {abs(offsets[far[0]]) / 100:.2f} m "
                f"from its frame's sensor along axis {axis}; at most {REACH_CM / 100} m"
            )
        steps[:, axis] = offsets
    return steps


def _in_frame(columns: Columns) -> NDArray[np.float64]:
    """Centroids in the coordinate frame, metres."""
    steps, positions, index = (
        columns[name] for name in ("centroids", "frame_positions", "frame_index")
    )
    # Before any arithmetic: what does not fit would be broadcast.
    for name, shape in {
        "centroids": (len(index), 3),
        "frame_positions": (len(positions), 3),
    }.items():
        if columns[name].shape != shape:
            raise MapFileError(f"{name}: {columns[name].shape}, not {shape}")
    if index.ndim != 1:
        raise MapFileError(f"frame_index: {index.shape}, not one number a segment")
    if len(index) and int(index.max()) >= len(positions):
        raise MapFileError(f"frame_index: index {int(index.max())} in a table of {len(positions)}")
    with np.errstate(all="ignore"):  # what is not finite is refused by the map's check
        centroids = centimeters(positions)[index]
        centroids += steps
        centroids /= 100
    return centroids


def _text(header: dict[str, Any], key: str) -> str:
    if not isinstance(header[key], str):
        raise MapFileError(f"header: {key} is not a text")
    return str(header[key])
