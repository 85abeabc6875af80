"""Tests of the labels of the town's returns, and of another day in the town."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float64
from placecell.datasets import open_drive
from placecell.datasets.labels import CODES, GROUND, class_of_code, read_codes
from placecell.segmentation.pipeline import record
from placecell.segmentation.segment_labels import segment_classes
from town import HDL_64E, Route, SceneObject, Town, one_robot, two_robots, write_drive
from town.objects.labels import CODE_OF_KIND
from town.places import Place, build_place

SMALL = replace(HDL_64E, columns=500)


@pytest.fixture(scope="module")
def town() -> Town:
    return Town.build(seed=5, streets=(2, 2))


@pytest.fixture(scope="module")
def folder(town: Town, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return drive(tmp_path_factory.mktemp("labeled") / "drive", town, labels=True)


def drive(folder: Path, town: Town, *, labels: bool) -> Path:
    route = Route.through(town.plan, town.terrain, [(0, 0), (1, 0), (1, 1)]).cut(40.0, 30.0)
    return write_drive(folder, town, route, traffic_seed=1, scans=3, lidar=SMALL, labels=labels)


def middles(things: tuple[SceneObject, ...], kind: str) -> Float64:
    return np.array([thing.mesh.bounds().mean(axis=0) for thing in things if thing.kind == kind])


def test_labels_change_no_other_file(town: Town, folder: Path, tmp_path: Path) -> None:
    plain = drive(tmp_path / "plain", town, labels=False)
    assert not (plain / "labels").exists()
    for file in plain.rglob("*.*"):
        assert file.read_bytes() == (folder / file.relative_to(plain)).read_bytes()


def test_each_return_has_the_code_of_the_object_it_lies_on(town: Town, folder: Path) -> None:
    mesh = town.mesh(1)
    assert set(mesh.codes.tolist()) >= {GROUND, 71, *(codes[0] for codes in CODES.values())}
    ground = len(town.ground)
    assert (mesh.codes[:ground] == GROUND).all()
    assert (mesh.codes[ground:] != GROUND).all()
    opened = open_drive(folder)
    codes = read_codes(opened, 0)
    assert len(codes) == len(opened.scan(0))
    low = opened.scan(0)[:, 2] < -1.6
    assert (codes[low] == GROUND).mean() > 0.95
    assert {GROUND, 50} <= set(codes.tolist())


@pytest.mark.slow
def test_labeled_drive_gives_labeled_segments(folder: Path) -> None:
    opened = open_drive(folder)
    recording = record(opened, PROTOCOL_V1.for_drive(len(opened)))
    found = segment_classes(opened, recording)
    assert len(found) == len(recording.segments)
    largest = np.argmax(recording.segments.counts)
    assert class_of_code()[50] == found[largest]  # a house


def test_kinds_of_the_streets_have_a_class(town: Town) -> None:
    kinds = {thing.kind for thing in (*town.objects, *town.traffic(1))}
    other = {"dustbins", "cabinet", "advertising column", "bus shelter"}
    assert kinds - set(CODE_OF_KIND) <= other


def test_on_another_day_no_bay_has_a_car_again(town: Town) -> None:
    today = middles(town.traffic(1), "parked car")
    other = middles(replace(town, other_cars=True).traffic(1), "parked car")
    assert min(len(today), len(other)) > 10
    distances = np.linalg.norm(today[:, None, :2] - other[None, :, :2], axis=2)
    assert distances.min() > 3.0


@pytest.mark.slow
def test_another_day_moves_what_is_movable_in_a_place() -> None:
    place, _ = build_place("car-park", seed=3, meters=60.0)
    assert isinstance(place, Place)
    today = middles(tuple(place.movables(1)), "parked car")
    other = middles(tuple(replace(place, other_cars=True).movables(1)), "parked car")
    distances = np.linalg.norm(today[:, None, :2] - other[None, :, :2], axis=2)
    assert distances.min() > 1.5
    assert replace(place, other_cars=True).objects == place.objects


@pytest.mark.slow
def test_one_robot_writes_the_drive_of_either_robot(tmp_path: Path) -> None:
    lidar = replace(SMALL, columns=60)
    both, second = two_robots(tmp_path / "both", seed=5, scans=1, lidar=lidar, place="indoor")
    alone = one_robot(tmp_path / "alone", 5, 1, place="indoor", lidar=lidar)
    other = one_robot(tmp_path / "other", 5, 1, place="indoor", lidar=lidar, other_cars=True)
    back = one_robot(tmp_path / "back", 5, 1, place="indoor", lidar=lidar, opposite=True)
    scan = Path("velodyne") / "000000.bin"
    for file in (scan, "poses.txt", "origin.txt"):
        assert (back / file).read_bytes() == (second / file).read_bytes()
    assert (alone / scan).read_bytes() == (both / scan).read_bytes()
    assert (other / scan).read_bytes() != (both / scan).read_bytes()
    assert (other / "poses.txt").read_bytes() == (both / "poses.txt").read_bytes()
