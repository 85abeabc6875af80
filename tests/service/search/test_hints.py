"""Hints of `/localize`: they narrow the answer, and never make a wrong pose sure."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import CompactMap, Hints, LastPoseHint, NearHint, SensorPose, encode

from placecell.descriptors.manifest import Manifest
from placecell.localization import LocalizationParameters
from service.inference.describer import Descriptors
from service.search.hints import Disc, HeadingRange, HintedArea, guesses_within
from service.search.localization import StoredNeighborhood
from tests.service.core.test_auth import made
from tests.service.search.test_localize import (
    TRUTH,
    assert_found,
    by_codes,
    packed,
    seen_in,
    street_map,
    twice,
)
from tests.service.service_builders import assert_problem, post_packed

SENSOR = SensorPose((0.0, 0.0, 0.0))
HERE = TRUTH.translation.tolist()
"""Position of the sensor, which is at the origin of the robot's frame."""


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


def ask(service: Any, body: dict[str, Any], **hints: Any) -> dict[str, Any]:
    response = service.post("/localize", json=body | {"hints": hints})
    assert response.status_code == 200, response.text
    answer: dict[str, Any] = response.json()
    return answer


RIGHT = {
    "near": {"position": HERE, "radius": 5.0},
    "near in the plane": {"near": {"position": HERE[:2], "radius": 5.0}},
    "near in a named map": {"near": {"position": HERE, "radius": 5.0, "map": "street"}},
    "yaw": {"yaw": {"radians": TRUTH.yaw + 0.1 + 2 * np.pi, "tolerance": 0.2}},
    "last pose": {"last_pose": {"map": "street", "position": HERE, "radius": 10.0}},
    "maps": {"maps": ["street"]},
    "geo without anchor": {"geo": {"lat": 49.0, "lon": 8.4, "accuracy": 5.0}},
    "sensor elsewhere": {
        "near": {"position": (TRUTH.apply(np.array([4.0, 0.0, 0.0]))).tolist(), "radius": 0.5},
        "sensor": {"position": [4.0, 0.0, 0.0]},
    },
    "heading of the sensor": {
        "yaw": {"radians": TRUTH.yaw + 1.0, "tolerance": 0.1},
        "sensor": {"position": [0.0, 0.0, 0.0], "yaw": 1.0},
    },
    "covariance": {
        "last_pose": {
            "map": "street",
            "position": HERE,
            "orientation": [0.0, 0.0, float(np.sin(TRUTH.yaw / 2)), float(np.cos(TRUTH.yaw / 2))],
            "covariance": np.diag([1.0, 1.0, 1.0, 0.01]).tolist(),
        }
    },
}
RIGHT["near"] = {"near": RIGHT["near"]}


@pytest.mark.parametrize("hints", RIGHT.values(), ids=list(RIGHT))
def test_right_hint_gives_the_pose(stocked: Any, body: Any, hints: dict[str, Any]) -> None:
    plain = stocked.post("/localize", json=body).json()
    assert plain["hints"] is None
    answer = ask(stocked, body, **hints)
    (told,) = answer["localizations"]
    assert_found(told)
    assert told["probability"] == plain["localizations"][0]["probability"]
    assert told["threshold"] == plain["localizations"][0]["threshold"]
    assert answer["hints"]["maps"] == ["street"]
    assert answer["hints"]["outside"] is None
    assert answer["hints"]["used"] == sorted(hints.keys() - {"sensor", "geo"})


def test_geo_hint_of_a_map_without_anchor_is_told(stocked: Any, body: Any) -> None:
    hints = ask(stocked, body, geo={"lat": 49.0, "lon": 8.4, "accuracy": 5.0})["hints"]
    (unused,) = hints["unused"]
    assert (unused["hint"], unused["map"]) == ("geo", "street")
    assert "no WGS 84 anchor" in unused["reason"]


WRONG = {
    "near": {"near": {"position": [HERE[0] - 60, HERE[1], HERE[2]], "radius": 20.0}},
    "height": {"near": {"position": [HERE[0], HERE[1], HERE[2] + 30], "radius": 20.0}},
    "yaw": {"yaw": {"radians": TRUTH.yaw + 1.5, "tolerance": 0.5}},
    "last pose": {"last_pose": {"map": "street", "position": [0, 0, 0], "radius": 20.0}},
    "heading": {
        "last_pose": {
            "map": "street",
            "position": HERE,
            "orientation": [0.0, 0.0, 1.0, 0.0],
            "radius": 10.0,
            "yaw_tolerance": 0.3,
        }
    },
}


@pytest.mark.parametrize("hints", WRONG.values(), ids=list(WRONG))
def test_wrong_hint_gives_no_pose_and_tells_the_place_outside(
    stocked: Any, body: Any, hints: dict[str, Any]
) -> None:
    answer = ask(stocked, body, **hints)
    (told,) = answer["localizations"]
    assert (told["localized"], told["pose"], told["reason"]) == (False, None, "outside-hints")
    assert "Nothing fits within the hints" in told["detail"]
    assert "Check the hints" in told["advice"]
    outside = answer["hints"]["outside"]
    assert outside["map"] == "street"
    np.testing.assert_allclose(outside["position"], HERE, atol=0.1)
    assert outside["yaw"] == pytest.approx(TRUTH.yaw, abs=0.01)
    assert outside["probability"] > 0.9


def test_hint_does_not_decide_between_equal_places(
    stocked: Any, manifest: Manifest, content: CompactMap
) -> None:
    # The robot may be at either place; a hint, right or wrong, must not make one of them sure.
    doubled = twice(content)
    stocked.put("/maps/street", content=encode(doubled), headers={"If-Match": "*"})
    body = by_codes(manifest, *seen_in(content))
    plain = stocked.post("/localize", json=body).json()["localizations"][0]
    assert plain["reason"] == "ambiguous"
    for place in plain["places"]:
        told = ask(stocked, body, near={"position": place["position"], "radius": 60.0})
        assert told["localizations"][0]["reason"] == "ambiguous"
        assert len(told["localizations"][0]["places"]) == 2


def test_hint_of_another_map_excludes_the_map_of_the_robot(
    stocked: Any, manifest: Manifest, body: Any
) -> None:
    stocked.put("/maps/hall", content=encode(street_map(manifest, seed=5)))
    answer = ask(stocked, body, maps=["hall"])
    told = {each["map"]: each for each in answer["localizations"]}
    assert not any(each["localized"] for each in told.values())
    assert told["street"]["reason"] == "outside-hints"
    assert "exclude map 'street'" in told["street"]["detail"]
    assert answer["hints"]["maps"] == ["hall"]
    assert answer["hints"]["outside"]["map"] == "street"
    near = ask(stocked, body, near={"position": HERE, "radius": 5.0, "map": "hall"})
    assert near["hints"]["maps"] == ["hall"]


@pytest.mark.parametrize("plane", [2, 3])
def test_segments_around_the_hint_suggest_the_place_within_it(
    service: Any, manifest: Manifest, content: CompactMap, plane: int
) -> None:
    service.put("/maps/both", content=encode(twice(content)))
    engine = service.app.state.placecell.engine
    snapshot, model = engine.maps.get("both"), engine.model
    codes, centroids = seen_in(content)
    there = StoredNeighborhood(codes, model, snapshot)
    for shift in (0.0, 250.0):
        center = TRUTH.translation + [0.0, shift, 0.0]
        area = HintedArea((Disc(center[:plane], 5.0),), ())
        (found,) = guesses_within(
            area, SENSOR, codes, centroids, model, snapshot, there, LocalizationParameters()
        )
        np.testing.assert_allclose(found.translation, center, atol=0.05)
        turned = HintedArea(area.discs, (HeadingRange(TRUTH.yaw + 1.0, 0.5),))
        assert not guesses_within(
            turned, SENSOR, codes, centroids, model, snapshot, there, LocalizationParameters()
        )


def test_range_of_headings_goes_around_the_circle() -> None:
    south = HeadingRange(np.pi - 0.1, 0.3)
    assert south.holds(-np.pi + 0.1)
    assert not south.holds(-np.pi + 0.3)
    assert HeadingRange(0.0, 4.0).holds(np.pi)


def covariance_hint(rows: list[list[float]], turn: list[float] | None = None) -> dict[str, Any]:
    last = {"map": "street", "position": HERE, "covariance": rows, "orientation": turn}
    return {"last_pose": last}


BAD = {
    "NaN": ({"near": {"position": [float("nan"), 0, 0], "radius": 5}}, "/hints/near/position"),
    "infinite radius": ({"near": {"position": HERE, "radius": float("inf")}}, "/hints/near/radius"),
    "negative radius": ({"near": {"position": HERE, "radius": -1}}, "/hints/near/radius"),
    "radius of zero": ({"near": {"position": HERE, "radius": 0}}, "/hints/near/radius"),
    "one coordinate": ({"near": {"position": [1.0], "radius": 1}}, "/hints/near/position"),
    "unknown field": ({"nearby": {}}, "/hints/nearby"),
    "unknown map": ({"maps": ["nowhere"]}, "/hints/maps/0"),
    "unknown map of a pose": (
        {"last_pose": {"map": "nowhere", "position": HERE, "radius": 5}},
        "/hints/last_pose/map",
    ),
    "unknown map nearby": (
        {"near": {"map": "<b>nowhere</b>", "position": HERE, "radius": 5}},
        "/hints/near/map",
    ),
    "neither radius nor covariance": (
        {"last_pose": {"map": "street", "position": HERE}},
        "/hints/last_pose",
    ),
    "ragged covariance": (
        {"last_pose": {"map": "street", "position": HERE, "covariance": [[1, 0, 0]] * 4}},
        "/hints/last_pose",
    ),
    "quaternion of length 2": (
        {
            "last_pose": {
                "map": "street",
                "position": HERE,
                "radius": 5,
                "orientation": [0, 0, 0, 2],
            }
        },
        "/hints/last_pose",
    ),
    "lopsided covariance": (
        covariance_hint([[1, 5, 0], [0, 1, 0], [0, 0, 1]]),
        "/hints/last_pose",
    ),
    "covariance below zero": (
        covariance_hint([[1, 5, 0], [5, 1, 0], [0, 0, 1]]),
        "/hints/last_pose",
    ),
    "covariance of zeros": (covariance_hint([[0, 0, 0]] * 3), "/hints/last_pose"),
    "heading without variance": (
        covariance_hint(np.diag([1, 1, 1, 0]).tolist(), [0, 0, 0, 1]),
        "/hints/last_pose",
    ),
    "covariance of the whole Earth": (
        covariance_hint([[1e308, 1e308, 0], [1e308, 1e308, 0], [0, 0, 1]]),
        "/hints/last_pose",
    ),
    "latitude": ({"geo": {"lat": 91, "lon": 0, "accuracy": 1}}, "/hints/geo/lat"),
    "tolerance": ({"yaw": {"radians": 0, "tolerance": float("nan")}}, "/hints/yaw/tolerance"),
}


@pytest.mark.parametrize(("hints", "pointer"), BAD.values(), ids=list(BAD))
def test_wrong_value_is_refused_with_its_place(
    stocked: Any, body: Any, hints: dict[str, Any], pointer: str
) -> None:
    response = post_packed(
        stocked, "/localize", packed(body) | {"hints": hints}, "application/json"
    )
    assert_problem(response, 422, "invalid-request")
    pointers = [each["pointer"] for each in response.json()["errors"]]
    assert any(each.startswith(pointer) for each in pointers), pointers
    assert not any("[" in each for each in pointers), pointers
    assert ".." not in response.json()["detail"]


@pytest.mark.parametrize("hints", [{}, {"geo": {"lat": 49.0, "lon": 8.4, "accuracy": 5.0}}])
def test_hint_that_narrows_nothing_is_not_the_reason(
    stocked: Any, body: Any, hints: dict[str, Any]
) -> None:
    scattered = np.random.default_rng(3).uniform(-30, 30, (len(body["centroids"]), 3)).tolist()
    lost = body | {"centroids": scattered}
    plain = stocked.post("/localize", json=lost).json()["localizations"][0]
    told = ask(stocked, lost, **hints)["localizations"][0]
    assert not plain["localized"]
    assert (told["reason"], told["detail"]) == (plain["reason"], plain["detail"])


def test_sensor_is_needed_where_the_frame_s_origin_is_far(stocked: Any, body: Any) -> None:
    far = np.array(body["centroids"]) + [5_000.0, 0.0, 0.0]
    near = {"position": HERE, "radius": 10.0}
    moved = body | {"centroids": far.tolist()}
    response = stocked.post("/localize", json=moved | {"hints": {"near": near}})
    assert_problem(response, 422, "invalid-request", "Give the sensor's pose")
    answer = ask(stocked, moved, near=near, sensor={"position": [5_000.0, 0.0, 0.0]})
    assert answer["localizations"][0]["localized"]
    assert ask(stocked, moved, maps=["street"])["localizations"][0]["localized"]


def test_both_encodings_and_the_client_s_class_agree(stocked: Any, body: Any) -> None:
    hints = Hints(
        near=NearHint(np.array(HERE), 5),
        last_pose=LastPoseHint("street", HERE, covariance=np.eye(3)),
        sensor=SensorPose((0, 0, 0)),
        maps=("street",),
    ).as_dict()
    first = ask(stocked, body, **hints)
    second = post_packed(stocked, "/localize", packed(body) | {"hints": hints}, "application/json")
    assert second.json() == first
    assert first["localizations"][0]["localized"]


def test_map_outside_the_scope_is_forbidden_as_a_hint(
    start: Any, tmp_path: Path, content: CompactMap, body: Any
) -> None:
    file = tmp_path / "keys.toml"
    key = made(file, "own", "--map", "street", "--write")
    with start(keys_file=file) as service:
        service.put("/maps/street", content=encode(content), headers=key)
        for name in ("hall", "attic"):  # whether the map exists is not told
            hinted = body | {"hints": {"maps": [name]}}
            refused = service.post("/localize", json=hinted, headers=key)
            assert_problem(refused, 403, "forbidden")


def test_engine_takes_the_same_hints(stocked: Any, body: Any, manifest: Manifest) -> None:
    engine = stocked.app.state.placecell.engine
    codes, centroids = np.array(body["codes"], np.int8), np.array(body["centroids"])
    seen = Descriptors(manifest.model_id, codes, None, centroids, {})
    found = engine.localize(seen, hints=Hints(near=NearHint(HERE, 5.0)))
    assert found[0].localization.pose is not None
    wrong = engine.localize(seen, hints=Hints(near=NearHint((0, 0, 0), 5.0)))
    assert wrong[0].localization.reason == "outside-hints"
    assert wrong.hints.outside is not None
