import numpy as np
import pytest

from placecell.localization.covariance import covariance_of
from placecell.localization.parameters import LocalizationParameters
from placecell.localization.pose import Pose
from placecell.localization.registration import register
from placecell.trajectories.covariance import cross
from tests.placecell.localization.scene_builders import a_pose, street


def test_a_cross_product_is_a_matrix() -> None:
    a, b = np.random.default_rng(0).normal(size=(2, 5, 3))
    np.testing.assert_allclose((cross(a) @ b[..., None])[..., 0], np.cross(a, b))


@pytest.mark.parametrize("model", ["yaw", "se3"])
@pytest.mark.parametrize("away", [0.0, 1000.0])
def test_covariance_matches_the_scatter_of_poses(model: str, away: float) -> None:
    """Poses registered with new noise scatter according to the covariance."""
    random = np.random.default_rng(1)
    parameters = LocalizationParameters(model=model, inflation=1.0)  # type: ignore[arg-type]
    source = street(random, 60.0, 40) + (away, 0, 0)
    true = a_pose(random)
    errors, stated = [], []
    for _ in range(400):
        target = true.apply(source) + random.normal(scale=0.15, size=source.shape)
        pose = register(source, target, np.ones(40), parameters)
        turn = pose.rotation @ true.rotation.T
        rotation = np.array(
            [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
        )
        shift = pose.translation - true.translation
        # exp(w) rotation about the map's origin, as the covariance is told.
        error = np.concatenate([shift, rotation / 2])
        errors.append(error if model == "se3" else error[[0, 1, 2, 5]])
        stated.append(covariance_of(pose, source, target, parameters))
    found = np.cov(np.array(errors).T)
    ratio = np.sqrt(np.diag(found) / np.diag(np.mean(stated, axis=0)))
    # The kernel takes a little of each residual away.
    assert ratio == pytest.approx(1.0, abs=0.25)
    correlation = found[0, -1] / np.sqrt(found[0, 0] * found[-1, -1])
    told = np.mean(stated, axis=0)
    assert told[0, -1] / np.sqrt(told[0, 0] * told[-1, -1]) == pytest.approx(correlation, abs=0.1)


def test_exact_segments_still_have_a_smallest_covariance() -> None:
    source = street(np.random.default_rng(2), 60.0, 10)
    covariance = covariance_of(
        Pose.of_yaw(0, np.zeros(3)), source, source, LocalizationParameters()
    )
    assert np.sqrt(np.diag(covariance)[:3]).min() > 0.02


@pytest.mark.parametrize(
    "source",
    [
        np.zeros((0, 3)),
        np.zeros((5, 3)),
        np.outer(np.arange(5.0), [0, 0, 1]),  # a pole
    ],
)
def test_undetermined_yaw_has_infinite_covariance(source: np.ndarray) -> None:
    identity = Pose.of_yaw(0, np.zeros(3))
    assert np.isinf(
        np.diag(covariance_of(identity, source, source, LocalizationParameters()))
    ).all()


def test_segments_in_a_row_determine_a_yaw_but_no_roll() -> None:
    row = np.outer(np.arange(5.0), [1, 0, 0])
    identity = Pose.of_yaw(0, np.zeros(3))
    assert np.isfinite(covariance_of(identity, row, row, LocalizationParameters())).all()
    covariance = covariance_of(identity, row, row, LocalizationParameters(model="se3"))
    assert np.isinf(np.diag(covariance)).all()


@pytest.mark.parametrize("model", ["yaw", "se3"])
@pytest.mark.parametrize("meters", [60.0, 6_000.0, 600_000.0])
def test_a_long_street_determines_all(model: str, meters: float) -> None:
    source = street(np.random.default_rng(4), meters, 200)
    parameters = LocalizationParameters(model=model)  # type: ignore[arg-type]
    covariance = covariance_of(Pose.of_yaw(0, np.zeros(3)), source, source, parameters)
    assert np.isfinite(covariance).all()
    # The longer, the surer of the direction.
    assert covariance[-1, -1] * meters**2 == pytest.approx(0.0012, rel=0.3)


def test_inflation_makes_the_covariance_larger() -> None:
    source = street(np.random.default_rng(3), 60.0, 10)
    pose = Pose.of_yaw(0, np.zeros(3))
    plain = covariance_of(pose, source, source, LocalizationParameters(inflation=1.0))
    larger = covariance_of(pose, source, source, LocalizationParameters(inflation=4.0))
    np.testing.assert_allclose(larger, 4 * plain)
