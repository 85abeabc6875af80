import numpy as np

from placecell.sources.point_times import is_time, split_name, time_fields


def test_a_unit_in_the_name_is_told() -> None:
    assert split_name("gps_time") == ("gpstime", "s")
    assert split_name("Time [ms]") == ("time", "ms")
    assert split_name("t(us)") == ("t", "us")
    assert split_name("time_stamp") == ("timestamp", None)
    assert split_name("point_time_offset") == ("pointtimeoffset", None)
    assert split_name("Timestamp_NSec") == ("timestamp", "ns")
    assert is_time("time_us")
    assert is_time("OFFSET-TIME")
    assert not is_time("s")
    assert not is_time("intensity_s")


def test_whole_seconds_and_their_fraction_become_one_field() -> None:
    seconds = np.array([1583971569, 1583971570], np.uint32)
    rest = np.array([950_000_001, 15_299_642], np.uint32)
    times = time_fields({"x": rest, "time_sec": seconds, "time_nsec": rest})
    assert list(times) == ["time_sec and time_nsec", "time_sec", "time_nsec"]
    total, unit = times["time_sec and time_nsec"]
    assert total.tolist() == [1583971569_950_000_001, 1583971570_015_299_642]
    assert unit == "ns"
    micro = time_fields({"t_s": seconds, "t_us": rest // 1000})["t_s and t_us"]
    assert micro[0].tolist() == [1583971569_950_000, 1583971570_015_299]


def test_fields_that_are_no_fraction_stay_apart() -> None:
    seconds = np.array([1, 2], np.uint32)
    whole = np.array([1_000_000_000, 2_000_000_000], np.uint32)
    assert list(time_fields({"t_s": seconds, "t_ns": whole})) == ["t_s", "t_ns"]
    assert list(time_fields({"t_s": seconds, "t_ms": seconds})) == ["t_s", "t_ms"]
    assert list(time_fields({"t_ns": seconds})) == ["t_ns"]
    empty = np.zeros(0, np.uint32)
    assert list(time_fields({"t_s": empty, "t_ns": empty})) == ["t_s", "t_ns"]
    assert time_fields({"x": seconds, "ring": seconds}) == {}
