"""Segments of a made-up yard: the pillars, whatever way the sensor is mounted."""

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.types import Float32
from placecell.segmentation.pipeline import segment_map
from service.clouds.segmented_scan import GROUND, OTHER, SegmentedScan, segment_scan
from service.clouds.uploaded_cloud import UploadedCloud, read_uploaded_cloud
from tests.placecell.sources.clouds.writers import las
from tests.service.clouds.scan_files import HEIGHT, PILLARS, turned, yard_scan

SCAN = yard_scan()


def uploaded(points: Float32) -> UploadedCloud:
    rows = np.insert(points, 3, np.arange(len(points)) % 7, axis=1).astype("<f4")
    return read_uploaded_cloud(rows.tobytes(), "scan.bin", 1_000_000)


def centers(scan: SegmentedScan) -> set[tuple[int, int]]:
    return {(round(float(x)), round(float(y))) for x, y, _ in (c.mean(axis=0) for c in scan.clouds)}


EXPECTED = {(round(x), round(y)) for x, y in PILLARS}


def test_pillars_are_the_segments() -> None:
    scan = segment_scan(uploaded(SCAN))
    assert centers(scan) == EXPECTED
    assert scan.sensor_height == pytest.approx(HEIGHT, abs=0.03)
    assert scan.problems == ()
    np.testing.assert_array_equal(scan.transform, np.eye(4))
    for index, cloud in enumerate(scan.clouds):
        marked = scan.voxels[scan.labels == index]
        assert {*map(tuple, marked.tolist())} == {*map(tuple, cloud.tolist())}
    ground = scan.voxels[scan.labels == GROUND]
    assert np.abs(ground[:, 2] + HEIGHT).max() < PROTOCOL_V1.ground_clearance + 0.05
    assert {*np.unique(scan.labels)} <= {GROUND, OTHER, *range(len(PILLARS))}


def test_segments_are_those_of_the_library() -> None:
    scan = segment_scan(uploaded(SCAN))
    expected = segment_map(scan.voxels, PROTOCOL_V1)
    assert len(expected) == len(scan.clouds)
    for one, other in zip(scan.clouds, expected, strict=True):
        np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize(("degrees", "axis"), [(12.0, 0), (-20.0, 1), (6.0, 1)])
def test_tilted_sensor_is_leveled(degrees: float, axis: int) -> None:
    scan = segment_scan(uploaded(turned(SCAN, degrees, axis)))
    assert len(scan.clouds) == len(PILLARS)
    assert any(f"tilted by {abs(degrees):.0f}" in each for each in scan.problems)
    heights = [float(cloud[:, 2].min()) for cloud in scan.clouds]
    assert np.ptp(heights) < 0.3
    turned_back = turned(SCAN, degrees, axis) @ scan.transform[:3, :3].T
    ground = turned_back[: len(SCAN) // 4, 2]
    assert np.ptp(ground) < 0.2


def test_scan_with_another_axis_up_is_turned() -> None:
    camera = turned(SCAN, 90.0, 0)  # y and z of a camera's frame
    scan = segment_scan(uploaded(camera))
    assert len(scan.clouds) == len(PILLARS)
    assert any("points up" in each for each in scan.problems)


def test_map_coordinates_are_centered_at_the_points() -> None:
    far = SCAN.astype(np.float64) + [451_234.5, 5_412_345.5, 120.0]
    scan = segment_scan(read_uploaded_cloud(las(far), "tile.las", 1_000_000))
    assert len(scan.clouds) == len(PILLARS)
    assert any("those of a map" in each for each in scan.problems)
    homogeneous = np.column_stack([far, np.ones(len(far))]) @ scan.transform.T
    assert np.abs(np.median(homogeneous[:, :3], axis=0)).max() < 2.0


@pytest.mark.parametrize(
    ("points", "told"),
    [
        (np.zeros((0, 3), np.float32), "No segment has 100 points"),
        (np.full((3, 3), 1e30, np.float32), "No segment has 100 points"),
        (np.tile(np.array([[5, 0, 0]], np.float32), (500, 1)), "No segment has 100 points"),
        (SCAN * np.float32(1000), "in mm"),
        (SCAN + np.array([100, 0, 0], np.float32), "only these are segmented"),
    ],
)
def test_unusual_scan_is_explained(points: Float32, told: str) -> None:
    plain = uploaded(SCAN)
    odd = UploadedCloud("PCD", type(plain.scan).of(points), np.zeros(3), ("an odd file",))
    scan = segment_scan(odd)
    assert scan.problems[0] == "An odd file."
    assert any(told in each for each in scan.problems), scan.problems
    assert all(each.endswith(".") for each in scan.problems)


def test_points_that_are_not_finite_are_counted() -> None:
    points = SCAN.copy()
    points[::100] = np.nan
    cloud = read_uploaded_cloud(
        np.column_stack([points, np.arange(len(points)) % 7]).astype("<f4").tobytes(),
        "a.bin",
        10**6,
    )
    scan = segment_scan(cloud)
    assert centers(scan) == EXPECTED
    assert "not finite" in scan.problems[0]
