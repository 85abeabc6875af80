"""Scans added to maps: segments at the pose of the sensor, with ids of their own."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from placecell_client import decode, encode

from placecell.descriptors.manifest import Manifest
from tests.service.clouds.scan_files import PILLARS, scan_file
from tests.service.service_builders import (
    assert_problem,
    map_of,
    random_codes,
    write_eigenvalue_model,
)


def file() -> bytes:
    """Return the scan that the tests add."""
    return scan_file("pcd")[2]


def add(service: Any, content: bytes | None = None, **query: Any) -> Any:
    """Add a scan of robot bob, or other content, to map yard."""
    query = {"robot": "bob", "name": "scan.pcd", "time": 1_700_000_000.0} | query
    return service.post(
        "/maps/yard/scans", params=query, content=file() if content is None else content
    )


def test_scan_makes_a_new_map_at_the_pose_of_the_sensor(service: Any) -> None:
    assert_problem(add(service), 404, "unknown-map")
    answer = add(service, create=True, x=100.0, y=-20.0, z=3.0, yaw=np.pi / 2)
    assert answer.status_code == 201, answer.text
    content = answer.json()
    assert content["changed"] == content["segments"] == len(PILLARS)
    assert content["ids"] == list(range(len(PILLARS)))
    assert (content["unusable"], content["problems"]) == (0, [])
    stored = service.get("/maps/yard")
    assert answer.headers["etag"] == stored.headers["etag"]
    found = decode(stored.content)
    expected = {(round(100.0 - y), round(-20.0 + x)) for x, y in PILLARS}
    assert {(round(x), round(y)) for x, y, _ in found.centroids} == expected
    assert found.robots == ("bob",)
    np.testing.assert_allclose(found.frame_positions, [[100.0, -20.0, 3.0]])
    np.testing.assert_allclose(found.frame_times, [1_700_000_000.0])
    half = np.sqrt(0.5)
    np.testing.assert_allclose(found.frame_orientations, [[0, 0, half, half]], atol=1e-6)
    assert found.extents is not None
    assert found.points is not None
    assert found.extents[:, 2].min() >= 24  # pillars of 3 m, without the lowest 0.3 m
    assert found.points.min() >= 100
    (version,) = service.get("/maps/yard/versions").json()["versions"]
    assert (version["operation"], version["changed"]) == ("edit", len(PILLARS))


def test_codes_are_those_of_describe(service: Any) -> None:
    segmented = service.post("/scans", params={"name": "scan.pcd"}, content=file())
    assert segmented.status_code == 200, segmented.text
    found = segmented.json()["segments"]
    segments = [{"points": each["points"], "sensor": [0, 0, 0]} for each in found]
    described = service.post("/describe", json={"segments": segments}).json()["descriptors"]
    add(service, create=True, yaw=1.0)
    stored = decode(service.get("/maps/yard").content)
    difference = stored.codes.astype(int) - [each["codes"] for each in described]
    assert np.abs(difference).max() <= 1  # the answer's points are rounded to 1 mm


def test_scans_join_a_map_under_reserved_ids(service: Any, manifest: Manifest) -> None:
    service.put("/maps/yard", content=encode(map_of(random_codes(9), manifest.model_id)))
    first, second = add(service).json()["ids"], add(service, robot="ann", x=50.0).json()["ids"]
    assert len({*first, *second}) == 2 * len(PILLARS)
    assert min(first + second) > 108
    stored = decode(service.get("/maps/yard").content)
    assert len(stored) == 9 + 2 * len(PILLARS)
    assert (stored.frame, stored.optional) == ("town", ())
    assert service.post("/maps/yard/versions/1/restore").status_code == 200
    assert len(decode(service.get("/maps/yard").content)) == 9


def test_repeated_scan_is_not_stored_twice_on_request(start: Any, tmp_path: Path) -> None:
    write_eigenvalue_model(tmp_path / "models", pair_threshold=0.5)
    with start(models_dir=tmp_path / "models") as service:
        add(service, create=True)
        again = add(service, deduplicate=True, time=1_700_000_100.0).json()
        assert (again["segments"], again["repeats"]) == (len(PILLARS), len(PILLARS))


def test_unusable_scans_leave_the_map_as_it_is(service: Any, manifest: Manifest) -> None:
    service.put("/maps/yard", content=encode(map_of(random_codes(9), manifest.model_id)))
    tag = service.get("/maps/yard").headers["etag"]
    assert_problem(add(service, content=b""), 422, "invalid-cloud-file")
    assert_problem(add(service, content=file()[:3000]), 422, "invalid-cloud-file", "scan.pcd")
    answer = add(service, content=b"5 0 0\n" * 500, name="scan.xyz")
    assert_problem(answer, 422, "no-usable-segment", "No segment has 100 points")
    for query in (
        {"robot": ""}, {"robot": "a\x00b"}, {"x": "nan"}, {"x": 1e9},
        {"yaw": "x"}, {"time": 1e12}, {"robot": "r" * 201},
    ):  # fmt: skip
        answer = add(service, **query)
        assert answer.status_code == 422, (query, answer.text)
    assert service.get("/maps/yard").headers["etag"] == tag


def test_other_version_and_missing_right_are_refused(
    start: Any, manifest: Manifest, tmp_path: Path
) -> None:
    from hashlib import sha256

    keys = tmp_path / "keys.toml"
    lines = {
        "reader": "", "ann": 'write = true\nmaps = ["yard"]\nrobot = "ann"', "owner": "write = true"
    }  # fmt: skip
    keys.write_text(
        "".join(
            f"[{name}]\nsha256 = '{sha256(name.encode()).hexdigest()}'\n{scope}\n"
            for name, scope in lines.items()
        )
    )
    with start(keys_file=keys) as service:

        def asked(key: str, name: str = "yard", **query: Any) -> Any:
            return service.post(
                f"/maps/{name}/scans",
                params={"create": True} | query,
                content=file(),
                headers={"Authorization": f"Bearer {key}"},
            )

        assert asked("ann").status_code == 201
        assert_problem(asked("reader", robot="bob"), 403, "forbidden")
        assert_problem(asked("ann", "hall"), 403, "forbidden")
        assert_problem(asked("ann", robot="bob"), 403, "forbidden")
        assert_problem(asked("owner"), 422, "invalid-request", "robot")
        stale = service.post(
            "/maps/yard/scans?robot=bob",
            content=file(),
            headers={"Authorization": "Bearer owner", "If-Match": '"00-1"'},
        )
        assert_problem(stale, 412, "precondition-failed")


@pytest.mark.parametrize("limits", [{"scan_points": 100}, {"scan_bytes": 1000}])
def test_large_scan_is_refused(start: Any, limits: dict[str, int]) -> None:
    with start(limits=limits) as service:
        answer = add(service, create=True)
        assert answer.status_code == 413
        assert_problem(service.get("/maps/yard"), 404, "unknown-map")
