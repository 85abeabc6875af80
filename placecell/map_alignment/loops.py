"""Alignments of more than two maps, checked around every loop; a bad one is rejected.

Once around a loop of maps leads back to where one began. Where it does not, an alignment of that
loop is wrong; which one, the other loops tell that it is part of. Where they do not, the rest of
the loop says, of each alignment, how its maps lie if all others are right; and the maps themselves
whether they do.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import networkx
import numpy as np

from placecell.core.types import Float64
from placecell.localization import Pose

LONGEST = 4
"""Loops of up to so many maps are all looked at; of longer ones, enough for each alignment."""

METERS, DEGREES = 1.0, 2.0
"""By which a loop may miss, for each of its alignments."""


@dataclass(frozen=True, slots=True, eq=False)
class PairwiseAlignment:
    """An alignment of two maps: an edge between them.

    Attributes:
        one, other: numbers of the maps.
        pose: from the other's frame to the one's.
        middle: float64 (3,), of what both have, meters, in the one's frame.
        weight: what speaks for it.
    """

    one: int
    other: int
    pose: Pose
    middle: Float64
    weight: float

    def into(self, number: int) -> Pose:
        """The pose into the frame of one of its two maps, from the other's."""
        return self.pose if number == self.one else self.pose.inverse()

    def middle_in(self, number: int) -> Float64:
        """The middle in the frame of one of its two maps."""
        return self.middle if number == self.one else self.pose.inverse().apply(self.middle)


FitsAsWell = Callable[[int, Pose], bool]
"""Whether the maps of an alignment, by its index, lie as well by another pose as by its own."""


@dataclass(frozen=True, slots=True)
class Loop:
    """A way around.

    Attributes:
        maps: their numbers, in the order of the way.
        alignments: indices of the alignments on it.
        meters: by which one misses the place where one began.
        degrees: by which one is turned then.
    """

    maps: tuple[int, ...]
    alignments: tuple[int, ...]
    meters: float
    degrees: float

    @property
    def closes(self) -> bool:
        """Whether it leads back."""
        steps = len(self.alignments)
        return self.meters <= METERS * steps and self.degrees <= DEGREES * steps


@dataclass(frozen=True, slots=True)
class LoopCheck:
    """What the loops say of alignments.

    Attributes:
        rejected: indices of those that are wrong, in the order in which they were found out.
        loops: all loops of all alignments, the wrong ones' too.
        proven: indices of those that are part of a loop that closes, and not wrong.
    """

    rejected: tuple[int, ...]
    loops: tuple[Loop, ...]
    proven: frozenset[int]


def check_loops(
    alignments: Sequence[PairwiseAlignment], fits_as_well: FitsAsWell = lambda *_: False
) -> LoopCheck:
    """Reject alignments until every loop closes.

    First the one that fails in most loops more than it holds in. Of several in one loop, the one
    whose maps lie as well as the rest of the loop says. If that is none or more than one, all of
    them: a map that is left out does less harm than one that is laid along what may be wrong.

    Args:
        alignments: one between each two maps, at most.
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
    """A loop that fails, and those on it that fail in most loops more than they hold in.

    Of several loops that with the fewest of them, and then the shortest.
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
    """How the two maps of an alignment lie, as its `pose` tells it, by the rest of a loop."""
    begin = loop.alignments.index(index) + 1
    around = Pose.of_matrix(np.eye(4))
    steps = [*zip(loop.maps, loop.alignments, strict=True)]
    for number, step in (*steps[begin:], *steps[: begin - 1]):
        around = around.after(alignments[step].into(number))
    # Into the map after it, from the map before it.
    after = loop.maps[begin % len(loop.maps)]
    return around if alignments[index].one == after else around.inverse()


def loops_of(
    alignments: Sequence[PairwiseAlignment], without: Sequence[int] = ()
) -> tuple[Loop, ...]:
    """Loops of alignments: all short ones, and of the long ones a basis."""
    graph = networkx.Graph()
    for index, each in enumerate(alignments):
        if index not in without:
            graph.add_edge(each.one, each.other, index=index)
    short = networkx.simple_cycles(graph, length_bound=LONGEST)
    basis = (maps for maps in networkx.cycle_basis(graph) if len(maps) > LONGEST)
    return tuple(measure_loop(maps, graph, alignments) for maps in [*short, *basis])


def measure_loop(
    maps: Sequence[int], graph: networkx.Graph, alignments: Sequence[PairwiseAlignment]
) -> Loop:
    """Once around from the first map, by what one misses at the middle of the first alignment."""
    steps = list(zip(maps, [*maps[1:], maps[0]], strict=True))
    indices = tuple(graph.edges[step]["index"] for step in steps)
    around = Pose.of_matrix(np.eye(4))
    for (number, _), index in zip(steps, indices, strict=True):
        around = around.after(alignments[index].into(number))
    start = alignments[indices[0]].middle_in(maps[0])
    meters, angle = around.difference(Pose.of_matrix(np.eye(4)), start)
    return Loop(tuple(maps), indices, meters, float(np.degrees(angle)))


def loops_by_alignment(loops: Iterable[Loop]) -> Counter[int]:
    """In how many loops each alignment is."""
    return Counter(index for loop in loops for index in loop.alignments)


def poses_from(
    start: int, alignments: Sequence[PairwiseAlignment], checked: LoopCheck
) -> dict[int, Pose]:
    """Pose of each map that can be reached, from its frame to that of the map to start from.

    Along alignments that a loop proves where there are such, and then the weightiest: the maximum
    spanning tree.
    """
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
