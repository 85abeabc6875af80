"""The shipped decoder makes shapes that resemble the segments."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from placecell.descriptors.manifest import SHAPE_FILE, Manifest, ModelError
from placecell.descriptors.shipped_models import MODELS_FOLDER
from placecell.shapes.decoder import ShapeDecoder, load_shape_decoder
from placecell.shapes.geometry import points_of
from service.clouds.map_shapes import decoded_points, stored_segments
from tests.placecell.shapes.shape_builders import FOLDER, map_of, walls


@pytest.fixture(scope="module")
def decoder() -> ShapeDecoder:
    return ShapeDecoder(FOLDER, Manifest.load(FOLDER))


@pytest.mark.parametrize("extents", [True, False])
def test_decoded_points_lie_near_the_segment(decoder: ShapeDecoder, extents: bool) -> None:
    segments = walls()
    points, owners = decoded_points(map_of(segments, extents=extents), decoder)
    assert np.unique(owners).tolist() == [0, 1, 2, 3]
    for index in range(len(segments)):
        cloud = segments.cloud(index)
        away = np.linalg.norm(points[owners == index][:, None] - cloud[None], axis=2).min(axis=1)
        assert away.mean() < 0.6


def test_box_keeps_the_shape_inside(decoder: ShapeDecoder) -> None:
    segments = walls()
    points, owners = decoded_points(map_of(segments), decoder)
    low, high = segments.bounds()
    for index in range(len(segments)):
        sides = np.ptp(points[owners == index], axis=0)
        assert (sides <= high[index] - low[index] + 1.5).all()


def test_shape_turns_with_the_map(decoder: ShapeDecoder) -> None:
    """A segment has the same grid wherever the map lies, without the box along the map's axes."""
    segments = walls()
    content = map_of(segments, extents=False)
    stored = stored_segments(content)
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
    moved = stored_segments(
        type(content)(
            **{
                name: getattr(content, name)
                for name in content.__dataclass_fields__
                if name not in {"centroids", "frame_positions"}
            },
            centroids=content.centroids @ turn.T + [5, 6, 0],
            frame_positions=content.frame_positions @ turn.T + [5, 6, 0],
        )
    )
    here, there = points_of(decoder.decode(stored))[0], points_of(decoder.decode(moved))[0]
    # The bearing is one of the inputs, but without a box it says nothing.
    common = min(len(here), len(there))
    assert common > 0.7 * max(len(here), len(there))


def test_batches_do_not_change_a_shape(decoder: ShapeDecoder) -> None:
    stored = stored_segments(map_of(walls(6)))
    whole = decoder.decode(stored)
    alone = decoder.decode(stored.part(3, 4))
    assert (whole.occupancy[3] != alone.occupancy[0]).mean() < 1e-3
    assert np.allclose(whole.centers[3], alone.centers[0], atol=0.02)


def test_model_without_a_decoder_is_told(tmp_path: Path) -> None:
    folder = MODELS_FOLDER / "eigenvalue"
    manifest = Manifest.load(folder)
    assert load_shape_decoder(folder, manifest) is None
    with pytest.raises(ModelError, match="has no shape decoder"):
        ShapeDecoder(folder, manifest)
    shutil.copytree(FOLDER, tmp_path / "model")
    (tmp_path / "model" / SHAPE_FILE).write_bytes(b"no network")
    with pytest.raises(ModelError, match="cannot be loaded"):
        ShapeDecoder(tmp_path / "model", Manifest.load(FOLDER))
