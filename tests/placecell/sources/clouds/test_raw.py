from pathlib import Path

import numpy as np
import pytest

from placecell.sources import DriveError, ScanOptions, parse_columns, use_scan_options
from placecell.sources.clouds import FolderOfClouds
from placecell.sources.clouds.formats import ReadOptions, read_cloud
from placecell.sources.point_layout import PointLayout

RNG = np.random.default_rng(5)


def cloud(points: int = 2000, columns: int = 4) -> np.ndarray:
    angle = RNG.uniform(0, 2 * np.pi, points)
    reach = RNG.uniform(3, 60, points)
    table = np.zeros((points, columns), np.float32)
    table[:, 0], table[:, 1] = reach * np.cos(angle), reach * np.sin(angle)
    table[:, 2] = RNG.uniform(-2, 3, points)
    for column in range(3, columns):
        table[:, column] = RNG.integers(0, 20 * (column - 2), points)
    return table


@pytest.mark.parametrize("columns", [3, 4, 5, 6])
def test_the_number_of_columns_is_found(tmp_path: Path, columns: int) -> None:
    tables = [cloud(columns=columns) for _ in range(4)]
    for index, table in enumerate(tables):
        table.tofile(tmp_path / f"{index}.bin")
    source = FolderOfClouds(tmp_path)
    assert len(source.fields) == columns
    for index, table in enumerate(tables):
        np.testing.assert_array_equal(source.scan(index).points, table[:, :3])


def test_stated_columns_and_unit_are_used(tmp_path: Path) -> None:
    table = cloud(columns=5)
    table[:, 4] = np.linspace(0, 0.1, len(table))
    (table * [1000, 1000, 1000, 1, 1]).astype("<f4").tofile(tmp_path / "0.bin")
    options = ScanOptions(columns=parse_columns("x,y,z,intensity,time"), unit="mm")
    with use_scan_options(options):
        source = FolderOfClouds(tmp_path)
    scan = source.scan(0)
    np.testing.assert_allclose(scan.points, table[:, :3], rtol=1e-5)
    assert scan.times is not None
    np.testing.assert_allclose(scan.times, table[:, 4], atol=1e-6)


def test_times_of_points_in_a_file_beside_are_read(tmp_path: Path) -> None:
    times = np.linspace(0, 0.1, 2000)
    for kind in ("<f4", "<f8"):
        cloud(columns=3).tofile(tmp_path / "points_07.bin")
        times.astype(kind).tofile(tmp_path / "times_07.bin")
        source = FolderOfClouds(tmp_path)
        assert len(source) == 1
        found = source.scan(0).times
        assert found is not None
        np.testing.assert_allclose(found, times, atol=1e-7)
        assert any("times_07.bin" in note for note in source.notes())
    times[:-1].tofile(tmp_path / "times_07.bin")
    assert FolderOfClouds(tmp_path).scan(0).times is None


def test_damaged_files_are_named(tmp_path: Path) -> None:
    for index in range(3):
        cloud().tofile(tmp_path / f"{index}.bin")
    (tmp_path / "1.bin").write_bytes((tmp_path / "1.bin").read_bytes()[:-3])
    RNG.integers(0, 2**32, 8000, dtype=np.uint32).tofile(tmp_path / "2.bin")
    source = FolderOfClouds(tmp_path)
    with pytest.raises(DriveError, match=r"1\.bin: 31,997 bytes is no whole number of points"):
        source.scan(1)
    with pytest.raises(DriveError, match=r"2\.bin: most values are no coordinates"):
        source.scan(2)


def test_a_file_of_a_few_bytes_is_refused(tmp_path: Path) -> None:
    (tmp_path / "0.bin").write_bytes(b"abc")
    with pytest.raises(DriveError, match=r"0\.bin: .* the longest has 3 bytes, not one value"):
        FolderOfClouds(tmp_path / "0.bin")


def test_a_single_file_whose_layout_is_not_sure_is_named(tmp_path: Path) -> None:
    cloud(5, 5).tofile(tmp_path / "tiny.bin")
    with pytest.raises(DriveError, match=r"tiny\.bin: .* State the layout with --columns"):
        FolderOfClouds(tmp_path / "tiny.bin")
    with use_scan_options(ScanOptions(columns=parse_columns("5"))):
        assert FolderOfClouds(tmp_path / "tiny.bin").scan(0).read == 5


def test_float64_values_are_read(tmp_path: Path) -> None:
    table = cloud(columns=3).astype("<f8")
    table.tofile(tmp_path / "0.bin")
    layout = PointLayout(("x", "y", "z"), "float64")
    found = read_cloud(tmp_path / "0.bin", ReadOptions(layout=layout)).values
    np.testing.assert_array_equal(np.stack([found[axis] for axis in "xyz"], axis=1), table)
