"""Each shipped model gives the same over HTTP as in the library."""

from dataclasses import replace

import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from placecell_client import encode

from placecell.core.segments import Segments
from placecell.core.types import Float32, Int8
from placecell.descriptors import pair_classifier
from placecell.descriptors.extractor import load_extractor
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.pair_classifier import load_pair_classifier
from placecell.descriptors.quantizer import Quantizer
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER, shipped_models
from placecell.descriptors.site_calibration import SiteConstants, calibrate
from tests.service.conftest import Start
from tests.service.service_builders import cloud, map_of, packed, post_packed, request_of

SENSOR = (9.0, -3.0, 1.7)
CLOUDS = [cloud(seed, points=300) for seed in range(6)]


@pytest.mark.parametrize("name", shipped_models())
def test_descriptor_and_probability_over_http_equal_those_of_the_library(
    name: str, start: Start
) -> None:
    extractor = load_extractor(MODELS_FOLDER / name)
    manifest = extractor.manifest
    segments = Segments.of([item.astype(np.float32) for item in CLOUDS], np.tile(SENSOR, (6, 1)))
    expected = extractor.describe(segments)
    codes = manifest.quantizer.encode(expected)
    with start(models_dir=MODELS_FOLDER, model=name) as client:
        assert client.get("/info").json()["model"]["model_id"] == manifest.model_id
        described = client.post("/describe", json=request_of(CLOUDS, SENSOR)).json()
        told = np.array([item["descriptor"] for item in described["descriptors"]])
        assert told == pytest.approx(expected, abs=1e-4)
        in_msgpack = post_packed(client, "/describe", packed(request_of(CLOUDS, SENSOR)))
        blobs = [item["codes"] for item in msgpack.unpackb(in_msgpack.content)["descriptors"]]
        assert [np.frombuffer(blob, np.int8).tolist() for blob in blobs] == codes.tolist()
        assert codes.shape == (6, client.get("/info").json()["model"]["code_bytes"])
        # The segments of a request surround one another, where the model looks around.
        single = client.post("/describe", json=request_of(CLOUDS[:1], SENSOR)).json()
        same = single["descriptors"][0]["codes"] == codes[0].tolist()
        assert same == (manifest.neighborhood is None)
        version = manifest.preprocessing["version"]
        stored = replace(map_of(codes, manifest.model_id, first_id=0), preprocessing=version)
        client.put("/maps/m", content=encode(stored))
        matched = client.post("/match", json=request_of(CLOUDS, SENSOR) | {"k": 6}).json()
    classifier = load_pair_classifier(MODELS_FOLDER / name, manifest)
    assert classifier is not None
    constants = SiteConstants.of(manifest)
    site = constants and calibrate(
        codes, stored.centroids, np.zeros(6, np.int64), manifest.quantizer, constants
    )
    probabilities = site.pair_probabilities if site else classifier.probabilities
    for query, answer in zip(codes, matched["queries"], strict=True):
        found = answer["candidates"]
        assert found[0]["distance"] == pytest.approx(0.0, abs=2 * manifest.quantizer.step)
        against = codes[[candidate["id"] for candidate in found]]
        probability = probabilities(np.repeat(query[None], len(against), axis=0), against)
        assert [candidate["probability"] for candidate in found] == pytest.approx(
            probability, abs=1e-3
        )
        assert ((probability >= 0) & (probability <= 1)).all()


def test_default_model_is_shipped_and_all_models_stay_within_30_megabytes() -> None:
    assert DEFAULT_MODEL in shipped_models()
    total = sum(file.stat().st_size for file in MODELS_FOLDER.rglob("*") if file.is_file())
    assert total < 30e6


def test_A7_pairs_are_classified_in_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    manifest = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
    classifier = load_pair_classifier(MODELS_FOLDER / DEFAULT_MODEL, manifest)
    assert classifier is not None
    codes = np.random.default_rng(3).integers(-128, 128, (2, 20, manifest.code_bytes))
    a, b = codes.astype(np.int8)
    whole = classifier.probabilities(a, b)
    monkeypatch.setattr(pair_classifier, "PAIRS", 7)
    sizes: list[int] = []
    decode = Quantizer.decode

    def noted(self: Quantizer, some: Int8) -> Float32:
        sizes.append(len(some))
        return decode(self, some)

    monkeypatch.setattr(Quantizer, "decode", noted)
    np.testing.assert_allclose(classifier.probabilities(a, b), whole, atol=1e-6)
    assert sizes == [7, 7, 7, 7, 6, 6]
    assert classifier.probabilities(a[:0], b[:0]).shape == (0,)
