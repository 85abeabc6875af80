"""Merges of maps that drift: things that both robots saw, and localization in the merged map."""

from collections.abc import Sequence
from time import perf_counter
from typing import Any

import numpy as np
from placecell_client import CompactMap
from placecell_client.maps.edit import take

from benchmarks.drift.town_maps import TrueMap
from benchmarks.drift.views import shared_things, within
from placecell.core.types import Float64, Int64
from placecell.pose_graph import GraphMap
from placecell.pose_graph.frames import headings, relative, wrapped
from service.engine import Engine
from service.inference.describer import Descriptors
from service.merging.bending import bent_content, graph_of, robots_of_captures

EVERY = 10.0
"""Way between two captures that are localized, meters."""

REACH = 4.9
"""Way around such a capture whose segments are localized: no segment has two views in it."""

NEAR = 10.0
"""Distance from the other robots' captures within which a capture is localized, meters."""

RIGHT = (1.0, 3.0)
"""Largest error of a right pose relative to the nearest capture of the map, meters and degrees."""


def merge_row(maps: Sequence[TrueMap], engine: Engine) -> dict[str, Any]:
    """Merge maps as `/merge` with `rigid: false`; return the keys that the report has for it.

    Each robot is localized in the merged map without its own segments, and in the same map with all
    captures at their true poses.
    """
    names = [f"drift-{number}" for number in range(len(maps))]
    try:
        for name, each in zip(names, maps, strict=True):
            engine.put_map(name, each.content)
        begun = perf_counter()
        # All views stay, to compare those of different robots.
        merged = engine.merge_maps("drift-merged", names, deduplicate=False, rigid=False)
        seconds = perf_counter() - begun
        content = engine.get_map("drift-merged")
    finally:
        for name in [*names, "drift-merged"]:
            if engine.maps.find(name) is not None:
                engine.delete_map(name)
    true = true_poses(content, maps)
    graph = graph_of(content)
    straight = bent_content(content, graph, true[:, :3, 3], headings(true[:, :3, :3]))
    row = {
        "merge_seconds": round(seconds, 1),
        "merged_maps": len(merged.plan.poses),
        "merged_within_0_3_m": round(within(graph, shared_things(graph, true)), 4),
    }
    for key, where in (("localized_merged", content), ("localized_undrifted", straight)):
        asked, right, wrong = localized(where, true, engine)
        row |= {"localized_queries": asked, key: round(right / max(asked, 1), 4)}
        row[f"{key}_wrong"] = wrong
    return row


def true_poses(content: CompactMap, maps: Sequence[TrueMap]) -> Float64:
    """Return the true pose of each capture of a merged map, float64 (f, 4, 4)."""
    known = {
        (each.content.robots[0], time): pose
        for each in maps
        for time, pose in zip(each.content.frame_times.tolist(), each.poses, strict=True)
    }
    keys = zip(robots_of_captures(content), content.frame_times.tolist(), strict=True)
    return np.stack([known[key] for key in keys])


def localized(content: CompactMap, true: Float64, engine: Engine) -> tuple[int, int, int]:
    """Localize each robot among the others; return the number of queries, right and wrong poses."""
    graph = graph_of(content)
    names = np.array(robots_of_captures(content))
    spots, turns = true[:, :3, 3], headings(true[:, :3, :3])
    counts = np.zeros(3, dtype=np.int64)
    for name in dict.fromkeys(names.tolist()):
        others = np.flatnonzero(names[graph.captures] != name)
        captures = np.unique(graph.captures[others])
        engine.put_map("drift-others", take(content, others))
        try:
            for query in _queries(graph, np.flatnonzero(names == name)):
                apart = np.linalg.norm(spots[captures] - spots[query], axis=1)
                if apart.min() > NEAR:
                    continue
                counts[0] += 1
                pose = _pose(content, graph, query, engine)
                if pose is None:
                    continue
                one = captures[apart.argmin()]
                frames = graph.frames
                there, turn = relative(
                    frames.positions[[one]], frames.yaws[[one]], pose[0][None], pose[1][None]
                )
                wanted, turned = relative(
                    spots[[one]], turns[[one]], spots[[query]], turns[[query]]
                )
                meters = np.linalg.norm(there - wanted)
                degrees = np.degrees(abs(wrapped(turn - turned)[0]))
                counts[1 if meters <= RIGHT[0] and degrees <= RIGHT[1] else 2] += 1
        finally:
            engine.delete_map("drift-others")
    return int(counts[0]), int(counts[1]), int(counts[2])


def _queries(graph: GraphMap, captures: Int64) -> Int64:
    """Return one capture for each 10 m of way."""
    ways = graph.frames.ways[captures]
    order = np.argsort(ways, kind="stable")
    _, first = np.unique(np.floor(ways[order] / EVERY), return_index=True)
    return captures[order[first]]


def _pose(
    content: CompactMap, graph: GraphMap, query: int, engine: Engine
) -> tuple[Float64, Float64] | None:
    """Localize the segments around a capture; return its position and heading, or None."""
    frames = graph.frames
    same = frames.odometry.tracks[graph.captures] == frames.odometry.tracks[query]
    near = np.abs(frames.ways[graph.captures] - frames.ways[query]) <= REACH
    rows = np.flatnonzero(same & near)
    # As the robot knows them: in the frame of its odometry.
    driven = graph.as_driven()
    at, yaw = driven.frames.positions[query], driven.frames.yaws[query]
    places, _ = relative(
        np.tile(at, (len(rows), 1)),
        np.full(len(rows), yaw),
        driven.centroids[rows],
        np.zeros(len(rows)),
    )
    seen = Descriptors(content.model_id, content.codes[rows], None, places, {})
    found = engine.localize(seen, ["drift-others"])
    best = found[0].localization.pose if len(found) else None
    return None if best is None else (best.translation, np.array(best.yaw))
