from collections.abc import Iterable
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

from segments.drives import open_drive
from segments.extraction import record
from segments.parameters import PROTOCOL_V1
from segments.recording import Recording
from segments.types import Float64
from town import read_origin, two_robots

SCANS = 32


@pytest.fixture(scope="module")
def drives(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    return two_robots(tmp_path_factory.mktemp("town"), seed=7, scans=SCANS)


@pytest.fixture(scope="module")
def recordings(drives: tuple[Path, Path]) -> tuple[Recording, Recording]:
    parameters = PROTOCOL_V1.for_drive(SCANS, every=6)
    one, other = (record(open_drive(folder), parameters) for folder in drives)
    return one, other


def sensors(folder: Path) -> Float64:
    return np.asarray(read_origin(folder) @ open_drive(folder).poses)


def centroids(folder: Path, recording: Recording) -> Float64:
    origin = read_origin(folder)
    return np.asarray(recording.segments.centroids() @ origin[:3, :3].T + origin[:3, 3])


def test_robots_meet_head_on(drives: tuple[Path, Path]) -> None:
    one, other = (sensors(folder) for folder in drives)
    assert [folder.name for folder in drives] == ["robot_a", "robot_b"]
    distance, nearest = cKDTree(one[:, :3, 3]).query(other[:, :3, 3])
    shared = distance < 4.0
    assert shared.mean() > 0.7
    assert distance.min() > 2.5  # never in the same lane
    heading = np.einsum("ij,ij->i", other[shared, :3, 0], one[nearest[shared], :3, 0])
    assert heading.max() < -0.9


def test_a_frame_holds_as_many_segments_as_a_real_street(
    recordings: tuple[Recording, Recording],
) -> None:
    for recording in recordings:
        frames = recording.frames[recording.frames >= 10]  # with a full local map
        a_frame = np.bincount(frames)[np.unique(frames)]
        assert 30 <= a_frame.mean() <= 100
        sizes = np.diff(recording.segments.ends, prepend=0)
        assert 150 <= np.median(sizes) <= 800
        assert sizes.max() > 1500


def test_robots_see_the_same_segments(
    drives: tuple[Path, Path], recordings: tuple[Recording, Recording]
) -> None:
    one, other = (
        centroids(folder, recording) for folder, recording in zip(drives, recordings, strict=True)
    )
    distance, _ = cKDTree(one).query(other)
    # Were the frames apart, some centroids would lie near one another all the same.
    by_chance, _ = cKDTree(one).query(np.add(other, (6.0, 6.0, 0.0)))
    assert np.mean(distance < 1.5) > 0.6
    assert np.mean(distance < 1.5) > np.mean(by_chance < 1.5) + 0.2


def test_progress_is_told_and_drives_are_protected(
    drives: tuple[Path, Path], tmp_path: Path
) -> None:
    told = []

    def progress(items: Iterable[int], total: int, what: str) -> Iterable[int]:
        told.append((total, what))
        return items

    two_robots(tmp_path, scans=2, columns=100, progress=progress)
    assert told == [(2, "scans of robot_a"), (2, "scans of robot_b")]
    with pytest.raises(FileExistsError):
        two_robots(tmp_path, scans=2, columns=100)
