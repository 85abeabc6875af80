"""Judgment of alignments: accepted, or rejected with a reason."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters, Overlap, align, fits_as_well
from placecell.map_alignment.align import distinct, judge, turned_around
from tests.placecell.map_alignment.map_builders import ByDistance, pair

PARAMETERS = AlignmentParameters()
SURE = np.diag([0.01, 0.01, 0.01, 1e-4])


def overlap(
    score: float = 50.0,
    agreement: float = 0.5,
    shift: float = 0.0,
    pairs: int = 40,
    covariance: Float64 = SURE,
) -> Overlap:
    rows = np.arange(pairs)
    return Overlap(
        pose=Pose.of_yaw(0.0, np.array([shift, 0.0, 0.0])),
        covariance=covariance,
        rows_a=rows,
        rows_b=rows,
        source=np.zeros((pairs, 3)),
        residuals=np.zeros(pairs),
        score=score,
        expected=(1_000, 1_000),
        found=(1_000 * agreement, 2_000 * agreement),
        parts=(0.5, 0.5),
    )


def test_good_overlap_is_aligned() -> None:
    best = overlap()
    found = judge([best], PARAMETERS)
    assert found.best is best
    assert found.second is None
    assert (found.reason, found.detail) == (None, "")
    assert found.pose is best.pose


@pytest.mark.parametrize(
    ("one", "reason", "words"),
    [
        (overlap(agreement=0.099), "inconsistent", "an agreement of 9.9%"),
        (overlap(agreement=0.1), None, ""),
        (overlap(score=11.9), "inconsistent", "a score of 11.9. "),
        (overlap(score=12.0), None, ""),
        (overlap(pairs=11), "inconsistent", "No part"),
        (overlap(pairs=12), None, ""),
        (overlap(covariance=np.diag([1, 1, 1, 0.0077])), "inconsistent", "determine the rotation"),
        (overlap(covariance=np.diag([1, 1, 1, 0.0075])), None, ""),
        (overlap(covariance=np.diag([np.inf] * 4)), "inconsistent", "determine the rotation"),
    ],
)
def test_poor_overlap_is_rejected_with_a_reason(
    one: Overlap, reason: str | None, words: str
) -> None:
    found = judge([one], PARAMETERS)
    assert found.reason == reason
    assert words in found.detail
    assert (found.pose is None) == (reason is not None)


@pytest.mark.parametrize(
    ("second", "is_ambiguous"),
    [
        (overlap(shift=99, score=40.1, agreement=0.05), True),
        (overlap(shift=99, score=39.9, agreement=0.05), False),
        # A smaller overlap that agrees as well is as good an answer,
        (overlap(shift=99, score=15.0, agreement=0.41), True),
        (overlap(shift=99, score=15.0, agreement=0.39), False),
        # unless it is too small to be one.
        (overlap(shift=99, score=11.0, agreement=0.41), False),
        # The same place is no other.
        (overlap(shift=2.9, score=49.0), False),
        (overlap(shift=3.1, score=49.0), True),
    ],
)
def test_second_place_as_good_is_ambiguous(second: Overlap, is_ambiguous: bool) -> None:
    found = judge([second, overlap()], PARAMETERS)
    assert found.reason == ("ambiguous" if is_ambiguous else None)
    assert found.best is not None
    assert found.best.score == 50.0
    if is_ambiguous:
        assert found.second is second
        assert found.pose is None
        assert "Another alignment" in found.detail


def test_good_overlap_precedes_a_large_one() -> None:
    large, good = overlap(score=60.0, agreement=0.07, shift=99), overlap(score=20.0)
    assert distinct([large, good], PARAMETERS) == [good, large]
    # Whose score still counts against it.
    assert judge([large, good], PARAMETERS).reason == "ambiguous"


def test_no_overlap_is_inconsistent() -> None:
    found = judge([], PARAMETERS)
    assert found.reason == "inconsistent"
    assert (found.best, found.second, found.pose) == (None, None, None)
    assert found.detail


def test_a_map_turned_on_the_spot_stays_there() -> None:
    pose = Pose.of_yaw(0.4, np.array([500.0, 7.0, 3.0]))
    viewpoints = np.array([[10.0, 20.0, 1.0], [12.0, 24.0, 1.0]])
    there = turned_around(pose, viewpoints)
    np.testing.assert_allclose(there.apply(viewpoints), pose.apply(viewpoints)[::-1], atol=1e-9)
    np.testing.assert_allclose(there.rotation, -pose.rotation * (1, 1, -1), atol=1e-12)


@pytest.mark.parametrize("rows", [0, 1, 11])
def test_maps_of_few_segments_are_rejected(rows: int) -> None:
    made, some = pair(0), np.arange(rows)
    for a, b in ((made.a.take(some), made.b), (made.a, made.b.take(some))):
        found = align(a.view, b.view, NoLooks())
        assert found.reason == "too-few-segments"
        assert f"{rows} segments" in found.detail
        assert found.best is None


class NoLooks(ByDistance):
    """Search that must not be used."""

    def __init__(self) -> None:
        pass


def test_parameters_limit_the_search() -> None:
    made = pair(0)
    strict = replace(PARAMETERS, least_score=1e6)
    found = align(made.a.view, made.b.view, made.looks, strict)
    assert found.reason == "inconsistent"
    assert found.best is not None
    assert len(found.best) >= strict.least_pairs


def test_fits_as_well_compares_a_pose_with_the_best() -> None:
    two = pair(3)
    a, b, looks = two.a.view, two.b.view, ByDistance(two.a, two.b)
    right = align(a, b, looks).best
    assert right is not None
    slid = Pose.of_yaw(0.0, np.array([25.0, 0.0, 0.0])).after(right.pose)
    gone = Pose.of_yaw(0.0, np.array([0.0, 900.0, 0.0])).after(right.pose)
    near = Pose.of_yaw(0.01, np.array([1.0, -0.5, 0.0])).after(two.truth)

    def lies(pose: Pose, best: Overlap) -> bool:
        return fits_as_well(a, b, pose, best, looks)

    wrong = replace(right, pose=slid, score=1e6)
    # About where it is right, within what a loop may miss by, whatever the wrong one's score.
    assert lies(two.truth, wrong)
    assert lies(near, wrong)
    # Where the maps would overlap and do not agree; and where they would not meet.
    assert not lies(slid, right)
    assert not lies(gone, right)
    # As the alignment itself has it is no other way.
    assert not lies(right.pose, right)
    assert not lies(near, right)
