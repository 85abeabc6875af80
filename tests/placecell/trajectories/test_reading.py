"""Trajectory files: each format is told by its content, and read right."""

import random
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.errors import DriveError
from placecell.core.types import Float64
from placecell.trajectories.reading import read_trajectory
from placecell.trajectories.trajectory import Trajectory

POSITIONS = np.array([[0.0, 0.0, 0.0], [1.0, 0.5, 0.1], [2.0, 1.5, 0.1]])
ANGLES = np.array([[0.0, 0.0, 0.1], [0.02, -0.03, 0.4], [0.05, 0.01, 1.2]])
QUATERNIONS = Rotation.from_euler("xyz", ANGLES).as_quat()
STAMPS = np.array([1_700_000_000.0, 1_700_000_000.1, 1_700_000_000.2])


def truth() -> Float64:
    poses = np.tile(np.eye(4), (3, 1, 1))
    poses[:, :3, :3] = Rotation.from_quat(QUATERNIONS).as_matrix()
    poses[:, :3, 3] = POSITIONS
    return poses


def read(folder: Path, text: str, name: str = "poses.txt") -> Trajectory:
    (folder / name).write_text(text)
    return read_trajectory(folder / name)


def lines(*columns: Float64, separator: str = " ") -> str:
    return "".join(
        separator.join(f"{value:.12g}" for value in row) + "\n" for row in np.column_stack(columns)
    )


KITTI = lines(truth()[:, :3].reshape(-1, 12))
TUM = lines(STAMPS, POSITIONS, QUATERNIONS)
NANO = ["1700000000000000000", "1700000000100000000", "1700000000200000000"]
EUROC = (
    "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], "
    "q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z [], b_w_RS_S_x [rad s^-1]\n"
) + "".join(
    f"{stamp},{row}"
    for stamp, row in zip(
        NANO,
        lines(POSITIONS, QUATERNIONS[:, [3, 0, 1, 2]], np.full(3, 9.0), separator=",").splitlines(
            keepends=True
        ),
        strict=True,
    )
)
G2O = (
    "".join(
        f"VERTEX_SE3:QUAT {identity} {row}"
        for identity, row in zip(
            (2, 0, 1),
            [lines(POSITIONS, QUATERNIONS).splitlines(keepends=True)[at] for at in (2, 0, 1)],
            strict=True,
        )
    )
    + "EDGE_SE3:QUAT 0 1 1 0 0 0 0 0 1\n"
)
CSV = "qw,qx,qy,qz,z [mm],x [mm],y [mm],time_ms,frame\n" + "".join(
    f"{row},{stamp[:13]},base\n"
    for stamp, row in zip(
        NANO,
        lines(
            QUATERNIONS[:, [3, 0, 1, 2]], POSITIONS[:, [2, 0, 1]] * 1000, separator=","
        ).splitlines(),
        strict=True,
    )
)
WITH_TIMES = {"tum": TUM, "euroc": EUROC, "csv": CSV}
FORMATS = WITH_TIMES | {"kitti": KITTI, "g2o": G2O}


@pytest.mark.parametrize("name", FORMATS)
def test_format_is_told_by_content(tmp_path: Path, name: str) -> None:
    found = read(tmp_path, FORMATS[name], "any.name")
    assert found.poses == pytest.approx(truth(), abs=1e-9)
    if name in WITH_TIMES:
        assert found.stamps == pytest.approx(STAMPS, abs=1e-6)
    else:
        assert found.stamps is None
        assert "order" in found.remarks[0]


def test_kitti_takes_the_times_of_the_file_beside(tmp_path: Path) -> None:
    (tmp_path / "00_times.txt").write_text("0\n0.1\n0.25\n")
    found = read(tmp_path, KITTI, "00.txt")
    assert found.stamps == pytest.approx([0, 0.1, 0.25])
    assert found.remarks == ("the times are those of 00_times.txt",)


def test_times_of_another_number_are_refused(tmp_path: Path) -> None:
    (tmp_path / "times.txt").write_text("0\n0.1\n")
    with pytest.raises(DriveError, match=r"times.txt: 2 times for the 3 poses.*Move the file away"):
        read(tmp_path, KITTI)


def test_matrices_of_four_rows(tmp_path: Path) -> None:
    whole = lines(truth().reshape(-1, 16))
    by_line = "\n\n".join(lines(pose) for pose in truth())
    by_column = lines(truth().transpose(0, 2, 1).reshape(-1, 16))
    for text in (whole, by_line, by_column):
        assert read(tmp_path, text).poses == pytest.approx(truth(), abs=1e-9)


def test_time_and_matrix(tmp_path: Path) -> None:
    text = lines(STAMPS, truth()[:, :3].reshape(-1, 12), separator=",")
    assert read(tmp_path, text).stamps == pytest.approx(STAMPS, abs=1e-3)
    text = lines(np.arange(3.0), truth().reshape(-1, 16))
    assert read(tmp_path, text).poses == pytest.approx(truth(), abs=1e-9)


def test_position_and_quaternion_without_times(tmp_path: Path) -> None:
    found = read(tmp_path, lines(POSITIONS, QUATERNIONS))
    assert found.poses == pytest.approx(truth(), abs=1e-9)
    assert found.stamps is None


def test_table_without_names_tells_the_order_that_it_assumes(tmp_path: Path) -> None:
    found = read(tmp_path, lines(STAMPS, POSITIONS, QUATERNIONS, separator=","))
    assert "read as time, x, y, z, qx, qy, qz, qw, as TUM's" in found.remarks[0]
    assert found.poses == pytest.approx(truth(), abs=1e-9)
    body = "".join(EUROC.splitlines(keepends=True)[1:])
    eight = "".join(",".join(line.split(",")[:8]) + "\n" for line in body.splitlines())
    found = read(tmp_path, eight)
    assert "as EuRoC's" in found.remarks[-1] + found.remarks[0]
    assert found.poses == pytest.approx(truth(), abs=1e-9)


@pytest.mark.parametrize(
    ("header", "columns"),
    [
        ("time,x,y,z,roll,pitch,yaw", [0, 1, 2, 3, 4, 5, 6]),
        ("yaw_rad;pitch_rad;roll_rad;tz;ty;tx;t", [6, 5, 4, 3, 2, 1, 0]),
        ("%time,field.pose.pose.position.x,field.pose.pose.position.y,field.pose.pose.position.z,"
         "Roll (rad),Pitch (rad),Yaw (rad)", [0, 1, 2, 3, 4, 5, 6]),
        ("stamp\tpos_x\tpos_y\tpos_z\troll\tpitch\tyaw", [0, 1, 2, 3, 4, 5, 6]),
        ("# timestamp tx ty tz roll pitch yaw", [0, 1, 2, 3, 4, 5, 6]),
        ("seconds easting northing up roll pitch yaw", [0, 1, 2, 3, 4, 5, 6]),
    ],
)  # fmt: skip
def test_columns_are_found_by_name(tmp_path: Path, header: str, columns: list[int]) -> None:
    separator = next((each for each in ";,\t" if each in header), " ")
    table = np.column_stack([STAMPS, POSITIONS, ANGLES])[:, columns]
    found = read(tmp_path, header + "\n" + lines(table, separator=separator))
    assert found.poses == pytest.approx(truth(), abs=1e-9)
    assert found.stamps == pytest.approx(STAMPS, abs=1e-3)


def test_comma_is_the_decimal_point_between_semicolons(tmp_path: Path) -> None:
    text = "time;x;y;z;qx;qy;qz;qw\n" + lines(
        np.arange(3.0), POSITIONS, QUATERNIONS, separator=";"
    ).replace(".", ",")
    assert read(tmp_path, text).poses == pytest.approx(truth(), abs=1e-9)


@pytest.mark.parametrize("header", ["time,x,y,z,yaw_deg", "time,x,y,z,yaw [deg]", "time,x,y,z,yaw"])
def test_degrees_are_told_by_name_or_by_magnitude(tmp_path: Path, header: str) -> None:
    found = read(tmp_path, f"{header}\n0,0,0,0,0\n1,1,0,0,90\n2,2,0,0,180\n")
    assert found.poses[1, :2, 0] == pytest.approx([0, 1], abs=1e-9)
    assert ("degrees" in "".join(found.remarks)) == (header == "time,x,y,z,yaw")


def test_angles_without_a_unit_are_told(tmp_path: Path) -> None:
    found = read(tmp_path, "x,y,theta\n0,0,0\n1,0,1.5707963267948966\n")
    assert "taken as radians" in found.remarks[0]
    assert found.poses[1] == pytest.approx(
        np.array([[0, -1, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]), abs=1e-9
    )


def test_matrix_columns(tmp_path: Path) -> None:
    names = ",".join(f"T{row}{column}" for row in range(3) for column in range(4))
    text = names + "\n" + lines(truth()[:, :3].reshape(-1, 12), separator=",")
    assert read(tmp_path, text).poses == pytest.approx(truth(), abs=1e-9)
    names = "tx,ty,tz," + ",".join(f"r{row}{column}" for row in "123" for column in "123")
    text = names + "\n" + lines(POSITIONS, truth()[:, :3, :3].reshape(-1, 9), separator=",")
    assert read(tmp_path, text).poses == pytest.approx(truth(), abs=1e-9)


def test_dates_and_split_times(tmp_path: Path) -> None:
    body = ",0,0,0,0,0,0,1\n"
    text = "time,x,y,z,qx,qy,qz,qw\n" + "".join(
        f"2023-11-14 22:13:20.{digit}00000000{body}" for digit in "012"
    )
    assert read(tmp_path, text).stamps == pytest.approx(STAMPS, abs=1e-6)
    text = "header.stamp.sec,header.stamp.nanosec,x,y,z,qx,qy,qz,qw\n" + "".join(
        f"1700000000,{digit}00000000{body}" for digit in "012"
    )
    assert read(tmp_path, text).stamps == pytest.approx(STAMPS, abs=1e-6)


@pytest.mark.parametrize(
    ("times", "scale"),
    [
        ([1_700_000_000_000, 1_700_000_000_100], 1e-3),
        ([1_700_000_000_000_000, 1_700_000_000_100_000], 1e-6),
        ([5_000_000_000_000, 5_000_005_000_000], 1e-9),
        ([0, 100_000], 1e-6),
        ([0, 100], 1e-3),
        ([10, 12], 1.0),
    ],
)
def test_unit_of_times(tmp_path: Path, times: list[int], scale: float) -> None:
    text = "".join(f"{time} {at} 0 0 0 0 0 1\n" for at, time in enumerate(times))
    assert read(tmp_path, text).stamps == pytest.approx(np.array(times) * scale)


def test_times_out_of_order_are_sorted_and_repeated_ones_dropped(tmp_path: Path) -> None:
    found = read(tmp_path, "".join(f"{time} {time} 0 0 0 0 0 1\n" for time in (0, 2, 1, 1)))
    assert found.poses[:, 0, 3].tolist() == [0, 1, 2]
    assert "not in order, first at pose 2" in found.remarks[0]
    assert "1 poses repeat a time" in found.remarks[1]


def test_planar_pose_graph(tmp_path: Path) -> None:
    found = read(tmp_path, "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 2 1.5707963267948966\n", "a.g2o")
    assert found.poses[1, :3, 3].tolist() == [1, 2, 0]
    assert found.poses[1, :2, 0] == pytest.approx([0, 1], abs=1e-9)


def test_ids_of_a_pose_graph_that_are_times(tmp_path: Path) -> None:
    vertices = "".join(f"VERTEX_SE3:QUAT {stamp} 0 0 0 0 0 0 1\n" for stamp in NANO)
    assert read(tmp_path, vertices).stamps == pytest.approx(STAMPS, abs=1e-6)
    letters = "".join(f"VERTEX_SE3:QUAT {(120 << 56) + at} {at} 0 0 0 0 0 1\n" for at in range(3))
    found = read(tmp_path, letters)
    assert found.stamps is None
    assert found.poses[:, 0, 3].tolist() == [0, 1, 2]


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "holds no lines with values"),
        ("# only a comment\n", "holds no lines with values"),
        ("1 2 3\n", r"line 1: 3 values a line; it must hold a trajectory.*header line"),
        ("1 2 3 4 5 6\n", "6 values a line"),
        (TUM + "1700000000.3 1 2\n", r"line 4: 3 values, expected 8.*remove the line"),
        (TUM.replace("0.5", "half", 1), r"line 2: found 'half', expected a number"),
        (TUM.replace("0.5", "nan", 1), r"line 2: a value is not finite"),
        ("0 1 2 3 0.5 0.5 0.5 2\n", "the quaternion .* has the length 2.18, expected 1"),
        ("0 1 2 3 0 0 0 0\n", "has the length 0, expected 1"),
        ("1 0 0 0 0 1 0 0 0 0 2 0\n", "is no rotation"),
        ("1 0 0 0 0 1 0 0 0 0 1e300 0\n", "is no rotation"),
        (lines(np.ones((4, 4))), "not each fourth line is 0 0 0 1"),
        (lines(np.ones((1, 16))), "last four are not 0 0 0 1"),
        ("latitude,longitude,altitude\n49,8,100\n", "header names no position .found latitude"),
        ("x,y,z\n1,2,3\n", "header names no rotation"),
        ("x [in],y [in],yaw\n1,2,3\n", "has the unit 'in', expected m, "),
        ("x,y,yaw [turns]\n1,2,3\n", "unit 'turns', expected rad or deg"),
        ("x,y,yaw,time [weeks]\n1,2,3,4\n", "unit 'weeks', expected s, ms"),
        ("x,y,yaw\n", "holds a header line and no values"),
        ("x,y,yaw\n1,2\n", r"line 2: 2 values, expected 3"),
        ("time,x,y,yaw\n2020-01-01 10:00:00,1,2,3\nsoon,1,2,3\n", "line 3: expected a date"),
        ("VERTEX_XY 0 1 2\n", "no vertex is a pose"),
        ("VERTEX_SE2 0 1 2\n", "2 values, expected 3 finite"),
        ("VERTEX_SE2 zero 1 2 3\n", "expected VERTEX_SE2 ID VALUES"),
        ("VERTEX_SE2 0 1 2 3\nVERTEX_SE2 0 1 2 3\n", "line 2: the id 0 was used before, on line 1"),
        ("VERTEX_SE2 0 1 2 3\nVERTEX_SE3:QUAT 1 0 0 0 0 0 0 1\n", "both 2D and 3D"),
        (f"VERTEX_SE2 {97 << 56} 1 2 3\nVERTEX_SE2 {98 << 56} 1 2 3\n", "letters a, b"),
        ("\0\0\0", "is a binary file"),
    ],
)
def test_damaged_file_is_refused_with_its_name_and_the_remedy(
    tmp_path: Path, text: str, said: str
) -> None:
    with pytest.raises(DriveError, match=said) as caught:
        read(tmp_path, text)
    assert str(tmp_path / "poses.txt") in str(caught.value)


def test_missing_file_and_folder_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DriveError, match="missing; it must hold a trajectory"):
        read_trajectory(tmp_path / "none.txt")
    with pytest.raises(DriveError, match="cannot be read"):
        read_trajectory(tmp_path)


def test_utf16_with_byte_order_mark_is_read(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_bytes(CSV.encode("utf-16"))
    assert read_trajectory(tmp_path / "a.csv").poses == pytest.approx(truth(), abs=1e-9)


def mutated(content: bytes, generator: random.Random) -> bytes:
    """Cut, flip, repeat, or replace a part of a file."""
    data = bytearray(content)
    for _ in range(generator.randint(1, 4)):
        at = generator.randrange(len(data))
        kind = generator.randrange(6)
        if kind == 0 and at:
            del data[at:]
        elif kind == 1:
            data[at] ^= 1 << generator.randrange(8)
        elif kind == 2:
            data[at:at] = generator.choice([b"nan", b"1e999", b"-", b",", b"\n", b"\0", b"#", b";"])
        elif kind == 3:
            del data[at : at + generator.randint(1, 40)]
        elif kind == 4:
            data[at:at] = data[at : at + generator.randint(1, 80)]
        else:
            data[at] = generator.randrange(256)
        if not data:
            return b""
    return bytes(data)


@pytest.mark.slow
@pytest.mark.parametrize("name", FORMATS)
def test_mutated_file_gives_a_trajectory_or_a_clear_error(tmp_path: Path, name: str) -> None:
    generator = random.Random(name)
    file = tmp_path / "poses.txt"
    for _ in range(400):
        file.write_bytes(mutated(FORMATS[name].encode(), generator))
        try:
            found = read_trajectory(file)
        except DriveError:
            continue
        assert len(found) >= 1
        assert np.isfinite(found.poses).all()
        assert found.stamps is None or (np.diff(found.stamps) > 0).all()
