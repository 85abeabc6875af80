"""Later passes confirm stored segments or find them gone, over HTTP."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Delta, decode, encode, encode_delta
from placecell_client.maps.canonical import canonical
from placecell_client.maps.edit import take

from placecell.descriptors.manifest import Manifest
from service.maps.layers import MapLayers
from service.maps.writes.long_life import PASS_SECONDS, observed_segments
from service.search import matching
from service.search.localization import StoredNeighborhood
from service.search.matching import nearest_segments
from tests.service.service_builders import map_of, random_codes

CAR, WALL, HOUSE, POST = 0, 1, 2, 3
CENTERS = [[8.0, 0.0, 0.8], [15.0, 0.0, 2.0], [0.0, 14.0, 2.5], [-6.0, -6.0, 1.5]]
SIDES = [[40, 20, 15], [5, 240, 40], [200, 5, 50], [2, 2, 30]]
DAY = 86_400.0


@pytest.fixture
def street(manifest: Manifest) -> CompactMap:
    """A parked car before a wall, a house and a post, seen by one capture."""
    given = map_of(random_codes(4, seed=3), manifest.model_id)
    return canonical(
        replace(
            given,
            centroids=np.array(CENTERS),
            ids=np.arange(4, dtype=np.uint32),
            frame_index=np.zeros(4, np.uint32),
            frame_times=np.array([1e9]),
            frame_positions=np.array([[0.0, 0.0, 1.8]]),
            frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
            extents=np.array(SIDES, np.uint8),
        )
    )


def drive_by(service: Any, street: CompactMap, rows: list[int], days: float, first: int) -> None:
    """Send what a robot sees when it passes again, with deduplication."""
    seen = take(street, np.array(rows))
    times = street.frame_times + days * DAY
    ids = np.arange(first, first + len(rows), dtype=np.uint32)
    edit = Delta(canonical(replace(seen, ids=ids, frame_times=times)), np.zeros(0, np.uint32))
    answer = service.post(
        "/maps/street/segments", content=encode_delta(edit), params={"deduplicate": True}
    )
    assert answer.status_code == 200, answer.text


def content(service: Any) -> CompactMap:
    return decode(service.get("/maps/street").content)


def counts(service: Any) -> list[tuple[int, int]]:
    """Return confirmations and misses of each segment."""
    found = content(service)
    assert found.ids.tolist() == [CAR, WALL, HOUSE, POST]
    assert found.confirmed is not None
    assert found.absent is not None
    return list(zip(found.confirmed.tolist(), found.absent.tolist(), strict=True))


@pytest.fixture
def passed(service: Any, street: CompactMap) -> Any:
    """The car left before the second day."""
    assert service.put("/maps/street", content=encode(street)).is_success
    drive_by(service, street, [WALL, HOUSE], 1, 100)
    return service


def test_pass_confirms_what_it_sees_and_misses_what_it_should_see(
    passed: Any, street: CompactMap
) -> None:
    # Nothing stands behind the post: it proves nothing that it was not seen.
    assert counts(passed) == [(0, 1), (1, 0), (1, 0), (0, 0)]
    found = content(passed)
    assert found.missed is not None
    assert found.missed.tolist() == [1e9 + DAY, 0, 0, 0]
    drive_by(passed, street, [WALL, POST], 2, 200)
    assert counts(passed) == [(0, 2), (2, 0), (1, 0), (1, 0)]
    drive_by(passed, street, [CAR, WALL], 3, 300)  # the car is back
    assert counts(passed) == [(1, 0), (3, 0), (1, 0), (1, 0)]


def test_one_pass_counts_once(passed: Any, street: CompactMap) -> None:
    before = passed.get("/maps/street").content
    drive_by(passed, street, [WALL, HOUSE], 1, 100)  # the same edit again
    assert passed.get("/maps/street").content == before
    drive_by(passed, street, [WALL, HOUSE], 1 + 0.5 * PASS_SECONDS / DAY, 200)
    assert counts(passed) == [(0, 1), (1, 0), (1, 0), (0, 0)]


def test_boxes_follow_the_turn_of_their_track_in_the_map(street: CompactMap) -> None:
    quarter = np.array([[0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5)]], np.float32)
    driven = replace(
        street,
        frame_tracks=np.ones(1, np.uint32),
        frame_odometry=np.zeros((1, 7)),
    )
    sides = np.array(SIDES) / 10
    np.testing.assert_array_equal(observed_segments(driven).sides, sides)
    turned = observed_segments(replace(driven, frame_orientations=quarter)).sides
    np.testing.assert_allclose(turned, sides[:, [1, 0, 2]], atol=1e-5)
    # Without odometry, it is not known whether a box was turned.
    unknown = replace(street, frame_orientations=quarter)
    np.testing.assert_array_equal(observed_segments(unknown).sides, sides)


def test_upload_without_boxes_judges_nothing(service: Any, street: CompactMap) -> None:
    plain = replace(street, extents=None)
    assert service.put("/maps/street", content=encode(plain)).is_success
    drive_by(service, plain, [WALL, HOUSE], 1, 100)
    assert content(service).absent is None


class Sure:
    """Classifier that gives each pair the same probability."""

    def probabilities(self, one: np.ndarray, other: np.ndarray) -> np.ndarray:
        return np.full(len(one), 0.6)


def test_absent_segment_is_less_probable_in_match_and_localize(
    service: Any, street: CompactMap
) -> None:
    assert service.put("/maps/street", content=encode(street)).is_success
    engine = service.app.state.placecell.engine
    model = replace(engine.model, classifier=Sure())

    def probabilities() -> tuple[list[float], list[float]]:
        snapshot = engine.maps.get("street")
        nearest = nearest_segments(street.codes, model, (snapshot,), 1)
        matched = matching._probabilities(street.codes, model, nearest)
        assert matched is not None
        there = StoredNeighborhood(street.codes, model, snapshot)
        rows = nearest.rows[:, 0]
        return matched[:, 0].tolist(), there.match_probabilities(np.arange(4), rows).tolist()

    assert probabilities() == ([0.6] * 4, [0.6] * 4)
    for day in (1, 2):
        drive_by(service, street, [WALL, HOUSE], day, 100 * day)
    for found in probabilities():
        assert found == pytest.approx([0.2, 0.6, 0.6, 0.6])


def test_presence_follows_from_the_counts_of_both_layers(street: CompactMap) -> None:
    told = replace(
        street,
        missed=np.zeros(4, np.uint32),
        confirmed=np.array([0, 3, 0, 0], np.uint8),
        absent=np.array([2, 1, 0, 0], np.uint8),
    )
    assert MapLayers.of(street).presence(np.arange(4)) is None
    layers = MapLayers.of(street).after(Delta(canonical(told), np.zeros(0, np.uint32)))
    found = layers.presence(np.array([[4, 5], [6, 0]]))
    assert found is not None
    np.testing.assert_allclose(found, [[1 / 3, 0.8], [1.0, 1.0]])
