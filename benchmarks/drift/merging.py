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
from service.core.problems import Problem
from service.engine import Engine
from service.inference.describer import Descriptors
from service.merging.bending import bent_content, graph_of, robots_of_captures

EVERY = 10.0
"""Way between two captures that are localized, meters, unless the plan states another one."""

STRETCH = 100.0
"""Way whose queries are drawn together for the confidence interval, meters: neighbors see the same
segments."""

DRAWS = 4_000
"""Number of draws for the confidence interval."""

NOT_LOCALIZED, IS_RIGHT, IS_WRONG = 0, 1, 2
"""Outcomes of a query."""

REACH = 4.9
"""Way around such a capture whose segments are localized: no segment has two views in it."""

NEAR = 10.0
"""Distance from the other robots' captures within which a capture is localized, meters."""

RIGHT = (1.0, 3.0)
"""Largest error of a right pose relative to the nearest capture of the map, meters and degrees."""


def merge_row(maps: Sequence[TrueMap], engine: Engine, every: float = EVERY) -> dict[str, Any]:
    """Merge maps as `/merge` with `rigid: false`; return the keys that the report has for it.

    Each robot is localized in the merged map without its own segments, and in the same map with all
    captures at their true poses.

    Args:
        maps: maps of the robots.
        engine: engine that merges and localizes.
        every: way between two captures that are localized, meters.
    """
    names = [f"drift-{number}" for number in range(len(maps))]
    try:
        for name, each in zip(names, maps, strict=True):
            engine.put_map(name, each.content)
        begun = perf_counter()
        # All views stay, to compare those of different robots.
        try:
            merged = engine.merge_maps("drift-merged", names, deduplicate=False, rigid=False)
        except Problem as error:  # too much drift to align the maps as a whole
            return {"merged_maps": 0, "merge_problem": error.kind}
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
    captures = {key: capture for capture, key in enumerate(capture_keys(content))}
    outcomes = []
    for where in (content, straight):
        # Captures of one time are ordered by their places, which differ between the two maps.
        same = np.array([captures[key] for key in capture_keys(where)], dtype=np.int64)
        found = localized(where, true[same], engine, every)
        found[:, 0] = same[found[:, 0]]
        outcomes.append(found[np.argsort(found[:, 0])])
    for key, found in zip(("localized_merged", "localized_undrifted"), outcomes, strict=True):
        row |= {
            "localized_queries": len(found),
            key: round(float((found[:, 1] == IS_RIGHT).mean()), 4) if len(found) else 0.0,
            f"{key}_wrong": int((found[:, 1] == IS_WRONG).sum()),
        }
    low, high = interval_of_difference(graph, *outcomes)
    return row | {"localized_difference_low": low, "localized_difference_high": high}


def interval_of_difference(graph: GraphMap, merged: Int64, undrifted: Int64) -> tuple[float, float]:
    """Return the 95% confidence interval of the difference between two shares of right poses.

    The queries of both are the same. Whole stretches of 100 m are drawn again and again
    (bootstrap), because queries beside each other succeed or fail together.

    Args:
        graph: the map.
        merged: int64 (queries, 2), capture and outcome of each query in the merged map.
        undrifted: the same queries in the undrifted map, in the same order.
    """
    if not len(merged):
        return 0.0, 0.0
    assert (merged[:, 0] == undrifted[:, 0]).all(), "the queries of the two maps differ"
    queries = merged[:, 0]
    step = (merged[:, 1] == IS_RIGHT).astype(int) - (undrifted[:, 1] == IS_RIGHT)
    stretches = np.column_stack(
        [graph.frames.odometry.tracks[queries], graph.frames.ways[queries] // STRETCH]
    )
    _, stretch = np.unique(stretches, axis=0, return_inverse=True)
    sums, counts = np.bincount(stretch, step), np.bincount(stretch)
    drawn = np.random.default_rng(23).integers(0, len(counts), (DRAWS, len(counts)))
    shares = sums[drawn].sum(axis=1) / counts[drawn].sum(axis=1)
    low, high = np.quantile(shares, [0.025, 0.975]).round(4).tolist()
    return low, high


def true_poses(content: CompactMap, maps: Sequence[TrueMap]) -> Float64:
    """Return the true pose of each capture of a merged map, float64 (f, 4, 4)."""
    known = {
        (each.content.robots[0], time): pose
        for each in maps
        for time, pose in zip(each.content.frame_times.tolist(), each.poses, strict=True)
    }
    return np.stack([known[key] for key in capture_keys(content)])


def capture_keys(content: CompactMap) -> list[tuple[str, float]]:
    """Return robot and time of each capture, which identify it in each map of these robots."""
    return list(zip(robots_of_captures(content), content.frame_times.tolist(), strict=True))


def localized(content: CompactMap, true: Float64, engine: Engine, every: float = EVERY) -> Int64:
    """Localize each robot among the others; return capture and outcome, int64 (queries, 2)."""
    graph = graph_of(content)
    names = np.array(robots_of_captures(content))
    spots, turns = true[:, :3, 3], headings(true[:, :3, :3])
    outcomes = []
    for name in dict.fromkeys(names.tolist()):
        others = np.flatnonzero(names[graph.captures] != name)
        captures = np.unique(graph.captures[others])
        engine.put_map("drift-others", take(content, others))
        try:
            for query in _queries(graph, np.flatnonzero(names == name), every):
                apart = np.linalg.norm(spots[captures] - spots[query], axis=1)
                if apart.min() > NEAR:
                    continue
                pose = _pose(content, graph, query, engine)
                if pose is None:
                    outcomes.append((query, NOT_LOCALIZED))
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
                is_right = meters <= RIGHT[0] and degrees <= RIGHT[1]
                outcomes.append((query, IS_RIGHT if is_right else IS_WRONG))
        finally:
            engine.delete_map("drift-others")
    return np.array(outcomes, dtype=np.int64).reshape(-1, 2)


def _queries(graph: GraphMap, captures: Int64, every: float) -> Int64:
    """Return one capture for each `every` meters of way."""
    ways = graph.frames.ways[captures]
    order = np.argsort(ways, kind="stable")
    _, first = np.unique(np.floor(ways[order] / every), return_index=True)
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
