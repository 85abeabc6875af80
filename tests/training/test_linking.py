"""Groups that several drives share: links by hand, and in a training set."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.core.types import Float64
from placecell.segmentation.recording import Recording
from training.data.linking import Linker
from training.data.training_set import Source, TrainingSet
from training.methods.context import ContextRecipe, learn_neighborhood, seen_by_several

TOWER, CAR, TREE = (0.0, 0.0), (10.0, 0.0), (10.0, 5.0)


def at(*places: tuple[float, float], height: float = 1.0) -> Float64:
    """Return centroids at horizontal places, all at one height."""
    return np.array([(*place, height) for place in places])


def test_groups_at_one_place_are_linked_and_others_are_new() -> None:
    linker = Linker(1.0)
    first = linker.add(np.array([0, 0, 1]), at(TOWER, (0.4, 0.0), CAR), "yard")
    assert first.tolist() == [0, 0, 1]
    # Robot B sees the tower 5 m higher, 0.5 m beside the mean of both views, and a tree.
    second = linker.add(np.array([0, 1]), at((0.7, 0.0), TREE, height=6.0), "yard")
    assert second.tolist() == [0, 2]
    # A third drive finds what either of the others saw.
    third = linker.add(np.array([0, 1, 2]), at(TREE, CAR, (30.0, 0.0)), "yard")
    assert third.tolist() == [2, 1, 3]


def test_drives_of_other_places_are_not_linked() -> None:
    linker = Linker(1.0)
    assert linker.add(np.array([0, 1]), at(TOWER, CAR), "yard").tolist() == [0, 1]
    assert linker.add(np.array([0, 1]), at(TOWER, CAR), "harbor").tolist() == [2, 3]
    assert linker.add(np.array([0, 1]), at(TOWER, CAR)).tolist() == [4, 5]
    assert linker.add(np.array([0, 1]), at(TOWER, CAR)).tolist() == [6, 7]
    assert linker.add(np.array([0, 1]), at(CAR, TOWER), "yard").tolist() == [1, 0]


def test_links_are_one_to_one_and_nearest_first() -> None:
    linker = Linker(1.0)
    linker.add(np.array([0]), at(TOWER), "yard")
    both = linker.add(np.array([0, 1]), at((0.6, 0.0), (-0.2, 0.0)), "yard")
    assert both.tolist() == [1, 0]
    far = linker.add(np.array([0]), at((-1.4, 0.0)), "yard")
    assert far.tolist() == [2]


def drive(name: str, world_to_site: Float64, *places: tuple[float, float]) -> Recording:
    """Return a drive that sees a box at each place of the site, each twice."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (0, 2)])
    to_world = np.linalg.inv(world_to_site)
    clouds = [
        ((corners + [*place, 0.0]) @ to_world[:3, :3].T + to_world[:3, 3]).astype(np.float32)
        for place in np.repeat(places, 2, axis=0)
    ]
    count = len(clouds)
    return Recording(
        name=name,
        parameters=PROTOCOL_V1,
        segments=Segments.of(clouds, np.tile(to_world[:3, 3], (count, 1))),
        captures=np.tile([0, 1], len(places)),
        groups=np.repeat(np.arange(len(places)), 2),
        distinct=np.ones(count, dtype=bool),
        scans=2,
        scan_hashes=(f"{name}0", f"{name}1"),
        path_length=1.0,
    )


BACK = np.array([[-1.0, 0, 0, 40], [0, -1, 0, 2], [0, 0, 1, 0.5], [0, 0, 0, 1]])
"""World of robot B, which starts at the other end of the street and looks back, to the site."""


def source(recording: Recording, site: str, to_site: Float64 | None = None) -> Source:
    return Source(recording, 0, 1, site, np.eye(4) if to_site is None else to_site)


def test_drives_of_one_town_share_groups_in_the_frame_of_the_town() -> None:
    a = source(drive("town:1", np.eye(4), TOWER, CAR), "town:1:streets")
    b = source(drive("town:1+robot-b", BACK, CAR, TREE), "town:1:streets", BACK)
    other = source(drive("town:2", np.eye(4), TOWER), "town:2:streets")
    together = TrainingSet.of([a, b, other])
    assert together.groups.tolist() == [0, 0, 1, 1, 1, 1, 2, 2, 3, 3]
    assert together.drives is not None
    assert together.drives.tolist() == [0, 0, 0, 0, 1, 1, 1, 1, 2, 2]
    seen = together.segments.centroids()[:, :2]
    assert seen[4:8] == pytest.approx(np.array([CAR, CAR, TREE, TREE]), abs=1e-4)
    assert together.segments.sensors[4] == pytest.approx([0, 0, 0], abs=1e-4)
    assert seen_by_several(together.groups, together.drives).tolist() == [False, True, False, False]


def test_single_drive_of_a_town_keeps_its_frame() -> None:
    recording = drive("town:1+robot-b", BACK, CAR, TREE)
    alone = TrainingSet.of([source(recording, "town:1:streets", BACK)])
    assert (alone.segments.points == recording.segments.points).all()
    assert alone.groups.tolist() == [0, 0, 1, 1]


def test_linked_groups_weigh_more_in_the_projection() -> None:
    random = np.random.default_rng(0)
    groups, size = np.repeat(np.arange(40), 4), 12
    around = random.uniform(0, 1, (40, size))[groups]
    linked = groups < 20
    # The views of linked groups differ in the first value, those of the others in the second.
    around[linked, 0] += random.normal(0, 3, linked.sum())
    around[~linked, 1] += random.normal(0, 3, (~linked).sum())
    clouds = [random.uniform(0, 1, (5, 3)).astype(np.float32) for _ in groups]
    data = TrainingSet(
        Segments.of(clouds, np.zeros((len(groups), 3))),
        groups,
        PROTOCOL_V1,
        around.astype(np.float32),
        drives=np.where(linked, np.arange(len(groups)) % 2, 0),
    )

    def strength(recipe: ContextRecipe, changed: TrainingSet = data) -> Float64:
        axes = learn_neighborhood(changed, recipe).axes
        return np.asarray(np.abs(axes[0]).mean() / np.abs(axes[1]).mean())

    equal = strength(ContextRecipe(dimension=4, linked=1.0))
    assert strength(ContextRecipe(dimension=4)) < 0.8 * equal
    unknown = strength(ContextRecipe(dimension=4), replace(data, drives=None))
    assert unknown == pytest.approx(equal)
