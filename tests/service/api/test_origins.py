"""Web pages that a user opens cannot access a service without keys."""

import asyncio
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode

from placecell.descriptors.manifest import Manifest
from service.api.middleware.origin_guard import OriginGuard
from service.core.settings import Settings
from tests.service.service_builders import assert_problem, map_of, random_codes

PATHS = [
    ("GET", "/maps"),
    ("GET", "/maps/yard"),
    ("GET", "/info"),
    ("GET", "/metrics"),
    ("GET", "/livez"),
    ("GET", "/openapi.json"),
    ("GET", "/docs"),
    ("GET", "/no/such/path"),
    ("DELETE", "/maps/yard"),
    ("POST", "/maps/yard/age?unseen_since=9e9"),
    ("POST", "/maps/yard/compact"),
    ("POST", "/maps/yard/ids?count=9"),
    ("POST", "/maps/yard/versions/1/restore"),
    ("POST", "/models/reload"),
    ("OPTIONS", "/maps/yard"),
]
"""Reads, and the writes that need no body."""

FOREIGN = [
    {"Host": "evil.example"},
    {"Host": "evil.example:8000"},
    {"Host": "localhost.evil.example"},
    {"Host": "127.0.0.1.evil.example"},
    {"Host": "evil.example#localhost"},
    {"Host": "localhost@evil.example"},
    {"Host": ""},
    {"Host": "192.168.1.7"},
    {"Host": "another"},
    {"Host": "[::1"},
    {"Origin": "http://evil.example"},
    {"Origin": "null"},
    {"Origin": "http://localhost:3000"},
    {"Origin": "http://testserver.evil.example"},
    {"Origin": "file://"},
    {"Sec-Fetch-Site": "cross-site"},
    {"Sec-Fetch-Site": "same-site"},
]
OWN: list[dict[str, str]] = [
    {},
    {"Host": "localhost"},
    {"Host": "LOCALHOST:8000"},
    {"Host": "127.0.0.1:8000"},
    {"Host": "127.1.2.3"},
    {"Host": "[::1]:8000"},
    {"Host": "localhost."},
    {"Host": "robots.localhost:8000"},
    {"Origin": "http://testserver"},
    {"Origin": "http://testserver:80"},
    {"Host": "localhost:8000", "Origin": "http://localhost:8000"},
    {"Host": "[::1]:8000", "Origin": "http://[::1]:8000"},
    {"Sec-Fetch-Site": "same-origin"},
    {"Sec-Fetch-Site": "none"},
]


def status_at(
    settings: Settings, server: tuple[str, int | None] | None, headers: list[tuple[str, str]]
) -> int:
    """Return the status of a request to this address."""
    sent: list[Any] = []

    async def app(scope: Any, receive: Any, send: Any) -> None:
        await send({"type": "http.response.start", "status": 200, "headers": []})

    async def send(message: Any) -> None:
        sent.append(message)

    class App:
        class state:  # noqa: N801
            class placecell:  # noqa: N801
                class metrics:  # noqa: N801
                    class rejected:  # noqa: N801
                        @staticmethod
                        def labels(_: str) -> Any:
                            return type("Counter", (), {"inc": lambda _: None})()

    scope = {
        "type": "http",
        "method": "GET",
        "path": "/maps",
        "server": server,
        "headers": [(name.encode(), value.encode()) for name, value in headers],
        "app": App,
    }
    asyncio.run(OriginGuard(app, settings)(scope, None, send))  # type: ignore[arg-type]
    return int(sent[0]["status"])


@pytest.mark.parametrize("headers", FOREIGN, ids=str)
def test_A9_foreign_hosts_and_origins_are_refused(
    service: Any, manifest: Manifest, headers: dict[str, str]
) -> None:
    data = encode(map_of(random_codes(3), manifest.model_id))
    assert service.put("/maps/yard", content=data).status_code == 201
    before = service.get("/maps").json()
    for method, path in PATHS:
        response = service.request(method, path, headers=headers)
        kind = "foreign-host" if "Host" in headers else "foreign-origin"
        assert_problem(response, 403, kind)
        assert "access-control-allow-origin" not in response.headers
    assert service.put("/maps/new", content=data, headers=headers).status_code == 403
    assert service.get("/maps").json() == before


@pytest.mark.parametrize("headers", OWN, ids=str)
def test_A9_own_names_are_accepted(service: Any, headers: dict[str, str]) -> None:
    assert service.get("/maps", headers=headers).status_code == 200
    assert service.post("/models/reload", headers=headers).status_code == 200


def test_A9_service_with_keys_accepts_any_host(start: Any, tmp_path: Path) -> None:
    file = tmp_path / "keys.toml"
    file.write_text("[a]\nsha256 = '" + "0" * 64 + "'\n")
    with start(keys_file=file) as service:
        for headers in FOREIGN[:2] + FOREIGN[-4:]:
            assert service.get("/livez", headers=headers).status_code == 200
            assert service.get("/maps", headers=headers).status_code == 401


def test_A9_setting_allows_further_hosts(start: Any) -> None:
    with start(allowed_hosts=["robots.example", "*.fleet.example"]) as service:
        for host, status in {
            "robots.example:8000": 200,
            "Robots.Example.": 200,
            "a.fleet.example": 200,
            "fleet.example": 403,
            "evilfleet.example": 403,
            "a.robots.example": 403,
        }.items():
            assert service.get("/maps", headers={"Host": host}).status_code == status, host
        own = {"Host": "robots.example", "Origin": "https://robots.example"}
        assert service.get("/maps", headers=own).status_code == 200


def test_A9_pages_of_allowed_origins_are_answered(start: Any) -> None:
    page, cross = "https://page.example", {"Sec-Fetch-Site": "cross-site"}
    with start(cors_origins=[page]) as service:
        answer = service.get("/maps", headers={"Origin": page} | cross)
        assert answer.status_code == 200
        assert answer.headers["access-control-allow-origin"] == page
        asks = {"Origin": page, "Access-Control-Request-Method": "DELETE"}
        assert service.options("/maps/yard", headers=asks | cross).status_code == 200
        for other in ({"Origin": "https://evil.example"} | cross, cross, {"Host": "page.example"}):
            assert service.get("/maps", headers=other).status_code == 403
    with start(cors_origins=["*"]) as service:
        anyone = {"Origin": "https://any.example"} | cross
        assert service.get("/maps", headers=anyone).status_code == 200
        assert service.get("/maps", headers=anyone | {"Host": "any.example"}).status_code == 403


@pytest.mark.parametrize(
    ("server", "host", "status"),
    [
        (("127.0.0.1", 8000), "localhost", 200),
        (("127.0.0.1", 8000), "testserver", 403),
        (("127.0.0.1", 8000), "10.0.0.5", 403),
        (("::1", 8000), "[::1]", 200),
        (("::ffff:127.0.0.1", 8000), "127.0.0.1", 200),
        (("::ffff:127.0.0.1", 8000), "10.0.0.5", 403),
        # --allow-remote: the operator allowed other machines, by address or by configured name.
        (("10.0.0.5", 8000), "10.0.0.5:8000", 200),
        (("10.0.0.5", 8000), "robots-pc", 200),
        (("10.0.0.5", 8000), "evil.example", 403),
        (("fd00::5", 8000), "[fd00::5]:8000", 200),
        # A Unix socket.
        (("/run/placecell.sock", None), "localhost", 200),
        (("/run/placecell.sock", None), "/run/placecell.sock", 403),
        (("/run/placecell.sock", None), "evil.example", 403),
        (None, "localhost", 200),
        (None, "evil.example", 403),
        # In this process, without a socket.
        (("test", 80), "test", 200),
        (("testserver", 80), "test", 403),
        (("evil.example", 80), "evil.example", 403),
    ],
)
def test_A9_allowed_hosts_depend_on_the_address_reached(
    server: tuple[str, int | None] | None, host: str, status: int
) -> None:
    settings = Settings(host="robots-pc")
    assert status_at(settings, server, [("host", host)]) == status


def test_A9_repeated_host_is_refused_and_missing_host_accepted() -> None:
    server = ("127.0.0.1", 8000)
    twice = [("host", "localhost"), ("host", "evil.example")]
    assert status_at(Settings(), server, twice) == 403
    assert status_at(Settings(), server, []) == 200
    assert status_at(Settings(), server, [("origin", "http://evil.example")]) == 403
