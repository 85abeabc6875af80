"""Tags, WGS 84 anchors and named anchors over HTTP: what keeps them, and what refuses them."""

import shutil
import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path
from typing import Any

import httpx
import numpy as np
import pytest
from placecell_client import Client, CompactMap, encode

from placecell.core.geodesy import GeoAnchor, to_geodetic
from placecell.descriptors.manifest import Manifest
from service.maps.sqlite.store import FILE, SqliteMapStore
from tests.service.core.test_auth import made
from tests.service.search.test_localize import TRUTH, by_codes, seen_in, street_map
from tests.service.service_builders import assert_problem, edit_of, map_of, random_codes

GEO: dict[str, Any] = {
    "lat": 49.0112,
    "lon": 8.4243,
    "height": 115.0,
    "yaw_deg": 37.0,
    "accuracy": 0.5,
}
DOCK = {"position": [1.0, 2.0, 0.5], "orientation": [0.0, 0.0, 0.6, 0.8]}
FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"


@pytest.fixture
def yard(manifest: Manifest) -> CompactMap:
    return map_of(random_codes(5), manifest.model_id)


@pytest.fixture
def stocked(service: Any, yard: CompactMap) -> Any:
    assert service.put("/maps/yard", content=encode(yard)).status_code == 201
    return service


def annotate(service: Any, name: str = "yard", **headers: str) -> None:
    for path, body in (
        ("tags", {"tags": ["outdoor", "floor-1"]}),
        ("anchor", GEO),
        ("anchors/dock", DOCK),
    ):
        response = service.put(f"/maps/{name}/{path}", json=body, headers=headers)
        assert response.status_code == 200, response.text


def read(service: Any, name: str = "yard") -> tuple[Any, ...]:
    """All annotations of a map, without authors and times."""
    tags = service.get(f"/maps/{name}/tags").json()["tags"]
    anchor = service.get(f"/maps/{name}/anchor").json()
    named = service.get(f"/maps/{name}/anchors").json()["anchors"]
    return (
        tags,
        {key: anchor[key] for key in (*GEO, "applies")},
        [(each["name"], each["position"], each["applies"]) for each in named],
    )


STORED = (["floor-1", "outdoor"], GEO | {"applies": True}, [("dock", [1.0, 2.0, 0.5], True)])


def test_annotations_are_read_as_written(stocked: Any) -> None:
    assert_problem(stocked.get("/maps/yard/anchor"), 404, "no-anchor")
    assert_problem(stocked.get("/maps/yard/anchors/dock"), 404, "unknown-anchor")
    annotate(stocked)
    assert read(stocked) == STORED
    dock = stocked.get("/maps/yard/anchors/dock").json()
    assert dock["orientation"] == pytest.approx(DOCK["orientation"])
    assert (dock["author"], dock["frame"]) == ("anyone", "town")
    assert stocked.get("/maps").json()["maps"][0]["tags"] == ["floor-1", "outdoor"]
    detail = stocked.get("/maps/yard", headers={"Accept": "application/json"}).json()
    assert detail["tags"] == ["floor-1", "outdoor"]
    assert detail["sequence"] == 1  # annotations make no version


def test_annotations_can_be_replaced_and_removed(stocked: Any) -> None:
    annotate(stocked)
    stocked.put("/maps/yard/tags", json={"tags": ["indoor", "indoor"]})
    assert stocked.get("/maps/yard/tags").json()["tags"] == ["indoor"]
    assert stocked.delete("/maps/yard/anchor").status_code == 204
    assert stocked.delete("/maps/yard/anchors/dock").status_code == 204
    assert_problem(stocked.delete("/maps/yard/anchor"), 404, "no-anchor")
    assert_problem(stocked.delete("/maps/yard/anchors/dock"), 404, "unknown-anchor")
    stocked.put("/maps/yard/tags", json={"tags": []})
    assert stocked.get("/maps/yard/tags").json()["tags"] == []


def test_annotations_survive_edit_replacement_restore_compaction_and_restart(
    start: Any, yard: CompactMap, manifest: Manifest
) -> None:
    with start() as service:
        service.put("/maps/yard", content=encode(yard))
        annotate(service)
        edit = edit_of(random_codes(2, 1), manifest.model_id, first_id=500)
        headers = {"Content-Type": "application/vnd.placecell.delta"}
        assert service.post("/maps/yard/segments", content=edit, headers=headers).is_success
        assert read(service) == STORED
        other = map_of(random_codes(7, 2), manifest.model_id)
        assert service.put(
            "/maps/yard", content=encode(other), headers={"If-Match": "*"}
        ).is_success
        assert read(service) == STORED
        assert service.post("/maps/yard/versions/1/restore").is_success
        assert service.post("/maps/yard/compact").is_success
        assert read(service) == STORED
    with start() as service:
        assert read(service) == STORED
        assert service.delete("/maps/yard").status_code == 204
        service.put("/maps/yard", content=encode(yard))
        assert service.get("/maps/yard/tags").json()["tags"] == []
        assert_problem(service.get("/maps/yard/anchor"), 404, "no-anchor")


def test_map_in_another_frame_does_not_use_its_anchors(
    stocked: Any, yard: CompactMap, manifest: Manifest
) -> None:
    annotate(stocked)
    moved = replace(map_of(random_codes(5), manifest.model_id), frame="other")
    stocked.put("/maps/yard", content=encode(moved), headers={"If-Match": "*"})
    assert read(stocked)[1]["applies"] is False
    assert read(stocked)[2] == [("dock", [1.0, 2.0, 0.5], False)]
    stocked.post("/maps/yard/versions/1/restore")
    assert read(stocked) == STORED


def test_named_anchors_are_listed_in_pages(stocked: Any) -> None:
    for name in ("c", "a", "b"):
        stocked.put(f"/maps/yard/anchors/{name}", json=DOCK)
    page = stocked.get("/maps/yard/anchors", params={"limit": 2}).json()
    assert ([each["name"] for each in page["anchors"]], page["next"]) == (["a", "b"], "b")
    rest = stocked.get("/maps/yard/anchors", params={"limit": 2, "after": "b"}).json()
    assert ([each["name"] for each in rest["anchors"]], rest["next"]) == (["c"], None)


@pytest.mark.parametrize(
    ("path", "body", "pointer"),
    [
        ("tags", {"tags": ["<b>bold</b>"]}, "/tags/0"),
        ("tags", {"tags": ["x" * 65]}, "/tags/0"),
        ("tags", {"tags": "outdoor"}, "/tags"),
        ("anchor", GEO | {"lat": 91}, "/lat"),
        ("anchor", GEO | {"lon": "8"}, "/lon"),
        ("anchor", {"lat": 49.0}, "/lon"),
        ("anchor", GEO | {"yaw_deg": 1e9}, "/yaw_deg"),
        ("anchor", GEO | {"accuracy": -1}, "/accuracy"),
        ("anchor", GEO | {"altitude": 1}, "/altitude"),
        ("anchors/dock", {"position": [0, 0]}, "/position"),
        ("anchors/dock", DOCK | {"orientation": [0, 0, 0, 0]}, ""),
    ],
)
def test_wrong_value_is_refused_with_its_place(
    stocked: Any, path: str, body: dict[str, Any], pointer: str
) -> None:
    response = stocked.put(f"/maps/yard/{path}", json=body)
    assert_problem(response, 422, "invalid-request")
    assert any(each["pointer"].startswith(pointer) for each in response.json()["errors"])


def test_wrong_names_and_values_that_are_not_json_are_refused(stocked: Any) -> None:
    headers = {"Content-Type": "application/json"}
    refused = stocked.put("/maps/yard/anchors/%3Cb%3E", json=DOCK)
    assert_problem(refused, 422, "invalid-name", "anchor")
    infinite = stocked.put("/maps/yard/anchor", content=b'{"lat": NaN, "lon": 0}', headers=headers)
    assert infinite.status_code in {400, 422}
    assert_problem(stocked.put("/maps/yard/anchor", content=b"{", headers=headers), 400, "not-json")
    assert_problem(stocked.put("/maps/nowhere/anchor", json=GEO), 404, "unknown-map")
    large = stocked.put("/maps/yard/tags", content=b"[" * (65 << 20), headers=headers)
    assert_problem(large, 413, "body-too-large")


def test_preconditions_are_about_the_version_of_the_map(stocked: Any) -> None:
    etag = stocked.get("/maps").json()["maps"][0]["etag"]
    for path, body in (("tags", {"tags": []}), ("anchor", GEO), ("anchors/dock", DOCK)):
        url = f"/maps/yard/{path}"
        assert_problem(
            stocked.put(url, json=body, headers={"If-Match": '"0-1"'}), 412, "precondition-failed"
        )
        assert stocked.put(url, json=body, headers={"If-Match": f'"{etag}"'}).is_success


def test_quotas_bound_tags_and_anchors(start: Any, yard: CompactMap) -> None:
    with start(limits={"map_anchors": 2, "annotations": 4}) as service:
        service.put("/maps/yard", content=encode(yard))
        many = {"tags": [f"t{number}" for number in range(33)]}
        assert_problem(service.put("/maps/yard/tags", json=many), 507, "quota-exceeded", "33 tags")
        for name in ("a", "b"):
            assert service.put(f"/maps/yard/anchors/{name}", json=DOCK).is_success
        full = service.put("/maps/yard/anchors/c", json=DOCK)
        assert_problem(full, 507, "quota-exceeded", "3 anchors; the limit is 2")
        assert service.put("/maps/yard/anchors/b", json=DOCK).is_success
        tags = {"tags": ["x", "y", "z"]}
        assert_problem(service.put("/maps/yard/tags", json=tags), 507, "quota-exceeded", "together")
        assert service.put("/maps/yard/tags", json={"tags": ["x", "y"]}).is_success
        service.delete("/maps/yard")
        service.put("/maps/yard", content=encode(yard))
        assert service.put("/maps/yard/tags", json=tags).is_success


def test_roles_of_keys(start: Any, tmp_path: Path, yard: CompactMap) -> None:
    file = tmp_path / "keys.toml"
    writer = made(file, "writer", "--write")
    reader = made(file, "reader")
    other = made(file, "other", "--write", "--map", "hall")
    robot = made(file, "robot", "--write", "--robot", "ann")
    with start(keys_file=file) as service:
        service.put("/maps/yard", content=encode(yard), headers=writer)
        annotate(service, **writer)
        for path, body in (("tags", {"tags": []}), ("anchor", GEO), ("anchors/dock", DOCK)):
            url = f"/maps/yard/{path}"
            assert_problem(service.put(url, json=body, headers=reader), 403, "forbidden")
            assert_problem(service.put(url, json=body, headers=other), 403, "forbidden")
            assert_problem(service.put(url, json=body, headers=robot), 403, "forbidden")
            assert_problem(service.get(url, headers=other), 403, "forbidden")
            assert service.get(url, headers=reader).status_code == 200
            assert service.get(url).status_code == 401
        # A robot's key writes its own anchors.
        own = "/maps/yard/anchors/charger"
        assert service.put(own, json=DOCK, headers=robot).is_success
        assert service.put(own, json=DOCK | {"position": [0, 0, 0]}, headers=robot).is_success
        assert service.delete(own, headers=robot).status_code == 204


@pytest.mark.sqlite
def test_altered_annotation_is_left_out_and_told_by_verify(
    start: Any, data_dir: Path, yard: CompactMap
) -> None:
    with start() as service:
        service.put("/maps/yard", content=encode(yard))
        annotate(service)
    with closing(sqlite3.connect(data_dir / FILE)) as connection:
        connection.execute("UPDATE annotations SET value = '{}' WHERE kind = 'anchor'")
        connection.commit()
    with start() as service:
        assert_problem(service.get("/maps/yard/anchor"), 404, "no-anchor")
        assert service.get("/maps/yard/anchors/dock").status_code == 200
    with SqliteMapStore.owned(data_dir) as store:
        (wrong,) = store.verify()
    assert "map 'yard': anchor '' was altered" in wrong


@pytest.mark.sqlite
def test_database_of_version_2_stays_readable_and_takes_annotations(
    start: Any, data_dir: Path
) -> None:
    data_dir.mkdir()
    shutil.copy(FIXTURES / "version-2.sqlite", data_dir / FILE)
    with SqliteMapStore.owned(data_dir) as store:
        assert store.verify() == []
        shed, yard = store.heads()
        assert (shed.name, shed.sequence, yard.name, yard.sequence) == ("shed", 1, "yard", 2)
        assert yard.next_id >= 10
        assert store.annotations() == {}
    with start() as service:
        annotate(service)
        assert read(service) == STORED
    with SqliteMapStore.owned(data_dir) as store:
        assert store.verify() == []
        assert len(store.annotations()) == 1


def test_answer_has_a_geopose_and_geo_hints_narrow(service: Any, manifest: Manifest) -> None:
    content = street_map(manifest)
    service.put("/maps/street", content=encode(content))
    body = by_codes(manifest, *seen_in(content))
    told = service.post("/localize", json=body).json()["localizations"][0]
    assert told["localized"]
    assert told["geopose"] is None
    only = {"Accept": "application/geopose+json"}
    refused = service.post("/localize", json=body, headers=only)
    assert_problem(refused, 409, "no-anchor", "PUT /maps")
    service.put("/maps/street/anchor", json=GEO)
    told = service.post("/localize", json=body).json()["localizations"][0]
    lat, lon, height = to_geodetic(TRUTH.translation, GeoAnchor(**GEO))[0]
    position = told["geopose"]["position"]
    assert (position["lat"], position["lon"]) == pytest.approx((lat, lon), abs=1e-6)
    assert position["h"] == pytest.approx(height, abs=0.1)
    # The heading from east is that in the map, and the map's yaw.
    quaternion = told["geopose"]["quaternion"]
    yaw = 2 * np.arctan2(quaternion["z"], quaternion["w"])
    assert yaw == pytest.approx(TRUTH.yaw + np.radians(37.0), abs=0.01)
    answer = service.post("/localize", json=body, headers=only)
    assert answer.headers["content-type"] == "application/geopose+json"
    assert answer.json() == told["geopose"]
    near = {"geo": {"lat": lat, "lon": lon, "accuracy": 2.0}}
    used = service.post("/localize", json=body | {"hints": near}).json()
    assert used["localizations"][0]["localized"]
    assert (used["hints"]["used"], used["hints"]["unused"]) == (["geo"], [])
    far = {"geo": {"lat": lat + 0.001, "lon": lon, "accuracy": 10.0}}
    wrong = service.post("/localize", json=body | {"hints": far}, headers=only)
    assert_problem(wrong, 409, "not-localized", "outside-hints")
    tagged = {"tags": ["outdoor"]}
    assert (
        service.post("/localize", json=body | {"hints": tagged}).json()["localizations"][0][
            "reason"
        ]
        == "outside-hints"
    )
    service.put("/maps/street/tags", json={"tags": ["outdoor"]})
    assert service.post("/localize", json=body | {"hints": tagged}).json()["localizations"][0][
        "localized"
    ]


def fixes(count: int, meters: float) -> list[dict[str, Any]]:
    steps = np.linspace(0, meters, count)
    positions = np.column_stack([steps, 0.2 * steps, np.zeros(count)])
    places = to_geodetic(positions, GeoAnchor(49.0112, 8.4243, 115.0, 37.0))
    return [
        {"position": position, "lat": lat, "lon": lon, "height": height, "accuracy": 1.0}
        for position, (lat, lon, height) in zip(positions.tolist(), places.tolist(), strict=True)
    ]


def test_anchor_is_fitted_to_fixes(stocked: Any) -> None:
    given = fixes(30, 200.0)
    given[3]["lat"] += 0.01
    dry = stocked.post("/maps/yard/anchor/fit", json={"fixes": given, "dry_run": True})
    assert dry.status_code == 200, dry.text
    assert_problem(stocked.get("/maps/yard/anchor"), 404, "no-anchor")
    told = stocked.post("/maps/yard/anchor/fit", json={"fixes": given}).json()
    assert told["inliers"] == 29
    assert [each["inlier"] for each in told["residuals"]].count(False) == 1
    assert told["residuals"][3]["meters"] > 1_000
    assert told["anchor"]["yaw_deg"] == pytest.approx(37.0, abs=0.01)
    assert told["yaw_deviation_deg"] < 1
    assert stocked.get("/maps/yard/anchor").json()["lat"] == told["anchor"]["lat"]
    few = stocked.post("/maps/yard/anchor/fit", json={"fixes": fixes(30, 2.0)})
    assert_problem(few, 422, "anchor-not-determined", "do not determine the yaw")
    bad = stocked.post("/maps/yard/anchor/fit", json={"fixes": []})
    assert_problem(bad, 422, "invalid-request")


def test_client_reads_and_writes_annotations(stocked: Any) -> None:
    def forward(request: httpx.Request) -> httpx.Response:
        told = stocked.request(
            request.method, str(request.url), content=request.content, headers=request.headers
        )
        return httpx.Response(told.status_code, content=told.content, headers=told.headers)

    client = Client("http://127.0.0.1", transport=httpx.MockTransport(forward))
    assert client.set_tags("yard", ["a", "b"]) == client.tags("yard") == ("a", "b")
    assert client.maps().maps[0].tags == ("a", "b")
    anchor = client.set_anchor("yard", 49.0, 8.4, height=110.0, yaw_deg=30.0)
    assert client.anchor("yard") == anchor
    assert (anchor.lat, anchor.height, anchor.position) == (49.0, 110.0, (0.0, 0.0, 0.0))
    client.delete_anchor("yard")
    given = fixes(20, 100.0)
    fit = client.fit_anchor(
        "yard",
        np.array([each["position"] for each in given]),
        [each["lat"] for each in given],
        [each["lon"] for each in given],
        heights=[each["height"] for each in given],
        accuracies=1.0,
    )
    assert fit.anchor.yaw_deg == pytest.approx(37.0, abs=0.01)
    assert fit.is_inlier.all()
    assert client.set_named_anchor("yard", "dock", (1, 2, 3)).position.tolist() == [1, 2, 3]
    assert [each.name for each in client.anchors("yard")] == ["dock"]
    assert client.named_anchor("yard", "dock").orientation.tolist() == [0, 0, 0, 1]
    client.delete_named_anchor("yard", "dock")
    assert client.anchors("yard") == ()
