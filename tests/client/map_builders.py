"""Builders of random maps, and of maps with common segments."""

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from hypothesis import strategies as st
from placecell_client import CompactMap, Delta
from placecell_client.maps.compact_map import OPTIONAL

PROVENANCE = ("source", "source_ids")
LONG_LIFE = ("missed", "confirmed", "absent")
TOGETHER = (PROVENANCE, LONG_LIFE)
GROUPS = [*((name,) for name in OPTIONAL if not any(name in each for each in TOGETHER)), *TOGETHER]
"""Groups of optional columns that come together."""
SOURCES = ("west", "unused", "east")


def random_map(
    segments: int = 20,
    dimension: int = 4,
    frames: int = 5,
    extent: float = 300.0,
    seed: int = 0,
    robots: tuple[str, ...] = ("zoe", "ann"),
    optional: Iterable[str] = (),
) -> CompactMap:
    """Build a random map: sensors within `extent`, segments within 40 m of their sensor."""
    random = np.random.default_rng(seed)
    quaternions = random.normal(size=(frames, 4))
    quaternions /= np.linalg.norm(quaternions, axis=1, keepdims=True)
    positions = random.uniform(-extent / 2, extent / 2, (frames, 3))
    frame_index = (np.arange(segments) % frames).astype(np.uint32)
    given = CompactMap(
        model_id="tiny-0123456789abcdef",
        preprocessing="1",
        frame="town",
        codes=random.integers(-127, 128, (segments, dimension)).astype(np.int8),
        centroids=positions[frame_index] + random.uniform(-40, 40, (segments, 3)),
        ids=random.permutation(segments * 3)[:segments].astype(np.uint32),
        robots=robots,
        robot=(np.arange(segments) % len(robots)).astype(np.uint16),
        frame_index=frame_index,
        frame_times=1.7e9 + np.sort(random.uniform(0, 100, frames)),
        frame_positions=positions,
        frame_orientations=quaternions.astype(np.float32),
    )
    columns: dict[str, Any] = {
        "extents": random.integers(0, 256, (segments, 3)).astype(np.uint8),
        "points": random.integers(0, 1 << 16, segments).astype(np.uint16),
        "views": given.ids[random.integers(0, max(segments, 1), segments)],
        "missed": random.integers(0, 1 << 32, segments).astype(np.uint32),
        "confirmed": random.integers(0, 256, segments).astype(np.uint8),
        "absent": random.integers(0, 256, segments).astype(np.uint8),
        "seen": random.integers(0, 1 << 32, segments).astype(np.uint32),
        "source": (np.arange(segments) % 3 + np.arange(segments) % 3 // 2).astype(np.uint16),
    }
    foreign = random.integers(0, 1 << 32, segments).astype(np.uint32)
    columns["source_ids"] = np.where(columns["source"], foreign, given.ids)
    columns["classes"] = random.integers(0, 249, segments).astype(np.uint8)
    chosen = {name: columns[name] for name in optional}
    return replace(given, sources=SOURCES if "source" in chosen else (), **chosen)


def column_sets(*groups: tuple[str, ...]) -> st.SearchStrategy[set[str]]:
    """Draw a set of optional columns: none to all of these groups."""
    return st.sets(st.sampled_from(groups)).map(
        lambda some: {name for each in some for name in each}
    )


COLUMN_SETS = column_sets(*GROUPS)
ORIENTATIONS = np.array([[0, 0, 0, 1], [0, 0, 0, -1], [1, 0, 0, 0], [-0.0, 0, 0, 1]], np.float32)


def with_tracks(given: CompactMap, track: int = 7) -> CompactMap:
    """Return a map whose captures have an odometry."""
    f = len(given.frame_times)
    odometry = np.column_stack([given.frame_positions, np.linspace(0, 1, f), np.zeros((f, 3))])
    return replace(given, frame_tracks=np.full(f, track, np.uint32), frame_odometry=odometry)


@st.composite
def maps(draw: st.DrawFn, optional: st.SearchStrategy[set[str]] = COLUMN_SETS) -> CompactMap:
    """Draw small maps from few values, so that two maps share ids, segments and captures."""
    ids = draw(st.lists(st.integers(0, 12), unique=True, max_size=10))
    n = len(ids)

    def column(values: st.SearchStrategy[Any], dtype: type, count: int = n, width: int = 0) -> Any:
        shape = (count, width) if width else (count,)
        size = int(np.prod(shape))
        drawn = draw(st.lists(values, min_size=size, max_size=size))
        return np.array(drawn, dtype).reshape(shape)

    few = st.integers(0, 1)
    frames = draw(st.integers(1, 3))
    robots = draw(st.permutations(["ann", "bob", "zoe"]))
    given = CompactMap(
        model_id="m",
        preprocessing="1",
        frame="yard",
        codes=column(few, np.int8, width=2),
        centroids=column(st.sampled_from([0.0, -0.0, 0.004, 1.0, -1.006]), np.float64, width=3),
        ids=np.array(ids, np.uint32),
        robots=tuple(robots),
        robot=column(st.integers(0, 2), np.uint16),
        frame_index=column(st.integers(0, frames - 1), np.uint32),
        frame_times=column(st.sampled_from([-1.5, 0.0, 2.5]), np.float64, frames),
        frame_positions=column(st.sampled_from([0.0, 0.005, 3.0]), np.float64, frames, 3),
        frame_orientations=ORIENTATIONS[column(st.integers(0, 3), np.intp, frames)],
    )
    chosen = draw(optional)
    widths = {"extents": 3}
    columns: dict[str, Any] = {
        name: column(few, OPTIONAL[name][0], width=widths.get(name, 0)) for name in sorted(chosen)
    }
    if "source" in chosen:
        columns["source"] = column(st.integers(0, 2), np.uint16)
        columns["source_ids"] = np.where(columns["source"], columns["source_ids"], given.ids)
        columns["sources"] = tuple(draw(st.permutations(["dock", "east", "west"])))
    if draw(st.booleans()):
        columns["frame_tracks"] = column(st.integers(0, 2), np.uint32, frames)
        columns["frame_odometry"] = column(st.sampled_from([0.0, -0.0, 1.5]), np.float64, frames, 7)
    return replace(given, **columns)


@st.composite
def deltas(
    draw: st.DrawFn, optional: st.SearchStrategy[set[str]] = COLUMN_SETS, since: int = 0
) -> Delta:
    """Draw a delta for any version, or from `since` to the next version."""
    changed = draw(maps(optional))
    removed = draw(st.sets(st.integers(0, 12))) - set(changed.ids.tolist())
    until = since + 1 if since else 0
    return Delta(changed, np.array(sorted(removed), np.uint32), since, until)
