"""The operator's page: its files, their headers, and the setting that turns it off."""

import gzip
import re
from pathlib import Path
from typing import Any
from urllib.parse import urljoin

import pytest

from service.api.pages import page, static_files
from tests.service.service_builders import assert_problem

POLICY = {
    "default-src 'self'",
    "img-src 'self' data: blob:",
    "worker-src 'self' blob:",
    "object-src 'none'",
    "base-uri 'none'",
    "form-action 'none'",
    "frame-ancestors 'none'",
}


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A page with files of several kinds, beside a file that does not belong to it."""
    made = tmp_path / "page"
    made.mkdir()
    (made / "index.html").write_text('<link href="page/page.css"><script src="page/page.js">')
    (made / "page.js").write_text("start();\n" * 100)
    (made / "page.css").write_text("body { margin: 0 }")
    (made / "icon.png").write_bytes(bytes(1000))
    (made / "notes.py").write_text("secret = 1")
    (made / "within").mkdir()
    (tmp_path / "secret.js").write_text("secret")
    monkeypatch.setattr(page, "FOLDER", made)
    return made


def test_page_has_a_strict_policy_and_needs_no_key(start: Any, tmp_path: Path) -> None:
    file = tmp_path / "keys.toml"
    file.write_text("[a]\nsha256 = '" + "0" * 64 + "'\n")
    with start(keys_file=file) as service:
        assert service.get("/maps").status_code == 401
        names = [path.name for path in page.FOLDER.iterdir()]
        assert page.INDEX in names
        for path in ("/", *(f"/page/{name}" for name in names)):
            answer = service.get(path)
            assert answer.status_code == 200, path
            assert {*answer.headers["content-security-policy"].split("; ")} == POLICY
            assert answer.headers["x-content-type-options"] == "nosniff"
            assert answer.headers["x-frame-options"] == "DENY"
            assert answer.headers["referrer-policy"] == "no-referrer"
            ending = ".html" if path == "/" else "." + path.rpartition(".")[2]
            kind = answer.headers["content-type"].partition(";")[0]
            assert kind == static_files.MEDIA_TYPES[ending]


@pytest.mark.parametrize("prefix", ["", "/robots/placecell"])
def test_page_uses_relative_addresses_of_its_own_files(start: Any, prefix: str) -> None:
    with start(root_path=prefix) as service:
        text = service.get("/").text
        assert "<style" not in text
        assert not re.search(r"<script(?![^>]*\bsrc=)", text)
        text = text.replace(f'<base href="{prefix}/">', "")
        for name in re.findall(r'(?:src|href)="([^"]*)"', text):
            seen = urljoin(f"https://robots.example{prefix}/", name)
            path = seen.removeprefix(f"https://robots.example{prefix}")
            assert path.startswith("/"), seen
            assert service.get(path).status_code == 200, path


def test_prefix_without_a_slash_leads_to_the_page(start: Any) -> None:
    with start(root_path="/fleet/placecell") as service:
        # A proxy that keeps the prefix.
        answer = service.get("/fleet/placecell", follow_redirects=False)
        assert answer.status_code == 308
        assert answer.headers["location"] == "/fleet/placecell/"
        kept = service.get("/fleet/placecell/")
        # A proxy that strips the prefix asks for the same file with and without the slash.
        stripped = service.get("/")
        assert kept.content == stripped.content
        assert '<base href="/fleet/placecell/">' in kept.text
        assert "base-uri 'self'" in kept.headers["content-security-policy"]
        tag = kept.headers["etag"]
        assert service.get("/", headers={"If-None-Match": tag}).status_code == 304
        assert_problem(service.get("/fleet"), 404, "not-found")
    with start() as service:
        assert "<base" not in service.get("/").text


def test_file_is_sent_as_gzip_only_where_it_is_accepted(service: Any, folder: Path) -> None:
    content = (folder / "page.js").read_bytes()
    for accepted, packed in (
        ("gzip, br", True), ("br, gzip;q=0.5", True), ("gzip; q=0", False), ("identity", False),
        ("br", False),
    ):  # fmt: skip
        with service.stream("GET", "/page/page.js", headers={"Accept-Encoding": accepted}) as got:
            raw = b"".join(got.iter_raw())
        assert (got.headers.get("content-encoding") == "gzip") == packed, accepted
        assert (gzip.decompress(raw) if packed else raw) == content
        assert (len(raw) < len(content)) == packed
        assert got.headers["vary"] == "Accept-Encoding"
    picture = service.get("/page/icon.png", headers={"Accept-Encoding": "gzip"})
    assert "content-encoding" not in picture.headers


def test_known_file_is_not_sent_again(service: Any, folder: Path) -> None:
    tags = set()
    for accepted in ("gzip", "identity"):
        headers = {"Accept-Encoding": accepted}
        first = service.get("/page/page.js", headers=headers)
        tag = first.headers["etag"]
        tags.add(tag)
        known = service.get("/page/page.js", headers=headers | {"If-None-Match": tag})
        assert (known.status_code, known.content) == (304, b"")
        assert known.headers["etag"] == tag
        assert "content-security-policy" in known.headers
        head = service.head("/page/page.js", headers=headers)
        assert (head.status_code, head.content) == (200, b"")
        assert head.headers["etag"] == tag
    assert len(tags) == 2
    (folder / "page.js").write_text("other();\n")
    changed = service.get("/page/page.js", headers={"If-None-Match": ", ".join(tags)})
    assert (changed.status_code, changed.text) == (200, "other();\n")


@pytest.mark.parametrize(
    "name",
    ["notes.py", "missing.js", "within", "..", "..%2Fsecret.js", "%2e%2e%2fsecret.js", ".", "a%00"],
)
def test_only_files_of_the_page_are_served(service: Any, folder: Path, name: str) -> None:
    del folder
    answer = service.get(f"/page/{name}")
    assert answer.status_code in {200, 404}
    assert "secret" not in answer.text.replace("secret.js", "")
    if answer.status_code == 404:
        assert_problem(answer, 404, "not-found")
    else:
        assert answer.text.startswith("<link")  # the test's client resolved the dots


def test_setting_turns_the_page_off(start: Any) -> None:
    with start(page=False) as service:
        for path in ("/", "/page/index.html", "/page/page.js"):
            assert_problem(service.get(path), 404, "not-found", "PLACECELL_PAGE=true")
        assert service.get("/maps").status_code == 200
