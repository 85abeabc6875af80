"""Judgment of segments by later passes, in scenes by hand."""

import numpy as np
import pytest

from placecell.lasting.difference import world_difference
from placecell.lasting.judgment import (
    ABSENT,
    CHANGED,
    CONFIRMED,
    UNSEEN,
    ObservedSegments,
    judge,
)

SENSOR = (0.0, 0.0, 1.8)
CAR = (8.0, 0.0, 0.8), (4.0, 2.0, 1.5)
WALL = (15.0, 0.0, 2.0), (0.5, 24.0, 4.0)
TRUCK = (5.0, 0.0, 1.5), (1.0, 5.0, 3.0)


def scene(*boxes: tuple[tuple[float, ...], tuple[float, ...]], at: tuple[float, ...] = SENSOR):  # type: ignore[no-untyped-def]
    """Return segments, each with center and sides, that one capture saw."""
    centers, sides = zip(*boxes, strict=True)
    return ObservedSegments(
        np.array(centers), np.array(sides), np.array([at]), np.zeros(len(boxes), np.int64)
    )


@pytest.mark.parametrize(
    ("later", "verdict"),
    [
        (scene(CAR, WALL), CONFIRMED),
        (scene(WALL), ABSENT),  # the wall behind it is seen
        (scene(((8.2, 0.1, 0.8), (3.0, 2.0, 1.4)), WALL), CONFIRMED),
        (scene(TRUCK, WALL), UNSEEN),  # something nearer hides it
        (scene(((8.0, 30.0, 2.0), (1.0, 1.0, 4.0))), UNSEEN),  # nothing is seen in that direction
        (scene(WALL, at=(-20.0, 0.0, 1.8)), UNSEEN),  # too far
        (scene(((9.2, 0.6, 0.3), (0.4, 0.4, 0.6)), WALL), CHANGED),  # a bollard stands there now
    ],
)
def test_parked_car_by_one_later_capture(later: ObservedSegments, verdict: int) -> None:
    assert judge(scene(CAR, WALL), later)[0] == verdict


def test_wall_is_confirmed_when_the_car_before_it_is_gone() -> None:
    assert judge(scene(CAR, WALL), scene(WALL)).tolist() == [ABSENT, CONFIRMED]


def test_segment_that_one_capture_misses_and_another_sees_is_confirmed() -> None:
    later = ObservedSegments(
        np.array([WALL[0], CAR[0]]),
        np.array([WALL[1], CAR[1]]),
        np.array([SENSOR, (4.0, 8.0, 1.8)]),
        np.array([0, 1]),
    )
    assert judge(scene(CAR, WALL), later)[0] == CONFIRMED


def test_segments_of_unknown_size_prove_no_absence() -> None:
    unknown = (WALL[0], (0.0, 0.0, 0.0))
    assert judge(scene(CAR), scene(unknown)).tolist() == [UNSEEN]
    assert judge(scene((CAR[0], (0.0, 0.0, 0.0))), scene(CAR)).tolist() == [CONFIRMED]


def test_difference_tells_what_appeared_and_what_is_gone() -> None:
    other = ((8.0, 3.0, 0.8), (4.0, 2.0, 1.5))
    counts = world_difference(scene(CAR, WALL), scene(other, WALL)).counts
    assert counts == {
        "kept": 1, "changed": 0, "gone": 1, "unseen": 0, "appeared": 1, "new_place": 0,
    }  # fmt: skip


def test_difference_to_itself_keeps_everything() -> None:
    both = world_difference(scene(CAR, WALL, TRUCK), scene(CAR, WALL, TRUCK))
    assert both.counts["kept"] == 3
    assert set(both.after.tolist()) == {CONFIRMED}


def test_rotated_and_shifted_scenes_have_the_same_verdicts() -> None:
    before, after = scene(CAR, WALL), scene(WALL)
    turned = []
    for each in (before, after):
        points, views = (
            np.column_stack([-given[:, 1] + 900.0, given[:, 0] - 70.0, given[:, 2] + 5.0])
            for given in (each.centroids, each.viewpoints)
        )
        turned.append(ObservedSegments(points, each.sides[:, [1, 0, 2]], views, each.captures))
    assert judge(turned[0], turned[1]).tolist() == judge(before, after).tolist()


def test_limit_of_pairs_leaves_captures_out() -> None:
    calls: list[int] = []
    spots = [(0.3 * number, 0.0, 1.8) for number in range(8)]
    later = ObservedSegments(
        np.array([WALL[0]] * 8), np.array([WALL[1]] * 8), np.array(spots), np.arange(8)
    )
    stored = scene(CAR, (WALL[0], (0.2, 0.2, 0.2)))
    for most, captures in ((None, 8), (10_000, 8), (64, 4), (1, 1)):
        calls.clear()
        verdicts = judge(stored, later, lambda: calls.append(1), most)
        assert len(calls) == captures
        assert verdicts[0] == ABSENT


def test_nothing_is_judged_without_segments() -> None:
    nothing = scene(CAR).take(np.zeros(1, bool))
    assert judge(nothing, scene(CAR)).tolist() == []
    assert judge(scene(CAR), nothing).tolist() == [UNSEEN]
