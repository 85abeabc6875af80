"""Tests of `placecell maps align` and `merge` against a running service."""

import json
from dataclasses import replace

import numpy as np
import pytest
from placecell_client import Client, CompactMap, moved
from placecell_client.maps.edit import take
from placecell_client.results.alignment import alignment_of
from placecell_client.results.merge import merge_of

from cli.maps.align import print_alignment
from cli.maps.merge import is_any_aligned, print_merge
from tests.cli.maps_command import bad, good, run
from tests.client.client_fakes import ALIGNED, LAID, MERGED, PART

QUARTER = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
"""Rotation by 90 degrees to the left."""


@pytest.fixture
def url(address: str, yard: CompactMap, monkeypatch: pytest.MonkeyPatch) -> str:
    """Address of a service with three maps: yard, hall (half of yard by another robot), moon."""
    monkeypatch.setenv("PLACECELL_URL", address)
    hall = replace(take(yard, np.arange(150, 300)), robots=("bob",))
    codes = np.random.default_rng(1).integers(-128, 128, yard.codes.shape).astype(np.int8)
    with Client(address) as client:
        for stored in client.maps():
            client.delete_map(stored.name)
        client.put_map("yard", yard)
        client.put_map("hall", moved(hall, QUARTER, [1000.0, 2000, 3], "hall"))
        client.put_map("moon", replace(yard, codes=codes))
    return address


@pytest.mark.usefixtures("url")
def test_align_prints_pose_and_overlap() -> None:
    told = good("align", "yard", "hall")
    # The inverse rotation moves the origin of hall's frame to (-2000, 1000).
    assert "-2000.00, 1000.00, -3.00, -90.0" in told
    assert "aligned" in told
    assert "The overlap is 100% of yard and 100% of hall." in told
    told = bad("align", "yard", "moon")
    assert "Maps yard and moon cannot be aligned (inconsistent)" in told
    assert "404" in bad("align", "yard", "nowhere")


@pytest.mark.usefixtures("url")
def test_align_prints_json() -> None:
    found = json.loads(good("align", "yard", "hall", "--json"))
    np.testing.assert_allclose(found["pose"]["translation"], [-2000, 1000, -3], atol=0.5)
    assert (found["other"], found["other_frame"]) == ("hall", "hall")
    assert np.shape(found["covariance"]) == (4, 4)
    result = run("align", "yard", "moon", "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["reason"] == "inconsistent"
    assert "cannot be aligned" in result.stderr


def test_tilted_frames_align_only_with_motion_se3(url: str, yard: CompactMap) -> None:
    tilted = np.array([[1.0, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
    with Client(url) as client:
        client.put_map("tilted", moved(yard, tilted, [5.0, 6, 7], "tilted"))
    assert "cannot be aligned" in bad("align", "yard", "tilted")
    assert "aligned" in good("align", "yard", "tilted", "--motion", "se3")
    assert "No two of the maps yard, tilted" in bad("merge", "site", "yard", "tilted", "--dry-run")
    laid = ("merge", "site", "yard", "tilted", "--dry-run", "--motion", "se3")
    assert "would have 300 segments" in good(*laid)
    assert "Invalid value for '--motion'" in run("align", "yard", "tilted", "--motion", "9").output


def test_merge_prints_the_command_that_undoes_it(url: str) -> None:
    names = ("yard", "hall", "moon")
    told = good("merge", "site", *names, "--dry-run")
    assert "Map site would have 300 segments" in told
    assert "Nothing was written" in told
    with Client(url) as client:
        assert "site" not in {stored.name for stored in client.maps()}
        told = good("merge", "site", *names)
        assert "left out" in told
        assert "yard and moon: " in told
        assert "Map site has 300 segments, version 1: 300 changed, 0 removed" in told
        assert "To undo the merge: placecell maps delete site" in told
        assert "The maps held nothing new" in good("merge", "site", "hall")
        first = next(stored.etag for stored in client.maps() if stored.name == "site")
        # Bob's segments repeat segments that the merged map has already.
        told = good("merge", "site", "hall", "--keep-repeats", "--if-match", first)
        assert "Map site has 450 segments, version 2: 150 changed, 0 removed" in told
        assert "To undo the merge: placecell maps restore site 1" in told
        assert client.get_map("site").robots == ("ann", "bob")
        good("restore", "site", 1)
        assert "412" in bad("merge", "site", "hall", "--keep-repeats", "--if-match", first)
        assert client.get_map("site").robots == ("ann",)


@pytest.mark.usefixtures("url")
def test_merge_prints_json() -> None:
    merged = json.loads(good("merge", "site", "yard", "hall", "--json"))
    assert (merged["sequence"], merged["previous"]) == (1, None)
    assert [part["repeats"] for part in merged["parts"]] == [0, 150]


@pytest.mark.usefixtures("url")
def test_merge_of_maps_that_cannot_be_aligned_fails() -> None:
    assert "nothing was changed" in bad("merge", "site", "yard", "moon")
    told = bad("merge", "site", "yard", "moon", "--dry-run")
    assert "No two of the maps yard, moon can be aligned" in told
    assert "would have" not in told
    assert "404" in bad("merge", "site", "yard", "nowhere")
    assert "twice" in bad("merge", "site", "yard", "yard")
    assert "two maps" in bad("merge", "site", "yard")
    assert run("merge", "site").exit_code == 2


@pytest.mark.parametrize("is_aligned", [True, False])
def test_align_prints_other_hypotheses(
    capsys: pytest.CaptureFixture[str], is_aligned: bool
) -> None:
    nothing = {"pose": None, "overlap": None, "covariance": None}
    print_alignment(alignment_of(ALIGNED | ({} if is_aligned else nothing)))
    told = capsys.readouterr().out
    assert "other hypothesis" in told
    assert "2.5" in told
    assert ("40.5" in told) is is_aligned
    assert ("The overlap is 50% of yard and 75% of hall." in told) is is_aligned


def test_merge_prints_loops_and_their_verdicts(capsys: pytest.CaptureFixture[str]) -> None:
    verdicts = [
        {"rejected": False, "proven": True},
        {"rejected": True, "proven": False},
        {"rejected": False, "proven": False},
    ]
    loop = {"maps": ["site", "yard", "hall"], "meters": 8.25, "degrees": 0.5, "closes": False}
    loops = [loop | {"meters": 0.5, "closes": True}, loop]
    pairs = [LAID | each for each in verdicts]
    print_merge(merge_of(MERGED | {"alignments": pairs, "loops": loops}))
    told = capsys.readouterr().out
    places = [told.index(word) for word in ("proven", "rejected", "aligned")]
    assert places == sorted(places)
    assert "Loop site - yard - hall - site closes: error 0.50 m and 0.5 degrees" in told
    assert "Loop site - yard - hall - site does not close: error 8.25 m" in told


@pytest.mark.parametrize(
    ("laid", "alignments", "is_any"),
    [
        ([True, False], [("a", "b")], False),
        ([True, True], [("a", "b")], True),
        ([True, False], [("site", "a"), ("site", "b"), ("a", "b")], True),
        ([False, False], [("site", "a"), ("site", "b"), ("a", "b")], False),
        ([True], [], False),
    ],
)
def test_one_map_alone_is_not_aligned(
    laid: list[bool], alignments: list[tuple[str, str]], is_any: bool
) -> None:
    content = MERGED | {
        "parts": [PART | {"merged": merged} for merged in laid],
        "alignments": [
            LAID | {"map": one, "other": other, "rejected": False, "proven": False}
            for one, other in alignments
        ],
    }
    assert is_any_aligned(merge_of(content)) is is_any
