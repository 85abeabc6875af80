"""API documentation pages: local files only, and correct statements about API keys."""

import re
from pathlib import Path
from typing import Any
from urllib.parse import urljoin

import pytest

from service.api.pages.static_files import MEDIA_TYPES
from tests.service.service_builders import assert_problem

OPEN = {"/livez", "/readyz", "/metrics", "/key"}
"""Paths that need no key."""


def files_of(html: str) -> list[str]:
    return re.findall(r'(?:src|href|spec-url)="([^"]*)"', html)


@pytest.mark.parametrize("prefix", ["", "/robots/placecell"])
@pytest.mark.parametrize("page", ["/docs", "/redoc"])
def test_A20_pages_load_only_files_of_the_service(start: Any, page: str, prefix: str) -> None:
    with start(root_path=prefix) as service:
        # The proxy forwards the path without the prefix. The browser sees the prefix.
        answer = service.get(page)
        assert answer.status_code == 200
        assert answer.headers["content-type"].startswith("text/html")
        policy = answer.headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "script-src 'self'" in policy
        assert "unsafe-eval" not in policy
        assert "http" not in policy
        assert "<script>" not in answer.text
        names = files_of(answer.text) + ["openapi.json"] + ["docs/start.js"] * (page == "/docs")
        assert len(names) >= 4
        for name in names:
            assert "//" not in name
            seen = urljoin(f"https://robots.example{prefix}{page}", name)
            path = seen.removeprefix(f"https://robots.example{prefix}")
            assert path.startswith("/"), seen
            got = service.get(path)
            assert got.status_code == 200, path
            assert got.content
            ending = "." + path.rpartition(".")[2]
            assert got.headers["content-type"].partition(";")[0] == MEDIA_TYPES[ending]
        document = service.get("/openapi.json").json()
        if prefix:
            assert document["servers"] == [{"url": prefix}]


def test_A20_scripts_request_no_other_host(service: Any) -> None:
    start = service.get("/docs/start.js").text
    assert "validatorUrl: null" in start
    assert "http" not in start
    assert_problem(service.get("/docs/core.py"), 404, "not-found")
    assert_problem(service.get("/docs/..%2Fcore.py"), 404, "not-found")


@pytest.mark.slow
def test_A20_description_marks_routes_that_need_a_key(start: Any, tmp_path: Path) -> None:
    file = tmp_path / "keys.toml"
    file.write_text("[a]\nsha256 = '" + "0" * 64 + "'\n")
    with start(keys_file=file) as service:
        document = service.get("/openapi.json").json()
        (scheme,) = document["components"]["securitySchemes"].items()
        assert scheme[0] == "HTTPBearer"
        assert scheme[1] | {"type": "http", "scheme": "bearer"} == scheme[1]
        told = 0
        for path, operations in document["paths"].items():
            for method, operation in operations.items():
                needs = operation.get("security") == [{"HTTPBearer": []}]
                assert needs != (path in OPEN), path
                filled = re.sub(r"\{(map|other|robot|anchor)\}", "yard", path)
                filled = filled.replace("{version}", "1")
                status = service.request(method, filled).status_code
                assert (status == 401) == needs, (method, path, status)
                told += 1
        assert told > 15
        for path in ("/docs", "/redoc", "/openapi.json", "/docs/start.js"):
            assert service.get(path).status_code == 200


def test_A20_setting_turns_the_description_off(start: Any) -> None:
    with start(docs=False) as service:
        for path in ("/docs", "/redoc", "/openapi.json", "/docs/start.js", "/docs/favicon.png"):
            answer = service.get(path)
            assert_problem(answer, 404, "not-found")
            assert "GET /docs" not in answer.json()["detail"]
        assert service.get("/info").status_code == 200
