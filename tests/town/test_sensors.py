"""Sensors of the town: beams by their data sheets, the rosette, mounting, rain and dropout."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.core.types import Float32, Float64
from town import HDL_64E, SENSORS, Lidar, Scene, read_origin, sensor, two_robots
from town.geometry.shapes import box
from town.places import PLACES, build_place
from town.places.indoor.floor import DIFFERING
from town.sensing.sensors import SOLID_STATE


def still(lidar: Lidar) -> Float64:
    return np.tile(np.eye(4), (lidar.columns, 1, 1))


def room() -> Scene:
    """Return a closed bright room, at least 5 m to each side."""
    return Scene(box((-20.0, -5.0, -6.0), (30.0, 10.0, 12.0), reflectance=0.8))


def scan(lidar: Lidar, time: float = 0.0) -> Float32:
    return lidar.scan(room(), still(lidar), np.eye(4), np.random.default_rng(0), time)


def elevations(directions: Float32) -> Float64:
    return np.degrees(np.arcsin(directions[..., 2].astype(np.float64)))


@pytest.mark.parametrize(
    ("name", "beams", "highest", "lowest", "step"),
    [
        ("hdl-32e", 32, 10.67, -30.67, 1.3335),
        ("vlp-16", 16, 15.0, -15.0, 2.0),
        ("os0-32", 32, 45.0, -45.0, 90 / 31),
        ("os0-64", 64, 45.0, -45.0, 90 / 63),
        ("os0-128", 128, 45.0, -45.0, 90 / 127),
        ("os1-32", 32, 22.5, -22.5, 45 / 31),
        ("os1-64", 64, 22.5, -22.5, 45 / 63),
        ("os1-128", 128, 22.5, -22.5, 45 / 127),
    ],
)
def test_beams_are_those_of_the_data_sheet(
    name: str, beams: int, highest: float, lowest: float, step: float
) -> None:
    lidar = sensor(name)
    found = elevations(lidar.directions())
    assert found.shape == (lidar.columns, beams)
    assert found[0] == pytest.approx(np.linspace(highest, lowest, beams), abs=0.001)
    assert -np.diff(found[7]) == pytest.approx(step, abs=0.001)


@pytest.mark.parametrize(
    ("name", "points"),
    [
        ("hdl-64e", 64_000),
        ("hdl-32e", 69_440),  # 32 lasers fire every 46.08 us
        ("vlp-16", 28_928),  # 16 lasers fire every 55.296 us
        ("os0-128", 131_072),  # 1,024 columns at 10 Hz
        ("os1-64", 65_536),
        ("solid-state", 24_000),  # 240,000 points a second
    ],
)
def test_a_room_returns_every_ray_but_the_dropouts(name: str, points: int) -> None:
    lidar = sensor(name, dropout=0.0)
    assert len(scan(lidar)) == points
    assert len(scan(sensor(name))) == pytest.approx((1 - SENSORS[name].dropout) * points, rel=0.01)


def test_rosette_fills_its_field_of_view() -> None:
    directions = sensor("solid-state").directions().reshape(-1, 3).astype(np.float64)
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1, abs=1e-6)
    assert directions[:, 0].min() > 0
    off = np.degrees(np.arccos(directions[:, 0]))
    angle = np.arctan2(directions[:, 2], directions[:, 1])
    sideways, upward = off * np.cos(angle), off * np.sin(angle)
    assert np.abs(sideways).max() == pytest.approx(70.4 / 2, abs=0.2)
    assert np.abs(upward).max() == pytest.approx(77.2 / 2, abs=0.3)


def test_rosette_deflects_by_hand() -> None:
    """At time 0 both prisms deflect to the left, and after a quarter turn of both upward."""
    lasers = replace(SOLID_STATE, columns=1, elevations=(0.0, 2.0))
    (left,) = lasers.directions(0.0)
    full, up = np.radians([35.2, 2.0])
    off = np.hypot(full, up)
    assert left[0] == pytest.approx([np.cos(full), np.sin(full), 0], abs=1e-6)
    assert left[1] == pytest.approx(
        [np.cos(off), np.sin(off) * full / off, np.sin(off) * up / off], abs=1e-6
    )
    same = replace(lasers, speeds=(600.0, 600.0))
    (upward,) = same.directions(0.025)
    assert upward[0] == pytest.approx([np.cos(full), 0, np.sin(full)], abs=1e-6)
    opposite = replace(lasers, speeds=(600.0, -600.0))
    (ahead,) = opposite.directions(0.025)
    assert ahead[0] == pytest.approx([1, 0, 0], abs=1e-6)


def test_rosette_does_not_repeat_from_scan_to_scan() -> None:
    lidar = sensor("solid-state", columns=500)
    assert not np.allclose(lidar.directions(0.0), lidar.directions(0.1), atol=0.1)
    assert len(np.unique(np.round(scan(lidar, 0.1)[:, :3], 2), axis=0)) > 2000
    np.testing.assert_array_equal(scan(lidar, 0.1), scan(lidar, 0.1))
    # 300 scans are whole revolutions of both prisms: 3,647 and 2,332.
    assert lidar.directions(0.1) == pytest.approx(lidar.directions(30.1), abs=1e-5)


def test_spinning_sensor_repeats_its_pattern() -> None:
    np.testing.assert_array_equal(HDL_64E.directions(0.0), HDL_64E.directions(12.3))


def test_options_change_only_what_they_name() -> None:
    assert sensor("hdl-64e") == HDL_64E
    assert sensor("vlp-16", columns=90, mount=0.3, rain=5.0, dropout=0.5) == replace(
        SENSORS["vlp-16"], columns=90, height=0.3, rain=5.0, dropout=0.5
    )


@pytest.mark.parametrize("mount", [0.29, 3.01, float("nan")])
def test_impossible_mounts_are_refused(mount: float) -> None:
    with pytest.raises(ValueError, match=r"expected 0\.3 to 3\.0 m above the ground"):
        sensor("vlp-16", mount=mount)


def test_unknown_sensor_names_the_known_ones() -> None:
    with pytest.raises(ValueError, match=r"'os2-128': expected one of hdl-64e, .*solid-state\."):
        sensor("os2-128")


def test_rain_dims_a_weak_sensor_earlier() -> None:
    """Share of returns from asphalt that is left in heavy rain."""
    plain = Scene(box((-200.0, -200.0, -3.0), (400.0, 400.0, 2.0), 0.15))

    def returns(name: str, rain: float) -> int:
        lidar = replace(sensor(name, columns=90, rain=rain), elevations=(-2.0, -4.0, -8.0))
        rng = np.random.default_rng(0)
        return len(lidar.scan(plain, still(lidar), np.eye(4), rng))

    assert returns("os0-64", 20) < returns("os0-64", 0)
    assert returns("os0-64", 20) / returns("os0-64", 0) < returns("os1-64", 20) / returns(
        "os1-64", 0
    )


@pytest.mark.parametrize("place", PLACES)
def test_low_sensor_keeps_clear_of_the_ground(place: str) -> None:
    """A sensor at 0.3 m has 0.25 m or more of air below it along both robots' routes."""
    built, route = build_place(place, 3, 150.0)
    scene = Scene(built.mesh(3))
    for way in (route, route.reversed()):
        poses = way.poses(np.arange(0.0, way.length(), 0.5), height=0.3)
        down = np.tile(np.array([0, 0, -1], np.float32), (len(poses), 1))
        ranges, _ = scene.cast(poses[:, :3, 3].astype(np.float32), down)
        assert ranges.min() > 0.25


@pytest.fixture(scope="module")
def build() -> Iterator[Callable[..., tuple[Any, Any]]]:
    """Build each place once, also in `two_robots`: a campus takes seconds."""
    with pytest.MonkeyPatch.context() as patch:
        once = cache(build_place)
        patch.setattr("town.drives.robots.build_place", once)
        yield once


@pytest.mark.parametrize(
    ("place", "mount", "expected"),
    [
        ("streets", None, {"hdl-64e": 1.73, "vlp-16": 0.6}),
        ("campus", None, {"hdl-64e": 1.5, "vlp-16": 0.6}),
        ("campus", 2.5, {"hdl-64e": 2.5, "vlp-16": 2.5}),
    ],
)
def test_mount_is_the_lower_of_sensor_and_place_unless_given(
    tmp_path: Path,
    build: Callable[..., tuple[Any, Any]],
    place: str,
    mount: float | None,
    expected: dict[str, float],
) -> None:
    for name, height in expected.items():
        folder = tmp_path / name
        lidar = sensor(name, columns=16)
        drive, _ = two_robots(folder, scans=1, place=place, lidar=lidar, mount=mount)
        town, _ = build(place, 7, 1.08 * PLACES[place].spacing + 4.0, 0, DIFFERING)
        origin = read_origin(drive)[:3, 3]
        above = origin[2] - town.terrain.height(origin[:2])
        assert above == pytest.approx(height, abs=0.02)
