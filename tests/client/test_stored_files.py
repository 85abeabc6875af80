"""Files that version 1 wrote stay readable."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from placecell_client import CompactMap, Delta, decode, decode_delta, encode, encode_delta
from placecell_client.classes import class_names, class_probabilities
from placecell_client.maps.edit import apply

from tests.fixtures import drifted_maps

FIXTURES = Path(__file__).resolve().parents[1] / "fixtures"
MAP_FILE = FIXTURES / "version-1.map"
DELTA_FILE = FIXTURES / "version-1.delta"
CLASSES_MAP = FIXTURES / "classes.map"
CLASSES_DELTA = FIXTURES / "classes.delta"

STORED = CompactMap(
    model_id="context-0123456789abcdef",
    preprocessing="1",
    frame="Kärntner Straße",
    codes=np.array([[-128, 127], [0, 1], [2, 3], [-4, 5], [60, -70]], np.int8),
    centroids=np.array(
        [
            [500_000.25, 5_400_010.5, 301.0],
            [499_672.33, 5_400_000.0, 299.99],
            [500_001.0, 5_399_999.0, 303.27],
            [-10.0, 20.0, -1.0],
            [0.0, -5.25, 2.5],
        ]
    ),
    ids=np.array([0, 7, 8, 300, 4_294_967_295], np.uint32),
    robots=("ann", "zoë"),
    robot=np.array([0, 1, 1, 0, 0], np.uint16),
    frame_index=np.array([1, 1, 2, 0, 0], np.uint32),
    frame_times=np.array([-2.5, 1.7e9, 1.7e9 + 0.1]),
    frame_positions=np.array(
        [[0.0, 0.0, 1.73], [500_000.0, 5_400_000.0, 300.125], [500_001.0, 5_400_000.0, 300.0]]
    ),
    frame_orientations=np.array([[0, 0, 0, 1], [0, 0, 0.6, 0.8], [-1, 0, 0, 0]], np.float32),
    extents=np.array([[1, 2, 3], [0, 0, 0], [255, 40, 17], [9, 9, 9], [4, 5, 6]], np.uint8),
    points=np.array([100, 0, 65_535, 812, 4000], np.uint16),
    views=np.array([0, 7, 7, 299, 4_294_967_295], np.uint32),
    seen=np.array([1_700_000_000, 1_700_000_500, 1_700_000_000, 0, 4_294_967_295], np.uint32),
)
CHANGED = CompactMap(
    model_id=STORED.model_id,
    preprocessing="1",
    frame=STORED.frame,
    codes=np.array([[11, 12], [13, 14]], np.int8),
    centroids=np.array([[500_002.0, 5_400_001.0, 300.5], [500_003.5, 5_400_000.0, 301.25]]),
    ids=np.array([7, 9], np.uint32),
    robots=("zoë",),
    robot=np.zeros(2, np.uint16),
    frame_index=np.zeros(2, np.uint32),
    frame_times=np.array([1.7e9 + 600]),
    frame_positions=np.array([[500_002.0, 5_400_000.0, 300.0]]),
    frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
    points=np.array([512, 256], np.uint16),
)


def test_stored_map_is_read() -> None:
    data = MAP_FILE.read_bytes()
    stored = decode(data)
    assert (stored.model_id, stored.preprocessing) == ("context-0123456789abcdef", "1")
    assert (stored.frame, stored.robots) == ("Kärntner Straße", ("ann", "zoë"))
    for name in ("codes", "ids", "robot", "frame_index", "frame_times", "frame_positions"):
        np.testing.assert_array_equal(getattr(stored, name), getattr(STORED, name), name)
    for name in ("centroids", "extents", "points", "views", "seen"):
        np.testing.assert_array_equal(getattr(stored, name), getattr(STORED, name), name)
    turned = STORED.frame_orientations * np.array([[1], [1], [-1]])
    np.testing.assert_array_equal(stored.frame_orientations, turned)
    assert encode(STORED) == data


def test_stored_delta_is_read() -> None:
    data = DELTA_FILE.read_bytes()
    delta = decode_delta(data)
    assert (delta.since, delta.until, delta.removed.tolist()) == (41, 43, [8, 12])
    assert encode(delta.changed) == encode(CHANGED)
    assert encode_delta(Delta(CHANGED, np.array([8, 12], np.uint32), 41, 43)) == data


def test_stored_delta_applies_to_the_stored_map() -> None:
    after = apply(decode(MAP_FILE.read_bytes()), decode_delta(DELTA_FILE.read_bytes()))
    assert after.ids.tolist() == [0, 7, 9, 300, 4_294_967_295]
    assert after.codes.tolist() == [[-128, 127], [11, 12], [13, 14], [-4, 5], [60, -70]]
    assert after.centroids[1].tolist() == [500_002.0, 5_400_001.0, 300.5]
    assert after.points is not None
    assert after.points.tolist() == [100, 512, 256, 812, 4000]
    assert after.views is not None
    assert after.views.tolist() == [0, 7, 9, 299, 4_294_967_295]
    assert after.seen is not None
    assert after.seen.tolist() == [1_700_000_000, 1_700_000_600, 1_700_000_600, 0, 4_294_967_295]


def test_stored_files_with_classes_are_read() -> None:
    data = CLASSES_MAP.read_bytes()
    stored = decode(data)
    assert stored.classes is not None
    assert stored.classes.tolist() == [0, 1, 121, 248, 93]
    assert class_names(stored.classes) == [None, "building", "vehicle", "other", "pole"]
    assert class_probabilities(stored.classes).tolist() == [
        0, 0, np.float32(0.9), 1, 1
    ]  # fmt: skip
    assert encode(replace(STORED, classes=stored.classes)) == data
    delta = decode_delta(CLASSES_DELTA.read_bytes())
    assert delta.changed.classes is not None
    assert delta.changed.classes.tolist() == [35, 0]
    after = apply(decode(MAP_FILE.read_bytes()), delta)
    assert after.classes is not None
    assert after.classes.tolist() == [0, 35, 0, 0, 0]


def test_stored_map_with_odometry_is_read() -> None:
    data = (FIXTURES / drifted_maps.MAP_FILE).read_bytes()
    stored, expected = decode(data), drifted_maps.DRIFTED
    np.testing.assert_array_equal(stored.frame_tracks, expected.frame_tracks)
    np.testing.assert_array_equal(stored.frame_odometry, expected.frame_odometry)
    np.testing.assert_array_equal(stored.centroids, expected.centroids)
    assert encode(expected) == data


def test_stored_delta_of_an_optimization_moves_the_capture() -> None:
    data = (FIXTURES / drifted_maps.DELTA_FILE).read_bytes()
    delta = decode_delta(data)
    assert (delta.since, delta.until, delta.changed.ids.tolist()) == (1, 2, [5])
    after = apply(decode((FIXTURES / drifted_maps.MAP_FILE).read_bytes()), delta)
    assert encode(after) == encode(drifted_maps.MOVED)
    assert encode_delta(drifted_maps.moved_delta()) == data
