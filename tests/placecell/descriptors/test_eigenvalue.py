import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from placecell.core.segments import Segments
from placecell.descriptors.eigenvalue import (
    FEATURES,
    eigenvalue_descriptors,
    eigenvalue_features,
    eigenvalues,
)
from tests.placecell.segment_builders import many_segments, one_segment


def features(points: object) -> dict[str, float]:
    return dict(zip(FEATURES, eigenvalue_descriptors(one_segment(points))[0].tolist(), strict=True))


def corners(a: float, b: float, c: float) -> list[list[float]]:
    """Return corners of a box with variances a^2, b^2 and c^2 along its axes."""
    return [[x, y, z] for x in (-a, a) for y in (-b, b) for z in (-c, c)]


def test_seven_features_by_hand() -> None:
    # Variances 9 : 1 : 0.04, their sum 10.04.
    l1, l2, l3 = 9.0, 1.0, 0.04
    shares = [value / 10.04 for value in (l1, l2, l3)]
    assert features(corners(3, 1, 0.2)) == pytest.approx(
        {
            "linearity": (l1 - l2) / l1,
            "planarity": (l2 - l3) / l1,
            "scattering": l3 / l1,
            "omnivariance": math.prod(shares) ** (1 / 3),
            "anisotropy": (l1 - l3) / l1,
            "eigenentropy": -sum(share * math.log(share) for share in shares),
            "change of curvature": l3 / (l1 + l2 + l3),
        },
        rel=1e-5,
    )


def test_eigenvalues_are_variances_largest_first() -> None:
    values = eigenvalues(one_segment([[z + 5, x - 4, y] for x, y, z in corners(3, 1, 0.2)]))
    assert values[0] == pytest.approx([9.0, 1.0, 0.04], rel=1e-5)


def test_blob_of_3_to_1_to_02_is_linear() -> None:
    """The linearity is 0.889; an earlier system gave -21 instead of 0.894.

    The blob's deviations are 3 : 1 : 0.2, so its variances are 9 : 1 : 0.04 and its linearity is
    (9 - 1) / 9 = 0.889: 0.894 is that within the noise of one sample of a few hundred points. (Of
    the deviations themselves it would be 0.667.) Sorted ascending under the same formula, the
    result is (0.04 - 1) / 0.04 = -24: -21 within that noise.
    """
    generator = np.random.default_rng(0)
    blobs = generator.normal(size=(40, 300, 3)) * [3.0, 1.0, 0.2]
    segments = Segments.of(list(blobs.astype(np.float32)), np.zeros((40, 3)))
    linearity = eigenvalue_descriptors(segments)[:, 0]
    assert linearity.mean() == pytest.approx(8 / 9, abs=0.005)
    assert linearity.min() < 0.894 < linearity.max()


def test_line() -> None:
    line = features([[x, 2 * x, -x] for x in range(10)])
    assert line["linearity"] == pytest.approx(1.0, abs=1e-6)
    assert line["anisotropy"] == pytest.approx(1.0, abs=1e-6)
    for name in ("planarity", "scattering", "omnivariance", "eigenentropy", "change of curvature"):
        assert line[name] == pytest.approx(0.0, abs=1e-4), name


def test_square_plane() -> None:
    square = features(corners(2, 2, 0))
    assert square["linearity"] == pytest.approx(0.0, abs=1e-6)
    assert square["planarity"] == pytest.approx(1.0, abs=1e-6)
    assert square["scattering"] == pytest.approx(0.0, abs=1e-6)
    assert square["eigenentropy"] == pytest.approx(math.log(2), abs=1e-6)


def test_cube_like_a_ball() -> None:
    cube = features(corners(1, 1, 1))
    assert cube["linearity"] == pytest.approx(0.0, abs=1e-6)
    assert cube["planarity"] == pytest.approx(0.0, abs=1e-6)
    assert cube["scattering"] == pytest.approx(1.0, abs=1e-6)
    assert cube["omnivariance"] == pytest.approx(1 / 3, abs=1e-6)
    assert cube["anisotropy"] == pytest.approx(0.0, abs=1e-6)
    assert cube["eigenentropy"] == pytest.approx(math.log(3), abs=1e-6)
    assert cube["change of curvature"] == pytest.approx(1 / 3, abs=1e-6)


def test_entropy_is_positive_and_at_most_log_3() -> None:
    entropy = eigenvalue_descriptors(many_segments([20] * 50))[:, FEATURES.index("eigenentropy")]
    assert (entropy > 0).all()
    assert (entropy <= math.log(3) + 1e-6).all()


def test_rotation_scale_and_place_make_no_difference() -> None:
    cloud = np.random.default_rng(2).normal(size=(200, 3)) * [2.0, 1.0, 0.5]
    turn = Rotation.from_euler("ZYX", [0.7, -0.4, 1.9]).as_matrix()
    moved = 1.7 * cloud @ turn.T + [20.0, -8.0, 3.0]
    assert features(moved) == pytest.approx(features(cloud), abs=1e-4)


def test_against_numpys_covariance() -> None:
    segments = many_segments([30, 400, 77])
    for index, values in enumerate(eigenvalues(segments)):
        covariance = np.cov(segments.cloud(index).T.astype(np.float64), bias=True)
        assert values == pytest.approx(np.linalg.eigvalsh(covariance)[::-1], rel=1e-4)


@pytest.mark.parametrize("points", [[[1.0, 2.0, 3.0]], [[1.0, 2.0, 3.0]] * 5])
def test_all_on_one_spot_gives_zeros(points: list[list[float]]) -> None:
    assert features(points) == dict.fromkeys(FEATURES, 0.0)


def test_features_of_zero_eigenvalues_are_finite() -> None:
    values = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    assert np.isfinite(eigenvalue_features(values)).all()


def test_no_segments() -> None:
    assert eigenvalue_descriptors(Segments.of([], np.zeros((0, 3)))).shape == (0, 7)
