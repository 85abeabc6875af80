"""Every capture of the queries' drive is a query, as for the peers."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from benchmarks.peers.frames import Stretch, frames_of, stretches_of_one, stretches_of_two
from evaluation.poses.evaluate import evaluate
from evaluation.poses.queries import Pair, described, random_frame
from service.engine import Engine
from tests.benchmarks.drive_builders import trip
from tests.placecell.segment_builders import many_segments
from tests.service.service_builders import write_eigenvalue_model

pytestmark = pytest.mark.slow


@pytest.fixture
def engine(tmp_path: Path) -> Iterator[Engine]:
    write_eigenvalue_model(tmp_path / "models")
    with Engine.temporary(tmp_path / "models" / "tiny") as engine:
        yield engine


def scans_of(engine: Engine, pair: Pair, most: int | None = None) -> list[int]:
    return [query.scan for query in pair.queries(engine, random_frame(0), most)]


MOST = (None, 1, 4, 7)
"""Queries asked for."""


def scans_of_peers(asking: list[Stretch], most: int | None = None) -> list[int]:
    return [scan for _, scan, _ in frames_of(asking, most)]


def test_queries_of_two_drives_are_those_of_the_peers(engine: Engine, tmp_path: Path) -> None:
    mapped = trip(tmp_path / "a", 8, left=range(0))
    asking = trip(tmp_path / "b", 16, left=range(3, 12))
    pair = Pair.of(mapped.folder, asking.folder)
    _, peers = stretches_of_two(mapped, asking, np.eye(4))
    for most in MOST:
        assert scans_of(engine, pair, most) == scans_of_peers(peers, most)


@pytest.mark.parametrize("left", [range(0), range(12, 15), range(19, 33)])
def test_queries_of_blocks_are_those_of_the_peers(
    engine: Engine, tmp_path: Path, left: range
) -> None:
    drive = trip(tmp_path / "a", 40, left)
    pair = Pair.of(drive.folder)
    _, peers = stretches_of_one(drive)
    for most in MOST:
        assert scans_of(engine, pair, most) == scans_of_peers(peers, most)


def test_queries_follow_another_step_between_captures(engine: Engine, tmp_path: Path) -> None:
    drive = trip(tmp_path / "a", 16, left=range(4, 13))
    pair = Pair.of(drive.folder, drive.folder, every=3)
    assert scans_of(engine, pair) == [0, 3, 6, 9, 12, 15]


def test_captures_without_segments_are_not_localized(tmp_path: Path) -> None:
    write_eigenvalue_model(tmp_path / "models")
    # Its engine map holds ten scans: those from 13 to 18 show nothing.
    mapped = trip(tmp_path / "a", 8, left=range(0))
    asking = trip(tmp_path / "b", 24, left=range(4, 19))
    pair = Pair.of(mapped.folder, asking.folder)
    report, rows = evaluate(pair, tmp_path / "models" / "tiny")
    assert [row["scan"] for row in rows] == [*range(24)]
    empty = [row for row in rows if not row["segments"]]
    assert [row["scan"] for row in empty] == [*range(13, 19)]
    assert {row["reason"] for row in empty} == {"too-few-segments"}
    # The mapping robot drove to meter 7, so that meter 16 is within the map, and 18 is not.
    assert [row["mapped"] for row in empty if row["scan"] != 17] == [True] * 4 + [False]
    assert report["queries"] + report["beyond_the_map"]["queries"] == 24
    told = report["reasons"], report["beyond_the_map"]["reasons"]
    assert sum(reasons.get("too-few-segments", 0) for reasons in told) >= 6


def test_query_without_segments_has_an_outcome(tmp_path: Path) -> None:
    write_eigenvalue_model(tmp_path / "models")
    mapped = trip(tmp_path / "a", 8, left=range(0))
    asking = trip(tmp_path / "b", 8, left=range(1))
    report, (row,) = evaluate(
        Pair.of(mapped.folder, asking.folder), tmp_path / "models" / "tiny", most=1
    )
    assert (row["scan"], row["segments"], row["reason"]) == (0, 0, "too-few-segments")
    assert report["not_localised"] == 1


@pytest.mark.parametrize("blind", ["a", "b"])
def test_error_names_the_drive_without_segments(tmp_path: Path, blind: str) -> None:
    write_eigenvalue_model(tmp_path / "models")
    for name in ("a", "b"):
        trip(tmp_path / name, 6, left=range(6 if name == blind else 0))
    pair = Pair.of(tmp_path / "a", tmp_path / "b")
    with pytest.raises(ValueError, match=rf"/{blind}: .* no segments .* 100 points.* beams"):
        evaluate(pair, tmp_path / "models" / "tiny")


def test_map_of_a_drive_without_segments_is_refused(engine: Engine, tmp_path: Path) -> None:
    trip(tmp_path / "a", 6, left=range(6))
    pair = Pair.of(tmp_path / "a", tmp_path / "a")
    with pytest.raises(ValueError, match="no segments"):
        pair.mapper.build_map(engine, "map")


def test_error_names_an_unreadable_origin_file(tmp_path: Path) -> None:
    for name in ("a", "b"):
        trip(tmp_path / name, 2, left=range(0))
    (tmp_path / "b" / "origin.txt").write_text("")
    with pytest.raises(ValueError, match=r"b/origin\.txt: 0 numbers.* 'placecell town'"):
        Pair.of(tmp_path / "a", tmp_path / "b")


def test_query_near_captures_without_segments_is_in_the_mapped_area(
    engine: Engine, tmp_path: Path
) -> None:
    mapped = trip(tmp_path / "a", 30, left=range(1, 30))
    asking = trip(tmp_path / "b", 30, left=range(0))
    asked = Pair.of(mapped.folder, asking.folder).queries(engine, random_frame(0))
    assert all(query.mapped for query in asked)


def test_description_without_segments_is_empty(engine: Engine) -> None:
    codes, centroids, heights = described(engine, many_segments([]))
    some, _, _ = described(engine, many_segments([200]))
    assert (codes.shape, codes.dtype) == ((0, some.shape[1]), some.dtype)
    assert centroids.shape == (0, 3)
    assert heights.shape == (0,)
