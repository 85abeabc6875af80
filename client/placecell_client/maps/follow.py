"""Follow: moves captures as other captures of their odometry track were moved before.

The optimization of a map moves captures, but a robot goes on writing in the frame of its odometry.
Its new captures follow the nearest capture of the same track, so they join the moved map.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from placecell_client.maps.canonical import canonical
from placecell_client.maps.compact_map import CompactMap

EXACT = 5e-3
"""Movement up to which captures stay exactly as they are, meters and radians: orientations are
float32, so the captures of a long track follow within some millimeters only."""


def followed(content: CompactMap, stored: Sequence[CompactMap]) -> CompactMap:
    """Return a map whose captures follow those of the same odometry tracks in other maps.

    The map itself is returned if nothing was moved.

    Args:
        content: A valid map.
        stored: Maps in the same coordinate frame, such as the layers of a stored map.
    """
    known = [each for each in stored if each.has_odometry and len(each.frame_times)]
    if not content.has_odometry or not known or not len(content.frame_times):
        return content
    assert content.frame_tracks is not None
    assert content.frame_odometry is not None
    tracks = np.concatenate([each.frame_tracks for each in known if each.frame_tracks is not None])
    times = np.concatenate([each.frame_times for each in known])
    turns, shifts = _corrections(known)
    own_turns, _ = _corrections([content])
    nearest = np.full(len(content.frame_times), -1)
    for track in np.unique(content.frame_tracks).tolist():
        rows = np.flatnonzero(tracks == track)
        if not track or not len(rows):
            continue
        rows = rows[np.argsort(times[rows], kind="stable")]
        mine = np.flatnonzero(content.frame_tracks == track)
        after = np.searchsorted(times[rows], content.frame_times[mine]).clip(max=len(rows) - 1)
        before = (after - 1).clip(min=0)
        gaps = [np.abs(times[rows[each]] - content.frame_times[mine]) for each in (before, after)]
        nearest[mine] = rows[np.where(gaps[0] < gaps[1], before, after)]
    found = nearest >= 0
    turn = np.where(found, turns[nearest] - own_turns, 0.0)
    turn = (turn + np.pi) % (2 * np.pi) - np.pi
    spots = _turned(content.frame_odometry[:, :3], turns[nearest]) + shifts[nearest]
    shift = np.where(found[:, None], spots - content.frame_positions, 0.0)
    if np.abs(shift).max() <= EXACT and np.abs(turn).max() <= EXACT:
        return content
    frames = content.frame_index
    offsets = content.centroids - content.frame_positions[frames]
    positions = content.frame_positions + shift
    return canonical(
        replace(
            content,
            frame_positions=positions,
            frame_orientations=_rotated(content.frame_orientations, turn),
            centroids=positions[frames] + _turned(offsets, turn[frames]),
        )
    )


def moved_at(
    before: CompactMap, after: CompactMap, position: Sequence[float]
) -> NDArray[np.float64] | None:
    """Return how a place moved from one version of a map to another, as a transform (4, 4).

    A robot that knew its pose in the earlier version has the transform times this pose in the later
    one. The nearest capture that both versions have determines it.

    Args:
        before: Earlier version.
        after: Later version.
        position: Place in the earlier version, meters, (3,).

    Returns:
        The transform; None if the versions share no capture with odometry.
    """
    if not (before.has_odometry and after.has_odometry):
        return None
    rows = [_keys(each) for each in (before, after)]
    shared = sorted(rows[0].keys() & rows[1].keys())
    if not shared:
        return None
    here, there = (np.array([each[key] for key in shared]) for each in rows)
    away = np.linalg.norm(before.frame_positions[here] - np.asarray(position), axis=1)
    one, other = int(here[away.argmin()]), int(there[away.argmin()])
    turn = _headings(after)[other] - _headings(before)[one]
    cos, sin = np.cos(turn), np.sin(turn)
    moved = np.eye(4)
    moved[:2, :2] = [[cos, -sin], [sin, cos]]
    moved[:3, 3] = after.frame_positions[other] - moved[:3, :3] @ before.frame_positions[one]
    return moved


def _keys(content: CompactMap) -> dict[tuple[int, float], int]:
    """Return the row of each capture with odometry, by track and time."""
    assert content.frame_tracks is not None
    pairs = zip(content.frame_tracks.tolist(), content.frame_times.tolist(), strict=True)
    return {key: row for row, key in enumerate(pairs) if key[0]}


def _corrections(
    maps: Sequence[CompactMap],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Return rotation about z (f,) and shift (f, 3) from the odometry to the map, by capture."""
    odometry = np.concatenate(
        [each.frame_odometry for each in maps if each.frame_odometry is not None]
    )
    turns = np.concatenate([_headings(each) for each in maps]) - odometry[:, 3]
    positions = np.concatenate([each.frame_positions for each in maps])
    return turns, positions - _turned(odometry[:, :3], turns)


def _headings(content: CompactMap) -> NDArray[np.float64]:
    """Return the heading of the sensor's x axis of each capture, radians."""
    x, y, z, w = content.frame_orientations.astype(np.float64).T
    return np.asarray(np.arctan2(2 * (x * y + z * w), 1 - 2 * (y * y + z * z)))


def _turned(points: NDArray[np.float64], angles: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rotate each point (n, 3) about z by its angle (n,)."""
    cos, sin = np.cos(angles), np.sin(angles)
    x, y, z = points.T
    return np.column_stack([cos * x - sin * y, sin * x + cos * y, z])


def _rotated(orientations: NDArray[np.float32], angles: NDArray[np.float64]) -> NDArray[np.float32]:
    """Rotate each orientation about the map's z axis by its angle."""
    x, y, z, w = orientations.astype(np.float64).T
    cos, sin = np.cos(angles / 2), np.sin(angles / 2)
    turned = np.column_stack(
        [cos * x - sin * y, cos * y + sin * x, cos * z + sin * w, cos * w - sin * z]
    )
    turned /= np.linalg.norm(turned, axis=1, keepdims=True)
    return turned.astype(np.float32)
