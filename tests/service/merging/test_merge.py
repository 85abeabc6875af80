"""`/maps/{map}/merge` over HTTP, with maps of one street."""

import threading
from collections import Counter
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, decode, encode, encode_delta
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import take

from placecell.descriptors.manifest import Manifest
from placecell.localization import Pose
from placecell.localization.registration import register_yaw
from placecell.map_alignment import MapAlignment
from service.maps.index import index_of
from service.maps.layers import MapLayers
from service.maps.sql.owners import Owners
from service.maps.sql.tables import row_of, save_head
from service.merging import alignment
from service.merging import merge as merge_module
from service.merging import plan as merging
from tests.service.core.test_auth import made
from tests.service.merging.merged_map_builders import (
    driven,
    merge,
    models_that_judge,
    put,
    relative,
)
from tests.service.service_builders import assert_problem, map_of, random_codes

pytestmark = pytest.mark.slow  # by their sum

NONE = np.zeros(0, np.uint32)


@pytest.fixture(scope="module")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "tiny")


@pytest.fixture(scope="module")
def other_manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "other")


@pytest.fixture
def maps(manifest: Manifest) -> dict[str, CompactMap]:
    """Store maps of three robots, of overlapping stretches at different times."""
    stretches = {"east": (0, 150), "west": (60, 210), "north": (30, 180)}
    return {
        name: driven(manifest.model_id, name, *ends, time=1e9 + 1e6 * number)
        for number, (name, ends) in enumerate(stretches.items())
    }


@pytest.fixture
def stocked(service: Any, maps: dict[str, CompactMap]) -> Any:
    for name, content in maps.items():
        put(service, name, content)
    return service


def content(service: Any, name: str = "site") -> CompactMap:
    response = service.get(f"/maps/{name}")
    assert response.status_code == 200, response.text
    return decode(response.content)


def origins(site: CompactMap) -> list[tuple[str, int]]:
    """Return source map and id there of each segment."""
    assert site.source is not None
    assert site.source_ids is not None
    names = ("", *site.sources)
    return [
        (names[number], id_)
        for number, id_ in zip(site.source.tolist(), site.source_ids.tolist(), strict=True)
    ]


def rows_from(site: CompactMap, name: str) -> np.ndarray:
    return np.array([row for row, (source, _) in enumerate(origins(site)) if source == name])


def edited(service: Any, name: str, changed: CompactMap, removed: Any = NONE) -> None:
    edit = encode_delta(Delta(changed, np.asarray(removed, np.uint32)))
    answer = service.post(f"/maps/{name}/segments", content=edit, headers={"If-Match": "*"})
    assert answer.status_code == 200, answer.text


def assert_lies_as_driven(site: CompactMap, maps: dict[str, CompactMap], frame: str) -> None:
    """Check that every segment is at its true position in the frame of one map."""
    where = {
        (name, id_): relative(frame, name).apply(place)
        for name, each in maps.items()
        for id_, place in zip(each.ids.tolist(), each.centroids, strict=True)
    }
    truth = np.array([where[key] for key in origins(site)])
    assert np.linalg.norm(site.centroids - truth, axis=1).max() < 0.5


def test_new_merged_map_has_the_frame_of_the_first_map(
    stocked: Any, maps: dict[str, CompactMap]
) -> None:
    response = merge(stocked, "site", ["east", "west", "north"], deduplicate=False)
    assert response.status_code == 201, response.text
    told = response.json()
    assert response.headers["etag"] == f'"{told["etag"]}"'
    assert stocked.get("/maps/site").headers["etag"] == response.headers["etag"]
    total = sum(map(len, maps.values()))
    assert (told["map"], told["frame"], told["dry_run"]) == ("site", "east's odometry", False)
    assert (told["sequence"], told["previous"]) == (1, None)
    assert (told["segments"], told["changed"], told["removed"]) == (total, total, 0)
    for name, part in zip(maps, told["parts"], strict=True):
        assert part["map"] == name
        assert part["merged"]
        assert stocked.get(f"/maps/{name}").headers["etag"] == f'"{part["etag"]}"'
        counts = [part[key] for key in ("added", "known", "repeats", "removed")]
        assert counts == [len(maps[name]), 0, 0, 0]
    pairs = {(each["map"], each["other"]): each for each in told["alignments"]}
    assert list(pairs) == [("east", "west"), ("east", "north"), ("west", "north")]
    for each in pairs.values():
        assert each["aligned"]
        assert each["proven"]
        assert not each["rejected"]
    (loop,) = told["loops"]
    assert loop["closes"]
    assert sorted(loop["maps"]) == sorted(maps)
    assert loop["meters"] < 1.0

    site = content(stocked)
    assert site.frame == "east's odometry"
    assert_lies_as_driven(site, maps, "east")
    # Each segment keeps its map, its id there, robot, time and codes.
    assert sorted(origins(site)) == sorted(
        (name, id_) for name, each in maps.items() for id_ in each.ids.tolist()
    )
    assert len(set(site.ids.tolist())) == total
    for name, each in maps.items():
        rows = rows_from(site, name)
        assert site.source_ids is not None
        theirs = np.searchsorted(each.ids, site.source_ids[rows])
        assert {site.robots[number] for number in site.robot[rows]} == {f"{name} robot"}
        np.testing.assert_array_equal(site.codes[rows], each.codes[theirs])
        np.testing.assert_array_equal(
            site.frame_times[site.frame_index[rows]], each.frame_times[each.frame_index[theirs]]
        )
        viewpoints = relative("east", name).apply(each.frame_positions[each.frame_index[theirs]])
        assert np.abs(site.frame_positions[site.frame_index[rows]] - viewpoints).max() < 0.5
    (summary,) = [each for each in stocked.get("/maps").json()["maps"] if each["name"] == "site"]
    assert summary["sources"] == {name: len(each) for name, each in sorted(maps.items())}
    assert summary["robots"] == {f"{name} robot": len(each) for name, each in sorted(maps.items())}
    # The merged parts are unchanged.
    for name, each in maps.items():
        assert stocked.get(f"/maps/{name}").content == encode(each)


def test_segments_shown_by_another_map_are_left_out(
    stocked: Any, maps: dict[str, CompactMap]
) -> None:
    whole = merge(stocked, "whole", ["east", "west"], deduplicate=False).json()
    told = merge(stocked, "site", ["east", "west"]).json()
    east, west = told["parts"]
    # The first map is complete, although it shows many objects more than once.
    assert (east["added"], east["repeats"]) == (len(maps["east"]), 0)
    assert west["added"] + west["repeats"] == len(maps["west"])
    assert 0.2 < west["repeats"] / len(maps["west"]) < 0.8
    assert told["segments"] == whole["segments"] - west["repeats"]
    # Segments left out are where both robots were.
    kept = {id_ for name, id_ in origins(content(stocked)) if name == "west"}
    west_map = maps["west"]
    out = west_map.centroids[~np.isin(west_map.ids, [*kept])]
    along = relative("east", "west").apply(out)[:, 0]
    assert along.max() < 180


def test_segments_seen_by_two_robots_at_once_are_repeats(service: Any, manifest: Manifest) -> None:
    for name, ends in {"east": (0, 150), "west": (0, 150)}.items():
        put(service, name, driven(manifest.model_id, name, *ends, time=1e9))
    told = merge(service, "site", ["east", "west"]).json()
    assert told["parts"][1]["repeats"] > 50


@pytest.mark.slow
def test_dry_run_returns_changes_and_writes_nothing(stocked: Any) -> None:
    before = stocked.get("/maps").json()
    response = merge(stocked, "site", ["east", "west"], dry_run=True)
    assert response.status_code == 200
    assert "etag" not in response.headers
    would = response.json()
    assert would["dry_run"]
    assert would["sequence"] is would["etag"] is would["previous"] is None
    assert stocked.get("/maps").json() == before
    assert stocked.get("/maps/site").status_code == 404
    done = merge(stocked, "site", ["east", "west"]).json()
    same = ("parts", "alignments", "loops", "segments", "changed", "removed", "frame")
    assert {key: would[key] for key in same} == {key: done[key] for key in same}

    # Merge into an existing merged map.
    before = [stocked.get(path).content for path in ("/maps", "/maps/site", "/maps/site/versions")]
    etag = stocked.get("/maps/site").headers["etag"]
    would = merge(stocked, "site", ["north"], dry_run=True).json()
    assert would["previous"] == 1
    after = [stocked.get(path).content for path in ("/maps", "/maps/site", "/maps/site/versions")]
    assert after == before
    assert stocked.get("/maps/site").headers["etag"] == etag
    done = merge(stocked, "site", ["north"]).json()
    for key in ("parts", "segments", "changed", "removed"):
        assert would[key] == done[key]


def test_merge_is_undone_byte_for_byte(stocked: Any) -> None:
    merge(stocked, "site", ["east", "west"])
    before = stocked.get("/maps/site").content
    told = merge(stocked, "site", ["north"]).json()
    assert (told["sequence"], told["previous"]) == (2, 1)
    assert told["changed"] > 50
    versions = stocked.get("/maps/site/versions").json()["versions"]
    assert versions[0]["operation"] == "merge"
    assert stocked.get("/maps/site").content != before
    assert stocked.post(f"/maps/site/versions/{told['previous']}/restore").status_code == 200
    assert stocked.get("/maps/site").content == before
    # A new merged map is undone by deleting it.
    assert stocked.delete("/maps/site").status_code == 204
    assert stocked.get("/maps/site").status_code == 404


@pytest.mark.slow
def test_merge_twice_adds_nothing(stocked: Any) -> None:
    names = ["east", "west", "north"]
    merge(stocked, "site", names)
    before = stocked.get("/maps/site")
    for again in (names, names[::-1], ["west"]):
        response = merge(stocked, "site", again)
        assert response.status_code == 200
        told = response.json()
        assert (told["changed"], told["removed"], told["sequence"]) == (0, 0, 1), told["parts"]
        assert [part["added"] for part in told["parts"]] == [0] * len(again)
        after = stocked.get("/maps/site")
        assert after.content == before.content
        assert after.headers["etag"] == before.headers["etag"]


@pytest.mark.parametrize(("ends", "count"), [((60, 120), 2), ((85, 125), 1)])
def test_map_with_few_shared_segments_keeps_its_pose(
    stocked: Any, manifest: Manifest, ends: tuple[float, float], count: int
) -> None:
    merge(stocked, "site", ["east", "west"])
    put_anew(stocked, "north", driven(manifest.model_id, "north", *ends, time=1.5e9))
    first = merge(stocked, "site", ["north"]).json()
    assert first["parts"][0]["added"] == count
    again = merge(stocked, "site", ["north"]).json()
    assert (again["changed"], again["sequence"]) == (0, first["sequence"])
    pose, before = (told["parts"][0]["pose"]["translation"] for told in (again, first))
    # The frame's origin is two kilometers away; at the map, the error is below a millimeter.
    np.testing.assert_allclose(pose, before, atol=1e-3)


def next_id(service: Any, name: str = "site") -> int:
    """Reserve one id of a map and return it."""
    return int(service.post(f"/maps/{name}/ids?count=1").json()["first"])


@pytest.mark.slow
def test_merge_takes_one_id_per_new_segment(stocked: Any, maps: dict[str, CompactMap]) -> None:
    merge(stocked, "site", ["east", "west"])
    first = next_id(stocked)
    assert len(content(stocked)) == first
    for again in (["east", "west"], ["west"]):
        told = merge(stocked, "site", again).json()
        assert (told["changed"], told["parts"][-1]["repeats"] > 0) == (0, True)
    assert next_id(stocked) == first + 1
    told = merge(stocked, "site", ["north"]).json()
    (part,) = told["parts"]
    assert part["added"] > 0 < part["repeats"]
    # The two reserved ids belong to the key that asked for them.
    new = range(first + 2, first + 2 + part["added"])
    assert content(stocked).ids.tolist() == [*range(first), *new]
    assert next_id(stocked) == new.stop


def test_merge_that_is_tried_again_takes_the_ids_of_its_first_try(
    stocked: Any, maps: dict[str, CompactMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    merge(stocked, "site", ["east", "west"])
    first = next_id(stocked)
    tries: list[bool] = []

    def written_meanwhile(*_: Any) -> bool:
        tries.append(True)
        return len(tries) > 1

    def two_fewer(content: CompactMap, *_: Any) -> tuple[None, CompactMap | None]:
        """Take two of the new segments away, so that the next join adds them with new ids."""
        calls.append(len(tries))
        is_first = calls.count(len(tries)) == 1
        return None, take(content, np.arange(len(content) - 2)) if is_first else None

    calls: list[int] = []
    monkeypatch.setattr(merge_module, "_is_same", written_meanwhile)
    monkeypatch.setattr(merge_module, "bend_content", two_fewer)
    told = merge(stocked, "site", ["north"], rigid=False)
    assert told.is_success, told.text
    assert (len(tries), calls) == (2, [0, 0, 1, 1])
    new = content(stocked).ids[content(stocked).ids > first]
    assert next_id(stocked) == new.max() + 1
    # Two new segments were taken away after the join, and joined with two further ids.
    assert new.max() - first == len(new) + 2


def test_views_of_new_segments_name_a_stored_segment(
    stocked: Any, maps: dict[str, CompactMap]
) -> None:
    west = maps["west"]
    put_anew(stocked, "west", replace(west, views=west.ids // 3 * 3))
    merge(stocked, "site", ["east", "west"])
    site = content(stocked)
    assert site.views is not None
    assert set(site.views.tolist()) <= set(site.ids.tolist())
    # New views of one object still share one object.
    rows = rows_from(site, "west")
    assert site.source_ids is not None
    things, named = site.source_ids[rows] // 3, site.views[rows]
    alone = named >= site.ids[rows].min()
    groups = {(thing, view) for thing, view in zip(things[alone], named[alone], strict=True)}
    assert len(groups) == len({thing for thing, _ in groups}) == len({view for _, view in groups})
    assert alone.sum() > len(groups) > 0


@pytest.mark.sqlite
def test_merge_without_enough_ids_changes_nothing(
    stocked: Any, maps: dict[str, CompactMap]
) -> None:
    merge(stocked, "site", ["east", "west"])
    store = stocked.app.state.placecell.engine.maps.store
    with store._database.transaction() as connection:
        (head,) = (each for each in store.heads() if each.name == "site")
        row = row_of(connection, head.uid)
        Owners(connection, row).write([(0, 2**32 - 3)], "anyone")
        save_head(connection, row, replace(head, next_id=2**32 - 3))
    edited(stocked, "site", take(maps["east"], np.arange(1)))
    before = stocked.get("/maps/site").content
    for dry_run in (True, False):
        refused = merge(stocked, "site", ["north"], dry_run=dry_run)
        assert_problem(refused, 409, "out-of-ids", "3 ids are left")
    assert stocked.get("/maps/site").content == before


def test_merge_again_follows_added_and_removed_segments(service: Any, manifest: Manifest) -> None:
    west = driven(manifest.model_id, "west", 60, 210, time=1.5e9)
    first = take(west, west.ids < 250)
    put(service, "east", driven(manifest.model_id, "east", 0, 150))
    put(service, "west", first)
    merge(service, "site", ["east", "west"], deduplicate=False)
    before = content(service)
    gone = np.arange(10, 40)
    edited(service, "west", take(west, west.ids >= 250), gone)
    told = merge(service, "site", ["west"], deduplicate=False).json()
    (part,) = told["parts"]
    counts = [part[key] for key in ("added", "known", "repeats", "removed")]
    assert counts == [len(west) - 250, 220, 0, 30]
    assert (told["changed"], told["removed"]) == (len(west) - 250, 30)
    after = content(service)
    assert {id_ for name, id_ in origins(after) if name == "west"} == {
        *range(10),
        *range(40, len(west)),
    }
    # Known segments are unchanged, under their ids; no id is given twice.
    rows, places = np.isin(before.ids, after.ids), np.isin(after.ids, before.ids)
    np.testing.assert_array_equal(before.centroids[rows], after.centroids[places])
    assert rows.sum() == len(before) - 30
    assert after.ids[~places].min() > before.ids.max()
    assert_lies_as_driven(after, {"east": content(service, "east"), "west": west}, "east")


def seen_at(there: CompactMap, rows: np.ndarray, moment: int) -> CompactMap:
    """Return segments whose `seen` is this second."""
    return replace(take(there, rows), seen=np.full(len(rows), moment, np.uint32))


def test_merge_again_updates_seen(stocked: Any, maps: dict[str, CompactMap]) -> None:
    west, rows, later = maps["west"], np.arange(30), 1_700_000_000
    merge(stocked, "site", ["east", "west"], deduplicate=False)
    before = content(stocked)
    edited(stocked, "west", seen_at(west, rows, later))
    told = merge(stocked, "site", ["west"], deduplicate=False).json()
    (part,) = told["parts"]
    assert [part[key] for key in ("added", "known", "removed")] == [0, len(west), 0]
    assert (told["changed"], told["removed"]) == (30, 0)
    after = content(stocked)
    assert after.seen is not None
    assert after.source_ids is not None
    lately = np.flatnonzero(after.seen == later)
    assert set(lately) <= set(rows_from(after, "west"))
    assert sorted(after.source_ids[lately]) == west.ids[rows].tolist()
    np.testing.assert_array_equal(after.ids, before.ids)
    np.testing.assert_array_equal(after.centroids, before.centroids)
    # The merged map keeps a later `seen` of its own.
    edited(stocked, "site", seen_at(after, lately, later + 9))
    assert merge(stocked, "site", ["west"], deduplicate=False).json()["changed"] == 0
    # Segments that no map saw since keep their `seen`.
    answer = stocked.post(f"/maps/site/age?unseen_since={later}", headers={"If-Match": "*"})
    assert answer.status_code == 200, answer.text
    assert len(content(stocked)) == 30


def put_anew(service: Any, name: str, content: CompactMap) -> None:
    put(service, name, content, **{"If-Match": "*"})


def seen_anew(there: CompactMap, rows: np.ndarray) -> CompactMap:
    """Return the map with some segments captured again an hour later, under their ids."""
    codes = there.codes.copy()
    codes[rows] = np.roll(codes[rows], 1, axis=1)
    later = there.frame_times[there.frame_index[rows]] + 3_600
    frames = np.arange(len(rows)) + len(there.frame_times)
    frame_index = there.frame_index.copy()
    frame_index[rows] = frames
    of_them = there.frame_index[rows]
    return canonical(
        replace(
            there,
            codes=codes,
            frame_index=frame_index,
            frame_times=np.concatenate([there.frame_times, later]),
            frame_positions=np.concatenate([there.frame_positions, there.frame_positions[of_them]]),
            frame_orientations=np.concatenate(
                [there.frame_orientations, there.frame_orientations[of_them]]
            ),
        )
    )


def described_anew(there: CompactMap, rows: np.ndarray) -> CompactMap:
    """Return the map with some codes changed."""
    codes = there.codes.copy()
    codes[rows] = np.roll(codes[rows], 1, axis=1)
    return replace(there, codes=codes)


def shifted(there: CompactMap, rows: np.ndarray) -> CompactMap:
    """Return the map with some centroids moved by 20 cm."""
    centroids = there.centroids.copy()
    centroids[rows] += (0.0, 0.2, 0.0)
    return replace(there, centroids=centroids)


@pytest.mark.parametrize("replaced", [seen_anew, described_anew, shifted])
def test_merge_again_takes_replaced_segments(
    stocked: Any, maps: dict[str, CompactMap], replaced: Any
) -> None:
    west, rows = maps["west"], np.arange(5, 35)
    merge(stocked, "site", ["east", "west"], deduplicate=False)
    before = content(stocked)
    put_anew(stocked, "west", replaced(west, rows))
    now = content(stocked, "west")
    would = merge(stocked, "site", ["west"], deduplicate=False, dry_run=True).json()
    told = merge(stocked, "site", ["west"], deduplicate=False).json()
    (part,) = told["parts"]
    assert [part[key] for key in ("added", "known", "repeats", "removed")] == [
        30, len(west) - 30, 0, 30,
    ]  # fmt: skip
    assert (told["changed"], told["removed"]) == (30, 30)
    assert would["parts"] == told["parts"]

    after = content(stocked)
    assert after.source_ids is not None
    order = rows_from(after, "west")
    order = order[np.argsort(after.source_ids[order])]
    assert after.source_ids[order].tolist() == now.ids.tolist()
    np.testing.assert_array_equal(after.codes[order], now.codes)
    np.testing.assert_array_equal(
        after.frame_times[after.frame_index[order]], now.frame_times[now.frame_index]
    )
    # They are where the map has them now, at the pose of the first merge.
    pose = register_yaw(now.centroids, after.centroids[order], np.ones(len(now)))
    assert np.abs(pose.apply(now.centroids) - after.centroids[order]).max() < 0.03
    # All other segments are unchanged, under their ids; no id is given twice.
    same, places = np.isin(before.ids, after.ids), np.isin(after.ids, before.ids)
    assert same.sum() == len(before) - 30
    np.testing.assert_array_equal(before.centroids[same], after.centroids[places])
    np.testing.assert_array_equal(before.codes[same], after.codes[places])
    assert after.ids[~places].min() > before.ids.max()

    again = merge(stocked, "site", ["west"], deduplicate=False).json()
    assert (again["changed"], again["removed"]) == (0, 0)
    assert again["parts"][0]["known"] == len(west)


def test_replaced_segment_shown_by_another_map_is_left_out(
    stocked: Any, maps: dict[str, CompactMap]
) -> None:
    west, rows = maps["west"], np.arange(len(maps["west"]))
    merge(stocked, "site", ["east", "west"])
    put_anew(stocked, "west", shifted(west, rows[40:60]))
    told = merge(stocked, "site", ["west"]).json()
    (part,) = told["parts"]
    assert part["added"] + part["repeats"] + part["known"] == len(west)
    assert part["removed"] > 0
    again = merge(stocked, "site", ["west"]).json()
    assert (again["changed"], again["removed"]) == (0, 0)


@pytest.mark.slow
def test_merge_again_takes_a_map_put_under_the_same_name(
    stocked: Any, maps: dict[str, CompactMap], manifest: Manifest
) -> None:
    merge(stocked, "site", ["east", "west"], deduplicate=False)
    other = driven(manifest.model_id, "west", 60, 210, seed=9, time=1.6e9)
    put_anew(stocked, "west", other)
    told = merge(stocked, "site", ["west"], deduplicate=False).json()
    (part,) = told["parts"]
    assert [part[key] for key in ("added", "known", "removed")] == [
        len(other), 0, len(maps["west"]),
    ]  # fmt: skip
    assert_lies_as_driven(content(stocked), {"east": maps["east"], "west": other}, "east")


def test_merge_again_moves_corrected_segments(stocked: Any, maps: dict[str, CompactMap]) -> None:
    """Return the map after a loop closure: some sensor positions and their segments are moved."""
    west = maps["west"]
    merge(stocked, "site", ["east", "west"], deduplicate=False)
    bent = west.frame_index < 4
    move = np.array([0.0, 2.0, 0.0])
    positions, centroids = west.frame_positions.copy(), west.centroids.copy()
    positions[:4] += move
    centroids[bent] += move
    put_anew(stocked, "west", replace(west, frame_positions=positions, centroids=centroids))
    (part,) = merge(stocked, "site", ["west"], deduplicate=False).json()["parts"]
    count = int(bent.sum())
    assert [part[key] for key in ("added", "known", "removed")] == [
        count, len(west) - count, count,
    ]  # fmt: skip
    (part,) = merge(stocked, "site", ["west"], deduplicate=False).json()["parts"]
    assert [part[key] for key in ("added", "known", "removed")] == [0, len(west), 0]


@pytest.mark.slow
def test_only_the_source_map_replaces_a_segment(stocked: Any, maps: dict[str, CompactMap]) -> None:
    """Otherwise two maps with different versions would undo each other's segment forever."""
    merge(stocked, "inner", ["west", "north"], deduplicate=False)
    merge(stocked, "site", ["east", "inner"], deduplicate=False)
    put_anew(stocked, "west", described_anew(maps["west"], np.arange(20)))
    first = merge(stocked, "site", ["west", "inner"], deduplicate=False).json()
    west, inner = first["parts"]
    assert (west["added"], west["removed"]) == (20, 20)
    assert (inner["added"], inner["removed"]) == (0, 0)
    again = merge(stocked, "site", ["west", "inner"], deduplicate=False).json()
    assert (again["changed"], again["removed"]) == (0, 0)


def test_merged_map_in_a_merged_map_keeps_provenance(stocked: Any) -> None:
    merge(stocked, "inner", ["west", "north"], deduplicate=False)
    told = merge(stocked, "site", ["east", "inner"], deduplicate=False).json()
    site = content(stocked)
    assert site.sources == ("east", "north", "west")
    assert told["segments"] == len(site)
    # So a map merged through another merged map is known.
    again = merge(stocked, "site", ["west"], deduplicate=False).json()
    (part,) = again["parts"]
    assert (part["added"], part["removed"], again["changed"]) == (0, 0, 0)
    assert part["known"] == len(content(stocked, "west"))


def test_segments_written_to_the_merged_map_stay(stocked: Any) -> None:
    merge(stocked, "site", ["east", "west"])
    own = take(content(stocked, "east"), np.arange(5))
    own = replace(own, ids=own.ids + np.uint32(90_000))
    edited(stocked, "site", own)
    merge(stocked, "site", ["north"])
    assert Counter(name for name, _ in origins(content(stocked)))[""] == 5


def test_map_that_cannot_be_aligned_is_left_out(stocked: Any, manifest: Manifest) -> None:
    put(stocked, "far", driven(manifest.model_id, "north", 300, 340, robot="far"))
    told = merge(stocked, "site", ["east", "west", "far"]).json()
    far = told["parts"][2]
    assert not far["merged"]
    assert far["pose"] is None
    assert far["added"] == far["known"] == far["repeats"] == 0
    reasons = {(each["map"], each["other"]): each["reason"] for each in told["alignments"]}
    assert reasons["east", "far"] == "inconsistent"
    assert content(stocked).sources == ("east", "west")

    before = stocked.get("/maps").json()
    for site in ("site", "new"):
        names = ["far"] if site == "site" else ["east", "far"]
        refused = merge(stocked, site, names)
        assert_problem(refused, 409, "not-aligned", "nothing was changed")
        would = merge(stocked, site, names, dry_run=True)
        assert would.status_code == 200
        assert not would.json()["parts"][-1]["merged"]
    assert stocked.get("/maps").json() == before


def test_map_is_prepared_once_for_all_alignments(
    stocked: Any, maps: dict[str, CompactMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    names = [*maps]
    for name, each in maps.items():  # so that none has an index over all of it
        edited(stocked, name, take(each, np.arange(0)), [3])
    joined, indexed = [], []
    content = MapLayers.content

    def counted(layers: MapLayers) -> CompactMap:
        joined.append(layers)
        return content(layers)

    def indexing(codes: Any, quantizer: Any) -> Any:
        indexed.append(len(codes))
        return index_of(codes, quantizer)

    monkeypatch.setattr(MapLayers, "content", counted)
    monkeypatch.setattr("service.merging.alignment.index_of", indexing)
    told = merge(stocked, "site", names)
    assert told.status_code == 201, told.text
    assert all(part["merged"] for part in told.json()["parts"])
    assert len(joined) == len(names)
    # No map is aligned with the last one.
    assert indexed == [len(maps[name]) - 1 for name in names[:-1]]


@pytest.fixture
def misled(monkeypatch: pytest.MonkeyPatch) -> None:
    """Align east and west wrongly, with a high score."""
    real = alignment.align_maps

    def wrong(a: Any, b: Any, *rest: Any) -> Any:
        found = real(a, b, *rest)
        if {a.snapshot.name, b.snapshot.name} == {"east", "west"} and found.best is not None:
            away = Pose.of_yaw(1.0, np.array([30.0, 0.0, 0.0])).after(found.best.pose)
            best = replace(found.best, pose=away, score=1e6)
            found = MapAlignment(best, None, None, "")
        return found

    monkeypatch.setattr(merging, "align_maps", wrong)


def test_alignment_that_breaks_a_loop_is_rejected(
    misled: None, stocked: Any, maps: dict[str, CompactMap], manifest: Manifest
) -> None:
    put(stocked, "south", driven(manifest.model_id, "north", 40, 190, robot="south", seed=7))
    told = merge(stocked, "site", ["east", "west", "north", "south"], deduplicate=False).json()
    rejected = [each for each in told["alignments"] if each["rejected"]]
    assert [(each["map"], each["other"]) for each in rejected] == [("east", "west")]
    assert not rejected[0]["proven"]
    assert all(each["proven"] for each in told["alignments"] if not each["rejected"])
    assert any(not loop["closes"] for loop in told["loops"])
    site = content(stocked)
    rows = rows_from(site, "west")
    assert len(rows) == len(maps["west"])
    part = take(site, np.sort(np.concatenate([rows, rows_from(site, "east")])))
    assert_lies_as_driven(part, maps, "east")


def test_wrong_alignment_of_three_maps_is_found_by_overlap(
    misled: None, stocked: Any, maps: dict[str, CompactMap]
) -> None:
    told = merge(stocked, "site", ["east", "west", "north"], deduplicate=False).json()
    rejected = [each for each in told["alignments"] if each["rejected"]]
    assert [(each["map"], each["other"]) for each in rejected] == [("east", "west")]
    assert not any(each["proven"] for each in told["alignments"])
    (loop,) = told["loops"]
    assert not loop["closes"]
    assert all(part["merged"] for part in told["parts"])
    assert_lies_as_driven(content(stocked), maps, "east")


def test_undecided_loop_merges_none_of_its_alignments(
    misled: None, stocked: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(merging, "fits_as_well", lambda *_: False)
    names = ["east", "west", "north"]
    assert_problem(merge(stocked, "site", names), 409, "not-aligned", "nothing was changed")
    told = merge(stocked, "site", names, dry_run=True).json()
    assert [each["rejected"] for each in told["alignments"]] == [True] * 3
    assert not any(part["merged"] for part in told["parts"])


def test_merge_under_an_outdated_etag_fails(stocked: Any) -> None:
    stale = {"If-Match": '"0123456789abcdef-1"'}
    assert_problem(
        merge(stocked, "site", ["east", "west"], headers=stale), 412, "precondition-failed"
    )
    assert stocked.get("/maps/site").status_code == 404
    new = {"If-None-Match": "*"}
    first = merge(stocked, "site", ["east", "west"], headers=new)
    assert first.status_code == 201
    before = stocked.get("/maps/site").content
    for headers in (stale, new):
        refused = merge(stocked, "site", ["north"], headers=headers)
        assert_problem(refused, 412, "precondition-failed")
    assert stocked.get("/maps/site").content == before
    seen = {"If-Match": first.headers["etag"]}
    assert merge(stocked, "site", ["north"], headers=seen).status_code == 200


@pytest.mark.parametrize(
    ("body", "pointer"),
    [
        ({}, "maps"),
        ({"maps": []}, "maps"),
        ({"maps": ["east"]}, "two maps or more"),
        ({"maps": ["east", "east"]}, "is named twice"),
        ({"maps": ["east", "site"]}, "is the merged map itself"),
        ({"maps": ["east", "-bad"]}, "maps"),
        ({"maps": ["east", 7]}, "maps"),
        ({"maps": "east"}, "maps"),
        ({"maps": ["east", "west"], "dryrun": True}, "dryrun"),
        ({"maps": ["east", "west"], "dry_run": 1}, "dry_run"),
        ({"maps": ["east", "west"], "deduplicate": None}, "deduplicate"),
        ({"maps": ["east", "west"], "motion": "any"}, "motion"),
        ({"maps": [f"m{n}" for n in range(13)]}, "the limit is 12"),
        ([], ""),
        ("site", ""),
    ],
)
def test_invalid_merge_request_is_refused(stocked: Any, body: Any, pointer: str) -> None:
    before = stocked.get("/maps").json()
    answer = stocked.post("/maps/site/merge", json=body)
    assert answer.status_code == 422, answer.text
    assert pointer in answer.text
    assert stocked.get("/maps").json() == before


@pytest.mark.parametrize("body", [b"", b"{", b"\xff\xfe", b"NaN", b'{"maps": ["a", "b"]'])
def test_merge_body_that_is_not_json_is_refused(stocked: Any, body: bytes) -> None:
    answer = stocked.post(
        "/maps/site/merge", content=body, headers={"Content-Type": "application/json"}
    )
    assert 400 <= answer.status_code < 500, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    packed = {"Content-Type": "application/msgpack"}
    assert_problem(
        stocked.post("/maps/site/merge", content=b"\x80", headers=packed),
        415,
        "unsupported-media-type",
    )


def test_maps_that_cannot_be_merged_are_refused(
    start: Any, maps: dict[str, CompactMap], other_manifest: Manifest
) -> None:
    with start(also=["other"]) as service:
        put(service, "east", maps["east"])
        assert_problem(merge(service, "site", ["east", "none"]), 404, "unknown-map", "none")
        bad = service.post("/maps/-bad/merge", json={"maps": ["east", "none"]})
        assert_problem(bad, 422, "invalid-map-name")
        put(service, "other", map_of(random_codes(20), other_manifest.model_id))
        assert_problem(merge(service, "site", ["east", "other"]), 409, "other-model")
        assert_problem(merge(service, "other", ["east"]), 409, "other-model")
        assert service.get("/maps/site").status_code == 404


def test_merge_needs_keys_for_all_maps(
    start: Any, tmp_path: Path, maps: dict[str, CompactMap]
) -> None:
    file = tmp_path / "keys.toml"
    writes, reads = made(file, "writer", "--write"), made(file, "reader")
    bound = made(file, "bound", "--write", "--map", "site", "--map", "east")
    robots = made(file, "robot", "--write", "--robot", "east robot")
    with start(keys_file=file) as service:
        for name, each in maps.items():
            put(service, name, each, **writes)
        for headers in (reads, bound, robots):
            refused = merge(service, "site", ["east", "west"], headers=headers)
            assert_problem(refused, 403, "forbidden")
        assert_problem(merge(service, "north", ["east"], headers=bound), 403, "forbidden")
        assert_problem(merge(service, "site", ["east", "west"]), 401, "unauthorized")
        assert service.get("/maps/site", headers=writes).status_code == 404
        assert merge(service, "site", ["east", "west"], headers=writes).status_code == 201
        # A robot key cannot add other robots' segments to an existing merged map.
        assert_problem(merge(service, "site", ["north"], headers=robots), 403, "forbidden")


def test_merge_over_quota_is_refused(start: Any, maps: dict[str, CompactMap]) -> None:
    most = max(map(len, maps.values()))
    with start(limits={"map_segments": most + 20}) as service:
        for name, each in maps.items():
            put(service, name, each)
        before = service.get("/maps").json()
        refused = merge(service, "site", ["east", "west"], deduplicate=False)
        assert_problem(refused, 507, "quota-exceeded", "The map would have")
        assert service.get("/maps").json() == before


def meanwhile(monkeypatch: pytest.MonkeyPatch, act: Callable[[], Any]) -> None:
    """Run a function once between the alignments and the write."""
    real, acts = merging.plan_merge, [act]

    def then(*args: Any) -> Any:
        plan = real(*args)
        if acts:
            acts.pop()()
        return plan

    monkeypatch.setattr("service.merging.merge.plan_merge", then)


@pytest.mark.slow
def test_merge_into_a_map_replaced_meanwhile_fails(
    stocked: Any, maps: dict[str, CompactMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    def replaced() -> None:
        put_anew(stocked, "site", maps["north"])

    def put_and_forgotten() -> None:
        replaced()
        edited(stocked, "site", take(maps["north"], NONE), [3])
        assert stocked.post("/maps/site/compact?keep=1").is_success

    def removed() -> None:
        assert stocked.delete("/maps/site").status_code == 204

    def removed_and_made_anew() -> None:
        removed()
        put(stocked, "site", maps["north"])

    def restored() -> None:
        assert stocked.post("/maps/site/versions/1/restore").status_code == 200

    for act in (replaced, put_and_forgotten, removed, removed_and_made_anew, restored):
        stocked.delete("/maps/site")
        merge(stocked, "site", ["east", "north"])
        edited(stocked, "site", take(content(stocked), NONE), [7])
        meanwhile(monkeypatch, act)
        answer = merge(stocked, "site", ["west"])
        assert_problem(answer, 409, "map-changed", "Try again")
        now = stocked.get("/maps/site")
        assert now.status_code == 404 or "west" not in decode(now.content).sources


def test_merge_into_a_map_created_meanwhile_fails(
    stocked: Any, maps: dict[str, CompactMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    meanwhile(monkeypatch, lambda: put(stocked, "site", maps["north"]))
    assert_problem(merge(stocked, "site", ["east", "west"]), 409, "map-changed")
    assert stocked.get("/maps/site").content == encode(maps["north"])


def test_empty_merged_map_takes_the_frame_of_the_first_map(
    stocked: Any, maps: dict[str, CompactMap], monkeypatch: pytest.MonkeyPatch
) -> None:
    put(stocked, "site", take(maps["north"], NONE))
    # The pose of segments written in the meantime is unknown.
    meanwhile(monkeypatch, lambda: edited(stocked, "site", take(maps["north"], np.arange(4))))
    assert_problem(merge(stocked, "site", ["east", "west"]), 409, "map-changed")
    edited(stocked, "site", take(maps["north"], NONE), np.arange(4))
    told = merge(stocked, "site", ["east", "west"], deduplicate=False)
    assert told.status_code == 200, told.text
    assert told.json()["frame"] == content(stocked).frame == "east's odometry"
    assert_lies_as_driven(content(stocked), maps, "east")
    before = told.json()["previous"]
    assert stocked.post(f"/maps/site/versions/{before}/restore").status_code == 200
    assert len(content(stocked)) == 0
    assert content(stocked).frame == "north's odometry"


def test_edits_during_a_merge_are_kept(stocked: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    merge(stocked, "site", ["east", "north"])
    own = take(content(stocked, "east"), np.arange(3))
    own = replace(own, ids=own.ids + np.uint32(70_000))
    meanwhile(monkeypatch, lambda: edited(stocked, "site", own, [7]))
    told = merge(stocked, "site", ["west"])
    assert told.status_code == 200, told.text
    assert (told.json()["previous"], told.json()["sequence"]) == (2, 3)
    now = content(stocked)
    assert set(own.ids.tolist()) <= set(now.ids.tolist())
    assert 7 not in now.ids
    assert "west" in now.sources


def test_merged_map_survives_a_restart(start: Any, maps: dict[str, CompactMap]) -> None:
    with start() as service:
        for name, each in maps.items():
            put(service, name, each)
        merge(service, "site", ["east", "west"])
        merge(service, "site", ["north"])
        before = [service.get(path) for path in ("/maps", "/maps/site", "/maps/site?version=1")]
    with start() as service:
        after = [service.get(path) for path in ("/maps", "/maps/site", "/maps/site?version=1")]
        assert [each.content for each in after] == [each.content for each in before]
        assert merge(service, "site", ["north"]).json()["changed"] == 0


def test_late_merge_is_not_written(stocked: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    asked: list[str] = []
    real = alignment.align_maps

    def slow(a: Any, b: Any, *rest: Any) -> Any:
        asked.append(b.snapshot.name)
        threading.Event().wait(0.3)
        return real(a, b, *rest)

    monkeypatch.setattr(merging, "align_maps", slow)
    late = {"Placecell-Timeout": "0.2"}
    refused = merge(stocked, "site", ["east", "west", "north"], headers=late)
    assert_problem(refused, 504, "deadline-exceeded")
    assert len(asked) == 1
    assert stocked.get("/maps/site").status_code == 404


def test_merge_is_recorded_in_the_audit_log(stocked: Any, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level("INFO")
    told = merge(stocked, "site", ["east", "west"]).json()
    (line,) = [one for one in caplog.records if one.name == "placecell.audit"]
    assert f"merge map site, {told['changed']} segments changed" in line.getMessage()
