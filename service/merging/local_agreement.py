"""Local agreement: a merge plan for maps that drift too much to align as a whole.

Loops between the maps show where they agree locally. The maps are bent by these loops, and must
then align as a whole, by the rules of every merge. So loops alone never join two maps.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters
from placecell.pose_graph import PoseGraphParameters
from placecell.pose_graph.between_maps import bend_between
from placecell.pose_graph.known_loops import KnownLoops
from service.inference.model_registry import Model
from service.maps.index import index_of
from service.maps.layers import MapLayers
from service.merging.alignment import CancellationCheck, MapSide
from service.merging.bending import bent_content, graph_of
from service.merging.graph_search import StoredSegmentSearch
from service.merging.plan import MergePlan, plan_of


def plan_by_loops(
    plan: MergePlan,
    known: Mapping[int, Pose],
    model: Model,
    parameters: AlignmentParameters,
    check: CancellationCheck,
) -> MergePlan:
    """Bend maps by the loops between them, and plan their merge again.

    Args:
        plan: plan of the maps as they are.
        known: poses of maps that were merged before, by number; these maps are not bent.
        model: model of their descriptors.
        parameters: parameters of the alignments.
        check: raises `Cancelled` if the deadline passed or the client disconnected.

    Returns:
        The new plan, if it places more maps than the given one does, and all of those; else the
        given one.
    """
    sides = list(plan.sides)
    loose = [number for number in range(len(sides)) if number not in known]
    if len(loose) < 2:
        return plan
    bent, loops = bent_sides([sides[each] for each in loose], model)
    for number, side in zip(loose, bent, strict=True):
        sides[number] = side
    check()
    again = plan_of(tuple(sides), model, parameters, check)
    poses = again.poses | dict(known)
    return replace(again, poses=poses, loops=loops) if poses.keys() > plan.poses.keys() else plan


def bent_sides(sides: Sequence[MapSide], model: Model) -> tuple[list[MapSide], KnownLoops | None]:
    """Move the captures of maps by the loops between them, each map in its own frame.

    Returns:
        The maps, and the loops for the optimization of the merged map.
    """
    contents = [side.content for side in sides]
    if not all(len(each) for each in contents):
        return list(sides), None
    graphs = [graph_of(each) for each in contents]
    codes = np.concatenate([each.codes for each in contents])
    # The largest map shows best how much the segments of the place are alike.
    largest = MapLayers.of(max(contents, key=len))
    search = StoredSegmentSearch(
        model,
        codes,
        index_of(codes, model.manifest.quantizer),
        largest.sites.of(largest, model.manifest),
    )
    found = bend_between(graphs, search, PoseGraphParameters(), model.confidence)
    moved = [
        MapSide.holding(side.snapshot, bent_content(side.content, graph, *poses))
        for side, graph, poses in zip(sides, graphs, found.poses, strict=True)
    ]
    return moved, found.known
