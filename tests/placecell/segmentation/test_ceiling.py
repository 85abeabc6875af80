"""Ceilings and walls above doors are removed indoors, and nothing elsewhere."""

from dataclasses import replace

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float32
from placecell.segmentation.ceiling import is_overhead
from placecell.segmentation.pipeline import segment_map
from tests.placecell.segment_builders import box, plane

HEIGHT = 2.9


def hall(height: float = HEIGHT, reach: float = 10.0) -> Float32:
    """Return floor and ceiling of a hall, (n, 3)."""
    floor = plane(reach)
    return np.concatenate([floor, floor + np.array([0, 0, height], dtype=np.float32)])


def two_rooms() -> Float32:
    """Return a hall with two walls, which a lintel above a door and the ceiling join."""
    walls = [box((-4.0, 0.0, 0.0), (5.0, 0.2, HEIGHT)), box((4.0, 0.0, 0.0), (5.0, 0.2, HEIGHT))]
    lintel = box((0.0, 0.0, 2.1), (3.2, 0.2, HEIGHT - 2.1))
    return np.concatenate([hall(), *walls, lintel])


def test_ceiling_and_lintels_are_overhead_and_walls_up_to_the_door_height_are_not() -> None:
    points = two_rooms()
    overhead = is_overhead(points, PROTOCOL_V1)
    np.testing.assert_array_equal(overhead, points[:, 2] > PROTOCOL_V1.door_height)
    assert overhead.any()


def test_rooms_are_one_region_only_while_the_ceiling_joins_them() -> None:
    off = replace(PROTOCOL_V1, ceiling_share=2.0, max_points=100_000)
    assert len(segment_map(two_rooms(), off)) == 1
    assert len(segment_map(two_rooms(), replace(off, ceiling_share=1 / 3))) == 2


@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_outdoors_nothing_is_overhead(slope: float) -> None:
    things = [box((x, y, 0.0), (3.0, 3.0, 4.0)) for x in (-6.0, 6.0) for y in (-6.0, 6.0)]
    points = np.concatenate([plane(20, slope=slope), *things])
    assert not is_overhead(points, PROTOCOL_V1).any()


def test_open_field_is_not_indoors() -> None:
    assert not is_overhead(plane(20), PROTOCOL_V1).any()


@pytest.mark.parametrize(
    ("height", "indoors"), [(1.5, False), (2.5, True), (7.0, True), (9.0, False)]
)
def test_ceiling_has_a_usual_height(height: float, indoors: bool) -> None:
    assert is_overhead(hall(height), PROTOCOL_V1).any() == indoors


def test_roof_over_a_small_part_of_the_map_does_not_make_it_indoors() -> None:
    roof = plane(4) + np.array([0, 0, 3.0], dtype=np.float32)
    assert not is_overhead(np.concatenate([plane(20), roof]), PROTOCOL_V1).any()


def test_empty_map_has_nothing_overhead() -> None:
    assert is_overhead(np.zeros((0, 3), np.float32), PROTOCOL_V1).shape == (0,)
