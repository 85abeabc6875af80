"""Scan Context as a peer, without its registration, which needs a package of the peers."""

import numpy as np
import pytest

from benchmarks.peers.exchange import NOTHING, MapFrame
from benchmarks.peers.systems.registered_context import (
    RegisteredContextParameters,
    RegisteredContextPeer,
    mean_squared_distance,
    thin,
)
from benchmarks.peers.systems.scan_context import about_z
from tests.benchmarks.peers.systems.test_scan_context import cloud, scene
from tests.placecell.segment_builders import pose

CONTEXT_ONLY = RegisteredContextParameters(gates=())


@pytest.mark.parametrize("turn", [0.0, 1.0, -2.5, 3.1])
def test_pose_is_that_of_the_local_map_rotated_by_the_best_angle(turn: float) -> None:
    frames = [
        MapFrame(pose(10.0 * seed, -3.0, 1.0, yaw=0.4 * seed), scene(seed)) for seed in (1, 2)
    ]
    peer = RegisteredContextPeer(CONTEXT_ONLY)
    peer.learn(frames)
    true = frames[1].pose @ about_z(turn)
    query = frames[1].cloud @ about_z(turn)[:3, :3]  # the inverse turn, of rows
    estimate = peer.locate(query.astype(np.float32))
    assert estimate.pose is not None
    assert estimate.pose[:3, 3] == pytest.approx(true[:3, 3])
    off = np.arccos((np.trace(estimate.pose[:3, :3].T @ true[:3, :3]) - 1) / 2)
    assert np.degrees(off) <= 3.01  # half a sector


def test_only_a_similar_context_with_a_small_error_is_sure() -> None:
    peer = RegisteredContextPeer(CONTEXT_ONLY)
    peer.learn([MapFrame(np.eye(4), scene(0))])
    same, other = peer.locate(scene(0)), peer.locate(scene(1))
    assert same.sure
    assert same.evidence == {"distance": pytest.approx(0), "error": pytest.approx(0)}
    assert not other.sure
    assert other.evidence["distance"] > 0.2
    assert other.score < same.score
    strict = RegisteredContextPeer(RegisteredContextParameters(gates=(), largest_error=-1.0))
    strict.learn([MapFrame(np.eye(4), scene(0))])
    assert not strict.locate(scene(0)).sure


def test_empty_local_map_has_no_pose() -> None:
    peer = RegisteredContextPeer(CONTEXT_ONLY)
    peer.learn([MapFrame(np.eye(4), scene(0))])
    assert peer.locate(cloud()) is NOTHING


def test_mean_squared_distance_is_that_of_the_nearest_points() -> None:
    source = cloud((0.0, 0.0, 0.0), (2.0, 0.0, 0.0))
    target = cloud((0.0, 1.0, 0.0), (2.0, 3.0, 0.0))
    # The distances are 1 and the root of 5: the second point is nearest to the first target.
    assert mean_squared_distance(source, target, np.eye(4)) == pytest.approx((1 + 5) / 2)
    assert mean_squared_distance(source, target, pose(0, 1, 0)) == pytest.approx((0 + 4) / 2)


def test_thin_keeps_one_point_per_voxel() -> None:
    kept = thin(cloud((0.05, 0, 0), (0.35, 0, 0), (0.45, 0, 0), (-0.05, 0, 0)))
    assert sorted(np.round(kept[:, 0], 2).tolist()) == pytest.approx([-0.05, 0.05, 0.45])


def test_target_is_the_map_up_to_50_meters_around_the_candidate() -> None:
    point = cloud((0.0, 0.0, 1.0))
    peer = RegisteredContextPeer(CONTEXT_ONLY)
    peer.learn([MapFrame(pose(x, 0.0, yaw=np.pi / 2), point) for x in (0.0, 49.0, 51.0)])
    # Each frame looks along y, so what lies further along x is to the right.
    target = peer.around(0)
    assert target[np.argsort(-target[:, 1])] == pytest.approx(
        np.array([[0.0, 0.0, 1.0], [0.0, -49.0, 1.0]]), abs=1e-4
    )
    assert peer.around(0) is target
