"""`/localize` over HTTP: a robot in a map whose codes are all different."""

import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from placecell_client import CompactMap, Delta, encode, encode_delta
from placecell_client.maps.edit import take
from scipy.spatial.transform import Rotation

from placecell.core.types import Float64, Int8, Int64
from placecell.descriptors.manifest import Manifest
from placecell.localization import LocalizationParameters, Pose
from tests.service.core.test_auth import made
from tests.service.service_builders import (
    MSGPACK,
    assert_problem,
    cloud,
    map_of,
    post_packed,
    random_codes,
    request_of,
)

TRUTH = Pose.of_yaw(0.7, np.array([120.0, -40.0, 3.0]))
"""Pose of the robot's frame in the map's frame."""


def street_map(manifest: Manifest, seed: int = 0, **changes: Any) -> CompactMap:
    """Two hundred segments along a street; all descriptors are different."""
    random = np.random.default_rng(seed)
    content = map_of(random_codes(200, seed), manifest.model_id, **changes)
    centroids = random.uniform((-200, -15, 0), (200, 15, 4), (200, 3)).round(2)
    return replace(content, centroids=centroids)


def seen_in(content: CompactMap, rows: Int64 | None = None) -> tuple[Int8, Float64]:
    """Codes and centroids of the segments that the robot sees, in the robot's frame."""
    rows = np.arange(40) if rows is None else rows
    return content.codes[rows], TRUTH.inverse().apply(content.centroids[rows])


def by_codes(manifest: Manifest, codes: Int8, centroids: Float64, **more: Any) -> dict[str, Any]:
    return {
        "model_id": manifest.model_id,
        "codes": codes.tolist(),
        "centroids": centroids.tolist(),
    } | more


def packed(body: dict[str, Any]) -> dict[str, Any]:
    """The same request with the blobs of msgpack."""
    blobs = {
        "codes": np.array(body["codes"], np.int8).tobytes(),
        "centroids": np.array(body["centroids"], "<f8").tobytes(),
    }
    return body | blobs


@pytest.fixture
def content(manifest: Manifest) -> CompactMap:
    return street_map(manifest)


@pytest.fixture
def stocked(service: Any, content: CompactMap) -> Any:
    assert service.put("/maps/street", content=encode(content)).status_code == 201
    return service


@pytest.fixture
def body(manifest: Manifest, content: CompactMap) -> dict[str, Any]:
    return by_codes(manifest, *seen_in(content))


def assert_found(told: dict[str, Any]) -> None:
    assert told["localized"], told
    assert told["reason"] is None
    assert told["detail"] == ""
    np.testing.assert_allclose(told["pose"]["translation"], TRUTH.translation, atol=0.05)
    assert told["pose"]["yaw"] == pytest.approx(TRUTH.yaw, abs=1e-3)
    turned = Rotation.from_quat(told["pose"]["rotation"]).as_matrix()
    np.testing.assert_allclose(turned, TRUTH.rotation, atol=1e-3)
    assert told["pose"]["rotation"][3] >= 0


def test_robot_in_map_gets_its_pose(stocked: Any, manifest: Manifest, body: Any) -> None:
    response = stocked.post("/localize", json=body)
    assert response.status_code == 200, response.text
    answer = response.json()
    assert answer["model_id"] == manifest.model_id
    assert answer["unusable"] == answer["skipped"] == []
    (told,) = answer["localizations"]
    assert (told["map"], told["frame"]) == ("street", "town")
    assert_found(told)
    assert told["probability"] > 0.9
    assert (told["advice"], told["meters_to_drive"]) == ("", None)
    assert (told["places"], told["places_apart"]) == ([], None)
    assert told["score"] > 0
    # Segment i was found as row i, whose id is 100 + i.
    assert [each["query"] for each in told["inliers"]] == list(range(40))
    assert [each["id"] for each in told["inliers"]] == list(range(100, 140))
    assert max(each["residual"] for each in told["inliers"]) < 0.05
    covariance = np.array(told["covariance"])
    assert covariance.shape == (4, 4)
    assert (np.linalg.eigvalsh(covariance) > 0).all()
    stages = [part.split(";")[0] for part in response.headers["server-timing"].split(", ")]
    assert stages == ["receive", "queue", "decode", "search", "verify", "encode"]


def test_sensor_of_codes_moves_the_pose_if_it_sees_other_sides(stocked: Any, body: Any) -> None:
    """All segments were seen from the map's origin."""

    def told(position: Float64) -> dict[str, Any]:
        sensor = {"position": TRUTH.inverse().apply(position).tolist()}
        response = stocked.post("/localize", json=body | {"hints": {"sensor": sensor}})
        assert response.status_code == 200, response.text
        (found,) = response.json()["localizations"]
        return dict(found)

    (plain,) = stocked.post("/localize", json=body).json()["localizations"]
    same, beyond = told(np.zeros(3)), told(np.array([70.0, 10.0, 0.0]))
    position = plain["pose"]["translation"]
    assert same["pose"]["translation"] == pytest.approx(position, abs=1e-6)
    assert np.linalg.norm(np.subtract(beyond["pose"]["translation"], position)) > 0.005
    assert plain["probability"] == same["probability"] == beyond["probability"]
    assert np.trace(beyond["covariance"]) > np.trace(same["covariance"])


def test_both_encodings_give_the_same_answer(stocked: Any, body: Any) -> None:
    first = stocked.post("/localize", json=body).json()
    listed = post_packed(stocked, "/localize", packed(body), "application/json").json()
    told = post_packed(stocked, "/localize", packed(body))
    assert told.headers["content-type"] == MSGPACK
    also = stocked.post("/localize", json=body, headers={"Accept": MSGPACK})
    assert first == listed == msgpack.unpackb(told.content) == msgpack.unpackb(also.content)


def test_motion_se3_gives_all_six_degrees_of_freedom(
    stocked: Any, body: Any, content: CompactMap
) -> None:
    (told,) = stocked.post("/localize", json=body | {"motion": "se3"}).json()["localizations"]
    assert told["localized"]
    assert np.array(told["covariance"]).shape == (6, 6)
    # A robot on its side.
    tilt = Pose(Rotation.from_euler("x", 80, degrees=True).as_matrix(), np.zeros(3))
    lying = tilt.apply(np.array(body["centroids"])).tolist()
    asked = body | {"centroids": lying}
    assert not stocked.post("/localize", json=asked).json()["localizations"][0]["localized"]
    asked |= {"motion": "se3"}
    (told,) = stocked.post("/localize", json=asked).json()["localizations"]
    pose = told["pose"]
    turned = Rotation.from_quat(pose["rotation"]).apply(lying) + pose["translation"]
    np.testing.assert_allclose(turned, content.centroids[:40], atol=0.2)


def test_answer_states_its_threshold_and_risk(stocked: Any, body: Any) -> None:
    confidence = stocked.app.state.placecell.engine.models.default.confidence
    (told,) = stocked.post("/localize", json=body).json()["localizations"]
    expected = confidence.threshold(None, LocalizationParameters().least_probability)
    assert (told["threshold"], told["max_false_acceptance"]) == expected


@pytest.mark.parametrize("risk", [0, -0.1, 0.6, "0.1", True])
def test_risk_out_of_range_is_refused(stocked: Any, body: Any, risk: object) -> None:
    response = stocked.post("/localize", json=body | {"max_false_acceptance": risk})
    assert_problem(response, 422, "invalid-request")
    assert response.json()["errors"][0]["pointer"] == "/max_false_acceptance"


def test_noise_is_inconsistent(stocked: Any, manifest: Manifest) -> None:
    random = np.random.default_rng(9)
    strange = by_codes(manifest, random_codes(40, 9), random.uniform(-30, 30, (40, 3)))
    (told,) = stocked.post("/localize", json=strange).json()["localizations"]
    assert not told["localized"]
    assert told["reason"] == "too-few-segments"
    assert told["detail"]
    assert told["pose"] is told["covariance"] is None
    assert told["inliers"] == []


def test_too_few_segments_give_the_reason(
    stocked: Any, manifest: Manifest, content: CompactMap
) -> None:
    few = by_codes(manifest, *seen_in(content, np.arange(2)))
    (told,) = stocked.post("/localize", json=few).json()["localizations"]
    assert told["reason"] == "too-few-segments"
    assert told["probability"] == told["score"] == 0
    assert told["others"] == told["places"] == []
    assert told["meters_to_drive"] > 0
    assert f"Drive about {told['meters_to_drive']:.0f} m" in told["advice"]


def twice(content: CompactMap) -> CompactMap:
    """A street with a copy of itself 250 m away."""
    shift = np.array([0.0, 250.0, 0.0])
    return replace(
        content,
        codes=np.concatenate([content.codes, content.codes]),
        centroids=np.concatenate([content.centroids, content.centroids + shift]),
        ids=np.arange(400, dtype=np.uint32),
        robot=np.zeros(400, np.uint16),
        frame_index=np.zeros(400, np.uint32),
    )


def test_two_equal_places_are_ambiguous_and_both_are_listed(
    service: Any, content: CompactMap, body: Any
) -> None:
    assert service.put("/maps/both", content=encode(twice(content))).status_code == 201
    (told,) = service.post("/localize", json=body).json()["localizations"]
    assert told["reason"] == "ambiguous"
    assert told["pose"] is None
    first, second = (np.array(each["pose"]["translation"]) for each in told["others"])
    assert abs(abs(first - second)[1] - 250) < 1
    assert {each["inliers"] for each in told["others"]} == {40}
    # The advice names both places: the middle of the segments, in each.
    middle = content.centroids[:40].mean(axis=0)
    assert told["places_apart"] == pytest.approx(250, abs=0.5)
    sides = sorted(each["position"][1] for each in told["places"])
    assert sides == pytest.approx([middle[1], middle[1] + 250], abs=0.5)
    assert {(each["map"], each["frame"]) for each in told["places"]} == {("both", "town")}
    assert "250.0 m apart" in told["detail"]
    assert "'session'" in told["advice"]


def with_landmarks(content: CompactMap) -> CompactMap:
    """A street with a copy of itself; the copy has twenty more segments."""
    both = twice(content)
    return replace(
        both,
        codes=np.concatenate([both.codes, random_codes(20, 77)]),
        centroids=np.concatenate([both.centroids, content.centroids[:20] + (3.0, 250.0, 0.0)]),
        ids=np.arange(420, dtype=np.uint32),
        robot=np.zeros(420, np.uint16),
        frame_index=np.zeros(420, np.uint32),
    )


def test_requests_of_a_session_support_each_other(
    service: Any, manifest: Manifest, content: CompactMap, body: Any
) -> None:
    """The robot has passed a landmark of the copy; the other segments are the same in both."""
    landmarks = with_landmarks(content)
    assert service.put("/maps/both", content=encode(landmarks)).status_code == 201
    passed = [
        by_codes(manifest, *seen_in(landmarks, np.arange(400 + first, 420)), session="ann-1")
        for first in range(6)
    ]

    def place(asked: dict[str, Any]) -> Any:
        (told,) = service.post("/localize", json=asked).json()["localizations"]
        return told["pose"] and round(told["pose"]["translation"][1], 0)

    assert place(body | {"session": "ann-1"}) is None
    # Sent again it says no more than once.
    for _ in range(6):
        assert place(passed[0]) == -40.0
    assert place(body | {"session": "ann-1"}) is None
    for asked in passed:
        assert place(asked) == -40.0
    assert place(body | {"session": "ann-1"}) == -40.0
    # Of others' sessions, and without one, nothing is known.
    assert place(body | {"session": "ann-2"}) is None
    assert place(body) is None


def put(service: Any, content: CompactMap, **headers: str) -> None:
    answer = service.put("/maps/both", content=encode(content), headers=headers)
    assert answer.is_success, answer.text


def removed_and_made_anew(service: Any, content: CompactMap) -> None:
    assert service.delete("/maps/both").status_code == 204
    put(service, content)


def restored(service: Any, content: CompactMap) -> None:
    edited(service, content)
    answer = service.post("/maps/both/versions/1/restore")
    assert answer.is_success, answer.text


def post_edit(service: Any, *delta: Any) -> None:
    answer = service.post(
        "/maps/both/segments", content=encode_delta(Delta(*delta)), headers={"If-Match": "*"}
    )
    assert answer.is_success, answer.text


def edited(service: Any, content: CompactMap) -> None:
    """Map without the segments that the robot does not see."""
    post_edit(service, take(content, slice(0)), content.ids[150:160])


def replaced(service: Any, content: CompactMap) -> None:
    put(service, take(content, ~np.isin(content.ids, range(150, 160))), **{"If-Match": "*"})


def emptied_and_filled(service: Any, content: CompactMap) -> None:
    post_edit(service, take(content, slice(0)), content.ids)
    post_edit(service, content, content.ids[:0])


@pytest.mark.parametrize(
    ("act", "counts"),
    [
        (edited, True),
        (replaced, False),
        (removed_and_made_anew, False),
        (restored, False),
        (emptied_and_filled, False),
    ],
)
def test_session_counts_while_the_frame_of_the_map_is_the_same(
    service: Any, manifest: Manifest, content: CompactMap, body: Any, act: Any, counts: bool
) -> None:
    landmarks = with_landmarks(content)
    put(service, landmarks)
    for first in range(6):
        rows = np.arange(400 + first, 420)
        asked = by_codes(manifest, *seen_in(landmarks, rows), session="ann")
        (told,) = service.post("/localize", json=asked).json()["localizations"]
        assert told["localized"]
    act(service, landmarks)
    (told,) = service.post("/localize", json=body | {"session": "ann"}).json()["localizations"]
    assert told["localized"] is counts, told
    assert told["reason"] == (None if counts else "ambiguous")


def test_each_map_gives_the_pose_in_its_own_frame(
    service: Any, manifest: Manifest, content: CompactMap, body: Any
) -> None:
    other = street_map(manifest, seed=5, frame="elsewhere")
    for name, each in (("a-other", other), ("b-street", content), ("c-empty", None)):
        stored = map_of(random_codes(0), manifest.model_id) if each is None else each
        assert service.put(f"/maps/{name}", content=encode(stored)).status_code == 201
    told = service.post("/localize", json=body).json()["localizations"]
    assert [each["map"] for each in told] == ["b-street", "a-other", "c-empty"]
    assert [each["localized"] for each in told] == [True, False, False]
    assert_found(told[0])
    assert told[2]["reason"] == "too-few-segments"
    told = service.post("/localize", json=body | {"maps": ["a-other"]}).json()["localizations"]
    assert [each["map"] for each in told] == ["a-other"]


def test_localize_without_maps_gives_an_empty_list(service: Any, body: Any) -> None:
    assert service.post("/localize", json=body).json()["localizations"] == []
    clouds = [cloud(0), cloud(1)[:3]]
    answer = service.post("/localize", json=request_of(clouds)).json()
    assert answer["localizations"] == []
    assert [each["query"] for each in answer["unusable"]] == [1]
    assert answer["unusable"][0]["error"]["type"].endswith("too-few-points")


def test_segments_and_their_codes_give_the_same_pose(service: Any, manifest: Manifest) -> None:
    clouds = [cloud(seed) for seed in range(30)]
    clouds[4] = clouds[4][:3]
    described = service.post("/describe", json=request_of(clouds)).json()["descriptors"]
    good = [index for index in range(30) if index != 4]
    codes = np.array([described[index]["codes"] for index in good], np.int8)
    centroids = np.array([described[index]["centroid"] for index in good])
    stored = map_of(codes, manifest.model_id)
    stored = replace(stored, centroids=TRUTH.apply(centroids).round(2))
    assert service.put("/maps/own", content=encode(stored)).status_code == 201
    answer = service.post("/localize", json=request_of(clouds)).json()
    (by_segments,) = answer["localizations"]
    assert [each["query"] for each in answer["unusable"]] == [4]
    # Twenty meters of segments tell the pose; inliers are numbered as the request's segments.
    assert by_segments["localized"], by_segments
    assert {each["query"] for each in by_segments["inliers"]} <= set(good)
    for each in by_segments["inliers"]:
        assert good[each["id"] - 100] == each["query"]
    (told,) = service.post("/localize", json=by_codes(manifest, codes, centroids)).json()[
        "localizations"
    ]
    np.testing.assert_allclose(
        told["pose"]["translation"], by_segments["pose"]["translation"], atol=1e-6
    )
    assert told["score"] == pytest.approx(by_segments["score"])


def test_map_of_another_model_is_skipped_or_refused(
    start: Any, manifest: Manifest, other_manifest: Manifest, content: CompactMap, body: Any
) -> None:
    with start(model="other") as service:
        stored = encode(street_map(other_manifest))
        assert service.put("/maps/old", content=stored).status_code == 201
    with start(model="tiny") as service:
        assert service.put("/maps/street", content=encode(content)).status_code == 201
        answer = service.post("/localize", json=body).json()
        assert [each["map"] for each in answer["localizations"]] == ["street"]
        assert answer["skipped"] == [{"map": "old", "model_id": other_manifest.model_id}]
        refused = service.post("/localize", json=body | {"maps": ["old"]})
        assert_problem(refused, 409, "other-model", other_manifest.model_id)


NAN = float("nan")


@pytest.mark.parametrize(
    ("changes", "status", "kind", "detail"),
    [
        ({"centroids": None}, 422, "invalid-request", "centroids"),
        ({"centroids": []}, 422, "invalid-request", "/centroids"),
        ({"centroids": [[0, 0, 0]]}, 422, "invalid-request", "1 centroids for 40 codes"),
        ({"centroids": [[0, 0]] * 40}, 422, "invalid-request", "/centroids/0"),
        ({"centroids": [[0, 0, 1e9]] * 40}, 422, "invalid-request", "/centroids/0/2"),
        ({"centroids": [["0", 0, 0]] * 40}, 422, "invalid-request", "/centroids/0/0"),
        ({"motion": "se2"}, 422, "invalid-request", "/motion"),
        ({"session": ""}, 422, "invalid-request", "/session"),
        ({"session": "a b"}, 422, "invalid-request", "/session"),
        ({"session": "x" * 65}, 422, "invalid-request", "/session"),
        ({"session": 7}, 422, "invalid-request", "/session"),
        ({"k": 0}, 422, "invalid-request", "/k"),
        ({"k": 101}, 422, "invalid-request", "the limit is 100"),
        ({"maps": ["nowhere"]}, 404, "unknown-map", "nowhere"),
        ({"model_id": "other-1"}, 409, "other-model", "other-1"),
        ({"luck": 1}, 422, "invalid-request", "/luck"),
        (request_of([cloud(0)]), 422, "invalid-request", "either"),
    ],
)
def test_bad_request_is_refused_with_the_reason(
    stocked: Any, body: Any, changes: Any, status: int, kind: str, detail: str
) -> None:
    assert_problem(stocked.post("/localize", json=body | changes), status, kind, detail)
    assert stocked.post("/localize", json=body).status_code == 200


@pytest.mark.parametrize(
    ("changes", "detail"),
    [
        ({"centroids": b"\0" * 25}, "/centroids: found 25 bytes, expected a multiple of 24"),
        ({"centroids": np.full(120, NAN).tobytes()}, "/centroids/0/0"),
        ({"centroids": np.full(120, 1e9).tobytes()}, "/centroids/0/0"),
        ({"centroids": b"\0" * 24}, "1 centroids for 40 codes"),
        ({"centroids": [0.0] * 120}, "/centroids: expected binary data"),
        ({"codes": b"\0" * 13}, "/codes: 13 bytes"),
    ],
)
def test_bad_blob_is_refused_with_a_pointer(
    stocked: Any, body: Any, changes: Any, detail: str
) -> None:
    refused = post_packed(stocked, "/localize", packed(body) | changes)
    assert_problem(refused, 422, "invalid-request", detail)


def test_segments_with_centroids_are_refused(stocked: Any) -> None:
    asked = request_of([cloud(0)]) | {"centroids": [[0, 0, 0]]}
    assert_problem(stocked.post("/localize", json=asked), 422, "invalid-request", "centroids")


def test_key_searches_its_own_maps_and_sessions(
    start: Any, tmp_path: Path, content: CompactMap, body: Any
) -> None:
    file = tmp_path / "keys.toml"
    everything, halls = made(file, "all", "--write"), made(file, "halls", "--map", "hall-*")
    with start(keys_file=file) as service:
        put = service.put("/maps/street", content=encode(content), headers=everything)
        assert put.status_code == 201
        assert_problem(service.post("/localize", json=body), 401, "unauthorized")
        assert service.post("/localize", json=body, headers=halls).json()["localizations"] == []
        named = body | {"maps": ["street"]}
        assert_problem(service.post("/localize", json=named, headers=halls), 403, "forbidden")
        sessions = service.app.state.placecell.engine.sessions
        assert service.post(
            "/localize", json=body | {"session": "s"}, headers=everything
        ).is_success
        assert len(sessions) == 1


@pytest.mark.slow
def test_concurrent_requests_do_not_mix_their_sessions(stocked: Any, body: Any) -> None:
    expected = stocked.post("/localize", json=body).json()
    answers: list[Any] = []

    def ask(number: int) -> None:
        for _ in range(5):
            asked = body | ({"session": f"robot-{number}"} if number % 2 else {})
            answers.append(stocked.post("/localize", json=asked).json())

    threads = [threading.Thread(target=ask, args=(number,)) for number in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(answers) == 30
    for answer in answers:
        np.testing.assert_allclose(
            answer["localizations"][0]["pose"]["translation"],
            expected["localizations"][0]["pose"]["translation"],
            atol=1e-6,
        )


HALF, WHOLE = 2.0, 4.0
"""Heights up to which the sensors of the map and of the robot see all objects, meters."""


@pytest.fixture
def halved(service: Any, content: CompactMap, manifest: Manifest) -> dict[str, Any]:
    """A map whose sensor saw half of each object, and a request of one that sees them whole."""
    centroids = content.centroids * (1, 1, 0) + (0, 0, HALF / 2)
    extents = np.full((len(content), 3), 10 * HALF, np.uint8)
    half = replace(content, centroids=centroids, extents=extents)
    assert service.put("/maps/street", content=encode(half)).status_code == 201
    whole = replace(content, centroids=centroids + (0, 0, (WHOLE - HALF) / 2))
    return by_codes(manifest, *seen_in(whole))


def height_of(service: Any, body: dict[str, Any]) -> float:
    """Return how much higher than it is the robot is localized, meters."""
    answer = service.post("/localize", json=body)
    assert answer.status_code == 200, answer.text
    (told,) = answer.json()["localizations"]
    assert told["localized"], told
    return float(told["pose"]["translation"][2] - TRUTH.translation[2])


def test_heights_of_codes_put_the_pose_on_the_ground(service: Any, halved: dict[str, Any]) -> None:
    count = len(halved["codes"])
    assert height_of(service, halved) == pytest.approx(-1.0, abs=0.02)
    assert height_of(service, halved | {"heights": [WHOLE] * count}) == pytest.approx(0, abs=0.1)
    some = [None, *[WHOLE] * (count - 1)]
    assert height_of(service, halved | {"heights": some}) == pytest.approx(0, abs=0.1)
    none = halved | {"heights": [None] * count}
    assert height_of(service, none) == pytest.approx(-1.0, abs=0.02)


def test_points_put_the_pose_on_the_ground(service: Any, halved: dict[str, Any]) -> None:
    """Segments have boxes: the same engine, with the heights that a description has."""
    engine = service.app.state.placecell.engine
    points = [cloud(seed) for seed in range(3)]
    described = engine.describe([*points, points[0][:2]], np.array([0.0, 0.0, 1.0]))
    sides = [np.ptp(each[:, 2]) for each in points]
    np.testing.assert_allclose(described.heights[:3], sides, atol=1e-5)
    assert np.isnan(described.heights[3])  # too few points
    found = replace(
        described,
        codes=np.array(halved["codes"], np.int8),
        centroids=np.array(halved["centroids"]),
        heights=np.full(len(halved["codes"]), WHOLE),
        errors={},
    )
    pose = engine.localize(found, maps=["street"])[0].localization.pose
    assert pose.translation[2] == pytest.approx(TRUTH.translation[2], abs=0.1)


@pytest.mark.parametrize(
    ("heights", "named"),
    [
        ([1.0], "1 heights for 40 codes"),
        ([-1.0] * 40, "/heights"),
        ([float("1e9")] * 40, "/heights"),
        (["high"] * 40, "/heights"),
        ([], "/heights"),
    ],
)
def test_wrong_heights_are_refused(stocked: Any, body: Any, heights: Any, named: str) -> None:
    answer = stocked.post("/localize", json=body | {"heights": heights})
    assert_problem(answer, 422, "invalid-request", named)


def test_segments_with_heights_are_refused(service: Any) -> None:
    body = request_of([cloud(0)]) | {"heights": [1.0]}
    assert_problem(service.post("/localize", json=body), 422, "invalid-request", "no heights")
