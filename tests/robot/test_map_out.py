"""Edits of the robot's own map: views are added, and those of segments that moved are removed."""

import numpy as np
from placecell_client import CompactMap, decode_delta
from placecell_client.maps.edit import apply

from robot.core.usable_segments import UsableSegments
from robot.mapping.map_out import Capture, EditMaker, MapEdit, SeenSegments
from tests.robot.agent_fakes import at


def seen(*ids: int) -> SeenSegments:
    count = len(ids)
    return SeenSegments(
        np.array(ids, np.int64),
        np.full((count, 4), 7, np.int8),
        np.array([[each, 1.0, 0.5] for each in ids], np.float64).reshape(-1, 3),
        "model-1",
        "1",
    )


def add(edits: EditMaker, meters: float, *ids: int, moved: tuple[int, ...] = ()) -> MapEdit | None:
    capture = Capture(meters, at(meters))
    return edits.add(seen(*ids), capture, meters, np.array(moved, np.int64))


def stored(content: CompactMap | None, edit: MapEdit | None) -> CompactMap:
    assert edit is not None
    delta = decode_delta(edit.content)
    return delta.changed if content is None else apply(content, delta)


def test_views_of_a_segment_that_moves_leave_the_map() -> None:
    edits = EditMaker("ann", "s")
    content = stored(None, add(edits, 0.0, 1, 2))
    content = stored(content, add(edits, 11.0, 1, 2))  # another view of both
    assert content.ids.tolist() == [0, 1, 2, 3]
    edit = add(edits, 12.0, 1, moved=(2, 9))
    assert edit is not None
    assert edit.segments == 0
    content = stored(content, edit)
    assert content.ids.tolist() == [0, 2]
    assert np.unique(content.centroids[:, 0]).tolist() == [1.0]
    # It was removed once; ids of the map are never used again.
    assert add(edits, 13.0, 1, moved=(2,)) is None
    content = stored(content, add(edits, 14.0, 1, 3, moved=(2,)))
    assert content.ids.tolist() == [0, 2, 4]


def test_segment_that_ended_or_another_part_is_not_removed() -> None:
    edits = EditMaker("ann", "s")
    add(edits, 0.0, 1)
    add(edits, 2.0, 2)  # segment 1 was not found again
    assert add(edits, 4.0, 2, moved=(1,)) is None
    edits.begin_part()
    assert add(edits, 6.0, moved=(2,)) is None


def test_edit_carries_the_classes_of_the_new_views() -> None:
    edits = EditMaker("ann", "s")
    found = UsableSegments(
        np.full((2, 4), 7, np.int8),
        np.array([[1, 1, 0], [2, 1, 0]], np.float64),
        np.array([0, 2]),
        np.array([0, 121], np.uint8),
    )
    described = SeenSegments.of(found, np.array([5, 6, 7]), "model-1", "1")
    assert described.ids.tolist() == [5, 7]
    edit = edits.add(described, Capture(0.0, at(0)), 0.0)
    content = stored(None, edit)
    assert content.classes is not None
    assert content.classes.tolist() == [0, 121]
