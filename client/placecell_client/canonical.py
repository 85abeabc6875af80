"""The canonical form of a compact map, so that equal maps become equal files."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from placecell_client.compact_map import CompactMap

STEPS = 65_534
"""Between the lowest and highest of an int16 coordinate, -32767 to 32767."""


def canonical(compact_map: CompactMap) -> CompactMap:
    """Rows sorted by id, tables sorted, merged, only of what is used; centroids rounded."""
    rows = np.argsort(compact_map.ids)
    used_robots, robot = np.unique(compact_map.robot[rows], return_inverse=True)
    names = [compact_map.robots[index] for index in used_robots]
    order = sorted(range(len(names)), key=lambda index: names[index])
    ranks = np.argsort(order)

    used_frames, frame_index = np.unique(compact_map.frame_index[rows], return_inverse=True)
    table = np.column_stack(
        [
            compact_map.frame_times[used_frames],
            compact_map.frame_positions[used_frames],
            _one_sign(compact_map.frame_orientations[used_frames]),
        ]
    )
    # Adding zero makes -0.0 and 0.0 the same bytes.
    merged, places = np.unique(table + 0.0, axis=0, return_inverse=True)
    return replace(
        compact_map,
        codes=np.ascontiguousarray(compact_map.codes[rows]),
        centroids=snap(compact_map.centroids[rows]),
        ids=compact_map.ids[rows],
        robots=tuple(names[index] for index in order),
        robot=ranks[robot].astype(np.uint16),
        frame_index=places.reshape(-1)[frame_index].astype(np.uint32),
        frame_times=merged[:, 0],
        frame_positions=merged[:, 1:4],
        frame_orientations=merged[:, 4:].astype(np.float32),
    )


def choose_scale(centroids: NDArray[np.float64]) -> int:
    """Centimetres a step, the least power of two with which the map's extent fits an int16."""
    scale_cm = 1
    while len(centroids):
        steps = np.rint(centroids * 100 / scale_cm)
        if np.ptp(steps, axis=0).max() <= STEPS:
            break
        scale_cm *= 2
    return scale_cm


def snap(centroids: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rounded to whole multiples of their scale from the frame's own origin, metres.

    Multiples from the frame's origin, not from the map's corner: a map that loses or gains
    segments is not rounded a second time. At the limit of a scale, rounding can shrink the extent
    until the next finer scale fits too; the rounded values are multiples of that as well.
    """
    scale_cm = choose_scale(centroids)
    return np.asarray(np.rint(centroids * 100 / scale_cm) * scale_cm / 100 + 0.0)


def _one_sign(orientations: NDArray[np.float32]) -> NDArray[np.float32]:
    """Of q and -q, the same rotation, the one whose last component that is not zero is positive."""
    last = np.zeros(len(orientations), dtype=np.float32)
    for component in orientations.T:
        last = np.where(component != 0, component, last)
    return np.where(last[:, None] < 0, -orientations, orientations)
