"""Tests of `align_maps` and `merge_maps`: requests, results and timeouts."""

import json
from collections.abc import Callable
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Hypothesis, MapLoop, Overlap, Pose, Retries, ServiceError

from tests.client.client_fakes import ALIGNED, LAID, MERGED, Blocking, Time, client_of

Make = Callable[..., Any]


@pytest.fixture(params=[client_of, Blocking], ids=["sync", "async"])
def make(request: pytest.FixtureRequest) -> Make:
    maker: Make = request.param
    return maker


def without(content: dict[str, Any], name: str) -> dict[str, Any]:
    return {key: value for key, value in content.items() if key != name}


@pytest.mark.parametrize("encoding", ["msgpack", "json"])
def test_align_and_merge_send_their_arguments(make: Make, encoding: str) -> None:
    seen: list[Any] = []

    def answer(request: httpx.Request) -> httpx.Response:
        path = request.url.raw_path.decode()
        headers = request.headers
        tags = headers.get("If-Match"), headers.get("Content-Type")
        seen.append((request.method, path, *tags, request.content))
        return httpx.Response(200, json=ALIGNED if "/align/" in path else MERGED)

    client = make(answer, encoding=encoding)
    client.align_maps("a.b", "../c/d")
    client.align_maps("a", "b", motion="se3", pairs=True)
    client.merge_maps("s.t", ("a", "b"))
    client.merge_maps("s", ["a"], dry_run=True, deduplicate=False, motion="se3", if_match="e-3")
    client.merge_maps("s", ["a"], if_match="*")
    assert seen[:2] == [
        ("POST", "/maps/a%2Eb/align/%2E%2E%2Fc%2Fd?motion=yaw", None, None, b""),
        ("POST", "/maps/a/align/b?motion=se3&pairs=true", None, None, b""),
    ]
    assert [each[:4] for each in seen[2:]] == [
        ("POST", "/maps/s%2Et/merge", None, "application/json"),
        ("POST", "/maps/s/merge", '"e-3"', "application/json"),
        ("POST", "/maps/s/merge", "*", "application/json"),
    ]
    usual = {"maps": ["a", "b"], "dry_run": False, "deduplicate": True, "motion": "yaw"}
    assert [json.loads(each[-1]) for each in seen[2:]] == [
        usual,
        {"maps": ["a"], "dry_run": True, "deduplicate": False, "motion": "se3"},
        usual | {"maps": ["a"]},
    ]


def test_alignment_is_parsed_into_typed_values(make: Make) -> None:
    found = make(lambda _: httpx.Response(200, json=ALIGNED)).align_maps("yard", "hall", pairs=True)
    assert (found.map, found.etag, found.frame) == ("yard", "e-3", "f")
    assert (found.other, found.other_etag, found.other_frame) == ("hall", "h-1", "g")
    # Rotation by 73.7 degrees: cosine 0.28, sine 0.96.
    np.testing.assert_allclose(found.pose.apply([1.0, 0, 0]), [10.28, 20.96, 1])
    assert (found.reason, found.detail) == (None, "")
    assert found.covariance.shape == (4, 4)
    assert found.overlap == Overlap(0.5, 0.75)
    assert (found.score, found.agreement, found.pairs) == (40.5, 0.625, 2)
    assert len(found.inliers) == 2
    assert found.inliers.ids.tolist() == [9, 7]
    assert found.inliers.other_ids.tolist() == [4, 5]
    assert found.inliers.residuals.tolist() == [0.25, 0.125]
    (other,) = found.others
    assert isinstance(other.pose, Pose)
    assert (other.score, other.agreement, other.pairs) == (2.5, 0.0625, 13)
    assert not isinstance(other, Hypothesis)


def test_unaligned_maps_have_no_pose(make: Make) -> None:
    nothing = {
        "aligned": False, "reason": "too-few-segments", "detail": "3 segments in a map.",
        "pose": None, "covariance": None, "overlap": None, "score": 0.0, "agreement": 0.0,
        "pairs": 0, "inliers": [], "others": [],
    }  # fmt: skip
    found = make(lambda _: httpx.Response(200, json=ALIGNED | nothing)).align_maps("yard", "hall")
    assert (found.pose, found.covariance, found.overlap) == (None, None, None)
    assert (found.reason, found.detail) == ("too-few-segments", "3 segments in a map.")
    assert (len(found.inliers), found.others) == (0, ())


def test_merge_is_parsed_into_typed_values(make: Make) -> None:
    merged = make(lambda _: httpx.Response(201, json=MERGED)).merge_maps("site", ["yard", "shed"])
    assert (merged.map, merged.frame, merged.dry_run) == ("site", "f", False)
    assert (merged.sequence, merged.etag, merged.previous) == (4, "s-4", 3)
    assert (merged.segments, merged.changed, merged.removed) == (32, 14, 1)
    yard, shed = merged.parts
    assert (yard.map, yard.etag, yard.merged) == ("yard", "e-3", True)
    assert (yard.added, yard.known, yard.repeats, yard.removed) == (12, 5, 3, 1)
    np.testing.assert_allclose(yard.pose.translation, [10, 20, 1])
    assert (shed.map, shed.merged, shed.pose) == ("shed", False, None)
    good, bad = merged.alignments
    assert (good.map, good.other, good.aligned, good.proven, good.rejected) == (
        *("site", "yard", True, True, False),
    )
    assert good.overlap == Overlap(0.5, 0.75)
    assert isinstance(good.pose, Pose)
    assert (good.score, good.agreement, good.pairs) == (40.5, 0.625, 2)
    assert (bad.aligned, bad.pose, bad.overlap) == (False, None, None)
    assert (bad.reason, bad.detail) == ("inconsistent", "Little agrees.")
    assert merged.loops == (MapLoop(("site", "yard", "hall"), 0.5, 0.25, closes=True),)


def test_dry_run_has_no_version(make: Make) -> None:
    dry = MERGED | {"dry_run": True, "sequence": None, "etag": None, "previous": None}
    merged = make(lambda _: httpx.Response(200, json=dry)).merge_maps("site", ["a"], dry_run=True)
    assert (merged.dry_run, merged.sequence, merged.etag, merged.previous) == (
        *(True, None, None, None),
    )


@pytest.mark.parametrize(
    "content",
    [
        [],
        without(ALIGNED, "pose"),
        ALIGNED | {"pose": {"translation": [1, 2], "rotation": [0, 0, 0, 1], "yaw": 0}},
        ALIGNED | {"overlap": 3},
        ALIGNED | {"inliers": [{"id": 9}]},
        ALIGNED | {"others": [LAID | {"pose": None}]},
    ],
)
def test_malformed_alignment_is_an_error(make: Make, content: Any) -> None:
    with pytest.raises(ServiceError, match="Unreadable"):
        make(lambda _: httpx.Response(200, json=content)).align_maps("yard", "hall")


@pytest.mark.parametrize(
    "content",
    [
        None,
        without(MERGED, "previous"),
        MERGED | {"parts": None},
        MERGED | {"parts": [{"map": "yard"}]},
        MERGED | {"alignments": [LAID]},
        MERGED | {"loops": [{"maps": 3, "meters": 0, "degrees": 0, "closes": True}]},
    ],
)
def test_malformed_merge_is_an_error(make: Make, content: Any) -> None:
    with pytest.raises(ServiceError, match="Unreadable"):
        make(lambda _: httpx.Response(200, json=content)).merge_maps("site", ["yard"])


CALLS: list[Callable[..., Any]] = [
    lambda client, **more: client.align_maps("yard", "hall", **more),
    lambda client, **more: client.merge_maps("site", ["yard"], if_match="e-3", **more),
]


@pytest.mark.parametrize("call", CALLS)
def test_align_and_merge_have_their_own_timeout_of_minutes(
    make: Make, call: Callable[..., Any]
) -> None:
    waited: list[str] = []

    def answer(request: httpx.Request) -> httpx.Response:
        waited.append(request.headers["Placecell-Timeout"])
        return httpx.Response(400)

    # An attempt with a shorter limit would start again and never finish.
    hurried = make(answer, timeout=2.0, retries=Retries(longest_attempt=1.0))
    for more in ({}, {"timeout": 900.0}):
        with pytest.raises(ServiceError):
            call(hurried, **more)
    with pytest.raises(ServiceError):
        hurried.info()
    assert waited == ["300.000", "900.000", "1.000"]


@pytest.mark.parametrize("call", CALLS)
def test_retries_end_within_the_timeout(make: Make, call: Callable[..., Any]) -> None:
    time = Time()

    def answer(_: httpx.Request) -> httpx.Response:
        time.now += 200
        return httpx.Response(504)

    with pytest.raises(ServiceError) as raised:
        call(make(answer, time))
    assert raised.value.status == 504
    assert time.now < 1000 + 2 * 200 + 1


@pytest.mark.parametrize("timeout", [0, -1, float("inf"), float("nan")])
@pytest.mark.parametrize("call", CALLS)
def test_invalid_timeout_is_refused(make: Make, call: Callable[..., Any], timeout: float) -> None:
    with pytest.raises(ValueError, match="timeout"):
        call(make(lambda _: httpx.Response(500)), timeout=timeout)
