"""Loop check: alignments of more than two maps are consistent around every loop, or rejected.

The composition of the alignments around a loop of maps must be the identity. If it is not, an
alignment of the loop is wrong. The other loops that contain an alignment show whether it is right.
If they do not decide, each alignment is compared with the composition of all others of its loop:
the maps themselves show whether they fit as well that way.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from placecell.core.types import Float64
from placecell.localization import Pose

if TYPE_CHECKING:
    import networkx

LONGEST = 4
"""Number of maps up to which all loops are checked. Of longer loops a cycle basis is checked."""

METERS, DEGREES = 1.0, 2.0
"""Largest position error, meters, and rotation error of a loop, per alignment."""


@dataclass(frozen=True, slots=True, eq=False)
class PairwiseAlignment:
    """Alignment of two maps: an edge of the graph of maps.

    Attributes:
        one, other: numbers of the maps.
        pose: transform from the frame of `other` to that of `one`.
        middle: float64 (3,), meters, mean centroid of the matched segments in the frame of `one`.
        weight: score of the alignment.
    """

    one: int
    other: int
    pose: Pose
    middle: Float64
    weight: float

    def into(self, number: int) -> Pose:
        """Return the transform into the frame of one of the two maps, from the other's."""
        return self.pose if number == self.one else self.pose.inverse()

    def middle_in(self, number: int) -> Float64:
        """Return `middle` in the frame of one of the two maps."""
        return self.middle if number == self.one else self.pose.inverse().apply(self.middle)


FitsAsWell = Callable[[int, Pose], bool]
"""Function (index of an alignment, pose) -> whether its maps fit as well by this pose."""


@dataclass(frozen=True, slots=True)
class Loop:
    """Loop of maps.

    Attributes:
        maps: numbers of the maps, in the order of the loop.
        alignments: indices of the alignments of the loop.
        meters: position error after one round, meters.
        degrees: rotation error after one round.
    """

    maps: tuple[int, ...]
    alignments: tuple[int, ...]
    meters: float
    degrees: float

    @property
    def closes(self) -> bool:
        """True if the errors are within the limits."""
        steps = len(self.alignments)
        return self.meters <= METERS * steps and self.degrees <= DEGREES * steps


@dataclass(frozen=True, slots=True)
class LoopCheck:
    """Result of the loop check.

    Attributes:
        rejected: indices of the wrong alignments, in the order of their rejection.
        loops: loops of all alignments, including the rejected ones.
        proven: indices of the alignments that are part of a closed loop and not rejected.
    """

    rejected: tuple[int, ...]
    loops: tuple[Loop, ...]
    proven: frozenset[int]


def check_loops(
    alignments: Sequence[PairwiseAlignment], fits_as_well: FitsAsWell = lambda *_: False
) -> LoopCheck:
    """Reject alignments until every loop closes.

    The first to be rejected is the alignment with the most failing minus closed loops. Among
    several in one loop, it is the one whose maps fit as well by the composition of the others. If
    that is none or more than one, all of them are rejected: a missing map does less harm than a map
    at a wrong place.

    Args:
        alignments: at most one alignment of each two maps.
        fits_as_well: is asked once, at most, of each alignment of a loop that fails.
    """
    rejected: list[int] = []
    every = loops = loops_of(alignments, rejected)
    while failing := [loop for loop in loops if not loop.closes]:
        loop, suspects = most_suspect(failing, loops)
        wrong = [
            index
            for index in suspects
            if len(suspects) == 1
            or fits_as_well(index, pose_by_other_alignments(loop, index, alignments))
        ]
        rejected += wrong if len(wrong) == 1 else suspects
        loops = loops_of(alignments, rejected)
    return LoopCheck(tuple(rejected), every, frozenset(loops_by_alignment(loops)))


def most_suspect(failing: Sequence[Loop], loops: Sequence[Loop]) -> tuple[Loop, list[int]]:
    """Return a failing loop and its alignments with the most failing minus closed loops.

    Among several loops it is the one with the fewest such alignments, then the shortest.
    """
    fails, holds = (
        loops_by_alignment(failing),
        loops_by_alignment(loop for loop in loops if loop.closes),
    )
    worst = max(fails[index] - holds[index] for index in fails)
    suspects = [
        (loop, [index for index in loop.alignments if fails[index] - holds[index] == worst])
        for loop in failing
    ]
    return min(
        (each for each in suspects if each[1]), key=lambda each: (len(each[1]), len(each[0].maps))
    )


def pose_by_other_alignments(
    loop: Loop, index: int, alignments: Sequence[PairwiseAlignment]
) -> Pose:
    """Return the pose of an alignment that follows from the other alignments of a loop."""
    begin = loop.alignments.index(index) + 1
    around = Pose.of_matrix(np.eye(4))
    steps = [*zip(loop.maps, loop.alignments, strict=True)]
    for number, step in (*steps[begin:], *steps[: begin - 1]):
        around = around.after(alignments[step].into(number))
    # The composition leads from the map before the alignment to the map after it.
    after = loop.maps[begin % len(loop.maps)]
    return around if alignments[index].one == after else around.inverse()


def loops_of(
    alignments: Sequence[PairwiseAlignment], without: Sequence[int] = ()
) -> tuple[Loop, ...]:
    """Return the loops of the alignments: all short ones, and a basis of the long ones."""
    import networkx  # it has 285 modules, and not each start of a service needs them

    graph = networkx.Graph()
    for index, each in enumerate(alignments):
        if index not in without:
            graph.add_edge(each.one, each.other, index=index)
    short = networkx.simple_cycles(graph, length_bound=LONGEST)
    basis = (maps for maps in networkx.cycle_basis(graph) if len(maps) > LONGEST)
    return tuple(measure_loop(maps, graph, alignments) for maps in [*short, *basis])


def measure_loop(
    maps: Sequence[int], graph: "networkx.Graph", alignments: Sequence[PairwiseAlignment]
) -> Loop:
    """Return the loop with its errors, measured at the middle of its first alignment."""
    steps = list(zip(maps, [*maps[1:], maps[0]], strict=True))
    indices = tuple(graph.edges[step]["index"] for step in steps)
    around = Pose.of_matrix(np.eye(4))
    for (number, _), index in zip(steps, indices, strict=True):
        around = around.after(alignments[index].into(number))
    start = alignments[indices[0]].middle_in(maps[0])
    meters, angle = around.difference(Pose.of_matrix(np.eye(4)), start)
    return Loop(tuple(maps), indices, meters, float(np.degrees(angle)))


def loops_by_alignment(loops: Iterable[Loop]) -> Counter[int]:
    """Count the loops that contain each alignment."""
    return Counter(index for loop in loops for index in loop.alignments)


def poses_from(
    start: int, alignments: Sequence[PairwiseAlignment], checked: LoopCheck
) -> dict[int, Pose]:
    """Return the transform from each connected map's frame to that of the start map.

    Paths follow the maximum spanning tree: proven alignments first, then those of larger weight.
    """
    import networkx

    graph = networkx.Graph()
    graph.add_node(start)
    for index, each in enumerate(alignments):
        if index not in checked.rejected:
            graph.add_edge(
                each.one, each.other, index=index, rank=(index in checked.proven, each.weight)
            )
    ranks = sorted({rank for *_, rank in graph.edges(data="rank")})
    for *_, data in graph.edges(data=True):
        data["weight"] = ranks.index(data["rank"])
    tree = networkx.maximum_spanning_tree(graph)
    poses = {start: Pose.of_matrix(np.eye(4))}
    for near, far in networkx.bfs_edges(tree, start):
        step = alignments[graph.edges[near, far]["index"]]
        poses[far] = poses[near].after(step.into(near))
    return poses
