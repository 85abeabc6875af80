"""The batches of the shape decoder's training, and the logits of some and of all voxels."""

import numpy as np
import pytest
import torch

from training.shapes.learning import ShapeRecipe, alike, drawn_voxels
from training.shapes.network import ShapeNetwork, shape_loss

GRID = (6, 5, 4)


def test_logits_of_some_voxels_are_those_of_the_whole_grid() -> None:
    torch.manual_seed(0)
    network = ShapeNetwork(np.eye(8, dtype=np.float32), GRID, 0.2)
    given = (
        torch.randn(3, 8),
        torch.tensor([[5.0, 1.0], [9.0, 0.0], [20.0, -1.0]]),
        torch.tensor([0.3, -2.0, 1.0]),
        torch.tensor([[0.4, 0.6, 0.5], [0.0, 0.0, 0.0], [1.0, 0.4, 0.4]]),
        torch.tensor([100.0, 0.0, 500.0]),
    )
    whole = network(*given)[0].flatten(1)
    voxels = torch.tensor([0, 7, 33, 64, 101, 119])
    torch.testing.assert_close(network.at(voxels, *given)[0], whole[:, voxels])
    assert whole.std(dim=1).min() > 0


def test_batches_hold_each_segment_once_with_boxes_of_similar_size() -> None:
    random = np.random.default_rng(0)
    reach = random.integers(1, 20, (2000, 3))
    batches = list(alike(reach, 40, random))
    assert len(batches) == 40
    np.testing.assert_array_equal(np.sort(np.concatenate(batches)), np.arange(2000))
    spread = np.mean([np.ptp(reach[rows, :2].max(axis=1)) for rows in batches])
    assert spread < np.ptp(reach[:, :2]) / 3


def test_drawn_voxels_stand_for_the_whole_grid() -> None:
    recipe = ShapeRecipe(inside=30, outside=20)
    voxels, weights = drawn_voxels(np.array([2, 2, 9]), GRID, recipe, np.random.default_rng(0))
    assert len(np.unique(voxels)) == 50
    assert weights.sum() == pytest.approx(np.prod(GRID))
    column, row, _ = np.unravel_index(voxels[:30], GRID)
    assert set(column) <= {1, 2, 3, 4}
    assert set(row) == {0, 1, 2, 3, 4}
    few, counted = drawn_voxels(np.array([1, 1, 1]), GRID, recipe, np.random.default_rng(0))
    assert counted[: np.argmax(counted > 1)].tolist() == [1.0] * 12
    assert len(few) == 32


def test_loss_with_weights_is_the_loss_of_repeated_voxels() -> None:
    logits, occupied = torch.randn(2, 3), torch.tensor([[1.0, 0.0, 1.0], [0.0, 0.0, 1.0]])
    weighted = shape_loss(logits, occupied, weights=torch.tensor([1.0, 2.0, 1.0]))
    columns = torch.tensor([0, 1, 1, 2])
    repeated = shape_loss(logits[:, columns], occupied[:, columns])
    for one, other in zip(weighted, repeated, strict=True):
        torch.testing.assert_close(one, other)
