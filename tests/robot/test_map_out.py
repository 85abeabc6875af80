"""Edits of the robot's own map: views are added, and those of segments that moved are removed."""

from dataclasses import replace

import numpy as np
from placecell_client import CompactMap, decode_delta
from placecell_client.maps.edit import apply

from placecell.core.segment_classes import ClassFilter
from placecell.core.segments import Segments
from placecell.core.types import Float64
from placecell.segmentation.incremental import LiveSegments
from placecell.trajectories.covariance import lever_arm
from robot.core.usable_segments import UsableSegments
from robot.mapping.map_out import Capture, EditMaker, MapEdit, SeenSegments
from robot.mapping.odometry_model import OdometryModel
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


def test_segments_of_unwanted_classes_are_left_out_with_all_their_columns() -> None:
    every = replace(seen(1, 2, 3), classes=np.array([0, 121, 1], np.uint8))  # 121: a vehicle
    kept = every.wanted(ClassFilter.of(None, ["movable"]))
    assert kept.ids.tolist() == [1, 3]
    assert kept.centroids[:, 0].tolist() == [1.0, 3.0]
    assert kept.classes is not None
    assert kept.classes.tolist() == [0, 1]
    assert len(kept.codes) == 2
    assert every.wanted(None) is every
    unknown = seen(1)
    assert unknown.wanted(ClassFilter.of(["pole"])) is unknown


def test_edit_carries_the_classes_of_the_new_views() -> None:
    edits = EditMaker("ann", "s")
    found = UsableSegments(
        np.full((2, 4), 7, np.int8),
        np.array([[1, 1, 0], [2, 1, 0]], np.float64),
        np.array([0, 2]),
        np.array([0, 121], np.uint8),
    )
    clouds = [
        np.random.default_rng(each).uniform(0, each, (9, 3)).astype(np.float32)
        for each in (1, 2, 30)
    ]
    live = LiveSegments(
        Segments.of(clouds, np.zeros((3, 3))),
        np.array([5, 6, 7]),
        np.ones(3, bool),
        np.zeros(3, np.int64),
        np.zeros(3, bool),
    )
    described = SeenSegments.of(found, live, "model-1", "1")
    assert described.ids.tolist() == [5, 7]
    edit = edits.add(described, Capture(0.0, at(0)), 0.0)
    content = stored(None, edit)
    assert content.classes is not None
    assert content.classes.tolist() == [0, 121]
    assert content.extents is not None
    for row, cloud in enumerate((clouds[0], clouds[2])):
        sides = np.ptp(cloud, axis=0)
        assert (content.extents[row] == np.ceil(10 * sides).clip(max=255)).all()


def test_variances_grow_with_distance_and_turn_and_begin_anew_with_a_part() -> None:
    edits = EditMaker("ann", "s", OdometryModel(0.1, 0.05, 0.01, 0.02))
    content = stored(None, add(edits, 0.0, 1))
    turned = at(4.0)
    turned[:2, :2] = [[0.0, -1.0], [1.0, 0.0]]
    edits.add(seen(), Capture(1.0, turned), 4.0)  # no edit, but the way counts
    content = stored(content, edits.add(seen(2), Capture(2.0, turned), 4.0))
    assert content.frame_odometry is not None
    np.testing.assert_allclose(content.frame_odometry[0, 4:], 0.0)
    np.testing.assert_allclose(content.frame_odometry[1, 4:], [0.04, 0.01, 4e-4 + 4e-4 * np.pi / 2])
    np.testing.assert_allclose(content.frame_odometry[1, 3], np.pi / 2)
    edits.begin_part()
    begun = stored(None, add(edits, 9.0, 3))
    assert begun.frame_odometry is not None
    np.testing.assert_allclose(begun.frame_odometry[:, 4:], 0.0)


def variances(*covariances: Float64 | None) -> Float64:
    """Return what the map states after captures that are 2 m apart, (n, 3)."""
    edits, content = EditMaker("ann", "s", OdometryModel(0.1, 0.05, 0.01, 0.02)), None
    for number, covariance in enumerate(covariances):
        capture = Capture(float(number), at(2.0 * number), covariance)
        content = stored(content, edits.add(seen(number), capture, 2.0 * number))
    assert content is not None
    assert content.frame_odometry is not None
    return np.asarray(content.frame_odometry[:, 4:])


BY_MODEL = [2 * 0.1**2, 2 * 0.05**2, 2 * 0.01**2]


def test_map_states_the_growth_of_a_stated_covariance() -> None:
    covariance = np.diag([0.01, 0.02, 0.03, 1e-4, 1e-4, 4e-4])
    covariances = [covariance]
    for _ in range(2):
        # Errors of the heading move the next position sideways: no error of the next step.
        arm = lever_arm(np.array([2.0, 0.0, 0.0]))
        covariance = arm @ covariance @ arm.T + np.diag([0.004, 0.006, 0.002, 0.0, 0.0, 1e-5])
        covariances.append(covariance)
    found = variances(*covariances)
    np.testing.assert_allclose(found[0], 0.0)
    np.testing.assert_allclose(np.diff(found, axis=0), [[0.005, 0.002, 1e-5]] * 2, atol=1e-12)


def test_model_is_used_where_the_covariance_is_unknown_or_constant() -> None:
    known, later = np.diag([0.1, 0.1, 0.1, 0.1, 0.1, 0.1]), np.diag([0.9] * 6)
    found = np.diff(variances(known, known, None, later), axis=0)
    np.testing.assert_allclose(found, [BY_MODEL] * 3)


def test_planar_odometry_gets_the_height_of_the_model() -> None:
    first, last = np.diag([0.1, 0.1, 0, 0, 0, 1e-4]), np.diag([0.2, 0.2, 0, 0, 0, 2e-4])
    (found,) = np.diff(variances(first, last), axis=0)
    # y: 0.1 more, without 2 m times an error of the heading of 0.01 rad.
    np.testing.assert_allclose(found, [0.1 - 0.0004 / 2, BY_MODEL[1], 1e-4])
