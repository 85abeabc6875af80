from pathlib import Path

import numpy as np
import pytest

from placecell.sources.clouds.times import stamps_beside, stamps_of_names

START = 1583836591.5


@pytest.mark.parametrize(
    ("stems", "expected"),
    [
        (["1583836591.500000000", "1583836591.600000000"], [START, START + 0.1]),
        (["cloud_1583836591_500000000", "cloud_1583836592_9"], [START, START + 0.500000009]),
        (["1583836591-500000", "1583836591-600000"], [START, START + 0.1]),
        (["1583836591_500", "1583836591_600"], [START, START + 0.1]),
        (["1583836591500000000", "1583836591600000000"], [START, START + 0.1]),
        (["a-1583836591500000", "a-1583836591600000"], [START, START + 0.1]),
        (["1583836591500", "1583836591600"], [START, START + 0.1]),
        (["1583836591", "1583836592"], [START - 0.5, START + 0.5]),
        (["2020-03-10_10-36-31_5", "2020-03-10_10-36-31_6"], [START, START + 0.1]),
        (["20200310103631", "20200310103632"], [START - 0.5, START + 0.5]),
    ],
)
def test_times_in_names_are_read(stems: list[str], expected: list[float]) -> None:
    found = stamps_of_names(stems)
    assert found is not None
    np.testing.assert_allclose(found, expected, atol=1e-6)


@pytest.mark.parametrize(
    "stems",
    [
        ["000000", "000001"],
        ["scan", "scan1"],
        ["1583836591", "7"],
        ["1583836591", "1583836591a"],
        ["2014-11-10-11-32-17_Frame_0001", "2014-11-10-11-32-17_Frame_0002"],
        ["2014-19-10-11-32-17", "2014-13-10-11-32-18"],
        ["1583836591_500", "99_600"],
    ],
)
def test_counters_and_equal_times_are_no_stamps(stems: list[str]) -> None:
    assert stamps_of_names(stems) is None


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("0.0\n0.1\n0.2\n", [0, 0.1, 0.2]),
        ("# time\n\n0.0\n0.1\n0.2\n", [0, 0.1, 0.2]),
        ("0\n100\n200\n", [0, 0.1, 0.2]),
        ("1583836591500\n1583836591600\n1583836591700\n", [START, START + 0.1, START + 0.2]),
        ("0 5.5\n1 5.6\n2 5.7\n", [5.5, 5.6, 5.7]),
        ("a.pcd,5.5\nb.pcd,5.6\nc.pcd,5.7\n", [5.5, 5.6, 5.7]),
        ("name,time\na.pcd,5.5\nb.pcd,5.6\nc.pcd,5.7\n", [5.5, 5.6, 5.7]),
        (
            "2020-03-10 10:36:31.5\n2020-03-10 10:36:31.6\n2020-03-10 10:36:31.7\n",
            [START, START + 0.1, START + 0.2],
        ),
        ("0\n0.1\n0.1\n", [0, 0.1, 0.1]),
        ("0 3\n0.1 3\n0.2 3\n0.3 3", [0, 0.1, 0.2]),
    ],
)
def test_a_file_of_times_is_read(tmp_path: Path, text: str, expected: list[float]) -> None:
    (tmp_path / "timestamps.txt").write_text(text)
    files = [tmp_path / f"{index}.bin" for index in range(3)]
    found = stamps_beside(files, [tmp_path / "absent", tmp_path], "s")
    assert found is not None
    assert found[0] is not None
    np.testing.assert_allclose(found[0], expected, atol=1e-6)


@pytest.mark.parametrize(
    ("text", "why"),
    [
        ("0.1\n0.2\n", "2 times for 3 scans"),
        ("0\n1\n2\n", "no list of times"),
        ("a\nb\nc\n", "no list of times"),
        ("", "no list of times"),
        ("0.0\nnan\n0.2\n", "no list of times"),
        ("0.3\n0.1\n0.2\n", "time decreases at scan 1"),
    ],
)
def test_a_file_that_is_no_list_of_times_is_told(tmp_path: Path, text: str, why: str) -> None:
    (tmp_path / "times.csv").write_text(text)
    files = [tmp_path / f"{index}.bin" for index in range(3)]
    found = stamps_beside(files, [tmp_path], "s")
    assert found is not None
    assert found[0] is None
    assert why in found[1]


def test_the_stated_unit_of_times_is_kept(tmp_path: Path) -> None:
    (tmp_path / "times.txt").write_text("0\n10\n")
    found = stamps_beside([tmp_path / "0.bin", tmp_path / "1.bin"], [tmp_path], "ms")
    assert found is not None
    np.testing.assert_allclose(found[0], [0, 0.01])  # type: ignore[arg-type]
    assert stamps_beside([], [tmp_path / "absent"], "s") is None
