from dataclasses import replace
from pathlib import Path

import numpy as np
import onnx
import pytest
from onnx import TensorProto, helper, numpy_helper

from placecell.core.parameters import PROTOCOL_V1
from placecell.core.segments import Segments
from placecell.descriptors.eigenvalue import eigenvalue_descriptors
from placecell.descriptors.extractor import BATCH, load_extractor
from placecell.descriptors.manifest import Manifest, ModelError, preprocessing_of
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.voxels import voxelize
from tests.placecell.segment_builders import many_segments

NOTHING = Segments.of([], np.zeros((0, 3)))
SIZES = [5, 100, 700, 3000, 60]


def toy_network(file: Path) -> None:
    """Write a network whose descriptor is the occupied voxels of each of 38 slices, and extents."""
    axes = numpy_helper.from_array(np.array([2, 3], np.int64), "axes")
    graph = helper.make_graph(
        [
            helper.make_node("Cast", ["occupancy"], ["grid"], to=TensorProto.FLOAT),
            helper.make_node("ReduceSum", ["grid", "axes"], ["slices"], keepdims=0),
            helper.make_node("Concat", ["slices", "extents"], ["descriptor"], axis=1),
        ],
        "toy",
        [
            helper.make_tensor_value_info("occupancy", TensorProto.UINT8, ["n", 38, 38, 18]),
            helper.make_tensor_value_info("extents", TensorProto.FLOAT, ["n", 3]),
        ],
        [helper.make_tensor_value_info("descriptor", TensorProto.FLOAT, ["n", 41])],
        [axes],
    )
    model = helper.make_model(graph, opset_imports=[helper.make_opsetid("", 17)], ir_version=8)
    onnx.checker.check_model(model)
    onnx.save(model, file)


@pytest.fixture
def learned(tmp_path: Path) -> Path:
    toy_network(tmp_path / "model.onnx")
    manifest = Manifest(
        name="toy",
        method="group",
        network="toy",
        dimension=41,
        quantizer=Quantizer(step=1.0),
        preprocessing=preprocessing_of(PROTOCOL_V1),
    )
    manifest.with_files(tmp_path, ["model.onnx"]).save(tmp_path)
    return tmp_path


@pytest.fixture
def baseline(tmp_path: Path) -> Path:
    Manifest(
        name="eigenvalue",
        method="eigenvalue",
        network="",
        dimension=7,
        quantizer=Quantizer(step=0.05),
        preprocessing=preprocessing_of(PROTOCOL_V1),
        standardization={"mean": [0.5] * 7, "deviation": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]},
    ).save(tmp_path)
    return tmp_path


def test_network_is_given_the_grids_and_the_extents(learned: Path) -> None:
    segments = many_segments(SIZES)
    occupancy, extents = voxelize(segments, PROTOCOL_V1)
    descriptors = load_extractor(learned, threads=1).describe(segments)
    assert descriptors.dtype == np.float32
    assert np.array_equal(descriptors[:, :38], occupancy.sum(axis=(2, 3)))
    assert np.array_equal(descriptors[:, 38:], extents)


def test_baseline_is_standardized(baseline: Path) -> None:
    segments = many_segments(SIZES)
    descriptors = load_extractor(baseline).describe(segments)
    raw = eigenvalue_descriptors(segments)
    assert descriptors.dtype == np.float32
    for column, deviation in enumerate([0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]):
        assert descriptors[:, column] == pytest.approx((raw[:, column] - 0.5) / deviation, abs=1e-5)


@pytest.mark.parametrize("kind", ["learned", "baseline"])
def test_result_does_not_depend_on_the_other_segments(
    kind: str, request: pytest.FixtureRequest
) -> None:
    extractor = load_extractor(request.getfixturevalue(kind), threads=1)
    segments = many_segments(SIZES)
    together = extractor.describe(segments)
    for index in range(len(segments)):
        alone = extractor.describe(segments.take([index]))
        assert alone[0] == pytest.approx(together[index], abs=1e-5)


def test_more_segments_than_a_batch(learned: Path) -> None:
    extractor = load_extractor(learned, threads=1)
    segments = many_segments([20] * (2 * BATCH + 3))
    descriptors = extractor.describe(segments)
    assert descriptors.shape == (2 * BATCH + 3, 41)
    last = extractor.describe(segments.take([len(segments) - 1]))
    assert last[0] == pytest.approx(descriptors[-1], abs=1e-5)


@pytest.mark.parametrize(("kind", "dimension"), [("learned", 41), ("baseline", 7)])
def test_no_segments(kind: str, dimension: int, request: pytest.FixtureRequest) -> None:
    descriptors = load_extractor(request.getfixturevalue(kind)).describe(NOTHING)
    assert descriptors.shape == (0, dimension)
    assert descriptors.dtype == np.float32


def test_model_id_comes_with_the_extractor(learned: Path) -> None:
    assert load_extractor(learned).manifest.model_id == Manifest.load(learned).model_id


def test_file_that_is_no_network(learned: Path) -> None:
    (learned / "model.onnx").write_bytes(b"not a network")
    manifest = Manifest(
        name="toy",
        method="group",
        network="toy",
        dimension=41,
        quantizer=Quantizer(step=1.0),
        preprocessing=preprocessing_of(PROTOCOL_V1),
    )
    manifest.with_files(learned, ["model.onnx"]).save(learned)
    with pytest.raises(ModelError, match=r"model\.onnx: cannot be loaded"):
        load_extractor(learned)


def test_network_that_the_manifest_does_not_name(learned: Path) -> None:
    # Its hash would be missing from the model's id.
    replace(Manifest.load(learned), files={}).save(learned)
    with pytest.raises(ModelError, match=r"manifest\.json: .*model\.onnx"):
        load_extractor(learned)


@pytest.mark.parametrize(
    "standardization", [{}, {"mean": [0.0] * 7}, {"mean": [0.0], "deviation": [1.0]}]
)
def test_baseline_without_its_statistics(
    baseline: Path, standardization: dict[str, list[float]]
) -> None:
    replace(Manifest.load(baseline), standardization=standardization).save(baseline)
    with pytest.raises(ModelError, match=r"manifest\.json: .*standardisation"):
        load_extractor(baseline)
