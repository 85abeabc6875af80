from pathlib import Path

import numpy as np
import pytest

from placecell.sources.clouds.formats import ReadOptions, format_of, read_cloud
from placecell.sources.clouds.text import holds_points
from placecell.sources.errors import DriveError
from tests.placecell.sources.clouds.writers import POINTS, read

BARE = "1.5 -2.25 0.5\n3 4 -1\n-7.125 .25 2.\n"


def write(folder: Path, text: str, name: str = "cloud.xyz") -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8", newline="")
    return file


@pytest.mark.parametrize(
    "text",
    [
        BARE,
        BARE.replace(" ", "\t"),
        BARE.replace(" ", "   "),
        BARE.replace(" ", ","),
        BARE.replace(" ", ", "),
        BARE.replace(" ", " , "),
        BARE.replace(" ", ";"),
        BARE.replace(".", ","),
        BARE.replace(".", ",").replace(" ", ";"),
        BARE.replace(".", ",").replace(" ", "\t"),
        BARE.replace("\n", "\r\n"),
        BARE.replace("\n", " \n\n"),
        BARE.replace("\n", ",\n").replace(" ", ","),
        BARE.replace("1.5", "+1.5E0"),
        "  " + BARE.replace("\n", "\n  "),
        "\ufeff" + BARE,
        "3\n" + BARE,
        "# a comment\n// another\n" + BARE + "# the end\n",
        "x y z\n" + BARE,
        "X,Y,Z\n" + BARE.replace(" ", ","),
        "//X Y Z\n" + BARE,
        "# x y z\n" + BARE,
        '"x","y","z"\n' + BARE.replace(" ", ","),
        "Points_m_XYZ:0,Points_m_XYZ:1,Points_m_XYZ:2\n" + BARE.replace(" ", ","),
        "pos_x;pos_y;pos_z\n" + BARE.replace(" ", ";"),
        "x [m],y [m],z [m]\n" + BARE.replace(" ", ","),
        "x,y,z\n" + BARE,
    ],
)
def test_each_way_of_writing_a_table_gives_the_points(tmp_path: Path, text: str) -> None:
    file = write(tmp_path, text)
    np.testing.assert_array_equal(read(file).points, POINTS)
    head = file.read_bytes()
    assert holds_points(head, file)


def test_columns_are_found_by_their_names(tmp_path: Path) -> None:
    text = "id,label,z,nx,y,x,timestamp\n" + "".join(
        f"{index},car,{z},9,{y},{x},{index * 5e7}\n" for index, (x, y, z) in enumerate(POINTS)
    )
    file = write(tmp_path, text, "cloud.csv")
    scan = read(file)
    np.testing.assert_array_equal(scan.points, POINTS)
    assert scan.times is not None
    np.testing.assert_allclose(scan.times, [0, 0.05, 0.1])
    assert read_cloud(file, ReadOptions()).fields[1] == "label"


def test_other_units_in_a_header_are_converted(tmp_path: Path) -> None:
    for header, factor in (("x (mm),y (mm),z (mm)", 1000), ("x_cm,y_cm,z_cm", 100)):
        rows = "".join(",".join(map(str, row)) + "\n" for row in POINTS * factor)
        scan = read(write(tmp_path, f"{header}\n{rows}"))
        np.testing.assert_allclose(scan.points, POINTS, rtol=1e-6)


def test_more_columns_follow_without_a_header(tmp_path: Path) -> None:
    file = write(tmp_path, "1 2 3 99 0.5\n4 5 6 98 0.6\n")
    np.testing.assert_array_equal(read(file).points, [[1, 2, 3], [4, 5, 6]])
    assert read_cloud(file, ReadOptions()).fields == ("x", "y", "z", "column_3", "column_4")
    stated = ReadOptions(("intensity", "x", "y", "z", "t"))
    np.testing.assert_array_equal(read(file, stated).points, [[2, 3, 99], [5, 6, 98]])


def test_normals_with_a_curvature_are_no_quaternions(tmp_path: Path) -> None:
    file = write(tmp_path, "1 2 3 99 0 0 1 0.01\n-1 2 3 98 0 1 0 0.02\n")
    np.testing.assert_array_equal(read(file).points, [[1, 2, 3], [-1, 2, 3]])


def test_missing_values_drop_the_point(tmp_path: Path) -> None:
    for cell in ("", "nan", "NaN", "null", "inf"):
        scan = read(write(tmp_path, f"x,y,z\n1,2,3\n4,{cell},6\n7,8,9\n"))
        np.testing.assert_array_equal(scan.points, [[1, 2, 3], [7, 8, 9]])
        assert scan.not_finite == 1


def test_utf_16_and_older_encodings_are_read(tmp_path: Path) -> None:
    file = tmp_path / "cloud.txt"
    file.write_bytes(BARE.encode("utf-16"))
    assert format_of(file) is not None
    np.testing.assert_array_equal(read(file).points, POINTS)
    file.write_bytes(b"# 20 \xb0C\n" + BARE.encode())
    np.testing.assert_array_equal(read(file).points, POINTS)


@pytest.mark.parametrize("name", ["photo.txt", "photo.xyz", "photo.csv"])
def test_picture_with_the_name_of_a_table_is_told(tmp_path: Path, name: str) -> None:
    file = tmp_path / name
    file.write_bytes(b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR" + bytes(range(256)))
    with pytest.raises(DriveError, match=r"89 50 4e 47 .* not a picture or an archive"):
        read(file)


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", "0 bytes"),
        ("# only a comment\n", "holds no rows of numbers"),
        ("x y z\n", "holds no rows of numbers"),
        ("1 2\n3 4\n", "has 2 columns; expected x, y and z"),
        ("0.0\n0.1\n", "has 1 column; expected"),
        ("a,b,c\n1,2,3\n", "no x, y and z; the fields are a, b, c"),
        ("words that are no header of it\n1 2 3\n", "neither numbers nor the names of the 3"),
        ("1 2 3\n4 five 6\n", "row 2 of its points is '4 five 6'; expected a number in column 2"),
        ("1 2 3\n4 5\n", "row 2 of its points is '4 5'"),
        ("1 2 " + "3" * 70_000, "a line has 70,004 characters"),
        ("1 2 3\n" + "4 5 " + "6 " * 200 + "a b\n1 " + "q" * 200, " ..."),
        ("1583836591.5 1 2 3\n1583836591.6 1 2 3\n", "a time, not x in meters"),
        ("1.5 1 2 3 0 0 0 1\n1.6 1 2 3 0 0.6 0 0.8\n", "is a trajectory, not a point cloud"),
        ("1 0 0 5 0 1 0 6 0 0 1 7\n", "rows are 3x4 matrices with a rotation"),
        (
            "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], "
            "q_RS_y [], q_RS_z []\n1,2,3,4,1,0,0,0\n",
            "a time, a position and a quaternion",
        ),
        ("t,x,y,z,qx,qy,qz,qw\n1,2,3,4,0,0,0,1\n", "is a trajectory"),
    ],
)
def test_other_content_is_named_with_what_is_wrong(
    tmp_path: Path, text: str, expected: str
) -> None:
    file = write(tmp_path, text)
    with pytest.raises(DriveError) as error:
        read(file)
    assert str(error.value).startswith(f"{file}: ")
    assert expected in str(error.value)


def test_stated_columns_must_fit(tmp_path: Path) -> None:
    with pytest.raises(DriveError, match="has 3 columns, but --columns names 4"):
        read(write(tmp_path, BARE), ReadOptions(("x", "y", "z", "i")))
