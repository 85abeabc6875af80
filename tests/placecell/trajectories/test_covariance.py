"""Covariances that messages state."""

import numpy as np
import pytest

from placecell.trajectories.covariance import lever_arm, stated_covariance


def test_stated_covariance_is_used() -> None:
    root = np.random.default_rng(0).normal(size=(6, 6))
    given = root @ root.T
    found = stated_covariance(given.ravel())
    assert found is not None
    np.testing.assert_allclose(found, given)


@pytest.mark.parametrize("rest", [0.0, 1e12])
def test_planar_covariance_is_used(rest: float) -> None:
    found = stated_covariance(np.diag([1e-4, 2e-4, rest, rest, rest, 1e-5]))
    assert found is not None
    assert found[5, 5] == 1e-5


@pytest.mark.parametrize(
    "values",
    [
        np.zeros((6, 6)),
        np.diag([1.0, 1.0, 1.0, 1.0, 1.0, 0.0]),
        np.diag([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
        np.diag([1.0, 1.0, -1.0, 1.0, 1.0, 1.0]),
        np.full((6, 6), np.nan),
        np.eye(6) + 2 * (np.eye(6, k=1) + np.eye(6, k=-1)),
    ],
    ids=["empty", "no heading", "unknown", "negative", "not finite", "no covariance"],
)
def test_covariance_without_use_is_left_out(values: np.ndarray) -> None:
    assert stated_covariance(values) is None


def test_lever_arm_moves_errors_of_the_heading_sideways() -> None:
    arm = lever_arm(np.array([10.0, 0.0, 0.0]))
    moved = arm @ np.diag([0.01, 0.01, 0.01, 0.0, 0.0, 1e-4]) @ arm.T
    np.testing.assert_allclose(np.diag(moved), [0.01, 0.02, 0.01, 0.0, 0.0, 1e-4])
