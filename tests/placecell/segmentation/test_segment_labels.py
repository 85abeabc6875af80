"""Tests of the classes of segments, from labels of points."""

from collections import deque

import numpy as np

from placecell.core.types import UInt8
from placecell.datasets.labels import NO_CLASS
from placecell.segmentation.segment_labels import (
    LabeledVoxels,
    majority,
    voxel_classes,
    voxel_keys,
)


def classes(*values: int) -> UInt8:
    return np.array(values, np.uint8)


def test_voxel_has_the_most_common_class_of_all_scans() -> None:
    voxels = voxel_keys(np.array([[0.05, 0, 0], [1.05, 0, 0], [-0.05, 0, 0]], np.float32), 0.1)
    first = np.array([[0.01, 0.01, 0.01], [0.09, 0, 0], [1.01, 0, 0]], np.float32)
    second = np.array([[0.02, 0, 0], [50.0, 0, 0]], np.float32)
    scans = deque(
        [
            LabeledVoxels(voxel_keys(first, 0.1), classes(3, 0, 1)),
            LabeledVoxels(voxel_keys(second, 0.1), classes(3, 2)),
        ]
    )
    assert voxel_classes(voxels, scans).tolist() == [3, 1, NO_CLASS]


def test_segment_has_the_class_of_most_of_its_points() -> None:
    owners = np.array([0, 0, 0, 1, 1, 1, 2])
    found = majority(classes(4, 4, 1, NO_CLASS, NO_CLASS, 2, 7), owners, 4)
    assert found[:3].tolist() == [4, NO_CLASS, 7]
