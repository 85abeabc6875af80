import dataclasses
import json

import pytest

from placecell.core.parameters import PROTOCOL_V1, Parameters


def test_protocol_v1() -> None:
    """Any change of these values makes another protocol."""
    assert PROTOCOL_V1.as_dict() == {
        "protocol": "v1",
        "frame_step": 2,
        "accumulated_scans": 10,
        "min_range": 3.0,
        "max_range": 60.0,
        "local_map_radius": 40.0,
        "map_voxel": 0.1,
        "ground_cell": 0.5,
        "ground_window": 15.0,
        "ground_clearance": 0.3,
        "ceiling_share": 1 / 3,
        "ceiling_lowest": 1.8,
        "ceiling_highest": 8.0,
        "door_height": 2.0,
        "growing_radius": 0.25,
        "min_points": 100,
        "max_points": 15_000,
        "d_same": 1.5,
        "grid": [38, 38, 18],
        "grid_voxel": 0.2,
        "th_H": 50,
    }


@pytest.mark.parametrize(
    ("scans", "every", "step"),
    [(99, None, 1), (100, None, 2), (501, None, 2), (10, 3, 3), (501, 1, 1)],
)
def test_captures_of_a_drive(scans: int, every: int | None, step: int) -> None:
    assert PROTOCOL_V1.for_drive(scans, every) == dataclasses.replace(PROTOCOL_V1, frame_step=step)


def test_parameters_survive_json() -> None:
    content = json.loads(json.dumps(Parameters(th_H=49).as_dict()))
    assert Parameters(**content | {"grid": tuple(content["grid"])}) == Parameters(th_H=49)
    assert Parameters(voxel_parts=2).as_dict()["voxel_parts"] == 2


def test_voxels_have_one_or_two_parts_along_an_edge() -> None:
    with pytest.raises(ValueError, match="voxel_parts 3"):
        Parameters(voxel_parts=3)
