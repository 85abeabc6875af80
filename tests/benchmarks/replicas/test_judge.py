"""Tests of the judge: what counts as lost, and how readers see a stale answer."""

import random

import httpx
import numpy as np
import pytest
from placecell_client import encode
from placecell_client.maps.edit import take
from placecell_client.maps.union import union

from benchmarks.replicas.availability import AnswerTimes
from benchmarks.replicas.fleet_clients import FleetReader, ProbeBoard, WriteProbe, seen_headers
from benchmarks.replicas.judge import is_union, lost_in, search_in
from benchmarks.synthetic_maps.random_maps import MapTemplate

TEMPLATE = MapTemplate("m", "v", 8)
RANDOM = np.random.default_rng(5)
ANN = TEMPLATE.random_map("ann", np.arange(10, dtype=np.uint32), RANDOM)
BOB = TEMPLATE.random_map("bob", np.arange(100, 105, dtype=np.uint32), RANDOM)


def test_nothing_is_lost_in_the_union() -> None:
    file = encode(union([ANN, BOB]))
    assert lost_in(file, [ANN, BOB]) == 0
    assert is_union(file, [ANN, BOB, TEMPLATE.empty_map()])


def test_missing_changed_and_unexpected_segments_are_lost() -> None:
    changed = TEMPLATE.random_map("bob", np.arange(100, 107, dtype=np.uint32), RANDOM)
    file = encode(union([take(ANN, np.arange(7)), changed]))
    # Three segments of Ann are missing. Bob's five have other codes, and two are not his.
    assert lost_in(file, [ANN, BOB]) == 3 + 5 + 2
    assert not is_union(file, [ANN, BOB])


def test_a_robot_without_segments_in_the_map_lost_all() -> None:
    assert lost_in(encode(ANN), [ANN, BOB]) == len(BOB)


def test_judge_searches_segments_of_every_map() -> None:
    search = search_in({"site": ANN, "yard": BOB}, "m")
    assert len(search["codes"]) == len(ANN) + len(BOB)
    assert search["maps"] == ["site", "yard"]


def reader() -> FleetReader:
    return FleetReader(
        name="reader",
        address="http://127.0.0.1:9",
        draw=random.Random(1),
        answers=AnswerTimes("read"),
        model_id="m",
        board=ProbeBoard(),
    )


@pytest.mark.parametrize(
    ("candidate", "stale"),
    [({"id": 3, "distance": 0}, 0), ({"id": 4, "distance": 0}, 1), ({"id": 3, "distance": 2.0}, 1)],
)
def test_reader_counts_an_answer_without_the_probe_as_stale(
    candidate: dict[str, float], stale: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("benchmarks.replicas.fleet_clients.WHOLE_MAPS", 0.0)
    sent: list[httpx.Request] = []

    def answer(request: httpx.Request) -> httpx.Response:
        sent.append(request)
        if len(sent) == 1:
            return httpx.Response(503)
        return httpx.Response(200, json={"queries": [{"candidates": [candidate]}]})

    one = reader()
    with httpx.Client(base_url="http://a", transport=httpx.MockTransport(answer)) as http:
        assert one._read(http, WriteProbe("site", "7", 3, (1, 2)))
    assert (one.reads, one.stale, one.refused["503"]) == (1, stale, 1)
    assert len(one.answers.times) == 1
    assert sent[0].headers["Placecell-Seen"] == seen_headers("site", "7")["Placecell-Seen"]


def test_reader_reads_whole_maps(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("benchmarks.replicas.fleet_clients.WHOLE_MAPS", 1.0)
    one = reader()
    transport = httpx.MockTransport(lambda _: httpx.Response(200, content=encode(ANN)))
    with httpx.Client(base_url="http://a", transport=transport) as http:
        assert one._read(http, WriteProbe("site", "7", 3, ()))
        assert one._read(http, WriteProbe("site", "7", 30, ()))
    assert (one.reads, one.stale) == (2, 1)


def test_board_shows_the_last_probe_of_each_map() -> None:
    board = ProbeBoard()
    assert board.draw(random.Random(0)) is None
    board.put(WriteProbe("site", "1", 1, ()))
    board.put(WriteProbe("site", "2", 2, ()))
    shown = board.draw(random.Random(0))
    assert shown is not None
    assert shown.etag == "2"
