"""Classes of segments in `/describe`, from a head that computes them from the features."""

from typing import Any

import numpy as np
import pytest
from placecell_client import Client, encode
from placecell_client.classes import class_names, class_probabilities
from placecell_client.http.encoding import MEDIA_TYPES

from placecell.core.segment_classes import ClassFilter, class_indices, encoded
from placecell.core.types import Float32, UInt8
from placecell.descriptors.extractor import EigenvalueExtractor, Inputs
from placecell.descriptors.manifest import Manifest
from tests.service.service_builders import (
    MSGPACK,
    cloud,
    map_of,
    post_packed,
    random_codes,
    request_of,
)
from tests.service.service_builders import packed as packed_body

CLOUDS = [cloud(seed) for seed in range(12)]


def classify(self: EigenvalueExtractor, inputs: Inputs, descriptors: Float32) -> UInt8:
    """Return a class that depends on the segment alone; some are unknown."""
    numbers = np.abs(inputs["features"][:, 0] * 1e4).astype(np.int64)
    return encoded(numbers % 9 - 1, numbers % 31 / 30)


@pytest.fixture
def headed(service: Any, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Return a service whose model has a semantic head."""
    monkeypatch.setattr(EigenvalueExtractor, "has_classes", True)
    monkeypatch.setattr(EigenvalueExtractor, "classify", classify)
    return service


def test_describe_without_a_head_has_no_classes(service: Any) -> None:
    assert "classes" not in service.post("/describe", json=request_of(CLOUDS)).json()
    client = Client("http://testserver", transport=service._transport)
    assert client.describe(CLOUDS, [9.0, -3.0, 1.7]).classes is None


def test_classes_of_both_encodings_are_equal(headed: Any) -> None:
    told = headed.post("/describe", json=request_of(CLOUDS)).json()
    blob = post_packed(headed, "/describe", packed_body(request_of(CLOUDS)))
    assert blob.headers["content-type"] == MSGPACK
    described = [
        Client("http://testserver", transport=headed._transport, encoding=encoding).describe(
            CLOUDS, [9.0, -3.0, 1.7]
        )
        for encoding in MEDIA_TYPES
    ]
    one, other = (each.classes for each in described)
    assert one is not None
    assert other is not None
    np.testing.assert_array_equal(one, other)
    names = class_names(one)
    assert len({*names}) > 3
    assert [each and each["name"] for each in told["classes"]] == names
    assert [each["probability"] for each in told["classes"] if each] == pytest.approx(
        class_probabilities(one)[one > 0], abs=1e-3
    )


def test_unusable_segment_has_an_unknown_class(headed: Any) -> None:
    clouds = [CLOUDS[0], CLOUDS[1][:2], CLOUDS[2]]
    whole = headed.post("/describe", json=request_of(CLOUDS)).json()["classes"]
    told = headed.post("/describe", json=request_of(clouds)).json()
    assert "error" in told["descriptors"][1]
    assert told["classes"] == [whole[0], None, whole[2]]


def test_added_scan_stores_the_classes(headed: Any, manifest: Manifest) -> None:
    rng = np.random.default_rng(0)
    ground = np.column_stack([rng.uniform(-20, 20, (9000, 2)), np.full(9000, -1.7)])
    boxes = [rng.uniform(-0.5, 0.5, (900, 3)) + [6.0 * n - 9, 8, -0.7] for n in range(4)]
    file = np.concatenate([ground, *boxes]).astype(np.float32)
    client = Client("http://testserver", transport=headed._transport)
    added = client.add_scan("yard", ply_of(file), file_name="scan.ply", robot="ann", create=True)
    stored = client.get_map("yard")
    assert len(stored) == len(added.ids) > 0
    assert stored.classes is not None
    # A map without classes stays one.
    bare = map_of(random_codes(3), manifest.model_id)
    assert headed.put("/maps/bare", content=encode(bare)).status_code == 201
    client.add_scan("bare", ply_of(file), file_name="scan.ply", robot="ann")
    assert client.get_map("bare").classes is None


def ply_of(points: Float32) -> bytes:
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(points)}\n"
        "property float x\nproperty float y\nproperty float z\nend_header\n"
    )
    return head.encode() + points.astype("<f4").tobytes()


def test_filter_by_hand() -> None:
    codes = encoded([-1, 0, 1, 3, 4], [0.5] * 5)
    ignoring = ClassFilter.of(None, ["movable"])
    assert ignoring is not None
    assert ignoring.keeps(codes).tolist() == [True, True, True, False, False]
    assert ignoring.keeps_query(codes).tolist() == [True, True, True, False, False]
    taking = ClassFilter.of(["building", "vehicle"], ["vehicle"])
    assert taking is not None
    assert taking.keeps(codes).tolist() == [False, True, False, False, False]
    assert taking.keeps_query(codes).tolist() == [True, True, False, False, False]
    assert ClassFilter.of(None) is None
    assert ClassFilter.of(None, ["person", "vehicle"]) == ignoring
    assert class_indices(codes).tolist() == [-1, 0, 1, 3, 4]


@pytest.mark.parametrize(
    ("classes", "ignore", "message"),
    [
        (["car"], [], "Invalid class 'car'. Expected building, .*, other."),
        (None, ["cars"], "Invalid class 'cars'. Expected building, .*, other, or movable."),
        (["movable"], [], "Invalid class 'movable'. Expected"),
    ],
)
def test_filter_with_an_unknown_name_is_refused(
    classes: list[str] | None, ignore: list[str], message: str
) -> None:
    with pytest.raises(ValueError, match=message):
        ClassFilter.of(classes, ignore)


def test_only_a_filter_makes_a_search_classify_its_queries(
    headed: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = []

    def counted(self: EigenvalueExtractor, inputs: Inputs, descriptors: Float32) -> UInt8:
        asked.append(len(descriptors))
        return classify(self, inputs, descriptors)

    monkeypatch.setattr(EigenvalueExtractor, "classify", counted)
    body = request_of(CLOUDS)
    assert headed.post("/match", json=body).status_code == 200
    assert headed.post("/localize", json=body).status_code == 200
    assert not asked
    assert headed.post("/match", json=body | {"ignore": "movable"}).status_code == 200
    assert asked == [len(CLOUDS)]
