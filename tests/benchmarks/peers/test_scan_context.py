import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from benchmarks.peers.exchange import NOTHING, Cloud, MapFrame
from benchmarks.peers.scan_context import (
    ScanContextParameters,
    ScanContextPeer,
    ScanContexts,
    about_z,
    distances,
    ring_key,
    scan_context,
)
from tests.placecell.segment_builders import pose

SMALL = ScanContextParameters(rings=2, sectors=4, radius=20.0, sensor_height=2.0, sure_below=0.13)


def cloud(*rows: tuple[float, float, float]) -> Cloud:
    return np.array(rows, dtype=np.float32).reshape(-1, 3)


def polar(distance: float, degrees: float, height: float) -> tuple[float, float, float]:
    angle = np.radians(degrees)
    return distance * np.cos(angle), distance * np.sin(angle), height


def scene(seed: int, count: int = 400) -> Cloud:
    """Poles of different heights all around."""
    random = np.random.default_rng(seed)
    distance, degrees = random.uniform(3, 70, count), random.uniform(0, 360, count)
    heights = random.uniform(-1.5, 8, count)
    return cloud(*map(polar, distance, degrees, heights))


def test_context_by_hand() -> None:
    context = scan_context(
        cloud(
            polar(5, 10, 1.0),  # ring 0, sector 0
            polar(6, 80, 3.0),  # the same cell: the greatest height counts
            polar(7, 45, -1.0),
            polar(15, 100, 0.5),  # ring 1, sector 1
            polar(9.99, 350, -1.9),  # ring 0, sector 3
            polar(20.01, 200, 9.0),  # beyond
        ),
        SMALL,
    )
    expected = [[5.0, 0, 0, 0.1], [0, 2.5, 0, 0]]
    assert context == pytest.approx(np.array(expected), abs=1e-6)


def test_angle_just_below_a_full_turn_is_the_last_sectors() -> None:
    assert scan_context(cloud((5.0, -0.01, 1.0)), SMALL)[0].tolist() == [0, 0, 0, 3]
    # Rounded, it is a whole turn: the first sector again, not one past the last.
    assert scan_context(cloud((5.0, -1e-12, 1.0)), SMALL)[0].sum() == 3


def test_constants_are_the_papers() -> None:
    parameters = ScanContextParameters()
    assert (parameters.rings, parameters.sectors, parameters.radius) == (20, 60, 80.0)
    assert scan_context(cloud()).shape == (20, 60)
    assert not scan_context(cloud()).any()


def test_ring_key_counts_sectors_by_hand() -> None:
    context = np.array([[5.0, 0, 0, 0.1], [0, 2.5, 0, 0]])
    assert ring_key(context).tolist() == [0.5, 0.25]


def test_distances_by_hand() -> None:
    # Columns of the query: (1, 0), (0, 1), none; of the candidate: (0, 2), none, (1, 1).
    query = np.array([[1.0, 0, 0], [0, 1, 0]])
    candidate = np.array([[0.0, 0, 1], [2, 0, 1]])
    half = np.sqrt(0.5)
    expected = [
        1 - 0,  # (1, 0) against (0, 2); the second has no counterpart
        1 - half,  # (0, 1) against (1, 1); the first has none
        1 - (half + 1) / 2,  # (1, 0) against (1, 1), (0, 1) against (0, 2)
    ]
    assert distances(query, candidate) == pytest.approx(np.array(expected))


def test_nothing_in_common_is_as_far_as_can_be() -> None:
    empty, full = np.zeros((2, 3)), np.ones((2, 3))
    assert distances(empty, full).tolist() == [1, 1, 1]


@given(st.integers(0, 59), st.integers(0, 1000))
def test_turning_the_query_turns_the_angles(turn: int, seed: int) -> None:
    random = np.random.default_rng(seed)
    query, candidate = (random.uniform(0, 5, (20, 60)) for _ in range(2))
    turned = distances(np.roll(query, -turn, axis=1), candidate)
    assert turned == pytest.approx(np.roll(distances(query, candidate), turn))


def test_a_context_is_at_no_distance_from_itself() -> None:
    context = scan_context(scene(0))
    apart = distances(context, context)
    assert apart[0] == pytest.approx(0)
    assert apart[1:].min() > 0.1


def test_the_frame_that_was_seen_is_found_first() -> None:
    contexts = ScanContexts([scene(seed) for seed in range(30)])
    for frame in (0, 17, 29):
        best = contexts.find(scene(frame))[0]
        assert (best.frame, best.yaw) == (frame, 0.0)
        assert best.distance == pytest.approx(0)


def test_candidates_are_as_many_as_asked_or_as_there_are() -> None:
    few = ScanContexts([scene(0), scene(1)])
    assert sorted(found.frame for found in few.find(scene(5))) == [0, 1]
    many = ScanContexts([scene(seed) for seed in range(15)])
    found = many.find(scene(20))
    assert len(found) == 10
    assert [one.distance for one in found] == sorted(one.distance for one in found)


@pytest.mark.parametrize("turn", [0.0, 1.0, -2.5, 3.1])
def test_pose_is_the_frames_turned_by_the_angle_found(turn: float) -> None:
    frames = [
        MapFrame(pose(10.0 * seed, -3.0, 1.0, yaw=0.4 * seed), scene(seed)) for seed in (1, 2)
    ]
    peer = ScanContextPeer(ScanContextParameters())
    peer.learn(frames)
    true = frames[1].pose @ about_z(turn)
    query = frames[1].cloud @ about_z(turn)[:3, :3]  # the inverse turn, of rows
    estimate = peer.locate(query.astype(np.float32))
    assert estimate.pose is not None
    assert estimate.pose[:3, 3] == pytest.approx(true[:3, 3])
    off = np.arccos((np.trace(estimate.pose[:3, :3].T @ true[:3, :3]) - 1) / 2)
    assert np.degrees(off) <= 3.01  # half a sector


def test_sure_only_of_what_looks_the_same() -> None:
    peer = ScanContextPeer(ScanContextParameters())
    peer.learn([MapFrame(np.eye(4), scene(0))])
    same, other = peer.locate(scene(0)), peer.locate(scene(1))
    assert same.sure
    assert not other.sure
    assert other.score < -0.13 < same.score <= 0


def test_an_empty_local_map_is_nowhere() -> None:
    peer = ScanContextPeer(ScanContextParameters())
    peer.learn([MapFrame(np.eye(4), scene(0))])
    assert peer.locate(cloud()) is NOTHING
