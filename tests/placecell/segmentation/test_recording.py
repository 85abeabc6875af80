import json
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from safetensors.numpy import load_file, save_file

from placecell.core.parameters import Parameters
from placecell.core.segments import Segments
from placecell.segmentation.recording import Recording, RecordingError
from tests.placecell.segment_builders import many_segments

COLUMNS = ("points", "ends", "sensors", "frames", "groups", "distinct")


def recording() -> Recording:
    # Group 0 lives in frames 0 to 4, group 1 in 2 alone, group 2 in 4 to 6.
    return Recording(
        name="toy",
        parameters=Parameters(frame_step=2, th_H=40),
        segments=many_segments([3, 4, 5, 6, 7, 2]),
        captures=np.array([0, 2, 2, 4, 4, 6]),
        groups=np.array([0, 0, 1, 0, 2, 2]),
        distinct=np.array([True, False, True, True, True, False]),
        scans=8,
        scan_hashes=tuple(f"{index:016x}" for index in range(8)),
        path_length=12.345678901234567,
    )


@pytest.fixture
def file(tmp_path: Path) -> Path:
    recording().save(tmp_path / "toy.safetensors")
    return tmp_path / "toy.safetensors"


def header_of(file: Path) -> dict[str, object]:
    content = file.read_bytes()
    (length,) = struct.unpack("<Q", content[:8])
    header = json.loads(content[8 : 8 + length])["__metadata__"]["header"]
    return dict(json.loads(header))


def rewrite(
    file: Path,
    header: dict[str, object] | None = None,
    columns: dict[str, np.ndarray | None] | None = None,
) -> None:
    """Rewrite the file with other header entries or columns; None removes a column."""
    tensors = load_file(file) | (columns or {})
    text = json.dumps(header_of(file) | (header or {}))
    kept = {name: column for name, column in tensors.items() if column is not None}
    save_file(kept, file, metadata={"header": text})


def test_round_trip_is_identical(file: Path) -> None:
    before, after = recording(), Recording.load(file)
    for name in ("points", "ends", "sensors"):
        one, other = getattr(before.segments, name), getattr(after.segments, name)
        assert np.array_equal(one, other)
        assert one.dtype == other.dtype
    for name in ("captures", "groups", "distinct"):
        one, other = getattr(before, name), getattr(after, name)
        assert np.array_equal(one, other)
        assert one.dtype == other.dtype
    for name in ("name", "parameters", "scans", "scan_hashes", "path_length"):
        assert getattr(before, name) == getattr(after, name)


def test_recording_has_the_mode_of_any_new_file(file: Path) -> None:
    other = file.with_name("other")
    other.touch()
    assert file.stat().st_mode == other.stat().st_mode


def test_columns_that_are_views_are_saved_as_they_read(tmp_path: Path) -> None:
    # Every second row of a larger array, and one stored column by column.
    whole = recording()
    spread = np.repeat(whole.segments.points, 2, axis=0)[::2]
    fortran = np.asfortranarray(whole.segments.sensors)
    replace(whole, segments=Segments(spread, whole.segments.ends, fortran)).save(tmp_path / "a")
    loaded = Recording.load(tmp_path / "a")
    assert np.array_equal(loaded.segments.points, whole.segments.points)
    assert np.array_equal(loaded.segments.sensors, whole.segments.sensors)


def test_empty_recording_survives_its_file(tmp_path: Path) -> None:
    none = np.zeros(0, dtype=np.int64)
    nothing = replace(
        recording(),
        segments=many_segments([]),
        captures=none,
        groups=none,
        distinct=np.zeros(0, dtype=bool),
    )
    nothing.save(tmp_path / "a")
    loaded = Recording.load(tmp_path / "a")
    assert len(loaded.segments) == 0
    assert loaded.within(0, 8).shape == (0,)


def test_capture_scans_include_those_without_segments() -> None:
    assert [*recording().capture_scans] == [0, 2, 4, 6]
    # What was seen of nothing, and a drive that was cut with another --every.
    every_third = replace(recording(), parameters=Parameters(frame_step=3))
    assert [*every_third.capture_scans] == [0, 3, 6]
    assert [*replace(recording(), part=range(3, 8)).capture_scans] == [3, 5, 7]


def test_saving_a_part_of_a_drive_is_refused(tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match="whole drive"):
        replace(recording(), part=range(3, 8)).save(tmp_path / "a")
    assert not (tmp_path / "a").exists()


def test_save_makes_the_folder_and_leaves_nothing_else(tmp_path: Path) -> None:
    recording().save(tmp_path / "new" / "toy.safetensors")
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["toy.safetensors"]


def test_same_recording_is_the_same_file(tmp_path: Path) -> None:
    recording().save(tmp_path / "a")
    recording().save(tmp_path / "b")
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


@pytest.mark.parametrize(
    ("first", "last", "groups"),
    [(0, 6, {0, 1, 2}), (0, 4, {0, 1}), (0, 3, {1}), (1, 6, {1, 2}), (2, 2, {1}), (5, 6, set())],
)
def test_within_takes_groups_that_lie_wholly_inside(
    first: int, last: int, groups: set[int]
) -> None:
    whole = recording()
    assert whole.within(first, last).tolist() == [group in groups for group in whole.groups]


@pytest.mark.parametrize("header", [{"version": 2}, {"version": 0}, {"format": "placecell-map"}])
def test_other_version_or_format(file: Path, header: dict[str, object]) -> None:
    rewrite(file, header)
    with pytest.raises(RecordingError, match=r"toy\.safetensors: .*version .*Prepare .* again"):
        Recording.load(file)


def refused(file: Path) -> str:
    with pytest.raises(RecordingError) as caught:
        Recording.load(file)
    assert str(file) in str(caught.value)
    return str(caught.value)


def test_missing_file(tmp_path: Path) -> None:
    refused(tmp_path / "none.safetensors")


@pytest.mark.parametrize("content", [b"", b"hello", b"\x00" * 100, b"\xff" * 64])
def test_other_file(tmp_path: Path, content: bytes) -> None:
    (tmp_path / "other").write_bytes(content)
    refused(tmp_path / "other")


def test_safetensors_of_another_kind(tmp_path: Path) -> None:
    save_file({"weights": np.zeros(3)}, tmp_path / "other")
    refused(tmp_path / "other")


@pytest.mark.parametrize("kept", [0.1, 0.5, 0.99])
def test_cut_file(file: Path, kept: float) -> None:
    content = file.read_bytes()
    file.write_bytes(content[: int(kept * len(content))])
    refused(file)


@pytest.mark.parametrize("column", COLUMNS)
def test_missing_column(file: Path, column: str) -> None:
    rewrite(file, columns={column: None})
    assert column in refused(file)


@pytest.mark.parametrize("entry", ["name", "parameters", "scans", "scan_hashes", "path_length_m"])
def test_missing_header_entry(file: Path, entry: str) -> None:
    tensors = load_file(file)
    header = header_of(file)
    del header[entry]
    save_file(tensors, file, metadata={"header": json.dumps(header)})
    assert entry in refused(file)


@pytest.mark.parametrize("header", ["{", "[]", "null", '"text"'])
def test_broken_header(file: Path, header: str) -> None:
    save_file(load_file(file), file, metadata={"header": header})
    refused(file)


def test_unknown_parameter(file: Path) -> None:
    rewrite(file, {"parameters": Parameters().as_dict() | {"colour": "red"}})
    assert "colour" in refused(file)


@pytest.mark.parametrize("column", ["sensors", "frames", "groups", "distinct"])
@pytest.mark.parametrize("change", [-1, 1])
def test_column_of_another_length(file: Path, column: str, change: int) -> None:
    values = load_file(file)[column]
    longer = np.concatenate([values, values[-1:]]) if change > 0 else values[:-1].copy()
    rewrite(file, columns={column: longer})
    assert column in refused(file)


@pytest.mark.parametrize(
    "ends",
    [
        [3, 7, 12, 18, 25, 28],  # beyond the points
        [3, 7, 12, 18, 25, 26],  # short of them
        [3, 7, 12, 11, 25, 27],  # backwards
        [3, 3, 12, 18, 25, 27],  # a segment without points
        [0, 7, 12, 18, 25, 27],
        [-1, 7, 12, 18, 25, 27],
    ],
)
def test_ends_that_do_not_fit_the_points(file: Path, ends: list[int]) -> None:
    assert load_file(file)["ends"].tolist() == [3, 7, 12, 18, 25, 27]
    rewrite(file, columns={"ends": np.array(ends)})
    assert "ends" in refused(file)


@pytest.mark.parametrize("column", COLUMNS)
def test_column_of_another_type(file: Path, column: str) -> None:
    rewrite(file, columns={column: load_file(file)[column].astype(np.float64)})
    assert column in refused(file)


@pytest.mark.parametrize("column", ["points", "sensors"])
def test_points_of_another_width(file: Path, column: str) -> None:
    rewrite(file, columns={column: np.ascontiguousarray(load_file(file)[column][:, :2])})
    assert column in refused(file)


def test_negative_group(file: Path) -> None:
    # It would count from the end of the groups.
    rewrite(file, columns={"groups": np.array([0, 0, 1, 0, 2, -1])})
    assert "groups" in refused(file)
