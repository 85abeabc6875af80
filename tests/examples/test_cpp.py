"""The C++ example: built here, run against a service, compared with the Python client."""

import contextlib
import json
import os
import shutil
import socket
import subprocess
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import httpx
import msgpack  # type: ignore[import-untyped]
import numpy as np
import pytest
from numpy.typing import NDArray
from placecell_client import (
    Client,
    CompactMap,
    Hints,
    NearHint,
    ServiceError,
    decode,
    encode,
)
from placecell_client.maps.compact_map import OPTIONAL

from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.child_process import running_service
from tests.client.map_builders import random_map, with_tracks

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "cpp"
GXX = ["g++", "-std=c++17", "-O1", "-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-Werror"]
ECHO = """
#include <iostream>
#include <iterator>
#include "placecell.hpp"
int main(int, char** arguments) try {
  if (std::string(arguments[1]) == "seen") {
    const placecell::Client client(arguments[2]);
    for (const char* map : {"yard", "hall"}) client.get_map_file(map);
    client.info();
    return 0;
  }
  const std::string data(std::istreambuf_iterator<char>(std::cin), {});
  const bool is_json = std::string(arguments[1]) == "json";
  std::cout << placecell::to_msgpack(is_json ? placecell::from_json(data)
                                             : placecell::from_msgpack(data));
} catch (const placecell::FormatError& error) {
  std::cerr << error.what();
  return 1;
}
"""
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(shutil.which("g++") is None, reason="no g++ to build the example with"),
]


def build(folder: Path, source: Path, *options: str) -> Path:
    """Build a program with the headers of the example; every warning is an error."""
    program = folder / "program"
    command: list[str | Path] = [*GXX, "-I", EXAMPLE / "include", source, "-o", program, *options]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    return program


def has_libcurl(folder: Path) -> bool:
    source = folder / "curl.cpp"
    source.write_text("#include <curl/curl.h>\nint main() { return !curl_easy_init(); }\n")
    command: list[str | Path] = ["g++", source, "-o", folder / "curl", "-lcurl"]
    done = subprocess.run(command, capture_output=True, timeout=60, check=False)
    return done.returncode == 0


@pytest.fixture(scope="module", params=["socket", "curl"])
def program(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The example, with each way of sending requests."""
    folder = tmp_path_factory.mktemp(request.param)
    if request.param == "socket":
        return build(folder, EXAMPLE / "example.cpp")
    if not has_libcurl(folder):
        pytest.skip("no headers of libcurl (libcurl4-openssl-dev) to build with")
    return build(folder, EXAMPLE / "example.cpp", "-DPLACECELL_WITH_CURL", "-lcurl")


@pytest.fixture(scope="module")
def echo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A program that reads JSON or msgpack and writes msgpack, or downloads two maps."""
    folder = tmp_path_factory.mktemp("echo")
    (folder / "echo.cpp").write_text(ECHO)
    return build(folder, folder / "echo.cpp")


def run(
    program: Path, *arguments: object, key: str | None = None
) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if name != "PLACECELL_KEY"}
    return subprocess.run(
        [program, *map(str, arguments)],
        capture_output=True,
        text=True,
        errors="backslashreplace",  # an error may quote a broken header
        timeout=60,
        check=False,
        env=environment | ({"PLACECELL_KEY": key} if key else {}),
    )


def lines(program: Path, *arguments: object) -> list[Any]:
    """Return the lines that a command prints."""
    done = run(program, *arguments)
    assert (done.returncode, done.stderr) == (0, "")
    return [json.loads(line) for line in done.stdout.splitlines()]


SENSOR = [1.5, -2.25, 1.8]


def scan() -> list[NDArray[np.float32]]:
    """Return 40 boxes of different sizes around the sensor; the last segment has too few points."""
    random = np.random.default_rng(7)
    clouds = []
    for _ in range(40):
        size, place = random.uniform(0.4, 4, 3), random.uniform(-25, 25, 3) * [1, 1, 0.05]
        clouds.append((random.uniform(-0.5, 0.5, (200, 3)) * size + place).astype(np.float32))
    return [*clouds, clouds[0][:2]]


@pytest.fixture(scope="module")
def scan_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("scan") / "scan.json"
    segments = [{"points": cloud.astype(float).tolist(), "sensor": SENSOR} for cloud in scan()]
    file.write_text(json.dumps({"segments": segments}))
    return file


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """A service with a map of the scan, moved and turned."""
    with running_service(tmp_path_factory.mktemp("data")) as address, Client(address) as client:
        described = client.describe(scan(), SENSOR)
        good = np.flatnonzero(np.isfinite(described.centroids).all(axis=1))
        turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        client.put_map(
            "yard",
            CompactMap(
                model_id=described.model_id,
                preprocessing=Manifest.load(MODELS_FOLDER / DEFAULT_MODEL).preprocessing["version"],
                frame="yard",
                codes=described.codes[good],
                centroids=described.centroids[good] @ turn.T + [100.0, 50.0, 0.5],
                ids=np.arange(len(good), dtype=np.uint32),
                robots=("ann",),
                robot=np.zeros(len(good), np.uint16),
                frame_index=np.zeros(len(good), np.uint32),
                frame_times=np.array([12.5]),
                frame_positions=np.array([[100.0, 50.0, 2.0]]),
                frame_orientations=np.array([[0, 0, 0, 1]], np.float32),
            ),
        )
        yield address


def test_descriptors_equal_the_python_clients(program: Path, address: str, scan_file: Path) -> None:
    with Client(address) as client:
        expected = client.describe(scan(), SENSOR)
    told = lines(program, "describe", address, scan_file)
    assert len(told) == len(expected.codes)
    assert list(expected.errors) == [40]
    for index, line in enumerate(told):
        if index in expected.errors:
            error = expected.errors[index]
            assert line == {"error": f"{error.title}: {error.detail}"}
        else:
            assert line == {
                "codes": expected.codes[index].tobytes().hex(),
                "descriptor": expected.descriptors[index].tobytes().hex(),
                "centroid": expected.centroids[index].tolist(),
            }


def test_pose_equals_the_python_clients(program: Path, address: str, scan_file: Path) -> None:
    with Client(address) as client:
        expected = client.localize(segments=scan(), sensors=SENSOR, maps=["yard"]).maps[0]
    assert expected.pose is not None
    assert expected.covariance is not None
    (line,) = lines(program, "localize", address, scan_file, "yard")
    assert line == {
        "map": "yard",
        "frame": "yard",
        "probability": expected.probability,
        "score": expected.score,
        "translation": expected.pose.translation.tolist(),
        "rotation": expected.pose.rotation.tolist(),
        "yaw": expected.pose.yaw,
        "covariance": expected.covariance.tolist(),
        "inliers": [
            list(each)
            for each in zip(
                expected.inliers.queries.tolist(),
                expected.inliers.ids.tolist(),
                expected.inliers.residuals.tolist(),
                strict=True,
            )
        ],
    }


def test_downloaded_map_equals_the_python_clients(
    program: Path, address: str, tmp_path: Path
) -> None:
    assert lines(program, "download", address, "yard", tmp_path / "yard.map") == []
    with Client(address) as client:
        assert (tmp_path / "yard.map").read_bytes() == client.get_map_file("yard")


@dataclass
class Answer:
    """An answer of a server of the tests, and the requests that it received."""

    status: int = 200
    headers: dict[str, str] = field(default_factory=dict)
    body: bytes = b""
    requests: list[tuple[str, dict[str, str], bytes]] = field(default_factory=list)


@pytest.fixture
def answer() -> Iterator[tuple[str, Answer]]:
    """A server that gives one answer to all requests; its address and the answer."""
    given = Answer()

    class Handler(BaseHTTPRequestHandler):
        protocol_version = "HTTP/1.1"

        def log_message(self, *_: Any) -> None:
            pass

        def do_POST(self) -> None:
            body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
            headers = {name.lower(): value for name, value in self.headers.items()}
            given.requests.append((self.path, headers, body))
            self.send_response(given.status)
            own = {"Content-Length": str(len(given.body))}
            chunked = "Transfer-Encoding" in given.headers
            for name, value in (({} if chunked else own) | given.headers).items():
                self.send_header(name, value)
            self.end_headers()
            self.wfile.write(given.body)
            self.close_connection = True

        do_GET = do_POST

    server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_address[1]}", given
    server.shutdown()
    server.server_close()


BUSY = b'{"type":"urn:placecell:problem:busy","title":"Busy","status":429,"detail":"It is full."}'


def python_request(method: str) -> bytes:
    """Return the body that the Python client sends."""
    sent = []

    def keep(request: httpx.Request) -> httpx.Response:
        sent.append(request.content)
        return httpx.Response(400, content=BUSY)

    service = Client("http://service", transport=httpx.MockTransport(keep))
    with service as client, contextlib.suppress(ServiceError):
        if method == "describe":
            client.describe(scan(), SENSOR)
        else:
            hints = Hints(near=NearHint((1.5, -2.0, 0.25), 30.0)) if method == "near" else None
            client.localize(segments=scan(), sensors=SENSOR, maps=["yard", "hall"], hints=hints)
    return sent[0]


def test_requests_equal_the_python_clients_bytes(
    program: Path, answer: tuple[str, Answer], scan_file: Path
) -> None:
    url, given = answer
    given.status, given.body = 429, BUSY
    near = ("--near", "1.5", "-2", "0.25", "30")
    cases: dict[str, tuple[str, ...]] = {
        "describe": ("describe",),
        "localize": ("localize", "yard", "hall"),
        "near": ("localize", *near, "yard", "hall"),
    }
    for name, (method, *rest) in cases.items():
        done = run(program, method, url + "/", scan_file, *rest, key="k-1")
        assert (done.returncode, done.stderr) == (1, "429 Busy: It is full.\n")
        path, headers, body = given.requests.pop()
        assert path == f"/{method}"
        assert headers["authorization"] == "Bearer k-1"
        assert headers["content-type"] == "application/msgpack"
        assert body == python_request(name)


@pytest.mark.parametrize(
    ("headers", "body", "message"),
    [
        ({"Content-Type": "text/html"}, b"<html>", "unreadable: it is not msgpack."),
        ({"Content-Type": "application/msgpack"}, b"\x81", "Invalid msgpack: the data is cut."),
        ({"Content-Type": "application/msgpack"}, b"\x80", "The key 'model_id' is missing."),
        ({"Content-Type": "application/msgpack"}, b"\x80" * 2, "bytes follow the value"),
        ({"Content-Type": "application/msgpack"}, b"\xdd\xff\xff\xff\xff", "the data is cut."),
        ({"Content-Type": "application/msgpack"}, b"\x91" * 1000, "nested too deeply"),
        ({"Content-Length": "9"}, b"short", ""),
    ],
)
def test_unreadable_answers_are_errors(
    program: Path,
    answer: tuple[str, Answer],
    scan_file: Path,
    headers: dict[str, str],
    body: bytes,
    message: str,
) -> None:
    url, given = answer
    given.headers, given.body = headers, body
    done = run(program, "describe", url, scan_file)
    assert (done.returncode, done.stdout) == (1, "")
    assert message in done.stderr


def test_error_page_of_a_proxy_is_shown(
    program: Path, answer: tuple[str, Answer], scan_file: Path
) -> None:
    url, given = answer
    given.status, given.body = 502, b"<h1>Bad gateway</h1>"
    done = run(program, "describe", url, scan_file)
    assert done.returncode == 1
    assert done.stderr == "502 Error of another server: <h1>Bad gateway</h1>\n"


def test_later_requests_name_the_versions_of_downloaded_maps(
    echo: Path, answer: tuple[str, Answer]
) -> None:
    url, given = answer
    given.headers, given.body = {"ETag": '"0123456789abcdef-3"'}, b"{}"
    assert run(echo, "seen", url).returncode == 0
    seen = [headers.get("placecell-seen") for _, headers, _ in given.requests]
    yard, hall = 'yard "0123456789abcdef-3"', 'hall "0123456789abcdef-3"'
    assert seen == [None, yard, f"{hall}, {yard}"]


def test_chunked_answers_are_joined(
    program: Path, answer: tuple[str, Answer], scan_file: Path
) -> None:
    url, given = answer
    content = msgpack.packb({"model_id": "m", "localizations": []})
    given.headers = {"Content-Type": "application/msgpack", "Transfer-Encoding": "chunked"}
    parts = content[:3], content[3:]
    given.body = b"".join(b"%x\r\n%b\r\n" % (len(part), part) for part in parts)
    given.body += b"0\r\n\r\n"
    assert lines(program, "localize", url, scan_file) == []
    given.body = b"ff\r\ntoo short"
    done = run(program, "localize", url, scan_file)
    assert done.returncode == 1


def test_service_that_does_not_run_is_named(program: Path, scan_file: Path) -> None:
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        port = listening.getsockname()[1]
    done = run(program, "describe", f"http://127.0.0.1:{port}", scan_file)
    assert (done.returncode, done.stdout) == (1, "")
    assert f"127.0.0.1:{port}" in done.stderr
    assert "Check the address, and that the service runs." in done.stderr


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("describe", "127.0.0.1:8000", "SCAN"), "expected http://HOST:PORT or https://HOST"),
        (("describe", "http://127.0.0.1:1", "/nowhere/scan.json"), "Cannot open"),
        (("map", "/nowhere/yard.map"), "Cannot open the map file '/nowhere/yard.map'"),
    ],
)
def test_wrong_arguments_are_named(
    program: Path, scan_file: Path, arguments: tuple[str, ...], message: str
) -> None:
    done = run(program, *(each.replace("SCAN", str(scan_file)) for each in arguments))
    assert (done.returncode, done.stdout) == (1, "")
    assert message in done.stderr


def test_unknown_command_prints_the_usage(program: Path) -> None:
    done = run(program, "fly")
    assert done.returncode == 2
    assert done.stderr.startswith("usage:")


def expected_lines(compact_map: CompactMap) -> list[Any]:
    head = {
        "segments": len(compact_map.ids),
        "frame": compact_map.frame,
        "model_id": compact_map.model_id,
        "robots": list(compact_map.robots),
        "sources": list(compact_map.sources),
    }
    capture = compact_map.frame_index
    return [head] + [
        {
            "id": int(compact_map.ids[row]),
            "robot": compact_map.robots[compact_map.robot[row]],
            "time": compact_map.frame_times[capture[row]],
            "sensor": compact_map.frame_positions[capture[row]].tolist(),
            "centroid": compact_map.centroids[row].tolist(),
            "class": 0 if compact_map.classes is None else int(compact_map.classes[row]),
            "codes": compact_map.codes[row].tobytes().hex(),
        }
        for row in range(len(compact_map.ids))
    ]


MAPS = {
    "bare": random_map(segments=50),
    "all-columns": random_map(segments=50, optional=OPTIONAL, extent=1e7),
    "odometry": with_tracks(random_map(segments=50, frames=5)),
    "empty": random_map(segments=0, frames=0),
    "many-robots": random_map(segments=400, robots=tuple(f"é-{n} \U0001f600" for n in range(300))),
}


@pytest.mark.parametrize("name", MAPS)
def test_map_file_reads_as_the_python_client_reads_it(
    program: Path, name: str, tmp_path: Path
) -> None:
    file = tmp_path / "a.map"
    file.write_bytes(encode(MAPS[name]))
    assert lines(program, "map", file) == expected_lines(decode(file.read_bytes()))


def test_damaged_map_files_are_refused(program: Path, tmp_path: Path) -> None:
    data = encode(random_map(segments=3, frames=2, optional=OPTIONAL))
    begin = 8 + int.from_bytes(data[:8], "little")
    damaged = [data[:length] for length in (0, 7, 8, 100, begin - 1, begin, len(data) - 1)]
    damaged += [data + b"\0", data.replace(b"placecell-map", b"placecell-mop")]
    damaged += [data.replace(rb"\"version\":1", rb"\"version\":2")]
    for bit in np.random.default_rng(0).integers(0, 8 * len(data), 60):
        flipped = bytearray(data)
        flipped[bit // 8] ^= 1 << bit % 8
        damaged.append(bytes(flipped))
    file = tmp_path / "a.map"
    for content in damaged:
        file.write_bytes(content)
        done = run(program, "map", file)
        assert (done.returncode, done.stdout) == (1, "")
        assert done.stderr.startswith("Invalid map file. ")


VALUES: list[Any] = [
    None,
    True,
    *(number for power in (5, 7, 8, 15, 16, 31, 32, 62) for number in (2**power, 2**power - 1)),
    *(number for power in (5, 7, 15, 31, 62) for number in (-(2**power), -(2**power) - 1)),
    0.1,
    -1e300,
    *("x" * size for size in (0, 31, 32, 255, 256, 65_535, 65_536)),
    *([0] * size for size in (0, 15, 16, 65_536)),
    {str(number): number for number in range(20)},
    {"a": [{"b": None}], 'é\n"\\': "\U0001f600"},
]


@pytest.mark.parametrize("value", VALUES, ids=lambda value: repr(value)[:20])
def test_values_are_read_and_written_as_pythons_msgpack_does(echo: Path, value: Any) -> None:
    packed = msgpack.packb(value)
    read = subprocess.run([echo, "msgpack"], input=packed, stdout=subprocess.PIPE, check=True)
    assert read.stdout == packed
    for text in (json.dumps(value), json.dumps(value, ensure_ascii=False, indent=1)):
        parsed = subprocess.run(
            [echo, "json"], input=text.encode(), stdout=subprocess.PIPE, check=True
        )
        assert parsed.stdout == packed


@pytest.mark.parametrize("size", [0, 255, 256, 65_536])
def test_blobs_are_read_and_written_as_pythons_msgpack_does(echo: Path, size: int) -> None:
    packed = msgpack.packb(bytes(size))
    read = subprocess.run([echo, "msgpack"], input=packed, stdout=subprocess.PIPE, check=True)
    assert read.stdout == packed


@pytest.mark.parametrize(
    "text", ["", "{", '{"a"}', "[1,]", "tru", '"a', '"\\x"', '"\\u12', "1 2", "[" * 1000, "--1"]
)
def test_broken_json_is_refused(echo: Path, text: str) -> None:
    done = subprocess.run(
        [echo, "json"], input=text, capture_output=True, text=True, timeout=60, check=False
    )
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr.startswith("Invalid JSON at byte ")


@pytest.mark.skipif(shutil.which("cmake") is None, reason="no cmake to build the example with")
def test_cmake_builds_the_example(tmp_path: Path) -> None:
    for arguments in (("-S", EXAMPLE, "-B", tmp_path), ("--build", tmp_path)):
        command: list[str | Path] = ["cmake", *arguments]
        done = subprocess.run(command, capture_output=True, text=True, timeout=180, check=False)
        assert done.returncode == 0, done.stderr
    assert run(tmp_path / "placecell_example").returncode == 2
