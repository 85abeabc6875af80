import pickle
import zipfile
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from placecell.sources.clouds.formats import ReadOptions, read_cloud
from placecell.sources.errors import DriveError
from tests.placecell.sources.clouds.writers import POINTS, read


def npy(array: Any, **options: Any) -> bytes:
    stream = BytesIO()
    np.save(stream, array, **options)
    return stream.getvalue()


def write(folder: Path, content: bytes, name: str = "cloud.npy") -> Path:
    file = folder / name
    file.write_bytes(content)
    return file


@pytest.mark.parametrize("dtype", ["<f4", ">f4", "<f8", "f2", "<i4", "g"])
@pytest.mark.parametrize("width", [3, 4, 7])
def test_each_type_and_width_gives_the_points(tmp_path: Path, dtype: str, width: int) -> None:
    table = np.zeros((3, width))
    table[:, :3] = POINTS * 8
    scan = read(write(tmp_path, npy(table.astype(dtype))))
    np.testing.assert_array_equal(scan.points, POINTS * 8)
    assert scan.points.dtype == np.float32


def test_arrays_in_the_order_of_fortran_and_columns_are_read(tmp_path: Path) -> None:
    many = np.random.default_rng(1).normal(0, 10, (200, 4)).astype(np.float32)
    fortran = read(write(tmp_path, npy(np.asfortranarray(many))))
    np.testing.assert_array_equal(fortran.points, many[:, :3])
    file = write(tmp_path, npy(many.T.copy()))
    np.testing.assert_array_equal(read(file).points, many[:, :3])
    assert "column after column" in read_cloud(file, ReadOptions()).remarks[0]


def test_a_grid_of_points_is_a_list(tmp_path: Path) -> None:
    file = write(tmp_path, npy(np.arange(24.0).reshape(2, 4, 3)))
    assert read(file).points.shape == (8, 3)
    assert "the grid (2, 4, 3)" in read_cloud(file, ReadOptions()).remarks[0]


def test_structured_arrays_are_read_by_name(tmp_path: Path) -> None:
    table = np.zeros(3, [("t", "<u4"), ("z", "<f8"), ("y", "<f4"), ("x", "<f4"), ("tag", "S3")])
    table["x"], table["y"], table["z"] = POINTS.T
    table["t"] = [0, 50_000_000, 100_000_000]
    scan = read(write(tmp_path, npy(table)))
    np.testing.assert_array_equal(scan.points, POINTS)
    assert scan.times is not None
    np.testing.assert_allclose(scan.times, [0, 0.05, 0.1])
    nested = np.zeros(3, [("xyz", "<f4", (3,)), ("i", "<f4")])
    nested["xyz"] = POINTS
    np.testing.assert_array_equal(read(write(tmp_path, npy(nested))).points, POINTS)


def test_stated_columns_name_a_plain_array(tmp_path: Path) -> None:
    table = np.concatenate([[[0], [0.05], [0.1]], POINTS], axis=1)
    file = write(tmp_path, npy(table))
    scan = read(file, ReadOptions(("t", "x", "y", "z")))
    np.testing.assert_array_equal(scan.points, POINTS)
    assert scan.times is not None
    with pytest.raises(DriveError, match=r"has 4 columns, but --columns names 3"):
        read(file, ReadOptions(("x", "y", "z")))


@pytest.mark.parametrize("save", [np.savez, np.savez_compressed])
@pytest.mark.parametrize(
    "arrays",
    [
        {"points": POINTS},
        {"points": POINTS, "colors": POINTS + 9},
        {"anything": POINTS, "pose": np.eye(2), "stamp": np.float64(3)},
        {"x": POINTS[:, 0], "y": POINTS[:, 1], "z": POINTS[:, 2], "other": np.zeros(9)},
    ],
)
def test_the_points_of_an_archive_are_found(tmp_path: Path, save: Any, arrays: Any) -> None:
    save(tmp_path / "cloud.npz", **arrays)
    np.testing.assert_array_equal(read(tmp_path / "cloud.npz").points, POINTS)


def test_times_beside_the_points_of_an_archive_are_read(tmp_path: Path) -> None:
    times = np.array([0, 0.05, 0.1])
    np.savez(tmp_path / "cloud.npz", points=POINTS, timestamps=times, labels=np.zeros(3))
    scan = read(tmp_path / "cloud.npz")
    assert scan.times is not None
    np.testing.assert_allclose(scan.times, times)


def test_objects_beside_the_points_of_an_archive_are_not_loaded(tmp_path: Path) -> None:
    np.savez(tmp_path / "cloud.npz", points=POINTS, info=np.array([{"a": 1}], object))
    np.testing.assert_array_equal(read(tmp_path / "cloud.npz").points, POINTS)


class Bomb:
    def __reduce__(self) -> Any:
        return (pytest.fail, ("unpickled",))


def archive(**entries: bytes) -> bytes:
    stream = BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as opened:
        for name, content in entries.items():
            opened.writestr(name + ".npy", content)
    return stream.getvalue()


OBJECTS = npy(np.array([Bomb()], object), allow_pickle=True)
HUGE = npy(np.zeros((1, 3))).replace(b"(1, 3), }" + b" " * 12, b"(1000000000000, 3), }")


@pytest.mark.parametrize(
    ("name", "content", "expected"),
    [
        ("a.npy", OBJECTS, "Python objects, which can run code"),
        ("a.npy", b"\x93NUMPY" + pickle.dumps(3), "cannot be read"),
        ("a.npy", npy(POINTS)[:-1], "cut short: the header states 9 values, but the file has 8"),
        ("a.npy", npy(POINTS)[:20], "cannot be read"),
        ("a.npy", HUGE, "states 3,000,000,000,000 values"),
        ("a.npy", npy(np.zeros(5)), "the array is float64 (5,)"),
        ("a.npy", npy(np.zeros((5, 2))), "expected numbers of shape (n, 3 or more)"),
        ("a.npy", npy(np.zeros((5, 3), complex)), "the array is complex128"),
        ("a.npy", npy(np.array(3.0)), "the array is float64 ()"),
        ("a.npy", npy(np.zeros(2, [("a", "f4")])), "no x, y and z; the fields are a"),
        ("a.npy", b"text", "cannot be read"),
        ("a.npz", archive(points=OBJECTS), "Python objects"),
        ("a.npz", archive(points=npy(POINTS)[:-1]), "cut short"),
        ("a.npz", archive(a=npy(POINTS), b=npy(POINTS)), "several arrays have"),
        ("a.npz", archive(a=npy(np.zeros(3))), "no array has"),
        ("a.npz", archive(), "found no arrays"),
        ("a.npz", archive(points=npy(POINTS))[:-30], "the archive cannot be read"),
        ("a.npz", lambda: archive(points=npy(np.zeros((10**7, 3)))), "over 100 times as many"),
    ],
)
def test_a_damaged_file_is_named_with_what_is_wrong(
    tmp_path: Path, name: str, content: bytes | Callable[[], bytes], expected: str
) -> None:
    file = write(tmp_path, content if isinstance(content, bytes) else content(), name)
    with pytest.raises(DriveError) as error:
        read(file)
    assert str(error.value).startswith(f"{file}: ")
    assert expected in str(error.value)
