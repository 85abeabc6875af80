"""The decoder of PointCloud2."""

from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose, assert_array_equal

from placecell.sources.bags.pointcloud2 import (
    PointCloud2,
    PointField,
    TimeField,
    cloud_clock,
    decode,
    time_fields,
)
from placecell.sources.errors import DriveError
from placecell.sources.point_clock import PointClock
from tests.placecell.sources.bags.bag_builders import (
    DATATYPES,
    PLAIN,
    START_NS,
    Layout,
    cloud_of,
    xyz,
)

POINTS = np.array([[1.5, -2, 0.25], [3, 4, 5], [-6, 7, 8.125], [0.5, 0.25, -1]], np.float32)


@st.composite
def layouts(draw: st.DrawFn) -> tuple[Layout, int]:
    """Draw a layout and a number of points that its rows divide."""
    kinds = st.sampled_from(["f4", "f8"])
    types = {axis: draw(kinds) for axis in "xyz"}
    if draw(st.booleans()):
        types |= dict.fromkeys("xyz", draw(st.sampled_from(["f4", "i2", "i4", "i1"])))
    types["intensity"] = draw(st.sampled_from(list(DATATYPES)))
    types["offset_time"] = draw(st.sampled_from(["u4", "i4", "f4", "f8"]))
    order = draw(st.permutations(list(types)))
    rows = draw(st.integers(1, 4))
    layout = Layout(
        types, order, draw(st.integers(0, 5)), draw(st.integers(0, 9)), draw(st.booleans()), rows
    )
    return layout, rows * draw(st.integers(1, 8))


@given(layouts(), st.integers(0, 2**32 - 1))
def test_any_layout_gives_the_points_that_were_written(
    drawn: tuple[Layout, int], seed: int
) -> None:
    layout, count = drawn
    random = np.random.default_rng(seed)
    points = random.integers(-99, 99, (count, 3)).astype(np.float64)
    points[random.random(count) < 0.2] = 0
    if all(layout.types[axis][0] == "f" for axis in "xyz"):
        points += random.integers(0, 8, (count, 3)) / 8
        points[random.random(count) < 0.2, random.integers(3)] = np.nan
        points[random.random(count) < 0.2] = 0
    times = np.arange(count) * 1000
    columns = xyz(points) | {"intensity": np.arange(count), "offset_time": times}
    clock = TimeField(("offset_time",)), PointClock("us", "stamp")
    scan = decode(cloud_of(columns, layout), "test", clock)
    kept = np.isfinite(points).all(axis=1) & (points != 0).any(axis=1)
    assert_array_equal(scan.points, points[kept].astype(np.float32))
    assert scan.points.dtype == np.float32
    assert scan.points.flags.c_contiguous
    assert scan.times is not None
    assert_allclose(scan.times, times[kept] * 1e-6, rtol=1e-6)
    assert scan.read == count
    assert scan.stamp == START_NS * 1e-9


@given(
    st.lists(
        st.builds(
            PointField,
            st.sampled_from(["x", "y", "z", "t", "X", "time_s", "time_ns", "", "rgb"]),
            st.integers(0, 2**32 - 1) | st.integers(0, 20),
            st.integers(0, 255) | st.integers(6, 8),
            st.integers(0, 2**32 - 1) | st.integers(0, 2),
        ),
        max_size=6,
    ),
    st.booleans(),
    st.tuples(*[st.integers(0, 2**32 - 1) | st.integers(0, 30)] * 4),
    st.binary(max_size=200),
)
def test_any_header_gives_a_scan_or_an_error(
    fields: list[PointField], big: bool, sizes: tuple[int, int, int, int], data: bytes
) -> None:
    point_step, row_step, width, height = sizes
    cloud = PointCloud2(fields, big, point_step, row_step, width, height, data)
    with suppress(DriveError):
        clock = cloud_clock([cloud], "test")
        scan = decode(cloud, "test", clock)
        assert len(scan.points) <= len(data)
        assert np.isfinite(scan.points).all()


def changed(**values: Any) -> PointCloud2:
    return replace(cloud_of(xyz(POINTS)), **values)


@pytest.mark.parametrize(
    ("cloud", "message"),
    [
        (changed(width=5), r"1 x 5 points of 12 bytes .* 60 bytes in all, but the data has 48"),
        (changed(width=0), "states 1 x 0 points of 12 bytes, but the data has 48 bytes"),
        (changed(point_step=0), "points of 0 bytes"),
        (changed(point_step=8), r"the field z \(f4 at 8\) ends at byte 12 of points of 8 bytes"),
        (changed(height=2**31, width=2**31), "but the data has 48"),
        (changed(fields=[]), "no field 'x'. Its fields are: none"),
        (changed(fields=[PointField(axis, 0, 7) for axis in "xyz"]), "overlap"),
        (changed(fields=[PointField(axis, 0, 7) for axis in "xxyz"]), "several fields 'x'"),
        (
            changed(fields=[PointField("x", 0, 7, 2), *cloud_of(xyz(POINTS)).fields[1:]]),
            r"x \(f4\[2\] at 0\) and y \(f4 at 4\) overlap",
        ),
        (
            changed(fields=[PointField(axis, 4 * n, 9) for n, axis in enumerate("xyz")]),
            "type of the field x .datatype 9 at 0. is unknown",
        ),
    ],
)
def test_header_that_lies_is_refused(cloud: PointCloud2, message: str) -> None:
    with pytest.raises(DriveError, match=message):
        decode(cloud, "test")


def test_empty_cloud_gives_no_points() -> None:
    scan = decode(changed(width=0, data=b""), "test")
    assert scan.points.shape == (0, 3)


def test_row_step_of_a_careless_driver_is_ignored() -> None:
    for row_step in (0, 7, 10**6):
        scan = decode(changed(row_step=row_step), "test")
        assert_array_equal(scan.points, POINTS)
        scan = decode(changed(width=2, height=2, row_step=row_step), "test")
        assert_array_equal(scan.points, POINTS)


def test_count_of_0_is_read_as_1() -> None:
    fields = [replace(field, count=0) for field in cloud_of(xyz(POINTS)).fields]
    assert_array_equal(decode(changed(fields=fields), "test").points, POINTS)


def test_fields_that_nobody_reads_may_overlap() -> None:
    fields = [*cloud_of(xyz(POINTS)).fields, PointField("rgb", 0, 7), PointField("rgba", 0, 6)]
    assert_array_equal(decode(changed(fields=fields), "test").points, POINTS)


def test_upper_case_names_are_read() -> None:
    fields = [replace(field, name=field.name.upper()) for field in cloud_of(xyz(POINTS)).fields]
    assert_array_equal(decode(changed(fields=fields), "test").points, POINTS)


def test_unit_scales_coordinates() -> None:
    layout = Layout(dict.fromkeys("xyz", "i4"))
    scan = decode(cloud_of(xyz(POINTS * 1000), layout), "test", scale=0.001)
    assert_allclose(scan.points, POINTS, atol=1e-6)


def test_float64_beyond_float32_is_dropped() -> None:
    points = POINTS.astype(np.float64)
    points[1, 2] = 1e300
    scan = decode(cloud_of(xyz(points), Layout(dict.fromkeys("xyz", "f8"))), "test")
    assert_array_equal(scan.points, POINTS[[0, 2, 3]])
    assert scan.not_finite == 1


def sweep(count: int = 1000) -> np.ndarray[Any, Any]:
    return np.linspace(0.0, 0.1, count)


def timed(name: str, kind: str, values: np.ndarray[Any, Any]) -> PointCloud2:
    points = np.random.default_rng(0).normal(size=(len(values), 3))
    columns = xyz(points) | {name: values}
    return cloud_of(columns, Layout(PLAIN.types | {name: kind}))


STAMP = START_NS * 1e-9
NS = (sweep() * 1e9).astype(np.int64)


@pytest.mark.parametrize(
    ("name", "kind", "values", "unit", "origin"),
    [
        ("time", "f4", sweep(), "s", "stamp"),
        ("time", "f4", sweep() - 0.1, "s", "stamp"),
        ("t", "u4", NS, "ns", "stamp"),
        ("offset_time", "u4", NS, "ns", "stamp"),
        ("timeOffset", "f4", sweep() * 1e3, "ms", "stamp"),
        ("time_stamp", "u4", NS // 1000, "us", "stamp"),
        ("timestamp", "f8", STAMP + sweep(), "s", "epoch"),
        ("timestamps", "f8", (STAMP + sweep()) * 1e6, "us", "epoch"),
        ("timestamp", "f8", (STAMP + sweep()) * 1e9, "ns", "epoch"),
        ("timestamp", "f8", 1234.5 + sweep(), "s", "first"),
        ("t_us", "u4", NS // 1000 + 3_000_000_000, "us", "first"),
    ],
)
def test_times_are_told_by_magnitude(
    name: str, kind: str, values: np.ndarray[Any, Any], unit: str, origin: str
) -> None:
    cloud = timed(name, kind, values)
    clock = cloud_clock([cloud], "test", period=0.1)
    assert clock is not None
    assert (clock[1].unit, clock[1].origin) == (unit, origin)
    scan = decode(cloud, "test", clock)
    assert scan.times is not None
    want = sweep() - 0.1 if values[0] == -0.1 else sweep()
    assert_allclose(scan.times, want, atol=2e-6)


def test_seconds_and_nanoseconds_in_two_fields_are_added() -> None:
    total = START_NS - 90_000_000 + NS
    points = np.random.default_rng(0).normal(size=(len(NS), 3))
    columns = xyz(points) | {"time_sec": total // 10**9, "time_nsec": total % 10**9}
    layout = Layout(PLAIN.types | {"time_sec": "u4", "time_nsec": "u4"})
    cloud = cloud_of(columns, layout)
    clock = cloud_clock([cloud], "test")
    assert clock is not None
    assert clock[0] == TimeField(("time_sec", "time_nsec"), "ns")
    scan = decode(cloud, "test", clock)
    assert scan.times is not None
    assert_allclose(scan.times, sweep() - 0.09, atol=1.1e-9)


@pytest.mark.parametrize("halves", [False, True])
def test_two_integers_in_one_field_are_joined(halves: bool) -> None:
    total = START_NS + NS
    parts = (total & 0xFFFFFFFF, total >> 32) if halves else (total // 10**9, total % 10**9)
    points = np.random.default_rng(0).normal(size=(len(NS), 3))
    columns = xyz(points) | {"timestamp": parts[0], "rest": parts[1]}
    cloud = cloud_of(columns, Layout(PLAIN.types | {"timestamp": "u4", "rest": "u4"}))
    fields = [*cloud.fields[:3], replace(cloud.fields[3], count=2)]
    cloud = replace(cloud, fields=fields)
    clock = cloud_clock([cloud], "test")
    assert clock is not None
    scan = decode(cloud, "test", clock)
    assert scan.times is not None
    assert_allclose(scan.times, sweep(), atol=1.1e-9)


def test_integer_in_the_bits_of_a_float64_is_read() -> None:
    cloud = timed("timestamp", "f8", (START_NS + NS).view(np.float64))
    clock = cloud_clock([cloud], "test")
    assert clock is not None
    scan = decode(cloud, "test", clock)
    assert scan.times is not None
    assert_allclose(scan.times, sweep(), atol=1.1e-9)


@pytest.mark.parametrize(
    "values", [np.zeros(1000), np.full(1000, 5.0), sweep() * 10, np.full(1000, np.nan)]
)
def test_times_that_are_no_sweep_give_no_clock(values: np.ndarray[Any, Any]) -> None:
    """The third are normalized to 0 to 1: no unit makes them a tenth of a second."""
    assert cloud_clock([timed("time", "f4", values)], "test", period=0.1) is None


def test_clock_of_a_source_holds_for_a_scan_of_few_points() -> None:
    clouds = [timed("t", "u4", NS), timed("t", "u4", np.array([0, 20_000])), timed("t", "u4", NS)]
    clock = cloud_clock(clouds, "test", 0.1)
    assert clock is not None
    scan = decode(clouds[1], "test", clock)
    assert scan.times is not None
    assert scan.times.tolist() == pytest.approx([0, 20e-6])


def test_wild_times_become_the_stamp() -> None:
    values = STAMP + sweep()
    values[3], values[5] = 0.0, np.nan
    clock = cloud_clock([timed("timestamp", "f8", values)], "test")
    assert clock is not None
    scan = decode(timed("timestamp", "f8", values), "test", clock)
    assert scan.times is not None
    assert scan.times[[3, 5]].tolist() == [0, 0]


def test_times_beyond_all_numbers_become_the_stamp() -> None:
    clock = TimeField(("time",)), PointClock("s", "epoch")
    for value in (1e300, -1e300, 1e15):
        scan = decode(timed("time", "f8", np.full(5, value)), "test", clock)
        assert scan.times is not None
        assert scan.times.tolist() == [0] * 5


def test_signaling_nan_is_a_nan() -> None:
    points = POINTS.copy()
    points.view(np.uint32)[1, 2] = 0x7F800001
    mixed = Layout({"x": "f4", "y": "f8", "z": "f4"})
    cloud = cloud_of(xyz(points), mixed)
    data = bytearray(cloud.data)
    data[16 + 12 : 16 + 16] = points[1, 2].tobytes()
    assert_array_equal(decode(replace(cloud, data=bytes(data)), "test").points, POINTS[[0, 2, 3]])


def test_cloud_without_the_time_field_has_no_times() -> None:
    clock = TimeField(("t",)), PointClock("ns", "stamp")
    assert decode(cloud_of(xyz(POINTS)), "test", clock).times is None
    assert time_fields(cloud_of(xyz(POINTS)).fields) == []
