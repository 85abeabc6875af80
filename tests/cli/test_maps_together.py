"""`placecell maps align` and `merge` against a running service, as a person uses them."""

import json
from dataclasses import replace

import numpy as np
import pytest
from placecell_client import Client, CompactMap, moved
from placecell_client.maps.edit import take
from placecell_client.results.alignment import alignment_of
from placecell_client.results.merge import merge_of

from cli.maps.together import is_any_laid, print_alignment, print_merge
from tests.cli.maps_command import bad, good, run
from tests.client.client_fakes import ALIGNED, LAID, MERGED, PART

QUARTER = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
"""A turn to the left."""


@pytest.fixture
def url(address: str, yard: CompactMap, monkeypatch: pytest.MonkeyPatch) -> str:
    """Of a service that holds the yard, half of it as another robot's, and what is nowhere near."""
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
def test_how_a_map_lies_is_told() -> None:
    told = good("align", "yard", "hall")
    # Turned back, and so its frame's origin is at (-2000, 1000).
    assert "-2000.00, 1000.00, -3.00, -90.0" in told
    assert "aligned" in told
    assert "both were in 100% of the places of yard, in 100% of those of hall" in told
    told = bad("align", "yard", "moon")
    assert "yard and moon are not aligned (inconsistent)" in told
    assert "404" in bad("align", "yard", "nowhere")


@pytest.mark.usefixtures("url")
def test_how_a_map_lies_is_told_as_json() -> None:
    found = json.loads(good("align", "yard", "hall", "--json"))
    np.testing.assert_allclose(found["pose"]["translation"], [-2000, 1000, -3], atol=0.5)
    assert (found["other"], found["other_frame"]) == ("hall", "hall")
    assert np.shape(found["covariance"]) == (4, 4)
    result = run("align", "yard", "moon", "--json")
    assert result.exit_code == 1
    assert json.loads(result.stdout)["reason"] == "inconsistent"
    assert "not aligned" in result.stderr


def test_frames_that_are_not_level_are_laid_on_each_other(url: str, yard: CompactMap) -> None:
    tilted = np.array([[1.0, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
    with Client(url) as client:
        client.put_map("tilted", moved(yard, tilted, [5.0, 6, 7], "tilted"))
    assert "not aligned" in bad("align", "yard", "tilted")
    assert "aligned" in good("align", "yard", "tilted", "--motion", "se3")
    assert "no map of yard, tilted" in bad("merge", "site", "yard", "tilted", "--dry-run")
    laid = ("merge", "site", "yard", "tilted", "--dry-run", "--motion", "se3")
    assert "300 segments it would hold" in good(*laid)
    assert "Invalid value for '--motion'" in run("align", "yard", "tilted", "--motion", "9").output


def test_maps_are_merged_and_a_merge_is_undone(url: str) -> None:
    names = ("yard", "hall", "moon")
    told = good("merge", "site", *names, "--dry-run")
    assert "300 segments it would hold" in told
    assert "nothing was written" in told
    with Client(url) as client:
        assert "site" not in {stored.name for stored in client.maps()}
        told = good("merge", "site", *names)
        assert "left out" in told
        assert "yard and moon: " in told
        assert "site: 300 segments, version 1: 300 changed, 0 removed" in told
        assert "to undo it: placecell maps delete site" in told
        assert "there was nothing new" in good("merge", "site", "hall")
        first = next(stored.etag for stored in client.maps() if stored.name == "site")
        # Bob's segments show what is there already.
        told = good("merge", "site", "hall", "--keep-repeats", "--if-match", first)
        assert "site: 450 segments, version 2: 150 changed, 0 removed" in told
        assert "to undo it: placecell maps restore site 1" in told
        assert client.get_map("site").robots == ("ann", "bob")
        good("restore", "site", 1)
        assert "412" in bad("merge", "site", "hall", "--keep-repeats", "--if-match", first)
        assert client.get_map("site").robots == ("ann",)


@pytest.mark.usefixtures("url")
def test_what_a_merge_did_is_told_as_json() -> None:
    merged = json.loads(good("merge", "site", "yard", "hall", "--json"))
    assert (merged["sequence"], merged["previous"]) == (1, None)
    assert [part["repeats"] for part in merged["parts"]] == [0, 150]


@pytest.mark.usefixtures("url")
def test_what_cannot_be_merged_is_told() -> None:
    assert "nothing was changed" in bad("merge", "site", "yard", "moon")
    told = bad("merge", "site", "yard", "moon", "--dry-run")
    assert "no map of yard, moon can be laid on another" in told
    assert "would hold" not in told
    assert "404" in bad("merge", "site", "yard", "nowhere")
    assert "twice" in bad("merge", "site", "yard", "yard")
    assert "two maps" in bad("merge", "site", "yard")
    assert run("merge", "site").exit_code == 2


@pytest.mark.parametrize("is_aligned", [True, False])
def test_other_ways_to_lay_maps_are_told(
    capsys: pytest.CaptureFixture[str], is_aligned: bool
) -> None:
    nothing = {"pose": None, "overlap": None, "covariance": None}
    print_alignment(alignment_of(ALIGNED | ({} if is_aligned else nothing)))
    told = capsys.readouterr().out
    assert "another way" in told
    assert "2.5" in told
    assert ("40.5" in told) is is_aligned
    assert ("both were in 50% of the places of yard, in 75% of those of hall" in told) is is_aligned


def test_what_loops_say_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    verdicts = [
        {"rejected": False, "proven": True},
        {"rejected": True, "proven": False},
        {"rejected": False, "proven": False},
    ]
    loop = {"maps": ["site", "yard", "hall"], "metres": 8.25, "degrees": 0.5, "closes": False}
    loops = [loop | {"metres": 0.5, "closes": True}, loop]
    pairs = [LAID | each for each in verdicts]
    print_merge(merge_of(MERGED | {"alignments": pairs, "loops": loops}))
    told = capsys.readouterr().out
    places = [told.index(word) for word in ("proven", "rejected", "aligned")]
    assert places == sorted(places)
    assert "site - yard - hall - site closes: 0.50 m and 0.5 degrees off" in told
    assert "site - yard - hall - site does not close: 8.25 m" in told


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
def test_a_map_alone_lies_on_none(
    laid: list[bool], alignments: list[tuple[str, str]], is_any: bool
) -> None:
    content = MERGED | {
        "parts": [PART | {"merged": merged} for merged in laid],
        "alignments": [
            LAID | {"map": one, "other": other, "rejected": False, "proven": False}
            for one, other in alignments
        ],
    }
    assert is_any_laid(merge_of(content)) is is_any
