"""WGS 84: reference values, round trips, and the place of a map."""

import numpy as np
import pytest

from placecell.core.geodesy import (
    GeoAnchor,
    ecef_of,
    enu_axes,
    geodetic_of,
    rotation_at,
    to_geodetic,
    to_map,
)

# Latitude, longitude, height; x, y, z. The axes of the ellipsoid, and the example of Hofmann-
# Wellenhof's formula at 45 degrees, computed with 30 digits: N = a / sqrt(1 - e2 / 2).
KNOWN = [
    ((0.0, 0.0, 0.0), (6_378_137.0, 0.0, 0.0)),
    ((0.0, 90.0, 100.0), (0.0, 6_378_237.0, 0.0)),
    ((90.0, 0.0, 0.0), (0.0, 0.0, 6_356_752.314245179)),
    ((-90.0, 0.0, 10.0), (0.0, 0.0, -6_356_762.314245179)),
    ((45.0, 45.0, 0.0), (3_194_419.145060574, 3_194_419.145060574, 4_487_348.408865919)),
]


@pytest.mark.parametrize(("place", "point"), KNOWN)
def test_reference_values(place: tuple[float, ...], point: tuple[float, ...]) -> None:
    np.testing.assert_allclose(ecef_of(*place), point, atol=1e-6)
    found = geodetic_of(np.array(point))
    assert found[0] == pytest.approx(place[0], abs=1e-11)
    assert found[2] == pytest.approx(place[2], abs=1e-6)


def test_round_trip_over_the_whole_earth() -> None:
    random = np.random.default_rng(0)
    places = random.uniform((-90, -180, -100), (90, 180, 9_000), (2_000, 3))
    back = geodetic_of(ecef_of(*places.T))
    np.testing.assert_allclose(back[:, :2], places[:, :2], atol=1e-10)
    np.testing.assert_allclose(back[:, 2], places[:, 2], atol=1e-6)


def test_axes_are_east_north_and_up() -> None:
    np.testing.assert_allclose(enu_axes(0.0, 0.0), [[0, 1, 0], [0, 0, 1], [1, 0, 0]], atol=1e-15)
    axes = enu_axes(49.0, 8.4)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-15)
    north = ecef_of(49.001, 8.4, 0.0) - ecef_of(49.0, 8.4, 0.0)
    assert (axes @ north)[1] == pytest.approx(np.linalg.norm(north), rel=1e-8)


def test_points_of_a_map_by_hand() -> None:
    # At 45 degrees, a degree of latitude has 111,131.8 m and one of longitude 78,846.8 m.
    anchor = GeoAnchor(45.0, 10.0, 200.0)
    north, east = to_geodetic(np.array([[0.0, 100.0, 5.0], [100.0, 0.0, 5.0]]), anchor)
    assert (north[0] - 45.0) * 111_131.8 == pytest.approx(100.0, abs=0.01)
    assert north[1] == 10.0
    assert (east[1] - 10.0) * 78_846.8 == pytest.approx(100.0, abs=0.01)
    assert east[2] == pytest.approx(205.0, abs=0.01)


def test_map_and_earth_are_inverse() -> None:
    anchor = GeoAnchor(-33.9, 151.2, 40.0, 30.0, 1.0, (1_000.0, -500.0, 3.0))
    points = np.random.default_rng(1).uniform(-5_000, 5_000, (100, 3))
    np.testing.assert_allclose(to_map(to_geodetic(points, anchor), anchor), points, atol=1e-6)
    np.testing.assert_allclose(
        to_geodetic(np.array(anchor.position), anchor)[0], (-33.9, 151.2, 40.0), atol=1e-9
    )


def test_moved_anchor_is_at_the_same_place() -> None:
    anchor = GeoAnchor(49.0, 8.4, 110.0, 175.0)
    turn = np.radians(20.0)
    rotation = np.array(
        [[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
    )
    translation = np.array([300.0, -20.0, 2.0])
    points = np.random.default_rng(2).uniform(-500, 500, (20, 3))
    moved = anchor.moved(rotation, translation)
    assert moved.yaw_deg == pytest.approx(155.0)
    np.testing.assert_allclose(
        to_geodetic(points @ rotation.T + translation, moved),
        to_geodetic(points, anchor),
        atol=1e-8,
    )


def test_rotation_at_a_far_point_follows_the_meridians() -> None:
    anchor = GeoAnchor(60.0, 10.0, 0.0, 90.0)
    np.testing.assert_allclose(rotation_at(np.zeros(3), anchor), anchor.rotation, atol=1e-12)
    # x points north, y west. North of a place 10 km to the west is to the right of x.
    far = rotation_at(np.array([0.0, 10_000.0, 0.0]), anchor)
    turned = np.degrees(np.arctan2(far[1, 0], far[0, 0])) - 90.0
    lon = to_geodetic(np.array([[0.0, 10_000.0, 0.0]]), anchor)[0, 1]
    assert turned == pytest.approx((10.0 - lon) * np.sin(np.radians(60.0)), rel=0.01)


def test_point_far_from_the_anchor_is_refused() -> None:
    with pytest.raises(ValueError, match="georeferenced already"):
        to_geodetic(np.array([[400_000.0, 0.0, 0.0]]), GeoAnchor(49.0, 8.4))
