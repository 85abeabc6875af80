"""`/scans` and `/key` over HTTP: files in, segments out, and clear refusals."""

from pathlib import Path
from typing import Any

import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest

from tests.placecell.sources.clouds.mutations import mutate
from tests.service.clouds.scan_files import KINDS, PILLARS, scan_file, yard_scan
from tests.service.service_builders import MSGPACK, assert_problem

SMALL = 0.8
"""Distance between the points of a small scan, meters."""

MUTATIONS = 25
"""Damaged files of each format."""


def send(service: Any, content: bytes, name: str = "scan", **headers: str) -> Any:
    return service.post("/scans", params={"name": name}, content=content, headers=headers)


def test_segments_of_a_file_can_be_matched_as_they_are(service: Any) -> None:
    answer = send(service, scan_file("pcd")[2], "scan.pcd")
    assert answer.status_code == 200, answer.text
    content = answer.json()
    assert content["format"] == "PCD"
    assert content["points"] == len(yard_scan())
    assert content["dropped_points"] == 0
    assert content["problems"] == []
    assert content["sensor_height"] == pytest.approx(1.8, abs=0.05)
    assert content["transform"] == np.eye(4).tolist()
    assert len(content["segments"]) == len(content["sensors"]) == len(PILLARS)
    for segment in content["segments"]:
        points = np.array(segment["points"])
        np.testing.assert_allclose(segment["centroid"], points.mean(axis=0), atol=2e-3)
        np.testing.assert_allclose(segment["extents"], np.ptp(points, axis=0), atol=2e-3)
    cloud = content["cloud"]
    assert len(cloud["points"]) == len(cloud["labels"]) <= 50_000
    np.testing.assert_array_equal(np.round(cloud["points"], 2), cloud["points"])
    assert {*cloud["labels"]} == {-2, -1, *range(len(PILLARS))} - (
        {-2} if -2 not in cloud["labels"] else set()
    )
    segments = [
        {"points": each["points"], "sensor": sensor}
        for each, sensor in zip(content["segments"], content["sensors"], strict=True)
    ]
    described = service.post("/describe", json={"segments": segments})
    assert described.status_code == 200
    assert all("codes" in each for each in described.json()["descriptors"])
    assert "segment;dur=" in answer.headers["server-timing"]


def test_msgpack_holds_the_same_scan_as_blobs(service: Any) -> None:
    expected = send(service, scan_file("laz")[2], "scan.laz").json()
    answer = send(service, scan_file("laz")[2], "scan.laz", Accept=MSGPACK)
    assert answer.headers["content-type"] == MSGPACK
    content = msgpack.unpackb(answer.content)
    assert content.keys() == expected.keys()
    for one, other in zip(content["segments"], expected["segments"], strict=True):
        points = np.frombuffer(one["points"], "<f4").reshape(-1, 3)
        np.testing.assert_allclose(points, other["points"], atol=1e-3)
        assert one["centroid"] == other["centroid"]
    points = np.frombuffer(content["cloud"]["points"], "<f4").reshape(-1, 3)
    np.testing.assert_allclose(points, expected["cloud"]["points"], atol=1e-5)
    assert np.frombuffer(content["cloud"]["labels"], "<i4").tolist() == expected["cloud"]["labels"]


@pytest.mark.parametrize("kind", list(KINDS))
def test_every_format_gives_the_same_segments(service: Any, kind: str) -> None:
    format_name, suffix, content = scan_file(kind)
    answer = send(service, content, f"scan{suffix}").json()
    assert (answer["format"], len(answer["segments"])) == (format_name, len(PILLARS))


def test_compressed_body_is_read(service: Any) -> None:
    import gzip

    packed = gzip.compress(scan_file("csv")[2])
    answer = send(service, packed, "scan.csv", **{"Content-Encoding": "gzip"})
    assert answer.status_code == 200
    assert len(answer.json()["segments"]) == len(PILLARS)


def test_unusable_files_are_explained(start: Any) -> None:
    with start(limits={"scan_points": 1000, "scan_bytes": 2_000_000}) as service:
        assert_problem(send(service, b""), 422, "invalid-cloud-file", "scan: is empty")
        assert_problem(send(service, bytes(5000)), 415, "unsupported-cloud-file", "PCD, PLY")
        cut = scan_file("pcd")[2][:5000]
        assert_problem(send(service, cut, "my.pcd"), 413, "too-many-points", "my.pcd: has")
        small = scan_file("pcd", SMALL)[2]
        answer = send(service, small[:-7], "my.pcd")
        assert_problem(answer, 413, "too-many-points")
        assert_problem(send(service, bytes(2_000_001)), 413, "body-too-large", "2000000")
        headers = {"Content-Type": "text/plain"}
        refused = service.post("/scans", content=b"1 2 3\n", headers=headers)
        assert_problem(refused, 415, "unsupported-media-type")
        assert_problem(send(service, small, Accept="text/html"), 406, "not-acceptable")
        assert_problem(send(service, small, "n" * 201), 422, "invalid-request")


def test_too_much_work_is_refused_before_it_is_done(start: Any) -> None:
    with start(limits={"cost_seconds": 1e-3}) as service:
        answer = send(service, scan_file("pcd")[2])
        assert_problem(answer, 413, "too-much-work", "most of it for scan")


def test_problem_shows_no_path_of_the_service(start: Any, tmp_path: Path) -> None:
    with start() as service:
        for name in ("../../etc/passwd", str(tmp_path), "/etc/hostname", "models/tiny/x.bin"):
            answer = send(service, b"\x00\x01" * 100, name)
            assert answer.status_code in {415, 422}
            detail = answer.json()["detail"]
            assert detail.startswith(f"{Path(name).name}: ")
            assert "/" not in detail.replace(" or ", "")


@pytest.mark.slow
@pytest.mark.parametrize("kind", list(KINDS))
def test_damaged_file_is_segmented_or_refused(service: Any, kind: str) -> None:
    _, suffix, content = scan_file(kind, SMALL)
    random = np.random.default_rng(list(kind.encode()))
    for number in range(MUTATIONS):
        damaged = mutate(content, random)
        answer = send(service, damaged, f"my{suffix}")
        assert answer.status_code in {200, 413, 415, 422}, (number, answer.text)
        if answer.status_code != 200:
            detail = answer.json()["detail"]
            assert detail.startswith(f"my{suffix}: "), detail
            assert detail.isprintable()


@pytest.fixture
def keys_file(tmp_path: Path) -> Path:
    from hashlib import sha256

    file = tmp_path / "keys.toml"
    scopes = {
        "reader": "", "writer": 'write = true\nmaps = ["yard", "hall-*"]\nrobot = "ann"',
        "owner": "write = true\nadmin = true",
    }  # fmt: skip
    file.write_text(
        "".join(
            f"[{name}]\nsha256 = '{sha256(name.encode()).hexdigest()}'\n{scope}\n"
            for name, scope in scopes.items()
        )
    )
    return file


def test_key_tells_its_scope(start: Any, keys_file: Path) -> None:
    def asked(name: str) -> Any:
        return service.get("/key", headers={"Authorization": f"Bearer {name}"})

    with start(keys_file=keys_file) as service:
        assert asked("reader").json() == {
            "name": "reader", "role": "read", "may_write": False, "maps": ["*"], "robot": None,
            "open": False,
        }  # fmt: skip
        assert asked("writer").json() == {
            "name": "writer", "role": "write", "may_write": True, "maps": ["yard", "hall-*"],
            "robot": "ann", "open": False,
        }  # fmt: skip
        assert asked("owner").json()["role"] == "admin"
        for unknown in (asked("other"), service.get("/key")):
            assert unknown.json() == {
                "name": "",
                "role": "none",
                "may_write": False,
                "maps": [],
                "robot": None,
                "open": False,
            }
        answer = service.post("/scans", content=b"1 2 3")
        assert_problem(answer, 401, "unauthorized")


def test_key_of_a_service_without_keys_may_do_everything(service: Any) -> None:
    assert service.get("/key").json() == {
        "name": "anyone", "role": "admin", "may_write": True, "maps": ["*"], "robot": None,
        "open": True,
    }  # fmt: skip
