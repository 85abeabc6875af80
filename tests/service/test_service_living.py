"""Things that are seen again: stored once, from every side that differs."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from placecell_client import CompactMap, Delta, decode, encode, encode_delta
from placecell_client.canonical import canonical
from placecell_client.map_edit import apply, empty, take

from segments.manifest import Manifest
from segments.quantiser import Quantiser
from service.living import NONE, RADIUS, SAME_VIEW, SameView, Sighting, sighting
from tests.service.service_builders import assert_problem
from tests.service.test_service_keys import made

QUANTISER = Quantiser(1.0)
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
    """Segments of one moment: places along x in metres, and what their codes all are.

    Seen from there, metres along y; from elsewhere at each time, unless said.
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


def look(upload: CompactMap, stored: CompactMap = NOTHING, views: int = 3) -> Sighting:
    # Codes apart by 1 are 7 ** 0.5 steps apart.
    return sighting(upload, stored, SameView(QUANTISER, 2 * 7**0.5), views=views)


def told(content: CompactMap) -> list[tuple[int, int, int]]:
    """Of each segment id, view of what, last seen."""
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
def test_a_segment_is_a_repeat_a_view_or_a_new_thing(
    place: float, code: int, expected: list[tuple[int, int, int]], repeats: int
) -> None:
    found = look(seen_at(20, [7], [place], [code]), STORED)
    assert told(found.changed) == expected
    assert found.repeats == repeats
    assert found.refreshed.tolist() == [1] * repeats


@pytest.mark.parametrize(("stand", "repeats"), [(4.9, 1), (5.1, 0), (-4.9, 1)])
def test_what_is_seen_from_where_it_was_seen_is_no_other_view(stand: float, repeats: int) -> None:
    stored = joined(seen_at(10, [1], [0.0], [0], stand=0.0))
    found = look(seen_at(20, [7], [0.1], [50], stand=stand), stored)
    assert found.repeats == repeats
    # Of all its views, not only of the one that looks most like it.
    far = joined(stored, look(seen_at(15, [2], [0.0], [60], stand=30.0), stored).changed)
    found = look(seen_at(20, [7], [0.1], [57], stand=stand), far)
    assert found.repeats == repeats
    assert found.refreshed.tolist() == [2] * repeats


def test_a_thing_has_so_many_views_and_no_more() -> None:
    upload = joined(*(seen_at(20 + step, [10 + step], [0.1], [10 * step]) for step in range(6)))
    found = look(upload, STORED)
    assert told(found.changed) == [(1, 1, 20), (11, 1, 21), (12, 1, 25)]
    assert found.repeats == 4
    alone = look(upload, STORED, views=1)
    assert told(alone.changed) == [(1, 1, 25)]


def test_what_is_seen_at_the_same_time_is_not_the_same_thing() -> None:
    found = look(seen_at(20, [7, 8], [0.1, 0.2], [50, 50]), STORED)
    assert told(found.changed) == [(7, 1, 20), (8, 1, 20)]
    again = look(seen_at(10, [7], [0.1], [0]), STORED)
    assert told(again.changed) == [(7, 7, 10)]


def test_an_upload_is_compared_with_itself_in_the_order_of_time() -> None:
    upload = joined(seen_at(30, [1], [0.0], [0]), seen_at(20, [9], [0.1], [0]))
    assert told(look(upload).changed) == [(9, 9, 30)]


def test_a_known_id_is_replaced_but_stays_a_view_of_what_it_was() -> None:
    stored = apply(STORED, Delta(look(seen_at(20, [7], [0.1], [50]), STORED).changed, NONE))
    found = look(seen_at(15, [7], [0.2], [60]), stored)
    assert told(found.changed) == [(7, 1, 20)]
    assert found.changed.codes[0, 0] == 60
    assert found.repeats == 0


def test_an_earlier_sighting_does_not_make_it_older() -> None:
    found = look(seen_at(5, [7], [0.1], [0]), STORED)
    assert (len(found.changed), found.repeats) == (0, 1)


def test_nothing_is_nothing() -> None:
    for stored in (NOTHING, STORED):
        found = look(NOTHING, stored)
        assert (len(found.changed), found.repeats) == (0, 0)
        assert set(found.changed.optional) == {"views", "seen"}


def seen_together(time: int, first: int, things: list[tuple[float, int]]) -> CompactMap:
    """A moment: ids from `first` on, of place and code each."""
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


@given(MOMENTS, MOMENTS)
@settings(max_examples=100, deadline=None)
def test_what_was_taken_in_is_known_from_then_on(
    first: list[CompactMap], second: list[CompactMap]
) -> None:
    stored = apply(NOTHING, Delta(look(joined(*first)).changed, NONE))
    upload = joined(*second)
    found = look(upload, stored)
    after = apply(stored, Delta(found.changed, NONE))
    # Sent again, it changes nothing.
    again = look(upload, after)
    assert encode(apply(after, Delta(again.changed, NONE))) == encode(after)
    # Nothing is lost: each segment is there, or was seen no earlier than it says, where it was.
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


def test_over_http(service: Any, manifest: Manifest) -> None:
    same = int(SAME_VIEW * manifest.pair_threshold / manifest.quantiser.step / 7**0.5)

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
    # What an edit removes it has not seen again, whatever stands there now.
    upload = seen_at(25, [5], [0.1], [0], model_id=manifest.model_id)
    instead = service.post(
        "/maps/site/segments?deduplicate=true",
        content=encode_delta(Delta(upload, np.array([1], np.uint32))),
    ).json()
    assert (instead["changed"], instead["removed"], instead["repeats"]) == (1, 1, 0)
    # What was not seen again can be told from what was.
    assert service.post("/maps/site/age?unseen_since=15").json()["removed"] == 1
    plain = seen_at(30, [9], [0.1], [0], model_id=manifest.model_id)
    stored_all = service.post("/maps/site/segments", content=encode_delta(Delta(plain, NONE)))
    assert stored_all.json()["segments"] == 3


def test_a_robot_s_key_may_see_another_s_segments_again(
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
        # But not write them.
        assert_problem(send("zoe", 30, [1]), 403, "forbidden")


def test_a_part_of_a_map_is_enough(manifest: Manifest) -> None:
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
