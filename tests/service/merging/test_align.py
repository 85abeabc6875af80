"""`/maps/{map}/align/{other}` over HTTP, with maps of one street."""

import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import Delta, decode, encode_delta
from placecell_client.maps.edit import take
from scipy.spatial.transform import Rotation

from placecell.descriptors.manifest import Manifest
from placecell.localization import Pose
from service.merging import alignment
from tests.placecell.map_alignment.map_builders import drive
from tests.service.core.test_auth import made
from tests.service.merging.merged_map_builders import (
    as_map,
    driven,
    main_street,
    models_that_judge,
    put,
    relative,
)
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

pytestmark = pytest.mark.slow  # by their sum


@pytest.fixture(scope="module")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return models_that_judge(tmp_path_factory.mktemp("models"))


@pytest.fixture(scope="module")
def manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "tiny")


@pytest.fixture(scope="module")
def other_manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "other")


@pytest.fixture
def stocked(service: Any, manifest: Manifest) -> Any:
    put(service, "east", driven(manifest.model_id, "east", 0, 150))
    put(service, "west", driven(manifest.model_id, "west", 60, 200))
    return service


def pose_told(pose: dict[str, Any]) -> Pose:
    rotation = Rotation.from_quat(pose["rotation"]).as_matrix()
    told = Pose(rotation, np.array(pose["translation"]))
    assert told.yaw == pytest.approx(pose["yaw"])
    return told


def assert_aligned(told: dict[str, Any], truth: Pose, at: np.ndarray) -> None:
    assert told["aligned"], told
    assert (told["reason"], told["detail"]) == (None, "")
    meters, angle = pose_told(told["pose"]).difference(truth, at)
    assert meters < 0.3
    assert np.degrees(angle) < 0.5


def middle(service: Any, name: str) -> np.ndarray:
    return np.asarray(decode(service.get(f"/maps/{name}").content).centroids.mean(axis=0))


def test_align_returns_the_transform(stocked: Any) -> None:
    response = stocked.post("/maps/east/align/west")
    assert response.status_code == 200, response.text
    told = response.json()
    assert_aligned(told, relative("east", "west"), middle(stocked, "west"))
    assert (told["map"], told["other"]) == ("east", "west")
    assert (told["frame"], told["other_frame"]) == ("east's odometry", "west's odometry")
    for key, name in (("etag", "east"), ("other_etag", "west")):
        assert stocked.get(f"/maps/{name}").headers["etag"] == f'"{told[key]}"'
    # 90 of 150 m, and of 140.
    assert told["overlap"]["of_map"] == pytest.approx(0.65, abs=0.1)
    assert told["overlap"]["of_other"] == pytest.approx(0.7, abs=0.1)
    assert told["agreement"] > 0.3
    assert told["score"] > 12
    assert told["pairs"] > 20
    assert told["inliers"] == []
    covariance = np.array(told["covariance"])
    assert covariance.shape == (4, 4)
    assert (np.linalg.eigvalsh(covariance) > 0).all()
    assert "verify" in response.headers["server-timing"]


def test_align_in_reverse_returns_the_inverse(stocked: Any) -> None:
    back = stocked.post("/maps/west/align/east").json()
    assert_aligned(back, relative("west", "east"), middle(stocked, "east"))
    there = stocked.post("/maps/east/align/west").json()
    around = pose_told(there["pose"]).after(pose_told(back["pose"]))
    meters, angle = around.difference(Pose.of_yaw(0.0, np.zeros(3)), middle(stocked, "east"))
    assert meters < 0.1
    assert np.degrees(angle) < 0.2


def test_align_returns_pairs_on_request(stocked: Any) -> None:
    told = stocked.post("/maps/east/align/west?pairs=true").json()
    assert len(told["inliers"]) == told["pairs"]
    here, there = (decode(stocked.get(f"/maps/{name}").content) for name in ("east", "west"))
    rows = np.searchsorted(here.ids, [each["id"] for each in told["inliers"]])
    others = np.searchsorted(there.ids, [each["other_id"] for each in told["inliers"]])
    moved = pose_told(told["pose"]).apply(there.centroids[others])
    distances = np.linalg.norm(moved - here.centroids[rows], axis=1)
    np.testing.assert_allclose(distances, [each["residual"] for each in told["inliers"]], atol=1e-6)
    assert distances.max() < 1.5


def test_align_finds_six_degrees_of_freedom_on_request(service: Any, manifest: Manifest) -> None:
    random = np.random.default_rng(1)
    east = driven(manifest.model_id, "east", 0, 150)
    lying = drive(main_street(), 30, 180, random)
    tilt = Pose(Rotation.from_euler("x", 50, degrees=True).as_matrix(), np.array([5.0, 6.0, 7.0]))
    put(service, "east", east)
    put(service, "west", as_map(lying.moved(tilt), manifest.model_id, "west", "bob"))
    assert not service.post("/maps/east/align/west").json()["aligned"]
    told = service.post("/maps/east/align/west?motion=se3").json()
    truth = tilt.inverse().after(relative("east", "west"))
    assert_aligned(told, truth, middle(service, "west"))
    assert np.array(told["covariance"]).shape == (6, 6)


def test_maps_of_different_places_are_not_aligned(service: Any, manifest: Manifest) -> None:
    put(service, "east", driven(manifest.model_id, "east", 0, 100))
    put(service, "west", driven(manifest.model_id, "west", 220, 320))
    told = service.post("/maps/east/align/west?pairs=true").json()
    assert not told["aligned"]
    assert told["reason"] == "inconsistent"
    assert told["detail"]
    assert told["pose"] is told["covariance"] is told["overlap"] is None
    assert told["inliers"] == []
    assert told["pairs"] == 0
    for other in told["others"]:
        assert other["score"] <= told["score"]


def test_map_that_shows_another_twice_is_ambiguous(stocked: Any, manifest: Manifest) -> None:
    east = decode(stocked.get("/maps/east").content)
    copy = replace(
        east,
        ids=east.ids + np.uint32(5_000),
        centroids=east.centroids + (900.0, 0.0, 0.0),
        frame_positions=east.frame_positions + (900.0, 0.0, 0.0),
        frame_times=east.frame_times + 5_000.0,
    )
    # The map is placed beside itself.
    edit = encode_delta(Delta(copy, np.zeros(0, np.uint32)))
    assert stocked.post("/maps/east/segments", content=edit).status_code == 200
    told = stocked.post("/maps/east/align/west").json()
    assert told["reason"] == "ambiguous"
    assert "Another alignment" in told["detail"]
    # Both hypotheses, the better one first.
    first, second = told["others"]
    assert first["score"] == told["score"] >= second["score"]
    apart = pose_told(first["pose"]).translation - pose_told(second["pose"]).translation
    assert np.linalg.norm(apart) == pytest.approx(900.0, abs=5.0)


def test_align_uses_segments_written_since(stocked: Any, manifest: Manifest) -> None:
    # West is written in parts, so that the index of the base lacks the rest.
    west = driven(manifest.model_id, "west", 60, 200)
    put(stocked, "parts", take(west, np.arange(100)))
    edit = encode_delta(Delta(take(west, np.arange(100, len(west))), np.zeros(0, np.uint32)))
    assert stocked.post("/maps/parts/segments", content=edit).status_code == 200
    whole = stocked.post("/maps/west/align/east").json()
    for one, other in (("parts", "east"), ("east", "parts")):
        told = stocked.post(f"/maps/{one}/align/{other}").json()
        assert told["aligned"]
    told = stocked.post("/maps/parts/align/east").json()
    assert told["pose"] == whole["pose"]


def test_map_aligns_with_itself(stocked: Any) -> None:
    told = stocked.post("/maps/east/align/east").json()
    assert_aligned(told, Pose.of_yaw(0.0, np.zeros(3)), middle(stocked, "east"))
    assert told["overlap"] == {"of_map": 1.0, "of_other": 1.0}


@pytest.mark.parametrize("rows", [0, 1])
def test_align_of_nearly_empty_map_gives_a_reason(
    stocked: Any, manifest: Manifest, rows: int
) -> None:
    put(stocked, "tiny", map_of(random_codes(rows), manifest.model_id))
    for path in ("/maps/tiny/align/east", "/maps/east/align/tiny", "/maps/tiny/align/tiny"):
        told = stocked.post(path).json()
        assert told["reason"] == "too-few-segments"
        assert f"{rows} segments" in told["detail"]
        assert told["others"] == []


def test_align_writes_nothing(stocked: Any) -> None:
    before = stocked.get("/maps").json()
    stocked.post("/maps/east/align/west")
    assert stocked.get("/maps").json() == before


def test_invalid_align_requests_are_refused(stocked: Any) -> None:
    assert_problem(stocked.post("/maps/east/align/none"), 404, "unknown-map", "none")
    assert_problem(stocked.post("/maps/none/align/east"), 404, "unknown-map", "none")
    for bad in ("-x", "a b", "x" * 65, "é"):
        answer = stocked.post(f"/maps/east/align/{bad}")
        assert_problem(answer, 422, "invalid-map-name", "expected 1 to 64 letters")
        assert_problem(stocked.post(f"/maps/{bad}/align/east"), 422, "invalid-map-name")
    for query in ("motion=9", "pairs=perhaps", "motion="):
        answer = stocked.post(f"/maps/east/align/west?{query}")
        assert_problem(answer, 422, "invalid-request")
    assert stocked.get("/maps/east/align/west").status_code == 405


@pytest.mark.parametrize("body", [b'{"motion": "se3"}', b"{}", b"\xff"])
def test_align_refuses_options_in_a_body(stocked: Any, body: bytes) -> None:
    for headers in ({}, {"Content-Type": "application/json"}):
        answer = stocked.post("/maps/east/align/west", content=body, headers=headers)
        assert_problem(answer, 422, "invalid-request", "in the query (?motion=se3)")
        assert [each["pointer"] for each in answer.json()["errors"]] == [""]
    packed = {"Content-Type": "application/msgpack"}
    answer = stocked.post("/maps/east/align/west", content=body, headers=packed)
    assert_problem(answer, 415, "unsupported-media-type")


def test_align_of_maps_of_two_models_is_refused(
    start: Any, manifest: Manifest, other_manifest: Manifest
) -> None:
    with start(also=["other"]) as service:
        put(service, "east", driven(manifest.model_id, "east", 0, 150))
        put(service, "other", map_of(random_codes(20), other_manifest.model_id))
        answer = service.post("/maps/east/align/other")
        assert_problem(answer, 409, "other-model", manifest.model_id)


def test_align_needs_a_key_for_both_maps(start: Any, tmp_path: Path, manifest: Manifest) -> None:
    file = tmp_path / "keys.toml"
    writes, reads = made(file, "writer", "--write"), made(file, "reader")
    bound = made(file, "bound", "--map", "east")
    robots = made(file, "bob", "--robot", "bob")
    with start(keys_file=file) as service:
        put(service, "east", driven(manifest.model_id, "east", 0, 150), **writes)
        put(service, "west", driven(manifest.model_id, "west", 60, 200), **writes)
        for headers in (reads, robots):
            told = service.post("/maps/east/align/west", headers=headers).json()
            assert told["aligned"]
        for path in (
            *("/maps/east/align/west", "/maps/west/align/east"),
            # The answer does not reveal which names exist.
            "/maps/east/align/none",
        ):
            assert_problem(service.post(path, headers=bound), 403, "forbidden")
        assert service.post("/maps/east/align/east", headers=bound).status_code == 200
        assert_problem(service.post("/maps/east/align/west"), 401, "unauthorized")


def test_too_many_alignments_get_429(
    start: Any, manifest: Manifest, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, go = threading.Event(), threading.Event()

    def slow(*args: Any) -> Any:
        begun.set()
        assert go.wait(30)
        return alignment.align_maps(*args)

    monkeypatch.setattr("service.engine.align_maps", slow)
    answers: list[Any] = []
    with start(limits={"alignments": 1}) as service:
        put(service, "east", driven(manifest.model_id, "east", 0, 150))
        path = "/maps/east/align/east"
        ask = threading.Thread(target=lambda: answers.append(service.post(path)))
        ask.start()
        try:
            assert begun.wait(30)
            busy = service.post(path)
            assert_problem(busy, 429, "busy")
            assert busy.headers["retry-after"]
            assert_problem(service.post("/maps/new/merge", json={"maps": ["east"]}), 429, "busy")
            # Readers and writers do not wait.
            assert service.get("/maps/east").status_code == 200
            edit = edit_of(random_codes(1), manifest.model_id, 9_000, "east robot")
            edited = service.post("/maps/east/segments", content=edit)
        finally:
            go.set()
            ask.join(30)
    assert edited.status_code in {200, 409}
    assert [each.status_code for each in answers] == [200]


def test_align_ends_at_its_deadline(start: Any, manifest: Manifest, monkeypatch: Any) -> None:
    asked: list[int] = []
    real = alignment.StoredDescriptorSearch.nearest

    def slow(self: Any, rows: Any) -> Any:
        asked.append(len(rows))
        threading.Event().wait(0.2)
        return real(self, rows)

    monkeypatch.setattr(alignment.StoredDescriptorSearch, "nearest", slow)
    with start() as service:
        put(service, "east", driven(manifest.model_id, "east", 0, 150))
        answer = service.post("/maps/east/align/east", headers={"Placecell-Timeout": "0.3"})
        assert_problem(answer, 504, "deadline-exceeded", "0.3 s")
        # Of about fifteen parts only those that had begun are searched.
        assert 1 <= len(asked) <= 4
