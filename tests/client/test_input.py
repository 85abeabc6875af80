"""Arrays that the client accepts, and errors for all others."""

import json
import warnings
from pathlib import Path
from typing import Any

import httpx
import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from placecell_client import Client, Description, PrecisionWarning
from placecell_client.http.encoding import Encoding, centroids_of, codes_of, segments_of

CLOUD = np.random.default_rng(0).uniform(-30, 30, (40, 3))
SENSOR = [0.0, 0.0, 1.5]
UTM = np.array([5e5, 5.4e6, 300.0])


def sent(points: Any, encoding: Encoding = "json") -> Any:
    """Return the points of a request's only segment."""
    body, _ = segments_of([points], SENSOR, encoding)
    given = body["segments"][0]["points"]
    if encoding == "json":
        return np.array(given, np.float64).reshape(-1, 3)
    return np.frombuffer(given, "<f4").reshape(-1, 3) + np.array(body.get("origin", [0, 0, 0]))


def structured(fields: list[Any], cloud: Any = CLOUD) -> Any:
    array = np.zeros(len(cloud), np.dtype(fields, align=True))
    for axis, name in enumerate("xyz"):
        array[name] = cloud[:, axis]
    return array


@pytest.mark.parametrize(
    "shape", [(3, 400), (40, 6), (40, 4), (40, 2), (40, 1), (120,), (3,), (), (1, 40, 3), (0, 4)]
)
def test_B3_wrong_shape_is_refused_by_name(shape: tuple[int, ...]) -> None:
    words = rf"segment 1 has shape \({', '.join(map(str, shape))},?\), expected \(n, 3\)"
    with pytest.raises(ValueError, match=words):
        segments_of([CLOUD, np.zeros(shape)], SENSOR, "msgpack")


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (np.zeros((4, 3), object), "type object, expected numbers"),
        (np.zeros((4, 3), bool), "type bool, expected numbers"),
        (np.zeros((4, 3), complex), "type complex128, expected numbers"),
        (np.zeros((4, 3), "datetime64[s]"), "expected numbers"),
        ([["1", "2", "3"]], "expected numbers"),
        ([[1, 2, 3], [4, 5]], "segment 0 is not an array of numbers"),
        (np.zeros(4, [("x", "f4"), ("y", "f4"), ("intensity", "f4")]), "fields x, y, intensity"),
        (np.zeros(4, [("x", "f4", 2), ("y", "f4"), ("z", "f4")]), "expected numbers"),
        (np.zeros(4, [("x", "U3"), ("y", "f4"), ("z", "f4")]), "expected numbers"),
        (None, "type object|shape"),
        ("abc", "shape"),
        ({1, 2, 3}, "shape"),
    ],
)
def test_B3_wrong_type_is_refused_by_name(points: Any, words: str) -> None:
    with pytest.raises(ValueError, match="segment 0") as raised:
        segments_of([points], SENSOR, "json")
    assert raised.match(words)


def test_B3_one_cloud_instead_of_a_list_is_refused() -> None:
    with pytest.raises(ValueError, match=r"segment 0 has shape \(3,\)"):
        segments_of(CLOUD, SENSOR, "msgpack")  # type: ignore[arg-type]


@pytest.mark.parametrize("encoding", ["json", "msgpack"])
@pytest.mark.parametrize(
    "fields",
    [
        [("x", "<f4"), ("y", "<f4"), ("z", "<f4")],
        [("z", "f8"), ("intensity", "u1"), ("x", "f8"), ("ring", "u2"), ("y", "f8")],
        [("x", ">f4"), ("y", ">f4"), ("z", ">f4"), ("t", ">u4")],
        [("y", "f4"), ("x", "f8"), ("z", ">f8"), ("rgb", "u1", 3)],
    ],
)
def test_B3_structured_arrays_are_accepted(encoding: Encoding, fields: list[Any]) -> None:
    array = structured(fields)
    np.testing.assert_allclose(sent(array, encoding), CLOUD, atol=4e-6)
    np.testing.assert_allclose(sent(array.reshape(8, 5), encoding), CLOUD, atol=4e-6)  # organized
    np.testing.assert_allclose(sent(array[::2], encoding), CLOUD[::2], atol=4e-6)
    assert len(sent(array[:0], encoding)) == 0


def test_B3_arrays_in_any_memory_layout_are_accepted(tmp_path: Path) -> None:
    mapped = np.memmap(tmp_path / "cloud", np.float64, "w+", shape=CLOUD.shape)
    mapped[:] = CLOUD
    wide = np.zeros((40, 6))
    wide[:, ::2] = CLOUD
    for given in (
        *(CLOUD, CLOUD.tolist(), tuple(map(tuple, CLOUD)), np.asfortranarray(CLOUD), mapped),
        *(wide[:, ::2], CLOUD.astype(">f8"), CLOUD.T.copy().T, list(CLOUD)),
    ):
        np.testing.assert_array_equal(sent(given), CLOUD)
    for kind in ("f2", "f4", ">f4", "i2", "u1", "i8", np.longdouble):
        whole = np.abs(CLOUD).astype(kind)
        np.testing.assert_array_equal(sent(whole), whole.astype(np.float64))
    nothing: Any
    for nothing in ([], np.zeros((0, 3)), np.zeros((0, 3), np.float32)):
        assert len(sent(nothing)) == 0


@pytest.mark.parametrize("encoding", ["json", "msgpack"])
@pytest.mark.parametrize("kind", ["f4", "f8"])
def test_B10_nonfinite_points_are_dropped_and_counted(encoding: Encoding, kind: str) -> None:
    broken = CLOUD.astype(kind)
    broken[3, 1], broken[7], broken[9, 2] = np.nan, np.inf, -np.inf
    masked = np.ma.masked_array(CLOUD, mask=np.zeros((40, 3), bool))
    masked[5, 0] = np.ma.masked
    body, clouds = segments_of([broken, CLOUD.astype(kind), masked], SENSOR, encoding)
    assert clouds.dropped == 4
    counts = [
        len(each["points"]) // (12 if encoding == "msgpack" else 1) for each in body["segments"]
    ]
    assert counts == [37, 40, 39]
    assert "NaN" not in json.dumps([each["sensor"] for each in body["segments"]])


def test_B10_the_result_counts_the_points_of_both_sides() -> None:
    def answer(request: httpx.Request) -> httpx.Response:
        asked = msgpack.unpackb(request.content)
        error = {"error": {"type": "t", "title": "T", "detail": "D"}}
        good = {"codes": b"\x01", "descriptor": bytes(4), "centroid": [0, 0, 0]}
        answers: dict[str, dict[str, Any]] = {
            "/describe": {"model_id": "m", "dimension": 1, "descriptors": [good, error]},
            "/match": {"model_id": "m", "queries": [error, error], "searched": [], "skipped": []},
            "/localize": {"model_id": "m", "localizations": [], "unusable": [], "skipped": []},
        }
        content = answers[request.url.path]
        assert len(asked["segments"][1]["points"]) == 0
        return httpx.Response(
            200,
            content=msgpack.packb(content | {"dropped_points": 2}),
            headers={"Content-Type": "application/msgpack"},
        )

    segments = [CLOUD, np.full((5, 3), np.nan)]
    with Client("http://service", transport=httpx.MockTransport(answer)) as client:
        assert client.describe(segments, SENSOR).dropped_points == 7
        assert client.match(segments=segments, sensors=SENSOR).dropped_points == 7
        assert client.localize(segments=segments, sensors=SENSOR).dropped_points == 7


@pytest.mark.parametrize(
    ("sensors", "words"),
    [
        ([0.0, 0.0], r"sensors has shape \(2,\), expected \(3,\) or \(1, 3\)"),
        (np.zeros((3, 1)), r"sensors has shape \(3, 1\)"),
        (np.zeros((2, 3)), r"sensors has shape \(2, 3\)"),
        ([0.0, np.nan, 0.0], "sensor 0 is not finite"),
        (["a", "b", "c"], "sensors has type"),
        ([True, True, True], "sensors has type bool"),
    ],
)
def test_B3_wrong_sensors_are_refused(sensors: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        segments_of([CLOUD], sensors, "msgpack")


def test_B3_wrong_codes_and_centroids_are_refused() -> None:
    for codes, words in (
        (np.zeros(4, np.int8), r"codes has shape \(4,\), expected \(n, any\)"),
        (np.zeros((4, 2)), "codes has type float64, expected integers"),
        (np.full((4, 2), 200), "codes has values outside -128 to 127"),
    ):
        with pytest.raises(ValueError, match=words):
            codes_of(codes, "msgpack")
    for centroids, words in (
        (np.zeros((3, 4)), r"centroids has shape \(3, 4\), expected \(n, 3\)"),
        (np.full((3, 3), np.nan), "centroid 0 is not finite"),
    ):
        with pytest.raises(ValueError, match=words):
            centroids_of(centroids, "msgpack")
    description = Description(
        "m", np.zeros((2, 4), np.int8), np.zeros((2, 4), np.float32), np.zeros((3, 2)), {}
    )
    with (
        Client("http://service") as client,
        pytest.raises(ValueError, match=r"centroids has shape \(2, 2\)"),
    ):
        client.localize(description)


@pytest.mark.parametrize("encoding", ["json", "msgpack"])
def test_B15_large_float32_coordinates_warn_and_float64_lose_nothing(encoding: Encoding) -> None:
    with pytest.warns(PrecisionWarning, match="Subtract an origin"):
        segments_of([(CLOUD + UTM).astype(np.float32)], UTM, encoding)
    with pytest.warns(PrecisionWarning):  # float32 has lost the digits before the call
        segments_of([(CLOUD + UTM).astype(np.float32).astype(np.float64)], UTM, encoding)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        body, _ = segments_of([CLOUD + UTM], UTM, encoding)
        segments_of([(CLOUD + 1000).astype(np.float32)], SENSOR, encoding)
        segments_of([np.round(CLOUD) + UTM], UTM, encoding)
    points = body["segments"][0]["points"]
    if encoding == "msgpack":
        assert body["origin"] == UTM.tolist()
        points = np.frombuffer(points, "<f4").reshape(-1, 3) + np.array(body["origin"])
    np.testing.assert_allclose(points, CLOUD + UTM, rtol=0, atol=4e-6)


def test_points_that_float32_cannot_hold_are_refused_by_name() -> None:
    with pytest.raises(ValueError, match="segment 0: point 1 is too far for float32"):
        segments_of([[[0.0, 0, 0], [1e300, 0, 0]]], SENSOR, "msgpack")
