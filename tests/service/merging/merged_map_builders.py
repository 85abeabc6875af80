"""Maps of robots that drove along one street, to align and merge."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from placecell_client import CompactMap, encode, moved
from placecell_client.maps.canonical import canonical

from placecell.localization import Pose
from tests.placecell.map_alignment.map_builders import MadeMap, Street, drive, street
from tests.service.service_builders import write_eigenvalue_model

TRUTH = {
    "east": Pose.of_yaw(0.0, np.zeros(3)),
    "west": Pose.of_yaw(2.0, np.array([900.0, -400.0, 3.0])),
    "north": Pose.of_yaw(-0.7, np.array([-2_000.0, 50.0, 1.0])),
}
"""Pose of each map's frame in the street's frame."""


def models_that_judge(folder: Path) -> Path:
    """Write two models with a match threshold."""
    write_eigenvalue_model(folder, pair_threshold=0.8)
    write_eigenvalue_model(folder, "other", step=0.03)
    return folder


def main_street(seed: int = 0) -> Street:
    return street(np.random.default_rng(seed), 400.0, begin=-30.0)


def as_map(
    made: MadeMap, model_id: str, name: str, robot: str, first_id: int = 0, time: float = 1e9
) -> CompactMap:
    """Return a robot's map in its own frame; sensor positions are ten seconds apart."""
    pose = TRUTH[name].inverse()
    viewpoints, frame_index = np.unique(made.view.viewpoints, axis=0, return_inverse=True)
    count = len(made.view)
    content = CompactMap(
        model_id=model_id,
        preprocessing="1",
        frame="street",
        codes=(40 * made.looks).round().clip(-127, 127).astype(np.int8),
        centroids=made.view.centroids,
        ids=np.arange(first_id, first_id + count, dtype=np.uint32),
        robots=(robot,),
        robot=np.zeros(count, np.uint16),
        frame_index=frame_index.ravel().astype(np.uint32),
        frame_times=np.array([time + 10.0 * moment for moment in range(len(viewpoints))]),
        frame_positions=viewpoints,
        frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (len(viewpoints), 1)),
    )
    return canonical(moved(content, pose.rotation, pose.translation, f"{name}'s odometry"))


def driven(
    model_id: str, name: str, begin: float, end: float, *, robot: str | None = None, seed: int = 0,
    first_id: int = 0, time: float = 1e9,
) -> CompactMap:  # fmt: skip
    """Return a robot's map of the street between two x; the robot has the map's name by default."""
    made = drive(main_street(), begin, end, np.random.default_rng([seed, *name.encode()]))
    return as_map(made, model_id, name, robot or f"{name} robot", first_id, time)


def put(service: Any, name: str, content: CompactMap, **headers: str) -> None:
    response = service.put(f"/maps/{name}", content=encode(content), headers=headers)
    assert response.is_success, response.text


def relative(one: str, other: str) -> Pose:
    """Return the true transform from the other map's frame into the one's."""
    return TRUTH[one].inverse().after(TRUTH[other])


def merge(service: Any, site: str, maps: Sequence[str], **more: Any) -> Any:
    headers = more.pop("headers", {})
    return service.post(f"/maps/{site}/merge", json={"maps": list(maps)} | more, headers=headers)
