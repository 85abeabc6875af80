"""Context model: projection of the neighborhood, its part of the descriptor, and the export."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import onnxruntime
import pytest
import torch

from placecell.core.parameters import NEIGHBORHOOD_V1, PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.core.types import Float32
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.neighborhood import describe_neighborhood
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.shipped_models import model_folder
from placecell.descriptors.voxels import voxelize
from training.data.training_set import TrainingSet
from training.export.onnx_graph import Exported, ExportedContext, export_onnx
from training.export.publishing import Data, publish_network
from training.export.quantization import quantize
from training.export.refitting import publish_refit
from training.methods import registry
from training.methods.context import (
    ContextRecipe,
    Projection,
    group_weights,
    height_scatter,
    learn_neighborhood,
    learn_rotation,
    rotation,
    scatter,
)
from training.methods.fit import Sgd
from training.methods.group_based import GroupBasedRecipe
from training.methods.networks import DescriptorNetwork, normalization_statistics
from training.methods.run import Run

SIZE = NEIGHBORHOOD_V1.size


def many_groups(seed: int, groups: int = 60, views: int = 5) -> TrainingSet:
    """Return boxes of many sizes whose neighborhoods are similar per group, with local noise."""
    random = np.random.default_rng(seed)
    world = np.random.default_rng(99)
    sizes, places = world.uniform(0.6, 4.0, (groups, 3)), world.uniform(0, 1, (groups, SIZE))
    clouds, labels, around = [], [], []
    for group in np.repeat(np.arange(groups), views):
        clouds.append((random.uniform(-0.5, 0.5, (60, 3)) * sizes[group]).astype(np.float32))
        labels.append(group)
        seen = places[group] + random.normal(0, 0.05, SIZE)
        seen[:20] += random.normal(0, 2, 20)
        around.append(np.abs(seen))
    return TrainingSet(
        Segments.of(clouds, np.full((len(clouds), 3), -8.0)),
        np.array(labels),
        PROTOCOL_V1,
        np.array(around, dtype=np.float32),
    )


def test_projection_keeps_views_of_a_group_together() -> None:
    data = many_groups(seed=0)
    assert data.neighborhood is not None
    projection = learn_neighborhood(data, ContextRecipe(dimension=8))
    strength = np.abs(projection.axes).mean(axis=1)
    assert strength[:20].mean() < 0.3 * strength[20:].mean()
    assert projection.mean == pytest.approx(data.neighborhood.mean(axis=0), abs=1e-4)
    projected = (data.neighborhood - projection.mean) @ projection.axes
    projected /= np.linalg.norm(projected, axis=1, keepdims=True)
    assert projection.center == pytest.approx(projected.mean(axis=0), abs=1e-4)
    # New views of a group are closer to one another than to those of other groups.
    fresh = many_groups(seed=1)
    assert fresh.neighborhood is not None
    found = (fresh.neighborhood - projection.mean) @ projection.axes
    found /= np.linalg.norm(found, axis=1, keepdims=True)
    distances = np.linalg.norm(found[:, None] - found[None], axis=2)
    np.fill_diagonal(distances, np.inf)
    assert (fresh.groups[distances.argmin(axis=1)] == fresh.groups).mean() > 0.9


def test_axes_of_descriptors_are_learned_from_real_streets() -> None:
    data = many_groups(seed=0)
    made_up = data.groups >= 40
    recorded = replace(data, synthetic=made_up).recorded()
    assert recorded.groups.tolist() == data.groups[~made_up].tolist()
    assert recorded.neighborhood is not None
    assert data.neighborhood is not None
    assert (recorded.neighborhood == data.neighborhood[~made_up]).all()
    # If all segments are synthetic, or this is unknown, all of them are used.
    town = replace(data, synthetic=np.ones(len(data), dtype=bool))
    assert town.recorded() is town
    assert data.recorded() is data


def test_scatter_by_hand() -> None:
    values = np.array([[0.0, 0], [2, 0], [5, 1], [5, 4], [5, 7]])
    groups, one_place = np.array([0, 0, 1, 1, 1]), np.zeros((5, 3), np.float32)
    within, centers = scatter(values, groups, one_place, np.ones(2))
    # Unbiased variances: 2 along x in the first group, 9 along y in the second; their mean.
    assert within == pytest.approx(np.array([[1.0, 0], [0, 4.5]]))
    assert centers.tolist() == [[1.0, 0], [5, 4]]
    within, _ = scatter(values, groups, one_place, np.array([0.5, 1.5]))
    assert within == pytest.approx(np.array([[0.5, 0], [0, 6.75]]))


def test_views_from_far_apart_weigh_more() -> None:
    values = np.array([[0.0, 0], [0, 1], [3, 0]])
    sensors = np.array([[0.0, 0, 0], [0, 0, 9], [5, 0, 0]], dtype=np.float32)
    within, _ = scatter(values, np.zeros(3, dtype=int), sensors, np.ones(1))
    # Half the squared differences of the three pairs; the height of the sensor does not count.
    pairs = [(0.4, (0, 1)), (5.4, (3, 0)), (5.4, (3, -1))]
    expected = sum(weight * np.outer(offset, offset) for weight, offset in pairs) / 2
    assert within == pytest.approx(expected / sum(weight for weight, _ in pairs))
    # Beyond 12 m the distance adds no weight.
    near, far = (np.array([[0.0, 0, 0], [12, 0, 0], [0, 12, 0]], np.float32) * f for f in (1, 9))
    assert scatter(values, np.zeros(3, dtype=int), near, np.ones(1))[0] == pytest.approx(
        scatter(values, np.zeros(3, dtype=int), far, np.ones(1))[0]
    )


def test_recorded_groups_have_half_of_the_weight() -> None:
    weights = group_weights(np.array([False, True, True, True, True]), 0.5)
    assert weights.tolist() == [2.5, 0.625, 0.625, 0.625, 0.625]
    assert group_weights(np.array([True, True]), 0.5).tolist() == [1, 1]
    assert group_weights(np.array([False, False]), 0.5).tolist() == [1, 1]


def test_groups_have_equal_weight_at_any_size() -> None:
    data = many_groups(seed=0)
    often = data.take(np.concatenate([np.arange(len(data)), *[np.arange(25)] * 40]))
    assert data.neighborhood is not None
    assert often.neighborhood is not None
    within, centers, again, same = (
        result
        for each in (data, often)
        for result in scatter(
            np.asarray(each.neighborhood, np.float64),
            each.groups,
            each.segments.sensors,
            np.ones(len(each.group_sizes())),
        )
    )
    assert same == pytest.approx(centers)
    # Five views of each group, repeated 41 times, add no information but for the unbiased estimate.
    assert np.trace(again) == pytest.approx(np.trace(within), rel=0.03)


def test_too_few_groups_raise_an_error() -> None:
    with pytest.raises(ValueError, match="longer drive"):
        learn_neighborhood(many_groups(seed=0, groups=6), ContextRecipe(dimension=8))


def test_rotation_keeps_distances_and_is_fixed() -> None:
    turn = rotation(64)
    assert turn @ turn.T == pytest.approx(np.eye(64), abs=1e-5)
    assert (turn == rotation(64)).all()


def test_learned_rotation_loses_less_by_quantization() -> None:
    random = np.random.default_rng(0)
    corners = random.choice([-3.0, -1, 1, 3], (4000, 8)).astype(np.float32)
    spread = corners + random.normal(0, 0.2, corners.shape).astype(np.float32)
    descriptors = spread @ rotation(8)

    def loss(turn: np.ndarray) -> float:
        turned = descriptors @ turn
        quantizer = Quantizer.fit(turned, 4)
        return float(np.square(quantizer.decode(quantizer.encode(turned)) - turned).mean())

    learned = learn_rotation(descriptors, 4)
    assert learned @ learned.T == pytest.approx(np.eye(8), abs=1e-5)
    assert loss(learned) < 0.9 * loss(rotation(8))
    assert (learned == learn_rotation(descriptors, 4)).all()


def exported(
    data: TrainingSet, dimension: int = 8, statistics: tuple[Float32, Float32] | None = None
) -> ExportedContext:
    torch.manual_seed(0)
    network = DescriptorNetwork("fast", *(statistics or normalization_statistics(data))).eval()
    random = np.random.default_rng(0)
    projection = Projection(
        np.zeros(SIZE, np.float32),
        random.normal(size=(SIZE, dimension)).astype(np.float32),
        1.2,
        np.zeros(dimension, np.float32),
    )
    axes = np.eye(64, dimension, dtype=np.float32)
    segment = Exported(network, np.zeros(64, np.float32), axes)
    return ExportedContext(segment, projection, rotation(2 * dimension)).eval()


def test_onnx_equals_torch_and_8_bits_come_close(tmp_path: Path) -> None:
    data = many_groups(seed=0, groups=20)
    network = exported(data)
    export_onnx(network, PROTOCOL_V1.grid, tmp_path / "full.onnx")
    occupancy, extents = voxelize(data.segments, data.parameters)
    assert data.neighborhood is not None
    given = {"occupancy": occupancy, "extents": extents, "surroundings": data.neighborhood}
    (found,) = onnxruntime.InferenceSession(tmp_path / "full.onnx").run(["descriptor"], given)
    with torch.no_grad():
        expected = network(*(torch.from_numpy(value) for value in given.values())).numpy()
    assert found == pytest.approx(expected, abs=1e-4)
    quantize(tmp_path / "full.onnx", data, tmp_path / "small.onnx")
    (small,) = onnxruntime.InferenceSession(tmp_path / "small.onnx").run(["descriptor"], given)
    errors = np.linalg.norm(small - expected, axis=1)
    spread = np.linalg.norm(expected - np.roll(expected, 7, axis=0), axis=1)
    assert 0 < errors.mean() < 0.1 * spread.mean()
    content = (tmp_path / "small.onnx").read_bytes()
    assert b"QuantizeLinear" in content
    assert str(tmp_path).encode() not in content


def test_8_bits_come_close_although_a_rare_voxel_has_a_huge_value(tmp_path: Path) -> None:
    data = many_groups(seed=0, groups=20)
    occupancy, extents = voxelize(data.segments, data.parameters)
    mean, deviation = normalization_statistics(data)
    occupied = np.count_nonzero(occupancy, axis=0)
    rare = tuple(np.argwhere(occupied == 1)[0])
    deviation[rare] = np.sort(deviation[occupied > 1])[0] / 300
    others = np.flatnonzero(occupancy[(slice(None), *rare)] == 0)
    network = exported(data, statistics=(mean, deviation))
    assert data.neighborhood is not None
    given = {"occupancy": occupancy, "extents": extents, "surroundings": data.neighborhood}
    with torch.no_grad():
        expected = network(*(torch.from_numpy(value) for value in given.values())).numpy()
    export_onnx(network, PROTOCOL_V1.grid, tmp_path / "full.onnx")
    quantize(tmp_path / "full.onnx", data, tmp_path / "small.onnx")
    (small,) = onnxruntime.InferenceSession(tmp_path / "small.onnx").run(["descriptor"], given)
    errors = np.linalg.norm(small - expected, axis=1)[others]
    spread = np.linalg.norm(expected - np.roll(expected, 7, axis=0), axis=1)
    assert errors.mean() < 0.1 * spread.mean()


def test_segment_without_neighborhood_is_ranked_by_its_own_part() -> None:
    data = many_groups(seed=0, groups=20)
    network = exported(data)
    occupancy, extents = map(torch.from_numpy, voxelize(data.segments, data.parameters))
    around = torch.from_numpy(data.neighborhood)
    with torch.no_grad():
        own = network.segment(occupancy, extents).numpy()
        stored = network(occupancy, extents, around).numpy()
        alone = network(occupancy, extents, torch.zeros_like(around)).numpy()
    # The segment's part has the length of a complete descriptor, so its ranking stays the same.
    longer = np.sqrt(1 + 1.2**2)
    assert (np.linalg.norm(alone, axis=1) / np.linalg.norm(own, axis=1)) == pytest.approx(longer)
    squared = np.square(alone[:, None] - stored[None]).sum(axis=2)
    expected = np.square(longer * own[:, None] - own[None]).sum(axis=2) + 1.2**2
    assert squared == pytest.approx(expected, rel=1e-3)


def test_context_training_publishes_a_usable_model(tmp_path: Path) -> None:
    data = many_groups(seed=0)
    training, validation = data.split(0.4, seed=0)
    recipe = ContextRecipe(
        segment=GroupBasedRecipe(epochs=1, sgd=Sgd(0.05, batch=32)), dimension=32
    )
    trained = registry.train(
        "context", training, validation, Run(tmp_path / "run", 0), recipe=recipe
    )
    provenance = {
        "sources": [{"drive": "toy", "scans": [0, 1], "frame_step": 1, "segments": 9}],
        "validation_share": 0.4,
        "licence": "free",
        "seed": 0,
        "seconds": 0.0,
        "machine": {"cores": 1},
        "command": "x",
    }
    manifest = publish_network(tmp_path / "toy", trained, Data(training, validation, provenance))
    assert manifest.model_id == Manifest.load(tmp_path / "toy").model_id
    assert manifest.neighborhood == NEIGHBORHOOD_V1
    assert (manifest.dimension, manifest.code_bytes) == (64, 16)
    figures = manifest.figures["validation"]
    assert figures["top1"] > figures["alone"]["top1"]
    # The extractor assumes that the segments were seen together.
    extractor = load_extractor(tmp_path / "toy")
    together = extractor.describe(data.segments)
    around = describe_neighborhood(data.segments)
    assert (together == extractor.describe(data.segments, around)).all()
    assert not np.allclose(together, extractor.describe(data.segments, np.zeros_like(around)))


def apart(folder: Path, data: TrainingSet, neighborhood: Float32 | None) -> Float32:
    """Return the distances between the descriptors, which no rotation changes."""
    described = load_extractor(folder).describe(data.segments, neighborhood)
    return np.asarray(np.linalg.norm(described[:, None] - described[None], axis=2))


def test_shift_of_heights_scatters_only_neighboring_layers() -> None:
    rings, layers = NEIGHBORHOOD_V1.shape
    centers = np.zeros((2, rings, layers))
    centers[0, 5, 3] = 2.0
    centers[1, 7, 0] = 4.0
    found = height_scatter(centers.reshape(2, -1), np.array([3.0, 1.0]))
    expected = np.zeros((rings, layers, rings, layers))
    # A shift takes from a layer what it gives to the next one, and returns it the other way.
    expected[5, 2, 5, 2] = expected[5, 4, 5, 4] = 3 / 4
    expected[5, 2, 5, 4] = expected[5, 4, 5, 2] = -3 / 4
    expected[7, 1, 7, 1] = 4 / 4
    assert found.reshape(expected.shape) == pytest.approx(expected)


def test_only_synthetic_drives_alone_get_the_scatter_of_heights() -> None:
    data = many_groups(seed=0)
    count = len(data.groups)

    def axes(synthetic: np.ndarray | None, heights: float) -> Float32:
        recipe = ContextRecipe(dimension=8, heights=heights)
        return learn_neighborhood(replace(data, synthetic=synthetic), recipe).axes

    made_up, mixed = np.ones(count, dtype=bool), data.groups > 5
    assert np.abs(axes(made_up, 2.0) - axes(made_up, 0.0)).max() > 0.01
    assert (axes(mixed, 2.0) == axes(mixed, 0.0)).all()
    assert (axes(None, 2.0) == axes(None, 0.0)).all()


def test_refit_keeps_the_network_and_fits_the_rest(tmp_path: Path) -> None:
    data = many_groups(seed=0)
    training, validation = data.split(0.4, seed=0)
    provenance = {
        "sources": [{"drive": "toy", "scans": [0, 1], "frame_step": 1, "segments": 9}],
        "validation_share": 0.4,
        "licence": "free",
        "seed": 0,
        "seconds": 7.0,
        "machine": {"cores": 1},
        "command": "train",
    }
    given = Data(training, validation, provenance)
    recipe = ContextRecipe(
        segment=GroupBasedRecipe(epochs=1, sgd=Sgd(0.05, batch=32)), dimension=32
    )
    run = Run(tmp_path / "run", 0)
    trained = registry.train("context", training, validation, run, recipe=recipe)
    first = publish_network(tmp_path / "toy", trained, given)
    # The same drives give the same model.
    again = publish_refit(tmp_path / "same", tmp_path / "toy", given, recipe)
    one, other = (apart(tmp_path / name, data, data.neighborhood) for name in ("toy", "same"))
    assert other == pytest.approx(one, abs=1e-3)
    assert again.dimension == first.dimension
    # Other neighborhoods change the descriptors in context, but not those of segments alone.
    fresh = many_groups(seed=1)
    moved = replace(data, neighborhood=np.asarray(fresh.neighborhood)[:, ::-1].copy())
    changed = given.stating(seconds=0.0, command="refit")
    changed = replace(changed, training=moved.take(np.arange(180)))
    refit = publish_refit(tmp_path / "toy", tmp_path / "toy", changed, recipe)
    assert refit.model_id not in (first.model_id, again.model_id)
    assert refit.training["command"] == "train\nrefit"
    assert refit.training["seconds"] == 7.0
    nothing = np.zeros_like(np.asarray(data.neighborhood))
    alone, before = (apart(tmp_path / name, data, nothing) for name in ("toy", "same"))
    assert alone == pytest.approx(before, abs=1e-3)
    seen = apart(tmp_path / "toy", data, data.neighborhood)
    assert np.abs(seen - one).max() > 0.1


def test_refit_of_another_method_raises_an_error(tmp_path: Path) -> None:
    data = many_groups(seed=0)
    with pytest.raises(ValueError, match="method context"):
        publish_refit(tmp_path / "toy", model_folder("group"), Data(data, data, {}))
