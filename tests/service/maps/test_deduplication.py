"""Deduplication: an object is stored once from each viewpoint."""

import tracemalloc
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from placecell_client import CompactMap, Delta, decode, encode, encode_delta
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import apply, empty, take, with_optional

from placecell.core.cancellation import Cancelled, CancelToken, cancelled_by
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.quantizer import Quantizer
from service.maps.writes import deduplication
from service.maps.writes.deduplication import (
    NONE,
    RADIUS,
    SAME_VIEW,
    SAME_VIEWPOINT,
    VIEWS,
    Deduplicated,
    SameView,
    deduplicate,
)
from tests.service.core.test_auth import made
from tests.service.service_builders import assert_problem

QUANTIZER = Quantizer(1.0)
NOTHING = empty("m", "1", "town", 7)


def seen_at(
    time: float,
    ids: list[int],
    places: list[float],
    codes: list[int],
    robot: str = "ann",
    model_id: str = "m",
    stand: float | None = None,
) -> CompactMap:
    """Return segments of one time: positions along x in meters, and the value of all their codes.

    The viewpoint is `stand`, meters along y; by default it changes with the time.
    """
    n = len(ids)
    return canonical(
        CompactMap(
            model_id=model_id,
            preprocessing="1",
            frame="town",
            codes=np.repeat(np.array(codes, np.int8).reshape(n, 1), 7, axis=1),
            centroids=np.column_stack([places, np.zeros((n, 2))]).astype(np.float64),
            ids=np.array(ids, np.uint32),
            robots=(robot,),
            robot=np.zeros(n, np.uint16),
            frame_index=np.zeros(n, np.uint32),
            frame_times=np.array([time]),
            frame_positions=np.array([[0.0, 6 * (time % 40) if stand is None else stand, 0.0]]),
            frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
        )
    )


def joined(*parts: CompactMap) -> CompactMap:
    whole = parts[0]
    for part in parts[1:]:
        whole = apply(whole, Delta(part, NONE))
    return whole


def look(upload: CompactMap, stored: CompactMap = NOTHING, views: int = 3) -> Deduplicated:
    # Codes that differ by 1 are 7 ** 0.5 steps apart.
    return deduplicate(upload, stored, SameView(QUANTIZER, 2 * 7**0.5), views=views)


def told(content: CompactMap) -> list[tuple[int, int, int]]:
    """Return id, `views` and `seen` of each segment."""
    assert content.views is not None
    assert content.seen is not None
    return list(
        zip(content.ids.tolist(), content.views.tolist(), content.seen.tolist(), strict=True)
    )


STORED = joined(seen_at(10, [1, 2], [0.0, 5.0], [0, 0]))


@pytest.mark.parametrize(
    ("place", "code", "expected", "repeats"),
    [
        (0.4, 2, [(1, 1, 20)], 1),  # the same again: it was seen
        (0.4, 3, [(7, 1, 20)], 0),  # there, but it looks different: another view
        (0.6, 0, [(7, 7, 20)], 0),  # elsewhere: another thing
        (-0.4, -2, [(1, 1, 20)], 1),
    ],
)
def test_segment_is_a_repeat_a_view_or_a_new_object(
    place: float, code: int, expected: list[tuple[int, int, int]], repeats: int
) -> None:
    found = look(seen_at(20, [7], [place], [code]), STORED)
    assert told(found.changed) == expected
    assert found.repeats == repeats
    assert found.refreshed.tolist() == [1] * repeats


@pytest.mark.parametrize(("stand", "repeats"), [(4.9, 1), (5.1, 0), (-4.9, 1)])
def test_segment_seen_from_the_same_viewpoint_is_a_repeat(stand: float, repeats: int) -> None:
    stored = joined(seen_at(10, [1], [0.0], [0], stand=0.0))
    found = look(seen_at(20, [7], [0.1], [50], stand=stand), stored)
    assert found.repeats == repeats
    # The viewpoint is compared with all views of the object, not only with the most similar one.
    far = joined(stored, look(seen_at(15, [2], [0.0], [60], stand=30.0), stored).changed)
    found = look(seen_at(20, [7], [0.1], [57], stand=stand), far)
    assert found.repeats == repeats
    assert found.refreshed.tolist() == [2] * repeats


def test_object_keeps_a_limited_number_of_views() -> None:
    upload = joined(*(seen_at(20 + step, [10 + step], [0.1], [10 * step]) for step in range(6)))
    found = look(upload, STORED)
    assert told(found.changed) == [(1, 1, 20), (11, 1, 21), (12, 1, 25)]
    assert found.repeats == 4
    alone = look(upload, STORED, views=1)
    assert told(alone.changed) == [(1, 1, 25)]


def test_segments_seen_at_the_same_time_are_different_objects() -> None:
    found = look(seen_at(20, [7, 8], [0.1, 0.2], [50, 50]), STORED)
    assert told(found.changed) == [(7, 1, 20), (8, 1, 20)]
    again = look(seen_at(10, [7], [0.1], [0]), STORED)
    assert told(again.changed) == [(7, 7, 10)]


def test_upload_is_compared_with_itself_in_order_of_time() -> None:
    upload = joined(seen_at(30, [1], [0.0], [0]), seen_at(20, [9], [0.1], [0]))
    assert told(look(upload).changed) == [(9, 9, 30)]


def test_replaced_segment_stays_a_view_of_its_object() -> None:
    stored = apply(STORED, Delta(look(seen_at(20, [7], [0.1], [50]), STORED).changed, NONE))
    found = look(seen_at(15, [7], [0.2], [60]), stored)
    assert told(found.changed) == [(7, 1, 20)]
    assert found.changed.codes[0, 0] == 60
    assert found.repeats == 0


def test_earlier_segment_does_not_lower_seen() -> None:
    found = look(seen_at(5, [7], [0.1], [0]), STORED)
    assert (len(found.changed), found.repeats) == (0, 1)


def test_empty_upload_changes_nothing() -> None:
    for stored in (NOTHING, STORED):
        found = look(NOTHING, stored)
        assert (len(found.changed), found.repeats) == (0, 0)
        assert set(found.changed.optional) == {"views", "seen"}


def seen_together(time: int, first: int, things: list[tuple[float, int]]) -> CompactMap:
    """Return segments of one time: ids from `first` on, with position and code of each."""
    places, codes = zip(*things, strict=True)
    return seen_at(time, list(range(first, first + len(things))), [*places], [*codes])


MOMENTS = st.lists(
    st.builds(
        seen_together,
        st.integers(0, 9),
        st.integers(0, 40),
        st.lists(st.tuples(st.floats(-2, 2), st.integers(-9, 9)), min_size=1, max_size=6),
    ),
    min_size=1,
    max_size=5,
)


@pytest.mark.slow
@given(MOMENTS, MOMENTS)
@settings(max_examples=100, deadline=None)
def test_stored_segment_is_known_to_later_uploads(
    first: list[CompactMap], second: list[CompactMap]
) -> None:
    stored = apply(NOTHING, Delta(look(joined(*first)).changed, NONE))
    upload = joined(*second)
    found = look(upload, stored)
    after = apply(stored, Delta(found.changed, NONE))
    # The repeated upload changes nothing.
    again = look(upload, after)
    assert encode(apply(after, Delta(again.changed, NONE))) == encode(after)
    # Nothing is lost: each segment is stored, or one near it was seen at that time or later.
    assert after.seen is not None
    for row, id_ in enumerate(upload.ids):
        if id_ in after.ids:
            continue
        near = np.abs(after.centroids[:, 0] - upload.centroids[row, 0]) <= RADIUS
        time = upload.frame_times[upload.frame_index[row]]
        assert (after.seen[near] >= time).any()
    assert {*stored.ids.tolist()} <= {*after.ids.tolist()}
    new = ~np.isin(upload.ids, stored.ids)
    assert found.repeats == new.sum() - np.isin(after.ids, upload.ids[new]).sum()


def test_deduplication_over_http(service: Any, manifest: Manifest) -> None:
    same = int(SAME_VIEW * manifest.pair_threshold / manifest.quantizer.step / 7**0.5)

    def send(time: float, ids: list[int], places: list[float], codes: list[int]) -> Any:
        upload = seen_at(time, ids, places, codes, model_id=manifest.model_id)
        return service.post(
            "/maps/site/segments?deduplicate=true&create=true",
            content=encode_delta(Delta(upload, NONE)),
        )

    first = send(10, [1, 2], [0.0, 5.0], [0, 0])
    assert (first.status_code, first.json()["repeats"], first.json()["segments"]) == (201, 0, 2)
    for _ in range(2):
        again = send(20, [3, 4], [0.1, 5.1], [same, 127])
        assert (again.status_code, again.json()["repeats"]) == (200, 1)
        assert (again.json()["segments"], again.json()["sequence"]) == (3, 2)
    stored = decode(service.get("/maps/site").content)
    assert told(stored) == [(1, 1, 20), (2, 2, 10), (4, 2, 20)]
    # An edit does not refresh segments that it removes.
    upload = seen_at(25, [5], [0.1], [0], model_id=manifest.model_id)
    instead = service.post(
        "/maps/site/segments?deduplicate=true",
        content=encode_delta(Delta(upload, np.array([1], np.uint32))),
    ).json()
    assert (instead["changed"], instead["removed"], instead["repeats"]) == (1, 1, 0)
    # Prune distinguishes segments that were seen again.
    assert service.post("/maps/site/age?unseen_since=15").json()["removed"] == 1
    plain = seen_at(30, [9], [0.1], [0], model_id=manifest.model_id)
    stored_all = service.post("/maps/site/segments", content=encode_delta(Delta(plain, NONE)))
    assert stored_all.json()["segments"] == 3


def test_robot_key_may_refresh_another_robots_segments(
    start: Any, manifest: Manifest, tmp_path: Path
) -> None:
    file = tmp_path / "keys.toml"
    keys = {name: made(file, name, "--write", "--robot", name) for name in ("ann", "zoe")}
    path = "/maps/site/segments?deduplicate=true&create=true"

    def send(robot: str, time: float, ids: list[int]) -> Any:
        upload = seen_at(time, ids, [0.0] * len(ids), [0] * len(ids), robot, manifest.model_id)
        content = encode_delta(Delta(upload, NONE))
        return service.post(path, content=content, headers=keys[robot])

    with start(keys_file=file) as service:
        assert send("ann", 10, [1]).status_code == 201
        assert send("zoe", 20, [2]).json()["repeats"] == 1
        stored = decode(service.get("/maps/site", headers=keys["ann"]).content)
        assert (told(stored), stored.robots) == ([(1, 1, 20)], ("ann",))
        # It may not replace them.
        assert_problem(send("zoe", 30, [1]), 403, "forbidden")


def test_nearby_segments_are_enough_to_deduplicate(manifest: Manifest) -> None:
    random = np.random.default_rng(0)
    stored = joined(
        *(
            seen_at(
                t, list(range(40 * t, 40 * t + 40)), random.uniform(-99, 99, 40).tolist(), [t] * 40
            )
            for t in range(5)
        )
    )
    upload = seen_at(9, list(range(900, 930)), random.uniform(20, 30, 30).tolist(), [4] * 30)
    near = take(stored, np.abs(stored.centroids[:, 0] - 25) < 6)
    whole, part = look(upload, stored), look(upload, near)
    assert encode(whole.changed) == encode(part.changed)
    assert whole.repeats == part.repeats > 0


def compared_with_all(
    upload: CompactMap, stored: CompactMap, same: SameView, itself: bool
) -> Deduplicated:
    """Deduplicate by comparing each segment with all others near it; the reference."""
    stored, given = (with_optional(each, ["views", "seen"]) for each in (stored, upload))
    known = take(stored, ~np.isin(stored.ids, given.ids))
    given = take(given, np.lexsort((given.ids, given.frame_times[given.frame_index])))
    rows = np.searchsorted(stored.ids, given.ids).clip(max=max(len(stored) - 1, 0))
    replaces = np.zeros(len(given), bool)
    if len(stored):
        replaces = stored.ids[rows] == given.ids
        latest = np.maximum(np.array(stored.seen)[rows], np.array(given.seen))
        given = replace(
            given,
            views=np.where(replaces, np.array(stored.views)[rows], np.array(given.views)),
            seen=np.where(replaces, latest, np.array(given.seen)),
        )
    both = [known, given]
    seen, things, codes, centroids = (
        np.concatenate([np.array(getattr(each, name)) for each in both])
        for name in ("seen", "views", "codes", "centroids")
    )
    moments = np.concatenate([each.frame_times[each.frame_index] for each in both])
    stands = np.concatenate([each.frame_positions[each.frame_index] for each in both])
    levels = same.quantizer.levels(codes).astype(np.float32)
    kept = list(range(len(known)))
    for row in range(len(known), len(seen)):
        apart = np.linalg.norm(centroids[kept] - centroids[row], axis=1)
        elsewhen = (moments[kept] != moments[row]) | (stands[kept] != stands[row]).any(axis=1)
        among = np.array(kept) < (len(seen) if itself else len(known))
        others = np.array(kept, dtype=int)[(apart <= RADIUS) & elsewhen & among]
        if len(others) and not replaces[row - len(known)]:
            distances = np.linalg.norm(levels[others] - levels[row], axis=1)
            nearest = others[distances.argmin()]
            of_it = others[things[others] == things[nearest]]
            away = np.linalg.norm(stands[of_it] - stands[row], axis=1).min()
            count = np.count_nonzero(things[kept] == things[nearest])
            if distances.min() <= same.steps or away <= SAME_VIEWPOINT or count >= VIEWS:
                seen[nearest] = max(seen[nearest], seen[row])
                continue
            things[row] = things[nearest]
        kept.append(row)
    again = seen[: len(known)] > np.array(known.seen)
    refreshed = take(replace(known, seen=seen[: len(known)]), again)
    rows = np.array(kept[len(known) :], dtype=int)
    new = take(
        replace(given, seen=seen[len(known) :], views=things[len(known) :]), rows - len(known)
    )
    changed = apply(refreshed, Delta(canonical(new), NONE))
    return Deduplicated(changed, refreshed.ids, len(given) - len(new))


def scattered(
    random: np.random.Generator, count: int, extent: float, first_id: int, moments: int
) -> CompactMap:
    """Return segments near one position, of several times, seen from a street beside it."""
    times = np.sort(random.integers(0, moments, count)).astype(float)
    stands = np.round(random.uniform(-20, 20, (moments, 3))) * (1, 1, 0)
    return canonical(
        CompactMap(
            model_id="m",
            preprocessing="1",
            frame="map",
            codes=random.integers(-40, 40, (count, 8)).astype(np.int8),
            centroids=random.uniform(-extent, extent, (count, 3)) * (1, 1, 0.2),
            ids=first_id
            + np.sort(random.choice(3 * count, count, replace=False)).astype(np.uint32),
            robots=("a",),
            robot=np.zeros(count, np.uint16),
            frame_index=times.astype(np.uint32),
            frame_times=np.arange(moments, dtype=float),
            frame_positions=stands,
            frame_orientations=np.tile(np.array([0, 0, 0, 1], np.float32), (moments, 1)),
        )
    )


@pytest.mark.parametrize("itself", [True, False])
@pytest.mark.parametrize("steps", [10.0, 40.0, 110.0])
@pytest.mark.parametrize(("extent", "moments"), [(0.3, 300), (1.0, 20), (3.0, 2), (15.0, 40)])
def test_A1_bounded_comparison_equals_full_comparison(
    extent: float, moments: int, steps: float, itself: bool
) -> None:
    same = SameView(Quantizer(0.01, 2), steps)
    for seed in range(4):
        random = np.random.default_rng(seed)
        upload = scattered(random, 160, extent, 0, moments)
        stored = scattered(random, 90, extent, int(random.choice([0, 1000])), moments)
        found = deduplicate(upload, stored, same, itself=itself)
        expected = compared_with_all(upload, stored, same, itself)
        assert encode(found.changed) == encode(expected.changed)
        assert found.refreshed.tolist() == expected.refreshed.tolist()
        assert found.repeats == expected.repeats


def peak_bytes(upload: CompactMap) -> int:
    """Return the peak memory of a comparison, without its arguments."""
    nothing, same = take(upload, slice(0)), SameView(Quantizer(0.01), 1.0)
    deduplicate(take(upload, slice(3)), nothing, same)
    tracemalloc.start()
    deduplicate(upload, nothing, same)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


@pytest.mark.parametrize("moments", [1, 30, 20_000], ids=["one-moment", "some", "all-differ"])
def test_A1_memory_is_linear_in_the_upload(moments: int) -> None:
    upload = scattered(np.random.default_rng(0), 20_000, 0.0, 0, moments)
    # A list of all neighbors would have 400 million entries: 3.2 GB.
    assert peak_bytes(upload) < 1_000 * len(upload)


@pytest.mark.parametrize("name", ["MOST_COMPARED", "MOST_VISITED"])
def test_A1_segment_is_compared_with_the_latest_segments(
    name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    # 60 objects of one time at one position; later segments look like the first of them.
    upload = scattered(np.random.default_rng(1), 61, 0.0, 0, 2)
    upload = replace(
        upload,
        frame_index=np.array([0] * 60 + [1], np.uint32),
        codes=np.array([0, *range(1, 60), 0], np.int8)[:, None],
    )
    same = SameView(Quantizer(0.01), 0.5)
    nothing = take(upload, slice(0))
    for most, repeats in ((60, 1), (59, 0), (0, 0)):
        monkeypatch.setattr(deduplication, name, most)
        assert deduplicate(upload, nothing, same, same_viewpoint=-1.0).repeats == repeats


def test_A1_comparison_stops_when_cancelled() -> None:
    upload = scattered(np.random.default_rng(2), 50, 1.0, 0, 50)
    with cancelled_by(CancelToken()) as token:
        token.cancel()
        with pytest.raises(Cancelled):
            deduplicate(upload, take(upload, slice(0)), SameView(Quantizer(0.01), 1.0))


def classed(content: CompactMap, *classes: int) -> CompactMap:
    return replace(content, classes=np.array(classes, np.uint8))


def test_repeat_gives_its_class_if_that_is_more_probable() -> None:
    stored = classed(seen_at(0, [1, 2, 3], [0, 10, 20], [0, 50, 100]), 100, 0, 121)
    again = classed(seen_at(0, [7, 8, 9], [0, 10, 20], [0, 50, 100], stand=1), 31, 40, 5)
    found = look(again, stored)
    # Building with 1.0 before vehicle with 0.2; a known class before unknown; 0.9 stays.
    assert found.repeats == 3
    assert found.changed.ids.tolist() == [1, 2]
    assert found.changed.classes is not None
    assert found.changed.classes.tolist() == [31, 40]
    # The same upload again changes nothing.
    after = apply(stored, Delta(found.changed, NONE))
    assert not len(look(again, after).changed)


def test_upload_without_classes_keeps_those_of_the_map() -> None:
    stored = classed(seen_at(0, [1], [0], [0]), 121)
    found = look(seen_at(0, [7, 8], [0, 30], [0, 50], stand=1), stored)
    after = apply(stored, Delta(found.changed, NONE))
    assert after.classes is not None
    assert (after.ids.tolist(), after.classes.tolist()) == ([1, 8], [121, 0])
    assert (
        look(seen_at(0, [7], [0], [0], stand=1), seen_at(0, [1], [0], [0])).changed.classes is None
    )


def test_replaced_segment_keeps_the_more_probable_class() -> None:
    stored = classed(seen_at(0, [1], [0], [0]), 121)
    found = look(classed(seen_at(9, [1], [0], [0]), 33), stored)
    assert found.changed.classes is not None
    assert found.changed.classes.tolist() == [121]
