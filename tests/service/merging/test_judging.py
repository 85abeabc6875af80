"""A merge confirms the segments that a later map saw, and finds that others are gone."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, decode, originated
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import apply, difference, take

from placecell.descriptors.manifest import Manifest
from placecell.lasting import judgment
from placecell.localization import Pose
from placecell.map_alignment import AlignmentParameters
from service.maps.writes.deduplication import SameView
from service.maps.writes.long_life import MOST_CAPTURES, PASS_SECONDS
from service.merging import judging
from service.merging.join import ROUNDED, MergePart, join_settled
from service.merging.judging import judged_map
from tests.service.maps.test_long_life import CAR, CENTERS, DAY, HOUSE, POST, SIDES, WALL
from tests.service.merging.drifting_maps import drifting_map
from tests.service.merging.merged_map_builders import driven, merge, models_that_judge, put
from tests.service.service_builders import map_of, random_codes

NONE = np.zeros(0, np.uint32)
PARAMETERS = AlignmentParameters()


@pytest.fixture(scope="module")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "tiny")


def drive(manifest: Manifest, rows: list[int], days: float, captures: int = 1) -> CompactMap:
    """Return the map of a robot that saw some of the segments, all from its last capture."""
    given = map_of(random_codes(4, seed=3), manifest.model_id)
    times = 1e9 + days * DAY - np.arange(captures, dtype=np.float64)[::-1]
    street = replace(
        given,
        centroids=np.array(CENTERS),
        ids=np.arange(4, dtype=np.uint32),
        frame_index=np.full(4, captures - 1, np.uint32),
        frame_times=times,
        frame_positions=np.tile([0.0, 0.0, 1.8], (captures, 1)),
        frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (captures, 1)),
        extents=np.array(SIDES, np.uint8),
    )
    return canonical(take(street, np.array(rows)))


def parts_of(**drives: CompactMap) -> list[MergePart]:
    """Return maps of one frame as parts of a merge."""
    pose = Pose(np.eye(3), np.zeros(3))
    return [MergePart(name, originated(each, name), pose, ROUNDED) for name, each in drives.items()]


def merged(
    manifest: Manifest, before: CompactMap | None, parts: list[MergePart], views: bool = False
) -> CompactMap:
    """Join and judge maps as a merge does; `views` keeps all views."""
    first = parts[0].content
    target = take(first, NONE) if before is None else before
    first_id = 0 if before is None else int(before.ids.max()) + 1
    same = None if views else SameView.of(manifest)
    content, _ = join_settled(target, parts, first_id, same, PARAMETERS)
    return judged_map(content, before, parts, PARAMETERS).content


def counts(content: CompactMap) -> dict[int, tuple[int, int]]:
    """Return confirmations and misses of Monday's segments."""
    assert content.source is not None
    assert content.source_ids is not None
    assert content.confirmed is not None
    assert content.absent is not None
    rows = np.flatnonzero(content.source == content.sources.index("monday") + 1)
    found = zip(content.confirmed[rows].tolist(), content.absent[rows].tolist(), strict=True)
    return dict(zip(content.source_ids[rows].tolist(), found, strict=True))


def is_same(one: CompactMap, other: CompactMap) -> bool:
    changed, removed = difference(one, other)
    return not len(changed) and not len(removed)


ALL = [CAR, WALL, HOUSE, POST]
GONE = {CAR: (0, 1), WALL: (1, 0), HOUSE: (1, 0), POST: (0, 0)}


@pytest.mark.parametrize("views", [False, True])
@pytest.mark.parametrize("order", [("monday", "tuesday"), ("tuesday", "monday")])
def test_later_map_confirms_and_misses_in_any_order(
    manifest: Manifest, order: tuple[str, str], views: bool
) -> None:
    drives = {"monday": drive(manifest, ALL, 0), "tuesday": drive(manifest, [WALL, HOUSE], 1)}
    parts = parts_of(**{name: drives[name] for name in order})
    site = merged(manifest, None, parts, views)
    if order[0] == "monday" or views:
        assert counts(site) == GONE
    else:  # Tuesday's views came first; Monday's are repeats of them, and confirm nothing
        assert counts(site) == {CAR: (0, 1), POST: (0, 0)}
    assert site.missed is not None
    assert sorted(site.missed.tolist())[-2:] == [0, 1e9 + DAY]
    assert is_same(merged(manifest, site, parts, views), site)
    assert is_same(merged(manifest, site, parts[::-1], views), site)


def test_maps_merged_one_after_the_other_are_judged_as_those_merged_together(
    manifest: Manifest,
) -> None:
    monday, tuesday = drive(manifest, ALL, 0), drive(manifest, [WALL, HOUSE], 1)
    wednesday = drive(manifest, [CAR, WALL], 2)  # the car is back
    parts = parts_of(monday=monday, tuesday=tuesday, wednesday=wednesday)
    first = merged(manifest, None, parts[:2])
    assert counts(first) == GONE
    second = merged(manifest, first, parts[2:])
    assert counts(second) == {CAR: (1, 0), WALL: (2, 0), HOUSE: (1, 0), POST: (0, 0)}
    assert is_same(merged(manifest, second, parts), second)


def test_passes_of_one_map_are_judged_in_order_of_time(manifest: Manifest) -> None:
    days = [drive(manifest, rows, day) for day, rows in enumerate([ALL, [WALL], [WALL, HOUSE]])]
    whole = days[0]
    for number, each in enumerate(days[1:], start=1):
        fresh = replace(each, ids=each.ids + np.uint32(10 * number))
        whole = apply(whole, Delta(canonical(fresh), NONE))
    site = merged(manifest, None, parts_of(monday=whole), views=True)
    found = counts(site)
    assert {each: found[each] for each in ALL} == {
        CAR: (0, 2),
        WALL: (2, 0),
        HOUSE: (1, 0),
        POST: (0, 0),
    }


def test_maps_of_one_hour_do_not_judge_each_other(manifest: Manifest) -> None:
    later = drive(manifest, [WALL, HOUSE], PASS_SECONDS / DAY)
    site = merged(manifest, None, parts_of(monday=drive(manifest, ALL, 0), tuesday=later))
    assert site.absent is None


def test_map_without_boxes_judges_nothing(manifest: Manifest) -> None:
    monday, tuesday = drive(manifest, ALL, 0), drive(manifest, [WALL, HOUSE], 1)
    plain = replace(tuesday, extents=None)
    site = merged(manifest, None, parts_of(monday=monday, tuesday=plain), views=True)
    assert site.absent is None
    bare = replace(monday, extents=None)
    assert merged(manifest, None, parts_of(monday=bare, tuesday=plain)).confirmed is None


def test_map_whose_segments_lie_elsewhere_in_the_merged_map_judges_nothing(
    manifest: Manifest,
) -> None:
    parts = parts_of(monday=drive(manifest, ALL, 0), tuesday=drive(manifest, [WALL, HOUSE], 1))
    content, _ = join_settled(take(parts[0].content, NONE), parts, 0, None, PARAMETERS)
    assert judged_map(content, None, parts, PARAMETERS).content.absent is not None
    # As an optimization does with maps without odometry.
    moved = content.centroids + [0.0, 1.0, 0.0] * (np.asarray(content.source) == 2)[:, None]
    bent = canonical(replace(content, centroids=moved))
    assert judged_map(bent, None, parts, PARAMETERS).content.absent is None


def test_counts_of_a_map_follow_into_the_merged_map(manifest: Manifest) -> None:
    monday = drive(manifest, ALL, 0)
    other = parts_of(tuesday=drive(manifest, [WALL], 1))
    site = merged(manifest, None, [*parts_of(monday=monday), *other], views=True)
    assert counts(site)[CAR] == (0, 1)
    # Two later passes wrote to Monday's own map: the house was seen, the car missed once more.
    told = replace(
        monday,
        seen=np.array([1e9, 1e9, 1e9 + 3 * DAY, 1e9], np.uint32),
        missed=np.array([1e9 + 3 * DAY, 0, 0, 0], np.uint32),
        confirmed=np.array([0, 0, 2, 0], np.uint8),
        absent=np.array([2, 0, 0, 0], np.uint8),
    )
    again = [*parts_of(monday=canonical(told)), *other]
    after = merged(manifest, site, again, views=True)
    assert counts(after) == {CAR: (0, 2), WALL: (1, 0), HOUSE: (2, 0), POST: (0, 0)}
    assert is_same(merged(manifest, after, again, views=True), after)
    # An older state of the map takes nothing back.
    older = [*parts_of(monday=monday), *other]
    assert is_same(merged(manifest, after, older, views=True), after)


def test_work_of_a_merge_is_bounded(manifest: Manifest, monkeypatch: pytest.MonkeyPatch) -> None:
    captures = 3 * MOST_CAPTURES
    given = map_of(random_codes(captures, seed=5), manifest.model_id)
    later = canonical(
        replace(
            given,
            centroids=np.tile(CENTERS[WALL], (captures, 1)),
            ids=np.arange(captures, dtype=np.uint32),
            frame_index=np.arange(captures, dtype=np.uint32),
            frame_times=1e9 + DAY + np.arange(captures, dtype=np.float64),
            frame_positions=np.tile([0.0, 0.0, 1.8], (captures, 1)),
            frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (captures, 1)),
            extents=np.tile(np.array(SIDES[WALL], np.uint8), (captures, 1)),
        )
    )
    parts = parts_of(monday=drive(manifest, ALL, 0), tuesday=later)
    compared = []
    judged_from = judgment._judged_from

    def counting(viewpoint: Any, stored: Any, around: Any, own: Any) -> Any:
        compared.append(len(stored) * len(around))
        return judged_from(viewpoint, stored, around, own)

    monkeypatch.setattr(judgment, "_judged_from", counting)
    whole = counts(merged(manifest, None, parts, views=True))
    everything = sum(compared)
    compared.clear()
    monkeypatch.setattr(judging, "MOST_PAIRS_OF_A_MERGE", everything // 10)
    assert counts(merged(manifest, None, parts, views=True)) == whole == GONE | {HOUSE: (0, 0)}
    assert 0 < sum(compared) <= everything // 10


def test_rigid_merge_confirms_once(service: Any, manifest: Manifest) -> None:
    for number, name in enumerate(("east", "west")):
        made = driven(manifest.model_id, name, 0, 100, time=1e9 + number * DAY)
        put(service, name, replace(made, extents=np.full((len(made), 3), 3, np.uint8)))
    tried = merge(service, "site", ["east", "west"], dry_run=True).json()
    site = confirmed_site(service, rigid=True)
    assert tried["segments"] == len(site)
    again = merge(service, "site", ["east", "west"]).json()
    assert again["sequence"] == again["previous"], again
    assert merge(service, "views", ["east", "west"], deduplicate=False).status_code == 201
    assert decode(service.get("/maps/views").content).confirmed is None


def test_merge_that_bends_judges_segments_where_they_lie_after_it(
    service: Any, manifest: Manifest
) -> None:
    pytest.importorskip("gtsam")
    for number, name in enumerate(("east", "west")):
        made, _ = drifting_map(
            manifest.model_id, number + 1, laps=1, robot=name, odometry=True, side=16
        )
        times = made.frame_times + number * DAY
        boxes = np.full((len(made), 3), 3, np.uint8)
        put(service, name, replace(made, frame_times=times, extents=boxes))
    confirmed_site(service, rigid=False)


def confirmed_site(service: Any, rigid: bool) -> CompactMap:
    """Merge the maps of two days; all that stands there is confirmed once, nothing is absent."""
    answer = merge(service, "site", ["east", "west"], rigid=rigid)
    assert answer.status_code == 201, answer.text
    site = decode(service.get("/maps/site").content)
    assert site.source is not None
    assert site.confirmed is not None
    assert site.absent is not None
    east = np.asarray(site.source) == site.sources.index("east") + 1
    assert (site.confirmed[east] == 1).mean() > 0.8
    assert not site.confirmed[~east].any()
    assert not site.absent.any()
    return site
