"""Shapes of stored segments, decoded from what a map holds of them."""

from collections.abc import Callable, Iterable
from dataclasses import replace

import numpy as np
from placecell_client import CompactMap

from placecell.core.types import Float32, Int64
from placecell.export.content import ExportContent
from placecell.shapes.decoder import ShapeDecoder, StoredSegments
from placecell.shapes.geometry import points_of
from service.clouds.map_export import content_of_map

CHUNK = 512
"""Number of segments whose grids are in memory at once, 26 kB each."""

Progress = Callable[[range, int, str], Iterable[int]]
"""Function that wraps a loop: its steps, their number, and what it does."""


def stored_segments(content: CompactMap) -> StoredSegments:
    """Return what the decoder reads of a map's segments."""
    counts = None if content.points is None else content.points.astype(np.int64)
    return StoredSegments(
        codes=content.codes,
        centroids=content.centroids,
        sensors=content.frame_positions[content.frame_index],
        extents=content.extents,
        counts=counts,
    )


def decoded_points(
    content: CompactMap,
    decoder: ShapeDecoder,
    progress: Progress | None = None,
    chunk: int = CHUNK,
) -> tuple[Float32, Int64]:
    """Return the points of all segments, float32 (points, 3), and the row of each, int64 (points,).

    Args:
        content: map of the decoder's model.
        decoder: decodes the shapes.
        progress: wraps the loop.
        chunk: number of segments that are decoded at once. A quantized decoder rounds by the values
            of its batch; with 1, a shape does not depend on the other segments.
    """
    stored = stored_segments(content)
    starts = range(0, len(stored), chunk)
    parts: list[Float32] = [np.zeros((0, 3), np.float32)]
    owners: list[Int64] = [np.zeros(0, np.int64)]
    steps = starts if progress is None else progress(starts, len(starts), "decoding shapes")
    for first in steps:
        shapes = decoder.decode(stored.part(first, min(first + chunk, len(stored))))
        points, rows = points_of(shapes)
        parts.append(points)
        owners.append(first + rows)
    return np.concatenate(parts), np.concatenate(owners)


def rendered_content(
    content: CompactMap, decoder: ShapeDecoder, progress: Progress | None = None
) -> ExportContent:
    """Return the content of a map for an export, with the decoded points of its segments."""
    points, owners = decoded_points(content, decoder, progress)
    return replace(
        content_of_map(content), points=points.astype(np.float64), owners=owners, remarks=()
    )
