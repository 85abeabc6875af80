"""Exports, each read back by an independent reader."""

import json
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any, get_args

import laspy
import numpy as np
import pytest
from placecell_client.maps.compact_map import CompactMap
from placecell_client.maps.map_file import decode, encode
from rosbags.rosbag2 import Reader
from rosbags.typesys import Stores, get_typestore
from typer.testing import CliRunner, Result

from cli import app
from cli.map_content import read_content
from placecell.core.geodesy import GeoAnchor, to_geodetic
from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.export import mcap_file
from placecell.export.content import class_colors, colors
from placecell.export.export import export as write
from placecell.export.geo import parse_anchor
from placecell.export.targets import Target
from placecell.segmentation.recording import Recording
from tests.client.map_builders import random_map

export = partial(write, read=read_content)


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    """Write a recording of three segments in two captures."""
    clouds = [
        np.random.default_rng(index).normal(10.0 * index, 1, (5 + index, 3)).astype(np.float32)
        for index in range(3)
    ]
    sensors = np.array([[0, 0, 1], [0, 0, 1], [4, 0, 1.5]])
    Recording(
        name="yard",
        parameters=PROTOCOL_V1,
        segments=Segments.of(clouds, sensors),
        captures=np.array([0, 0, 2]),
        groups=np.array([0, 1, 1]),
        distinct=np.ones(3, dtype=bool),
        scans=4,
        scan_hashes=("a", "b", "c", "d"),
        path_length=4.0,
    ).save(tmp_path / "yard.safetensors")
    return tmp_path / "yard.safetensors"


@pytest.fixture
def map_file(tmp_path: Path) -> tuple[Path, CompactMap]:
    """Write a map of 20 segments of two robots."""
    written = encode(random_map(20, optional=("extents", "views")))
    (tmp_path / "town.map").write_bytes(written)
    return tmp_path / "town.map", decode(written)


def run(*words: object) -> Result:
    result: Result = CliRunner().invoke(app, ["export", *map(str, words)])
    return result


def read_ply(file: Path) -> tuple[list[str], np.ndarray]:
    """Read a binary PLY file by hand."""
    head, _, body = file.read_bytes().partition(b"end_header\n")
    lines = head.decode().splitlines()
    kinds = {"double": "<f8", "uchar": "u1", "ushort": "<u2", "uint": "<u4"}
    fields = [line.split()[1:] for line in lines if line.startswith("property")]
    return lines, np.frombuffer(body, [(name, kinds[kind]) for kind, name in fields])


def test_ply_has_all_points_with_segment_and_color(recording: Path, tmp_path: Path) -> None:
    content = export(recording, "ply", tmp_path / "a.ply")
    lines, table = read_ply(tmp_path / "a.ply")
    assert lines[0] == "ply"
    assert f"element vertex {5 + 6 + 7}" in lines
    np.testing.assert_array_equal(np.stack([table[a] for a in "xyz"], 1), content.points)
    np.testing.assert_array_equal(table["id"], np.repeat([0, 1, 2], [5, 6, 7]))
    np.testing.assert_array_equal(table["group"], np.repeat([0, 1, 1], [5, 6, 7]))
    assert len(np.unique(np.stack([table[c] for c in ("red", "green", "blue")], 1), axis=0)) == 3


@pytest.mark.parametrize(("color", "distinct"), [("id", 3), ("group", 2), ("robot", 1)])
def test_color_follows_the_chosen_number(recording: Path, color: str, distinct: int) -> None:
    result = run(recording, "--to", "ply", "--color", color)
    assert result.exit_code == 0, result.output
    _, table = read_ply(recording.with_suffix(".ply"))
    shades = np.stack([table[c] for c in ("red", "green", "blue")], 1)
    assert len(np.unique(shades, axis=0)) == distinct


def test_las_of_a_map_has_centroids_ids_and_robots(
    map_file: tuple[Path, CompactMap], tmp_path: Path
) -> None:
    path, town = map_file
    export(path, "las", tmp_path / "a.las", "robot")
    las = laspy.read(tmp_path / "a.las")
    np.testing.assert_allclose(las.xyz, town.centroids, atol=6e-4)
    np.testing.assert_array_equal(las["segment"], town.ids)
    np.testing.assert_array_equal(las["robot"], town.robot)
    assert town.views is not None
    np.testing.assert_array_equal(las["group"], town.views)
    assert las.red.max() > 255


def test_pcd_has_packed_colors(recording: Path, tmp_path: Path) -> None:
    content = export(recording, "pcd", tmp_path / "a.pcd")
    head, _, body = (tmp_path / "a.pcd").read_bytes().partition(b"DATA binary\n")
    assert b"FIELDS x y z rgb id robot group" in head
    table = np.frombuffer(body, "<u4").reshape(-1, 7)
    np.testing.assert_array_equal(table[:, :3].copy().view("<f4"), content.points.astype("f4"))
    shades = colors(content.ids)[content.owners].astype(np.uint32)
    expected = (shades[:, 0] << 16) | (shades[:, 1] << 8) | shades[:, 2]
    np.testing.assert_array_equal(table[:, 3], expected)
    np.testing.assert_array_equal(table[:, 4], content.owners)


def test_mcap_is_read_by_rosbags(
    recording: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mcap_file, "POINTS_A_MESSAGE", 10)
    content = export(recording, "mcap", tmp_path / "a.mcap")
    store = get_typestore(Stores.ROS2_HUMBLE)
    clouds: list[tuple[str, Any]] = []
    poses: list[tuple[str, Any]] = []
    with Reader(tmp_path / "a.mcap") as reader:
        for connection, _, data in reader.messages():
            message: Any = store.deserialize_cdr(data, connection.msgtype)
            assert message.header.frame_id == "yard"
            (poses if connection.topic == "/poses" else clouds).append((connection.topic, message))
    assert [topic for topic, _ in clouds] == ["/segments", "/segments_1"]
    tables = [np.frombuffer(each.data, "<u4").reshape(-1, 7) for _, each in clouds]
    table = np.concatenate(tables)
    np.testing.assert_array_equal(table[:, :3].copy().view("<f4"), content.points.astype("f4"))
    np.testing.assert_array_equal(table[:, 4], content.owners)
    first = clouds[0][1]
    assert [field.name for field in first.fields] == [n for n, _ in mcap_file.FIELDS]
    assert (first.width, first.height, first.point_step) == (10, 1, 28)
    assert len(poses) == 2
    last = poses[1][1]
    assert last.pose.position.x == 4
    assert last.header.stamp.sec == 2


def test_mcap_states_definitions_of_all_types(recording: Path, tmp_path: Path) -> None:
    from mcap.reader import make_reader

    export(recording, "mcap", tmp_path / "a.mcap")
    with (tmp_path / "a.mcap").open("rb") as stream:
        summary = make_reader(stream).get_summary()
    assert summary is not None
    for schema in summary.schemas.values():
        text = schema.data.decode()
        assert "MSG: std_msgs/Header" in text
        assert "MSG: builtin_interfaces/Time" in text


def test_geojson_lies_around_its_anchor(map_file: tuple[Path, CompactMap], tmp_path: Path) -> None:
    path, town = map_file
    export(path, "geojson", tmp_path / "a.geojson", anchor=GeoAnchor(49.0, 8.4, yaw_deg=90.0))
    content = json.loads((tmp_path / "a.geojson").read_text())
    points = [f for f in content["features"] if f["geometry"]["type"] == "Point"]
    lines = [f for f in content["features"] if f["geometry"]["type"] == "LineString"]
    assert (len(points), len(lines)) == (20, 1)
    assert {f["properties"]["id"] for f in points} == set(town.ids.tolist())
    assert {f["properties"]["robot"] for f in points} == {"ann", "zoe"}
    # The map's x axis points north: 1 degree of latitude at 49 degrees is 111.2 km.
    for feature, centroid in zip(points, town.centroids, strict=True):
        longitude, latitude, height = feature["geometry"]["coordinates"]
        assert (latitude - 49.0) * 111_200 == pytest.approx(centroid[0], rel=1e-3, abs=0.05)
        assert (longitude - 8.4) * 73_171 == pytest.approx(-centroid[1], rel=1e-3, abs=0.05)
        bulge = (centroid[:2] ** 2).sum() / (2 * 6_371_000)  # the Earth falls away from the map
        assert height == pytest.approx(centroid[2] + bulge, abs=1e-3)


def test_geojson_without_anchor_says_what_to_give(recording: Path) -> None:
    result = run(recording, "--to", "geojson")
    assert result.exit_code == 1
    assert "--anchor LAT,LON" in result.output
    assert run(recording, "--to", "geojson", "--anchor", "49,8.4").exit_code == 0


@pytest.mark.parametrize("text", ["", "49", "49;8", "95,8", "49,200", "49,8,1,2", "nan,8"])
def test_wrong_anchor_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="expected LAT,LON"):
        parse_anchor(text)


def test_points_far_from_the_anchor_are_refused() -> None:
    with pytest.raises(ValueError, match="km from the anchor"):
        to_geodetic(np.array([[5e5, 5e6, 0.0]]), GeoAnchor(0, 0))


def test_tum_and_g2o_have_the_poses_of_the_captures(
    map_file: tuple[Path, CompactMap], tmp_path: Path
) -> None:
    path, town = map_file
    export(path, "tum", tmp_path / "a.tum")
    rows = np.loadtxt(tmp_path / "a.tum")
    order = np.argsort(town.frame_times)
    np.testing.assert_allclose(rows[:, 0], town.frame_times[order], atol=1e-6)
    np.testing.assert_allclose(rows[:, 1:4], town.frame_positions[order], atol=1e-8)
    turns = np.abs((rows[:, 4:] * town.frame_orientations[order]).sum(axis=1))
    np.testing.assert_allclose(turns, 1, atol=1e-6)
    content = export(path, "g2o", tmp_path / "a.g2o")
    lines = [line.split() for line in (tmp_path / "a.g2o").read_text().splitlines()]
    vertices = [line for line in lines if line[0] == "VERTEX_SE3:QUAT"]
    edges = [line for line in lines if line[0] == "EDGE_SE3:QUAT"]
    assert (len(vertices), len(edges)) == (5, 4)
    assert all(len(edge) == 3 + 7 + 21 for edge in edges)
    step = np.linalg.inv(content.poses[0]) @ content.poses[1]
    np.testing.assert_allclose([float(v) for v in edges[0][3:6]], step[:3, 3], atol=1e-8)


def test_existing_file_is_kept_without_overwrite(recording: Path) -> None:
    file = recording.with_suffix(".ply")
    file.write_text("mine")
    assert "exists already" in run(recording, "--to", "ply").output
    assert file.read_text() == "mine"
    assert run(recording, "--to", "ply", "--overwrite").exit_code == 0
    assert file.read_bytes().startswith(b"ply")
    assert not list(file.parent.glob("*.unfinished"))
    assert run(recording, "--to", "ply", "-o", recording, "--overwrite").exit_code == 1


@pytest.mark.parametrize("target", get_args(Target))
def test_empty_map_gives_a_valid_file(tmp_path: Path, target: Target) -> None:
    (tmp_path / "empty.map").write_bytes(encode(random_map(0, frames=1)))
    export(tmp_path / "empty.map", target, tmp_path / "out", anchor=GeoAnchor(0, 0))
    assert (tmp_path / "out").exists()


def test_other_files_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a.map").write_text("hello")
    (tmp_path / "a.safetensors").write_text("hello")
    for name in ("a.map", "a.safetensors", "none"):
        with pytest.raises(ValueError, match="recording"):
            read_content(tmp_path / name)


def test_map_is_colored_by_class(map_file: tuple[Path, CompactMap], tmp_path: Path) -> None:
    path, town = map_file
    classes = np.zeros(len(town), np.uint8)
    classes[:2] = 1, 121
    known = tmp_path / "known.map"
    known.write_bytes(encode(replace(town, classes=classes)))
    for file, expected in ((known, class_colors(classes)), (path, class_colors(0 * classes))):
        export(file, "ply", tmp_path / "a.ply", "class")
        _, table = read_ply(tmp_path / "a.ply")
        shades = np.stack([table[c] for c in ("red", "green", "blue")], 1)
        np.testing.assert_array_equal(shades, expected)
        (tmp_path / "a.ply").unlink()
    assert class_colors(classes)[:3].tolist() == [[70, 110, 200], [225, 60, 55], [140, 140, 140]]
