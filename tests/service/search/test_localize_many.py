"""`/localize` and `/match` over many maps: one search, one judgment (rows B1 and B13)."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, encode, moved, originated
from placecell_client.maps.edit import take

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from placecell.descriptors.manifest import Manifest
from placecell.localization import LocalizationParameters
from service.maps import shared_index
from service.maps.shared_index import SharedIndexes
from service.search import ranking
from service.search.ranking import FULL, best_of, votes_of
from tests.service.core.test_auth import made
from tests.service.search.test_localize import (
    TRUTH,
    by_codes,
    packed,
    seen_in,
    street_map,
    with_landmarks,
)
from tests.service.service_builders import edit_of, map_of, post_packed, random_codes

REVISIT = 0.6
"""Standard deviation of descriptors between two visits, in steps."""


def seen_again(content: CompactMap, seed: int, robot: str = "bob") -> CompactMap:
    """Return the same things mapped by another robot at another time."""
    random = np.random.default_rng(seed)
    noise = random.normal(scale=REVISIT, size=content.codes.shape)
    return replace(
        content,
        codes=(content.codes + noise).round().clip(-127, 127).astype(np.int8),
        centroids=(content.centroids + random.normal(scale=0.15, size=(len(content), 3))).round(2),
        robots=(robot,),
        frame_times=content.frame_times + 1_000.0 * (1 + seed),
    )


def changed(content: CompactMap, share: float, seed: int) -> CompactMap:
    """Return the content with a share of the things replaced by others."""
    random = np.random.default_rng([seed, 1])
    rows = random.choice(len(content), round(share * len(content)), replace=False)
    codes, centroids = content.codes.copy(), content.centroids.copy()
    codes[rows] = random_codes(len(rows), 1_000 + seed, codes.shape[1])
    centroids[rows] = random.uniform((-200, -15, 0), (200, 15, 4), (len(rows), 3)).round(2)
    return replace(content, codes=codes, centroids=centroids)


def put(service: Any, name: str, content: CompactMap, **headers: str) -> None:
    answer = service.put(f"/maps/{name}", content=encode(content), headers=headers)
    assert answer.is_success, answer.text


def ask(service: Any, body: dict[str, Any], **more: Any) -> list[dict[str, Any]]:
    answer = service.post("/localize", json=body | more)
    assert answer.status_code == 200, answer.text
    told: list[dict[str, Any]] = answer.json()["localizations"]
    return told


@pytest.fixture
def floor(manifest: Manifest) -> CompactMap:
    return street_map(manifest)


@pytest.fixture
def body(manifest: Manifest, floor: CompactMap) -> dict[str, Any]:
    """Return the request of a robot that visits the floor again."""
    return by_codes(manifest, *seen_in(seen_again(floor, 77)))


@pytest.mark.parametrize("names", [("a", "z"), ("z", "a")])
def test_B1_equal_floors_are_ambiguous_and_the_rival_is_named(
    service: Any, floor: CompactMap, body: Any, names: tuple[str, str]
) -> None:
    put(service, names[0], seen_again(floor, 1, "ann"))
    put(service, names[1], seen_again(floor, 2, "bob"))
    told = ask(service, body)
    for one, other in (told, told[::-1]):
        assert not one["localized"]
        assert one["reason"] == "ambiguous"
        assert one["pose"] is None
        assert one["probability"] < 0.6
        assert one["rival"]["map"] == other["map"]
        assert one["rival"]["frame"] == "town"
        for pose in (one["others"][0]["pose"], one["rival"]["pose"]):
            np.testing.assert_allclose(pose["translation"], TRUTH.translation, atol=0.5)
        assert repr(other["map"]) in one["detail"]
        assert "/merge" in one["detail"]
        assert [each["map"] for each in one["places"]] == [one["map"], other["map"]]
        assert one["places_apart"] is None
    # Within one of them the robot is where it is.
    (alone,) = ask(service, body, maps=[names[1]])
    assert alone["localized"]
    assert alone["rival"] is None


@pytest.mark.parametrize("names", [("a", "z"), ("z", "a")])
def test_B1_floors_that_differ_enough_give_the_right_floor(
    service: Any, floor: CompactMap, body: Any, names: tuple[str, str]
) -> None:
    put(service, names[0], seen_again(floor, 1, "ann"))
    put(service, names[1], seen_again(changed(floor, 0.6, 3), 2, "bob"))
    right, wrong = ask(service, body)
    assert (right["map"], wrong["map"]) == names
    assert right["localized"]
    assert right["probability"] >= 0.9
    assert right["rival"]["map"] == names[1]
    assert right["rival"]["score"] < right["score"]
    assert not wrong["localized"]
    assert wrong["probability"] < 0.5
    assert wrong["rival"]["map"] == names[0]
    assert "fits better" in wrong["detail"]


def test_B1_both_encodings_name_the_rival(service: Any, floor: CompactMap, body: Any) -> None:
    import msgpack  # type: ignore[import-untyped]

    put(service, "a", seen_again(floor, 1, "ann"))
    put(service, "b", seen_again(floor, 2, "bob"))
    told = msgpack.unpackb(post_packed(service, "/localize", packed(body)).content)
    assert told["localizations"] == ask(service, body)


def merged_from(one: CompactMap, name: str) -> CompactMap:
    """A map as a merge writes it: in another frame, with other ids, each with its source."""
    angle = np.radians(30.0)
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    laid = moved(originated(one, name), turn, np.array([500.0, 20.0, 0.0]), "site")
    return replace(laid, ids=laid.ids + np.uint32(5_000))


def test_B1_a_merged_map_and_its_source_are_one_place(
    service: Any, floor: CompactMap, body: Any
) -> None:
    source = seen_again(floor, 1, "ann")
    put(service, "a", source)
    put(service, "site", merged_from(source, "a"))
    told = ask(service, body)
    assert [each["localized"] for each in told] == [True, True]
    assert [each["rival"] for each in told] == [None, None]
    # A look-alike beside them is a rival of both, and of no other name.
    put(service, "b", seen_again(floor, 2, "bob"))
    by_map = {each["map"]: each for each in ask(service, body)}
    assert {each["reason"] for each in by_map.values()} == {"ambiguous"}
    assert by_map["a"]["rival"]["map"] == by_map["site"]["rival"]["map"] == "b"


def test_B1_map_under_a_source_s_name_is_another_place(
    service: Any, floor: CompactMap, body: Any
) -> None:
    put(service, "site", merged_from(seen_again(floor, 1, "ann"), "a"))
    put(service, "a", seen_again(floor, 2, "ann"))
    assert {each["reason"] for each in ask(service, body)} == {"ambiguous"}


def with_moments(content: CompactMap) -> CompactMap:
    """Return the content captured at two moments."""
    return replace(
        content,
        frame_index=(np.arange(len(content)) >= len(content) // 2).astype(np.uint32),
        frame_times=np.array([1.7e9, 1.7e9 + 12.25]),
        frame_positions=np.array([[0.0, 0, 0], [30, 0, 0]]),
        frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (2, 1)),
    )


def test_B1_a_map_stored_twice_is_one_place(service: Any, floor: CompactMap, body: Any) -> None:
    content = with_moments(seen_again(floor, 1))
    put(service, "yard", content)
    put(service, "yard-copy", content)
    told = ask(service, body)
    assert [each["localized"] for each in told] == [True, True]
    # Where one segment differs, nothing proves that it is a copy.
    put(service, "yard-copy", take(content, np.arange(199)), **{"If-Match": "*"})
    assert {each["reason"] for each in ask(service, body)} == {"ambiguous"}


def test_B1_a_rival_that_the_key_does_not_open_is_neither_searched_nor_named(
    start: Any, tmp_path: Path, floor: CompactMap, body: Any
) -> None:
    file = tmp_path / "keys.toml"
    everything, halls = made(file, "all", "--write"), made(file, "halls", "--map", "hall-*")
    with start(keys_file=file) as service:
        put(service, "hall-1", seen_again(floor, 1), **everything)
        put(service, "yard", seen_again(floor, 2), **everything)
        answer = service.post("/localize", json=body, headers=halls)
        (told,) = answer.json()["localizations"]
        assert told["localized"]
        assert told["rival"] is None
        assert "yard" not in answer.text
        told = service.post("/localize", json=body, headers=everything).json()["localizations"]
        assert {each["reason"] for each in told} == {"ambiguous"}


def test_B1_evidence_against_a_wrong_floor_adds_up(
    service: Any, manifest: Manifest, floor: CompactMap
) -> None:
    """The robot has passed landmarks of floor a; both floors have the segments that it sees now."""
    landmarks = with_landmarks(floor)
    put(service, "b", take(landmarks, np.arange(200, 400)))
    put(service, "a", take(landmarks, np.arange(200, 420)))
    same = by_codes(manifest, *seen_in(landmarks, np.arange(200, 240)))
    passed = [
        by_codes(manifest, *seen_in(landmarks, np.arange(400 + first, 420)), session="ann")
        for first in range(6)
    ]
    assert {each["reason"] for each in ask(service, same, session="ann")} == {"ambiguous"}
    for each in passed:
        assert ask(service, each)[0]["map"] == "a"
    first = ask(service, same, session="ann")[0]
    assert first["map"] == "a"
    assert first["localized"], first
    assert {each["reason"] for each in ask(service, same)} == {"ambiguous"}


def many(manifest: Manifest, count: int = 40) -> dict[str, CompactMap]:
    """Return maps whose descriptors are all different."""
    return {f"map-{number:03}": street_map(manifest, 100 + number) for number in range(count)}


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    for name, content in many(manifest).items():
        put(service, name, content)
    return service


def test_B13_of_many_maps_few_are_searched_in_full_and_the_right_one_is_found(
    stocked: Any, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    from service.search import localization

    searched = []
    map_query = localization.map_query

    def counted(**arguments: Any) -> Any:
        searched.append(arguments["snapshot"].name)
        return map_query(**arguments)

    monkeypatch.setattr(localization, "map_query", counted)
    for name in ("map-000", "map-039"):
        searched.clear()
        told = ask(stocked, by_codes(manifest, *seen_in(many(manifest)[name])))
        assert len(told) == 40
        assert told[0]["map"] == name
        assert told[0]["localized"]
        assert not any(each["localized"] for each in told[1:])
        assert name in searched
        assert len(searched) <= FULL
        # As alone, for nothing else fits.
        (alone,) = ask(stocked, by_codes(manifest, *seen_in(many(manifest)[name])), maps=[name])
        assert told[0]["pose"] == alone["pose"]


def test_B13_forty_equal_floors_are_ambiguous_and_the_work_is_bounded(
    service: Any, floor: CompactMap, body: Any
) -> None:
    for number in range(40):
        put(service, f"floor-{number:02}", seen_again(floor, number))
    told = ask(service, body)
    assert len(told) == 40
    assert not any(each["localized"] for each in told)
    assert sum(each["reason"] == "ambiguous" for each in told) <= FULL
    assert told[0]["reason"] == "ambiguous"
    assert "searched in full" in told[-1]["detail"]


def match_by_hand(maps: dict[str, CompactMap], query: Any, k: int) -> list[tuple[int, str, int]]:
    """Return squared distance, map and id of the nearest candidates."""
    found = []
    for name, content in maps.items():
        squared = ((content.codes.astype(int) - query.astype(int)) ** 2).sum(axis=1)
        found += list(
            zip(squared.tolist(), [name] * len(content), content.ids.tolist(), strict=True)
        )
    return sorted(found)[:k]


@pytest.mark.parametrize("names", [None, [f"map-{number:03}" for number in range(3, 36)]])
def test_B13_match_over_many_maps_is_exact_with_ties_by_map_then_id(
    service: Any, manifest: Manifest, names: list[str] | None
) -> None:
    maps = {
        # Few different codes: many ties, within a map and between maps.
        f"map-{number:03}": map_of(random_codes(30, number) // 64, manifest.model_id)
        for number in range(40)
    }
    for name in sorted(maps, reverse=True):
        put(service, name, maps[name])
    queries = random_codes(6, 5) // 64
    body = by_codes(manifest, queries, np.zeros((6, 3)), k=60)
    del body["centroids"]

    def check() -> None:
        asked = body if names is None else body | {"maps": names}
        answer = service.post("/match", json=asked).json()["queries"]
        chosen = {name: maps[name] for name in names or maps}
        for query, item in zip(queries, answer, strict=True):
            got = [(each["map"], each["id"]) for each in item["candidates"]]
            assert got == [each[1:] for each in match_by_hand(chosen, query, 60)]

    check()
    # A map is written, one is removed, one is new: each is found as it is now.
    more = map_of(random_codes(4, 900) // 64, manifest.model_id, first_id=500)
    edit = edit_of(more.codes, manifest.model_id, first_id=500, removed=[100, 101])
    answer = service.post("/maps/map-010/segments", content=edit, headers={"If-Match": "*"})
    assert answer.is_success, answer.text
    kept = take(maps["map-010"], np.arange(2, 30))
    maps["map-010"] = replace(
        kept,
        codes=np.concatenate([kept.codes, more.codes]),
        ids=np.concatenate([kept.ids, more.ids]),
        centroids=np.concatenate([kept.centroids, more.centroids]),
        robot=np.zeros(32, np.uint16),
        frame_index=np.zeros(32, np.uint32),
    )
    if names is None:
        assert service.delete("/maps/map-020").status_code == 204
        del maps["map-020"]
        maps["map-100"] = map_of(random_codes(30, 100) // 64, manifest.model_id)
        put(service, "map-100", maps["map-100"])
    check()


def test_B13_maps_of_other_keys_do_not_displace_own_maps(
    start: Any, tmp_path: Path, manifest: Manifest, floor: CompactMap, body: Any
) -> None:
    file = tmp_path / "keys.toml"
    everything, halls = made(file, "all", "--write"), made(file, "halls", "--map", "hall-*")
    with start(keys_file=file) as service:
        for name, content in many(manifest, 20).items():
            put(service, name.replace("map", "hall"), content, **everything)
        put(service, "hall-100", floor, **everything)
        before = service.post("/localize", json=body, headers=halls)
        for number in range(20):
            put(service, f"yard-{number}", seen_again(floor, number), **everything)
        after = service.post("/localize", json=body, headers=halls)
        assert before.json() == after.json()
        assert "yard" not in after.text
        shared = service.app.state.placecell.engine.maps.shared
        service.post("/localize", json=body, headers=everything)
        for indexes in shared._by_model.values():
            maps = service.app.state.placecell.engine.maps.all()
            names = {each.head.uid: each.name.split("-")[0] for each in maps}
            for index in indexes:
                assert len({names[uid] for uid, *_ in index.keys}) == 1


@pytest.mark.slow
def test_B13_a_shared_index_is_kept_while_little_changes(stocked: Any, manifest: Manifest) -> None:
    body = by_codes(manifest, *seen_in(many(manifest)["map-007"]))
    assert ask(stocked, body)[0]["map"] == "map-007"
    maps = stocked.app.state.placecell.engine.maps
    (before,) = maps.shared._by_model[manifest.model_id]
    for number in range(3):
        edit = edit_of(random_codes(1, 800 + number), manifest.model_id, first_id=700)
        path = f"/maps/map-{number:03}/segments"
        assert stocked.post(path, content=edit, headers={"If-Match": "*"}).is_success
        ask(stocked, body)
    assert maps.shared._by_model[manifest.model_id] == [before]
    for number in range(30):
        assert stocked.delete(f"/maps/map-{number + 10:03}").status_code == 204
    assert ask(stocked, body)[0]["map"] == "map-007"
    assert before not in maps.shared._by_model[manifest.model_id]


def test_B13_a_cancelled_search_stops(stocked: Any, manifest: Manifest) -> None:
    maps = stocked.app.state.placecell.engine.maps
    searched = tuple(maps.all())
    codes, centroids = seen_in(many(manifest)["map-001"])
    model = stocked.app.state.placecell.engine.models.default
    known = SharedIndexes().parts(searched, searched, model.id, model.manifest.quantizer, ())
    parameters = LocalizationParameters()
    votes = votes_of(codes, centroids, searched, known, parameters)
    assert votes.argmax() == 1
    assert votes[1] == 40
    token = CancelToken()
    token.cancel()
    with cancelled_by(token), pytest.raises(Cancelled):
        votes_of(codes, centroids, searched, known, parameters)


def test_B13_votes_are_counted_in_parts_where_there_are_too_many(
    stocked: Any, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ranking, "PAIRS", 20_000)
    searched = tuple(stocked.app.state.placecell.engine.maps.all())
    codes, centroids = seen_in(many(manifest)["map-001"])
    model = stocked.app.state.placecell.engine.models.default
    known = SharedIndexes().parts(searched, searched, model.id, model.manifest.quantizer, ())
    votes = votes_of(codes, centroids, searched, known, LocalizationParameters())
    assert votes.argmax() == 1


def test_best_maps_by_hand() -> None:
    votes = np.array([3, 20, 9, 8, 7, 20, 2])
    assert best_of(votes, 4).tolist() == [1, 2, 3, 5]
    assert best_of(votes, 4, most=2).tolist() == [1, 5]
    # Where the robot was found before comes first, but not in all places.
    assert best_of(votes, 4, [6, 0, 2], most=4).tolist() == [0, 1, 5, 6]
    assert best_of(np.zeros(9, np.int64), 4).tolist() == []


def test_few_small_maps_need_no_shared_index(service: Any, manifest: Manifest) -> None:
    for name, content in many(manifest, shared_index.LOOSE - 1).items():
        put(service, name, content)
    body = by_codes(manifest, *seen_in(many(manifest, 5)["map-004"]))
    assert ask(service, body)[0]["map"] == "map-004"
    assert service.app.state.placecell.engine.maps.shared._by_model[manifest.model_id] == []
