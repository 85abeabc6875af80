import hashlib
from pathlib import Path

import numpy as np
import pytest

from placecell.sources import DriveError, ScanOptions, use_scan_options
from placecell.sources.clouds import FolderOfClouds
from placecell.sources.scan_options import Unit
from tests.placecell.sources.clouds.writers import POINTS, las, pcd, ply

XYZ = [("x", "F", 4, 1), ("y", "F", 4, 1), ("z", "F", 4, 1)]
PROPERTIES = ["float x", "float y", "float z"]


def write(folder: Path, *names: str) -> None:
    """Write clouds; the first point's x is the position in the list of names."""
    folder.mkdir(parents=True, exist_ok=True)
    for index, name in enumerate(names):
        rows = (POINTS + [index, 0, 0]).tolist()
        content = (
            ply("ascii", PROPERTIES, rows) if name.endswith("ply") else pcd(XYZ, rows, "ascii")
        )
        (folder / name).write_bytes(content)


def order(source: FolderOfClouds) -> list[str]:
    return [file.name for file in source.files]


def test_scans_are_ordered_by_number(tmp_path: Path) -> None:
    write(tmp_path, "scan10.pcd", "scan9.pcd", "scan100.pcd")
    source = FolderOfClouds(tmp_path)
    assert order(source) == ["scan9.pcd", "scan10.pcd", "scan100.pcd"]
    assert len(source) == 3
    assert source.scan(0).points[0, 0] == 2.5
    assert np.isnan(source.stamps).all()
    assert source.fields == ("x", "y", "z")
    assert source.title == tmp_path.name
    assert source.trajectory() is None


def test_a_single_file_is_one_scan(tmp_path: Path) -> None:
    write(tmp_path, "cloud.pcd", "other.pcd")
    source = FolderOfClouds(tmp_path / "cloud.pcd")
    assert len(source) == 1
    assert source.title == "cloud"
    np.testing.assert_array_equal(source.scan(0).points, POINTS)
    content = (tmp_path / "cloud.pcd").read_bytes()
    assert source.scan_hash(0) == hashlib.sha256(content).hexdigest()[:16]


@pytest.mark.parametrize(
    "name", ["velodyne", "lidar", "scans", "pcd", "os1_cloud", "a/../velodyne"]
)
def test_scans_may_lie_one_folder_deeper(tmp_path: Path, name: str) -> None:
    (tmp_path / "a").mkdir()
    write(tmp_path / name, "0.pcd", "1.pcd")
    (tmp_path / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n")
    source = FolderOfClouds(tmp_path)
    assert order(source) == ["0.pcd", "1.pcd"]
    assert FolderOfClouds.recognizes(tmp_path)
    assert "the scans are in" in source.notes()[0]


def test_several_folders_with_scans_are_refused(tmp_path: Path) -> None:
    write(tmp_path / "front", "0.pcd")
    write(tmp_path / "rear", "0.pcd")
    assert FolderOfClouds.recognizes(tmp_path)
    with pytest.raises(DriveError, match="several folders hold point clouds: front, rear"):
        FolderOfClouds(tmp_path)


def test_files_that_are_no_scans_are_ignored(tmp_path: Path) -> None:
    write(tmp_path, "000.pcd", "001.pcd", "._000.pcd", ".hidden.pcd", "000_labels.pcd", "map.pcd")
    write(tmp_path / "__MACOSX", "000.pcd")
    np.save(tmp_path / "poses.npy", np.eye(4))
    np.save(tmp_path / "times.npy", np.arange(2.0))
    (tmp_path / "000.label").write_bytes(b"1234")
    (tmp_path / "notes.txt").write_text("three two one\nfour 5 6\n")
    (tmp_path / "folder.pcd").mkdir()
    source = FolderOfClouds(tmp_path)
    assert order(source) == ["000.pcd", "001.pcd"]
    assert source.notes() == ("files without a number in their names are left out: map.pcd",)


def test_of_mixed_formats_the_majority_is_read_and_told(tmp_path: Path) -> None:
    write(tmp_path, "0.pcd", "1.pcd", "2.pcd", "3.ply")
    source = FolderOfClouds(tmp_path)
    assert len(source) == 3
    assert "only the 3 PCD files are read, not 1 PLY" in source.notes()[0]
    write(tmp_path, "4.ply")
    with pytest.raises(DriveError, match="3 PCD files and 2 PLY"):
        FolderOfClouds(tmp_path)


def test_a_folder_without_clouds_is_refused(tmp_path: Path) -> None:
    assert not FolderOfClouds.recognizes(tmp_path)
    with pytest.raises(DriveError, match="holds no point clouds; expected files such as"):
        FolderOfClouds(tmp_path)
    (tmp_path / "poses.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n")
    (tmp_path / "ground.txt").write_text("1 0 0 0 0 1 0 0 0 0 1 0\n" * 3)
    assert not FolderOfClouds.recognizes(tmp_path)
    assert not FolderOfClouds.recognizes(tmp_path / "absent")
    (tmp_path / "image.png").write_bytes(b"\x89PNG\r\n")
    with pytest.raises(DriveError, match=r"image\.png: is no point cloud"):
        FolderOfClouds(tmp_path / "image.png")


def test_names_with_times_give_stamps_and_the_order(tmp_path: Path) -> None:
    write(tmp_path, "c_1583836591_90.pcd", "c_1583836590_200000000.pcd")
    source = FolderOfClouds(tmp_path)
    np.testing.assert_allclose(source.stamps, [1583836590.2, 1583836591.00000009], atol=1e-6)
    assert source.scan(0).points[0, 0] == 2.5
    assert source.scan(0).stamp == source.stamps[0]


def test_a_file_of_times_beside_gives_stamps(tmp_path: Path) -> None:
    write(tmp_path / "velodyne", "0.pcd", "1.pcd")
    (tmp_path / "times.txt").write_text("0.0\n0.1\n")
    source = FolderOfClouds(tmp_path)
    np.testing.assert_array_equal(source.stamps, [0, 0.1])
    assert any("times.txt, in s" in note for note in source.notes())
    (tmp_path / "times.txt").write_text("0.0\n")
    assert np.isnan(FolderOfClouds(tmp_path).stamps).all()


def test_what_was_found_is_told_once(tmp_path: Path) -> None:
    for index in range(3):
        content = pcd(XYZ, POINTS.tolist(), "binary", VIEWPOINT="1 0 0 1 0 0 0")
        (tmp_path / f"{index}.pcd").write_bytes(content)
    told: list[str] = []
    with use_scan_options(ScanOptions(tell=told.append)):
        source = FolderOfClouds(tmp_path)
    source.scan(0)
    assert len(told) == 1
    assert "VIEWPOINT" in told[0]


def test_one_shift_is_subtracted_from_all_scans(tmp_path: Path) -> None:
    far = np.array([400_000.0, 5_000_000.0, 120.0])
    for index in range(2):
        (tmp_path / f"{index}.las").write_bytes(las(POINTS + far + [index * 50.0, 0, 0]))
    source = FolderOfClouds(tmp_path)
    assert source.shift is not None
    np.testing.assert_array_equal(source.shift, [400_000, 5_000_000, 100])
    for index in range(2):
        expected = POINTS + [index * 50.0, 0, 20]
        np.testing.assert_allclose(source.scan(index).points, expected, atol=5e-4)
    assert "(400000, 5000000, 100) m is subtracted" in " ".join(source.notes())


def test_the_stated_unit_is_applied(tmp_path: Path) -> None:
    write(tmp_path, "0.pcd")
    with use_scan_options(ScanOptions(unit="mm")):
        source = FolderOfClouds(tmp_path)
    np.testing.assert_allclose(source.scan(0).points, POINTS / 1000, rtol=1e-6)


def test_a_damaged_scan_is_an_error_only_when_it_is_read(tmp_path: Path) -> None:
    write(tmp_path, "0.pcd", "1.pcd")
    (tmp_path / "0.pcd").write_bytes(b"")
    source = FolderOfClouds(tmp_path)
    with pytest.raises(DriveError, match=r"0\.pcd: holds no points \(0 bytes\)"):
        source.scan(0)
    assert len(source.scan(1).points) == 3
    assert source.scan_hash(0) != source.scan_hash(1)
    (tmp_path / "1.pcd").unlink()
    with pytest.raises(DriveError, match=r"1\.pcd: cannot be read \(No such file"):
        source.scan(1)
    assert len(source.scan_hash(1)) == 16


def test_content_decides_before_the_name(tmp_path: Path) -> None:
    write(tmp_path, "cloud.pcd")
    (tmp_path / "cloud.pcd").rename(tmp_path / "cloud.txt")
    np.testing.assert_array_equal(FolderOfClouds(tmp_path / "cloud.txt").scan(0).points, POINTS)
    (tmp_path / "table.pcd").write_text("no cloud at all")
    with pytest.raises(DriveError, match=r"table\.pcd: it has a PCD header without"):
        FolderOfClouds(tmp_path / "table.pcd")


@pytest.mark.parametrize(("unit", "meters"), [("ft", 0.3048), ("us-ft", 1200 / 3937)])
def test_feet_become_meters(tmp_path: Path, unit: Unit, meters: float) -> None:
    (tmp_path / "0.pcd").write_bytes(pcd(XYZ, [[10, 20, 3]], "binary"))
    with use_scan_options(ScanOptions(unit=unit)):
        points = FolderOfClouds(tmp_path).scan(0).points
    np.testing.assert_allclose(points, np.array([[10, 20, 3]]) * meters, rtol=1e-6)
