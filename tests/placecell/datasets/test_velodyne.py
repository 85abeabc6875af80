import hashlib
from pathlib import Path

import numpy as np
import pytest

from placecell.datasets.drive import find_scans, read_table, read_velodyne
from placecell.sources.errors import DriveError
from placecell.trajectories.poses import check_rotations
from tests.placecell.segment_builders import MemoryDrive, pose, write_scan


def refused(file: Path) -> str:
    with pytest.raises(DriveError) as caught:
        read_velodyne(file)
    assert str(file) in str(caught.value)
    return str(caught.value)


def test_points_without_reflectance(tmp_path: Path) -> None:
    rows = np.array([[1, 2, 3, 0.5], [4, 5, 6, 0.25]], dtype="<f4")
    (tmp_path / "a.bin").write_bytes(rows.tobytes())
    points = read_velodyne(tmp_path / "a.bin")
    assert points.tolist() == [[1, 2, 3], [4, 5, 6]]
    assert points.dtype == np.float32
    assert points.flags.c_contiguous


def test_reflectance_may_be_anything(tmp_path: Path) -> None:
    np.array([[1, 2, 3, np.nan]], dtype="<f4").tofile(tmp_path / "a.bin")
    assert len(read_velodyne(tmp_path / "a.bin")) == 1


@pytest.mark.parametrize("missing", [1, 4, 12, 15])
def test_cut_file(tmp_path: Path, missing: int) -> None:
    write_scan(tmp_path / "a.bin", [[1, 2, 3]] * 3)
    content = (tmp_path / "a.bin").read_bytes()
    (tmp_path / "a.bin").write_bytes(content[:-missing])
    assert f"{48 - missing} bytes is no whole number of points" in refused(tmp_path / "a.bin")


def test_empty_file(tmp_path: Path) -> None:
    (tmp_path / "a.bin").touch()
    assert "no points" in refused(tmp_path / "a.bin")


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_values_that_are_not_finite(tmp_path: Path, value: float) -> None:
    write_scan(tmp_path / "a.bin", [[1, 2, 3], [1, value, 3], [value, value, 3], [4, 5, 6]])
    assert "2 of 4 points are not finite" in refused(tmp_path / "a.bin")


def test_missing_file(tmp_path: Path) -> None:
    assert "cannot be read" in refused(tmp_path / "none.bin")


def test_folder_instead_of_a_file(tmp_path: Path) -> None:
    refused(tmp_path)


def test_scans_are_in_order_of_their_numbers(tmp_path: Path) -> None:
    for name in ("10", "9", "000002"):
        write_scan(tmp_path / f"{name}.bin", [[1, 2, 3]])
    (tmp_path / "notes.txt").touch()
    assert [file.stem for file in find_scans(tmp_path)] == ["000002", "9", "10"]


def test_no_scans(tmp_path: Path) -> None:
    with pytest.raises(DriveError, match="holds no scans") as caught:
        find_scans(tmp_path)
    assert str(tmp_path) in str(caught.value)


@pytest.mark.parametrize("name", ["scan_3.bin", "first.bin", "-1.bin", "²3.bin"])
def test_scan_whose_name_is_no_number(tmp_path: Path, name: str) -> None:
    write_scan(tmp_path / "000000.bin", [[1, 2, 3]])
    write_scan(tmp_path / name, [[1, 2, 3]])
    with pytest.raises(DriveError, match="must be its number") as caught:
        find_scans(tmp_path)
    assert name in str(caught.value)


def test_table(tmp_path: Path) -> None:
    (tmp_path / "t.txt").write_text("1 2.5e1\n\n  -3\t4  \n")
    assert read_table(tmp_path / "t.txt", 2, "pairs").tolist() == [[1, 25], [-3, 4]]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("1 2\n1 two\n", "line 2: .*two.*must hold pairs"),
        ("1 2\n1 2 3\n", "line 2: 3 values; it must hold pairs"),
        ("1 2\n1\n", "line 2: 1 values"),
        ("1 2\nnan 1\n", "not finite"),
        ("1 inf\n", "not finite"),
    ],
)
def test_broken_table(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "t.txt").write_text(text)
    with pytest.raises(DriveError, match=rf"t\.txt.*{message}"):
        read_table(tmp_path / "t.txt", 2, "pairs")


def test_binary_table_is_refused(tmp_path: Path) -> None:
    (tmp_path / "t.txt").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(DriveError, match=r"t\.txt: cannot be read"):
        read_table(tmp_path / "t.txt", 2, "pairs")


def test_missing_table_says_what_it_must_hold(tmp_path: Path) -> None:
    with pytest.raises(DriveError, match=r"t\.txt: missing; it must hold pairs"):
        read_table(tmp_path / "t.txt", 2, "pairs")


def test_rotations_pass_and_others_are_named() -> None:
    good = pose(1, 2, 3, yaw=0.4)
    scaled, mirrored = good.copy(), good.copy()
    scaled[:3, :3] *= 1.01
    mirrored[:3, 0] *= -1
    check_rotations(np.stack([good, pose()]), Path("p.txt"))
    for bad, fault in ((scaled, "no rotation"), (mirrored, "a reflection .*left-handed")):
        with pytest.raises(DriveError, match=rf"p\.txt, pose 1: .*{fault}"):
            check_rotations(np.stack([good, bad, good]), Path("p.txt"))


def test_path_length_by_hand() -> None:
    drive = MemoryDrive([[]] * 4, [pose(), pose(3, 4), pose(3, 4), pose(3, 4, 2)])
    assert drive.path_length() == pytest.approx(7.0)
    assert MemoryDrive([[]], [pose()]).path_length() == 0.0


def test_scan_hash_is_its_files(tmp_path: Path) -> None:
    write_scan(tmp_path / "0.bin", [[1, 2, 3]])
    drive = MemoryDrive([[]], [pose()])
    drive.scan_files = [tmp_path / "0.bin"]
    whole = hashlib.sha256((tmp_path / "0.bin").read_bytes()).hexdigest()
    assert drive.scan_hash(0) == whole[:16]
