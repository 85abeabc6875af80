from math import nan
from typing import Any

import numpy as np
import pytest

from placecell.core.types import Float64
from placecell.sources.point_times import is_time, point_times, split_name

SWEEP = np.linspace(0, 0.1, 11)
STAMP = 1_700_000_000.25


def expect(times: Float64 | None, right: Any, within: float = 1e-6) -> None:
    assert times is not None
    assert times.dtype == np.float64
    np.testing.assert_allclose(times, right, atol=within, rtol=0)


@pytest.mark.parametrize("unit", [1.0, 1e3, 1e6, 1e9])
@pytest.mark.parametrize("name", ["t", "time", "TIMESTAMP", "time_stamp", "offset_time", "ts"])
def test_relative_times_are_read_in_every_unit(name: str, unit: float) -> None:
    expect(point_times({name: SWEEP * unit}, STAMP), SWEEP)
    expect(point_times({name: SWEEP * unit}, nan), SWEEP)
    expect(point_times({name: (SWEEP - 0.1) * unit}, STAMP), SWEEP - 0.1)


@pytest.mark.parametrize("unit", [1.0, 1e3, 1e6, 1e9])
def test_times_since_1970_become_relative_to_the_stamp(unit: float) -> None:
    times = (STAMP - 0.05 + SWEEP) * unit
    expect(point_times({"timestamp": times}, STAMP), SWEEP - 0.05)
    expect(point_times({"timestamp": times}, nan), SWEEP)
    expect(point_times({"timestamp": times}, STAMP + 3600), SWEEP)


@pytest.mark.parametrize("dtype", [np.uint64, np.int64])
def test_64_bit_nanoseconds_stay_exact(dtype: type) -> None:
    start = 1_700_000_000_123_456_789
    offsets = np.array([0, 1, 2, 100_000_000])
    times: Any = (start + offsets).astype(dtype)
    expect(point_times({"t": times}, nan), offsets * 1e-9, within=1e-12)


def test_zero_times_of_points_without_an_echo_do_not_change_the_unit() -> None:
    times = np.concatenate([STAMP + SWEEP, [0.0, np.nan]])
    expect(point_times({"timestamp": times}, STAMP), [*SWEEP, 0.05, 0.05])
    whole = np.concatenate([[0, 0], 1_700_000_000_000_000_000 + np.arange(11) * 10_000_000])
    expect(point_times({"t": whole}, nan), [0.05, 0.05, *SWEEP])


def test_times_of_unusable_points_do_not_count() -> None:
    times = np.concatenate([SWEEP * 1e9, [4e9, np.nan]])
    usable = np.arange(13) < 11
    expect(point_times({"t": times}, STAMP, usable), [*SWEEP, 0.05, 0.05])


@pytest.mark.parametrize("uptime", [12.0, 1500.0, 80_000.0])
@pytest.mark.parametrize("unit", [1.0, 1e6, 1e9])
def test_a_clock_since_the_start_of_the_sensor_is_relative_to_the_earliest_point(
    uptime: float, unit: float
) -> None:
    times = (uptime + SWEEP) * unit
    expect(point_times({"timestamp": times}, STAMP), SWEEP)
    expect(point_times({"timestamp": times}, uptime + 0.1), SWEEP - 0.1)


def test_whole_seconds_and_nanoseconds_are_added() -> None:
    seconds = np.array([1583971569, 1583971569, 1583971570], np.uint32)
    rest = np.array([900_000_000, 950_000_001, 15_299_642], np.uint32)
    fields = {"time_sec": seconds, "time_nsec": rest}
    expect(point_times(fields, nan), [0, 0.050000001, 0.115299642], within=1e-12)
    expect(point_times(fields, 1583971570.015299642), [-0.115299642, -0.065299641, 0.0])


def test_a_unit_in_the_name_is_kept() -> None:
    assert split_name("gps_time") == ("gpstime", "s")
    assert split_name("Time [ms]") == ("time", "ms")
    assert split_name("point_time_offset") == ("pointtimeoffset", None)
    assert is_time("time_us")
    assert not is_time("s")
    assert not is_time("intensity_s")
    expect(point_times({"t_us": np.array([0.0, 900.0])}, nan), [0, 9e-4])
    expect(point_times({"t": np.array([0.0, 9e-4])}, nan), [0, 9e-4])
    expect(point_times({"t_us": np.array([0.0, 1.3e6])}, nan), [0, 1.3])
    # Nebula's times within one packet: nanoseconds, as the smaller unit does less harm.
    expect(point_times({"t": np.array([0.0, 1.3e6])}, nan), [0, 1.3e-3])


@pytest.mark.parametrize(
    "values",
    [
        np.zeros(5),
        np.full(5, STAMP),
        np.full(5, np.nan),
        np.array([], np.float32),
        STAMP + np.arange(0, 300.0, 60),  # a map: no sweep
        np.array([1.5e15, 1.5e15, 1.5e15 + 134_217_728], np.float32),  # float32 loses the times
        np.array([-1e308, 1e308]),
        np.array([0, 2**64 - 1], np.uint64),
        np.array([0, 10**10, 10**12]),
    ],
)
def test_times_that_span_no_sweep_are_none(values: Any) -> None:
    assert point_times({"time": values}, STAMP) is None


def test_fields_of_other_names_are_ignored() -> None:
    assert point_times({"x": SWEEP, "intensity": SWEEP}, STAMP) is None
    expect(point_times({"time": np.zeros(11), "t": SWEEP}, STAMP), SWEEP)
