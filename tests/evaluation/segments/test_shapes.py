"""Figures of reconstruction, by hand and on a few walls."""

import numpy as np
import pytest

from evaluation.segments.shapes import CodedGrids, by_size, chamfer, overlap, shape_figures
from placecell.core.segments import Segments
from placecell.descriptors.extractor import load_extractor
from placecell.shapes.decoder import Shapes, load_shape_decoder
from tests.placecell.segment_builders import one_scan_recording
from tests.placecell.shapes.shape_builders import FOLDER, walls


def test_overlap_by_hand() -> None:
    one = np.array([[[[True, True, False, False]]], [[[False, False, False, False]]]])
    other = np.array([[[[False, True, True, False]]], [[[False, False, False, False]]]])
    assert overlap(one, other).tolist() == pytest.approx([1 / 3, 0])


def test_sizes_by_hand() -> None:
    found = by_size(np.array([0.2, 0.4, 0.6, 0.8]), np.array([100, 249, 250, 5000]))
    assert found == {
        "below 250": {"segments": 2, "iou": 0.3},
        "250 to 499": {"segments": 1, "iou": 0.6},
        "500 to 1499": {"segments": 0, "iou": None},
        "from 1500": {"segments": 1, "iou": 0.8},
    }


def test_chamfer_by_hand() -> None:
    cloud = np.array([[1.1, 0.1, 0.1], [1.3, 0.1, 0.1]], np.float32)
    grid = np.zeros((1, 2, 2, 2), bool)
    grid[0, 1, 1, 1] = True
    # The decoded point is 1.1, 0.1, 0.1: 0 from the cloud; the cloud is 0 and 0.2 from it.
    shapes = Shapes(grid, np.array([[1.0, 0, 0]]), np.zeros(1), 0.2)
    segments = Segments.of([cloud], np.zeros((1, 3)))
    assert chamfer(shapes, segments) == pytest.approx(0.05, abs=1e-4)
    nothing = Shapes(grid & False, shapes.centers, shapes.bearings, 0.2)
    assert chamfer(nothing, segments) == pytest.approx(0.2, abs=1e-4)


def test_decoder_beside_the_baseline() -> None:
    extractor = load_extractor(FOLDER)
    decoder = load_shape_decoder(FOLDER, extractor.manifest)
    known = one_scan_recording(walls(8, seed=1), "known")
    figures = shape_figures(walls(), extractor.describe(walls()), extractor, decoder, known)
    assert figures["reconstructed"] == 4
    assert 0.05 < figures["iou"] <= 1
    assert 0 < figures["baseline_iou"] <= 1
    assert figures["baseline_training"] == "known"
    assert 0 < figures["chamfer_m"] < 0.6
    # Segments that the baseline knows are given back nearly whole.
    segments = known.segments
    again = shape_figures(segments, extractor.describe(segments), extractor, decoder, known)
    assert again["nearest_code_iou"] > 0.99


def test_model_without_a_decoder_has_no_figures() -> None:
    extractor = load_extractor(FOLDER)
    figures = shape_figures(walls(), extractor.describe(walls()), extractor, None, None)
    assert figures["iou"] is None
    assert figures["reconstructed"] == 0


def test_grids_are_of_the_drawn_segments() -> None:
    extractor = load_extractor(FOLDER)
    some = CodedGrids.drawn(one_scan_recording(walls(8), "walls"), extractor, 3, seed=0)
    assert len(some.codes) == len(some.segments) == len(some.grids) == 3
    assert some.grids.any(axis=(1, 2, 3)).all()
    assert some.stored(extents=False).extents is None
