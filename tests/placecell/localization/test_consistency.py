import numpy as np
import pytest

from placecell.core.bits import unpacked
from placecell.core.types import Bool, Float64
from placecell.localization.consistency import consistent
from placecell.localization.correspondences import Correspondences
from placecell.localization.parameters import LocalizationParameters
from tests.placecell.localization.scene_builders import a_pose, any_rotation


def pairs(source: Float64, target: Float64) -> Correspondences:
    numbers = np.arange(len(source))
    return Correspondences(
        numbers, numbers, numbers, source, target, np.ones(len(source)), len(source)
    )


def graph_of(found: Correspondences, parameters: LocalizationParameters) -> Bool:
    """Return the consistency graph, bool (m, m)."""
    return unpacked(consistent(found, parameters), len(found))


def agree(here: list[float], there: list[float], **changes: float | str) -> bool:
    """Return whether the origin and these points are consistent in two frames."""
    source, target = np.array([[0.0] * 3, here]), np.array([[0.0] * 3, there])
    parameters = LocalizationParameters(**changes)  # type: ignore[arg-type]
    return bool(graph_of(pairs(source, target), parameters)[0, 1])


@pytest.mark.parametrize(
    ("here", "there", "agreeing"),
    [
        ([10, 0, 0], [0, 10, 0], True),
        ([10, 0, 0], [0, 10.9, 0], True),
        ([10, 0, 0], [0, 11.1, 0], False),
        ([10, 0, 0], [0, 8.9, 0], False),
        ([0.3, 0, 0], [0, 0, 0], True),
        # Heights: half a meter, and 2 degrees, which are 0.35 m at 10 m.
        ([10, 0, 0], [10, 0, 0.84], True),
        ([10, 0, 0], [10, 0, 0.86], False),
        ([0, 0, 3], [0, 0, -3], False),
    ],
)
def test_heights_and_level_distances_are_kept(
    here: list[float], there: list[float], agreeing: bool
) -> None:
    assert agree(here, there) is agreeing


def test_without_gravity_distances_in_space_are() -> None:
    assert agree([0, 0, 10], [10, 0, 0], model="se3")
    assert not agree([0, 0, 10], [10, 0, 0])
    assert not agree([0, 0, 10], [11.1, 0, 0], model="se3")


def test_no_edge_to_itself_its_query_or_its_place() -> None:
    points = np.zeros((3, 3))
    found = Correspondences(
        np.array([0, 0, 1]), np.array([0, 1, 0]), np.arange(3), points, points, np.ones(3), 2
    )
    expected = np.zeros((3, 3), dtype=bool)
    expected[1, 2] = expected[2, 1] = True
    np.testing.assert_array_equal(graph_of(found, LocalizationParameters()), expected)


@pytest.mark.parametrize(("model", "move"), [("yaw", a_pose), ("se3", any_rotation)])
def test_a_motion_keeps_everything_consistent(model: str, move: object) -> None:
    random = np.random.default_rng(0)
    source = random.uniform(-40, 40, (40, 3))
    pose = move(random)  # type: ignore[operator]
    parameters = LocalizationParameters(model=model)  # type: ignore[arg-type]
    graph = graph_of(pairs(source, pose.apply(source)), parameters)
    assert graph.sum() == 40 * 39
    # And of other points there are few.
    other = graph_of(pairs(source, random.uniform(-40, 40, (40, 3))), parameters)
    assert other.sum() < 0.2 * 40 * 39
    np.testing.assert_array_equal(other, other.T)


@pytest.mark.parametrize("model", ["yaw", "se3"])
def test_edges_match_distances_computed_pair_by_pair(model: str) -> None:
    random = np.random.default_rng(3)
    count = 150
    source, target = random.uniform(-6, 6, (2, count, 3)) * (1, 1, 0.3)
    queries, places = random.integers(0, 20, (2, count))
    found = Correspondences(
        queries, places, np.arange(count), source, target, np.ones(count), count
    )
    parameters = LocalizationParameters(model=model)  # type: ignore[arg-type]
    axes = 2 if model == "yaw" else 3
    here, there = (
        np.linalg.norm((each[:, None] - each)[..., :axes], axis=2) for each in (source, target)
    )
    rise, other_rise = (each[:, None, 2] - each[:, 2] for each in (source, target))
    expected = np.abs(here - there) <= parameters.distance_tolerance
    if model == "yaw":
        most = parameters.height_tolerance + np.tan(np.radians(parameters.tilt)) * here
        expected &= np.abs(rise - other_rise) <= most
    expected &= (queries[:, None] != queries) & (places[:, None] != places)
    np.testing.assert_array_equal(graph_of(found, parameters), expected)
