"""Tests of `Client.localize`: requests and results."""

import json
import re
from dataclasses import replace
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Description, ItemError, Pose

from tests.client.client_fakes import LOCALIZED, PLACE, POSE, client_of, packed

CLOUD = np.arange(12, dtype=np.float64).reshape(4, 3)
UNUSABLE = ItemError("urn:x", "Too few points", "4 points")
DESCRIBED = Description(
    "m",
    np.array([[0, 0], [3, 4], [5, 6]], np.int8),
    np.zeros((3, 2), np.float32),
    np.array([[np.nan] * 3, [1.0, 2, 3], [4, 5, 6]]),
    {0: UNUSABLE},
)


def test_localize_sends_codes_with_centroids() -> None:
    def answer(request: httpx.Request) -> httpx.Response:
        assert request.url.path == "/localize"
        assert json.loads(request.content) == {
            "k": 25,
            "motion": "yaw",
            "maps": ["yard"],
            "session": "ann-7",
            "max_false_acceptance": 0.01,
            "model_id": "m",
            "codes": [[3, 4], [5, 6]],
            "centroids": [[1, 2, 3], [4, 5, 6]],
        }
        inliers = [{"query": 1, "id": 9, "residual": 0.25}]
        return httpx.Response(
            200, json=LOCALIZED | {"localizations": [PLACE | {"inliers": inliers}]}
        )

    with client_of(answer, encoding="json") as client:
        found = client.localize(
            DESCRIBED, maps=["yard"], session="ann-7", max_false_acceptance=0.01
        )
    # Indices are those of the description; its first segment could not be used.
    assert found.maps[0].inliers.queries.tolist() == [2]
    assert found.maps[0].inliers.ids.tolist() == [9]
    assert found.maps[0].inliers.residuals.tolist() == [0.25]
    assert len(found.maps[0].inliers) == 1
    assert found.errors == {0: UNUSABLE}


def test_requests_of_a_session_have_one_header_for_balancers() -> None:
    sent: list[str | None] = []

    def answer(request: httpx.Request) -> httpx.Response:
        sent.append(request.headers.get("Placecell-Session"))
        return packed(LOCALIZED)

    with client_of(answer) as client:
        for session in ("ann-7", "ann-7", "bob", "Zoë\r\n", None):
            client.localize(DESCRIBED, session=session)
        client.localize(segments=[CLOUD], sensors=np.zeros(3), session="ann-7")
    first, second, other, odd, none, segments = sent
    assert first == second == segments
    assert len({first, other, odd, none}) == 4
    assert none is None
    assert all(each is None or re.fullmatch("[0-9a-f]{16}", each) for each in sent)


def test_msgpack_sends_arrays_as_bytes() -> None:
    sent: list[Any] = []

    def answer(request: httpx.Request) -> httpx.Response:
        import msgpack  # type: ignore[import-untyped]

        sent.append(msgpack.unpackb(request.content))
        return packed(LOCALIZED)

    with client_of(answer) as client:
        client.localize(DESCRIBED)
        client.localize(segments=[CLOUD], sensors=[1.0, 2.0, 3.0], motion="se3", k=5)
    assert sent[0]["codes"] == bytes([3, 4, 5, 6])
    assert np.frombuffer(sent[0]["centroids"], "<f8").tolist() == [1, 2, 3, 4, 5, 6]
    assert "session" not in sent[0]
    assert (sent[1]["motion"], sent[1]["k"], len(sent[1]["segments"])) == ("se3", 5, 1)


def test_localized_robot_has_a_pose() -> None:
    with client_of(lambda _: packed(LOCALIZED)) as client:
        found = client.localize(segments=[CLOUD], sensors=np.zeros(3))
    best = found.best
    assert best is found.maps[0]
    assert best.pose is not None
    assert (best.map, best.frame, best.probability, best.score) == ("yard", "f", 0.97, 7.5)
    # Rotation by 73.7 degrees: cosine 0.28, sine 0.96.
    expected = np.array([[0.28, -0.96, 0, 10], [0.96, 0.28, 0, 20], [0, 0, 1, 1], [0, 0, 0, 1]])
    np.testing.assert_allclose(best.pose.matrix, expected, atol=1e-12)
    np.testing.assert_allclose(best.pose.apply([1.0, 0, 0]), [10.28, 20.96, 1])
    np.testing.assert_allclose(best.pose.apply([[1.0, 0, 0]]), [[10.28, 20.96, 1]])
    assert best.others[0].score == 2.5
    assert best.others[0].inliers == 3
    assert found.errors == {}


@pytest.mark.parametrize("size", [4, 6])
def test_covariance_of_a_point_includes_the_rotation(size: int) -> None:
    """A rotation of 0.1 rad about z moves a point 10 m east of the origin by 1 m to the north."""
    covariance = np.diag([0.04, 0.04, 0.01, *[0.0] * (size - 4), 0.01])
    flat = {"translation": [0, 0, 0], "rotation": [0, 0, 0, 1], "yaw": 0.0}
    place = PLACE | {"pose": flat, "covariance": covariance.tolist()}
    with client_of(lambda _: packed(LOCALIZED | {"localizations": [place]})) as client:
        best = client.localize(DESCRIBED).best
    assert best is not None
    np.testing.assert_allclose(best.covariance_at([0, 0, 0]), np.diag([0.04, 0.04, 0.01]))
    np.testing.assert_allclose(best.covariance_at([10, 0, 0]), np.diag([0.04, 1.04, 0.01]))
    np.testing.assert_allclose(best.covariance_at([0, 10, 0]), np.diag([1.04, 0.04, 0.01]))


def test_not_localized_has_no_pose_but_a_reason() -> None:
    nowhere = PLACE | {
        "localized": False, "reason": "ambiguous", "detail": "Two.", "pose": None,
        "covariance": None, "inliers": [],
    }  # fmt: skip
    unusable = [{"query": 3, "error": {"type": "urn:x", "title": "t", "detail": "d"}}]
    content = LOCALIZED | {
        "localizations": [nowhere], "unusable": unusable,
        "skipped": [{"map": "old", "model_id": "n"}],
    }  # fmt: skip
    with client_of(lambda _: packed(content)) as client:
        found = client.localize(segments=[CLOUD], sensors=np.zeros(3))
    assert found.best is None
    assert found.maps[0].reason == "ambiguous"
    assert isinstance(found.maps[0].others[0].pose, Pose)
    assert found.errors == {3: ItemError("urn:x", "t", "d")}
    assert found.skipped[0].model_id == "n"
    with pytest.raises(ValueError, match="ambiguous"):
        found.maps[0].covariance_at([0, 0, 0])


def test_B1_two_equal_maps_are_ambiguous_and_the_rival_is_named() -> None:
    rival = {"map": "hall", "frame": "g", "pose": POSE, "score": 7.25, "inliers": 5}
    nowhere = {
        "localized": False, "reason": "ambiguous", "detail": "Two.", "pose": None,
        "covariance": None, "inliers": [],
    }  # fmt: skip
    places = [
        PLACE | nowhere | {"rival": rival},
        PLACE | nowhere | {"map": "hall", "rival": rival | {"map": "yard"}},
    ]
    with client_of(lambda _: packed(LOCALIZED | {"localizations": places})) as client:
        found = client.localize(DESCRIBED)
    assert found.best is None
    assert found.rival is not None
    assert (found.rival.map, found.rival.frame, found.rival.score) == ("hall", "g", 7.25)
    assert found.rival.inliers == 5
    assert found.rival.pose.translation.tolist() == [10.0, 20.0, 1.0]
    assert found.maps[1].rival is not None
    assert found.maps[1].rival.map == "yard"


def test_B1_equally_probable_maps_are_ordered_by_score() -> None:
    """The answer is from a service that judges each map alone."""
    old = {name: value for name, value in PLACE.items() if name != "rival"}
    places = [old | {"map": "a", "score": 73.0}, old | {"map": "z", "score": 129.0}]
    with client_of(lambda _: packed(LOCALIZED | {"localizations": places})) as client:
        found = client.localize(DESCRIBED)
    assert found.best is not None
    assert found.best.map == "z"
    assert found.rival is None


def test_localize_refuses_both_or_no_kinds_of_query() -> None:
    with client_of(lambda _: httpx.Response(500)) as client:
        for arguments in ({}, {"segments": [CLOUD]}, {"description": DESCRIBED, "sensors": CLOUD}):
            with pytest.raises(ValueError, match="either"):
                client.localize(**arguments)


def test_centroids_are_checked_before_they_are_sent() -> None:
    broken = Description("m", DESCRIBED.codes, DESCRIBED.descriptors, np.full((3, 3), np.nan), {})
    with (
        client_of(lambda _: httpx.Response(500)) as client,
        pytest.raises(ValueError, match="not finite"),
    ):
        client.localize(broken)


def test_what_helps_is_read_and_older_services_have_none() -> None:
    place = {"map": "yard", "frame": "f", "position": [1.0, 2, 3], "yaw": 0.5, "score": 4.0}
    told = {
        "localized": False, "reason": "ambiguous", "pose": None, "covariance": None,
        "threshold": 0.75, "max_false_acceptance": 0.001, "advice": "Drive on.",
        "meters_to_drive": 4.0, "places": [place, place], "places_apart": 12.5,
    }  # fmt: skip
    answers = [packed(LOCALIZED | {"localizations": [PLACE | told]}), packed(LOCALIZED)]
    with client_of(lambda _: answers.pop(0)) as client:
        found, older = (client.localize(DESCRIBED).maps[0] for _ in range(2))
    assert (found.threshold, found.max_false_acceptance) == (0.75, 0.001)
    assert (found.advice, found.meters_to_drive, found.places_apart) == ("Drive on.", 4.0, 12.5)
    first = found.places[0]
    assert (first.map, first.frame, first.yaw, first.score) == ("yard", "f", 0.5, 4.0)
    assert first.position.tolist() == [1, 2, 3]
    assert (older.threshold, older.max_false_acceptance) == (None, None)
    assert (older.advice, older.meters_to_drive, older.places, older.places_apart) == (
        "", None, (), None,
    )  # fmt: skip


def test_heights_are_sent_with_codes_and_left_out_for_an_older_service() -> None:
    asked: list[Any] = []
    sessions: list[str] = []

    def answer(request: httpx.Request) -> httpx.Response:
        asked.append(json.loads(request.content).get("heights"))
        sessions.append(request.headers["placecell-session"])
        if asked[-1] is not None and len(asked) == 2:
            detail = "/heights: Extra inputs are not permitted."
            return httpx.Response(422, json={"title": "Invalid request", "detail": detail})
        return httpx.Response(200, json=LOCALIZED | {"localizations": [PLACE]})

    boxed = replace(DESCRIBED, heights=np.array([np.nan, 2.5, np.nan]))
    with client_of(answer, encoding="json") as client:
        client.localize(boxed, session="ann-7")
        client.localize(boxed, session="ann-7")
    assert asked == [[2.5, None], [2.5, None], None]
    assert len(set(sessions)) == 1


def test_description_has_the_heights_of_its_boxes() -> None:
    def answer(_: httpx.Request) -> httpx.Response:
        told = {"codes": [1, 2], "descriptor": [0.1, 0.2], "centroid": [0, 0, 0]}
        bad = {"error": {"type": "urn:x", "title": "Too few points", "detail": "none"}}
        content = {"model_id": "m", "dimension": 2, "descriptors": [told, told, bad]}
        return httpx.Response(200, json=content)

    broken = CLOUD.copy()
    broken[3] = np.nan
    with client_of(answer, encoding="json") as client:
        found = client.describe([CLOUD, broken, np.zeros((0, 3))], np.zeros(3))
    np.testing.assert_array_equal(found.heights, [9.0, 6.0, np.nan])
