"""Small training sets that every test of the trainings shares."""

import numpy as np
import pytest

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from training.data.training_set import TrainingSet

SHAPES = 8


def make_shapes(views: int, seed: int) -> TrainingSet:
    """Eight boxes of different size, each seen from a few places with fresh points on it."""
    random = np.random.default_rng(seed)
    sizes = np.random.default_rng(99).uniform(0.6, 4.0, (SHAPES, 3))
    clouds, sensors, groups = [], [], []
    for group, size in enumerate(sizes):
        for _ in range(views):
            points = random.uniform(-0.5, 0.5, (150, 3))
            side = random.integers(0, 3, 150)
            points[np.arange(150), side] = np.sign(points[np.arange(150), side]) / 2
            clouds.append((points * size + [10 * group, 0, 0]).astype(np.float32))
            sensors.append([10 * group + random.normal(0, 0.5), -8.0, 1.0])
            groups.append(group)
    return TrainingSet(
        Segments.of(clouds, np.array(sensors)), np.array(groups, dtype=np.int64), PROTOCOL_V1
    )


@pytest.fixture(scope="session")
def shapes() -> TrainingSet:
    return make_shapes(views=6, seed=0)


@pytest.fixture(scope="session")
def other_views() -> TrainingSet:
    return make_shapes(views=4, seed=1)
