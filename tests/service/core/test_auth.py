"""API keys: scopes, changes of the key file, and no secrets in logs and answers."""

import hashlib
import hmac
import logging
import os
import time
from pathlib import Path
from typing import Any

import pytest
from placecell_client import encode
from typer.testing import CliRunner

from cli import app
from placecell.descriptors.manifest import Manifest
from service.api.middleware.refusal_log import RefusalLog, address_of
from service.api.state import open_state
from service.core import auth as keys_module
from service.core.auth import new_key, read_keys
from service.core.settings import Settings
from service.engine import StartError
from tests.service.service_builders import assert_problem, cloud, map_of, random_codes, request_of


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "keys.toml"


def made(file: Path, name: str, *options: str) -> dict[str, str]:
    """Create a key with the command; return the headers with the key."""
    done = CliRunner().invoke(app, ["keys", name, "--file", str(file), *options])
    assert done.exit_code == 0, done.output
    return {"Authorization": "Bearer " + done.output.splitlines()[0]}


def test_request_without_known_key_answers_401(start: Any, file: Path) -> None:
    key = made(file, "ann")
    with start(keys_file=file) as service:
        for path in ("/info", "/maps", "/maps/yard"):
            assert_problem(service.get(path), 401, "unauthorized", "Bearer")
            wrong = {"Authorization": key["Authorization"] + "x"}
            assert_problem(service.get(path, headers=wrong), 401, "unauthorized")
        answer = service.post("/describe", json=request_of([cloud(0)]))
        assert_problem(answer, 401, "unauthorized")
        assert answer.headers["www-authenticate"] == "Bearer"
        basic = {"Authorization": key["Authorization"].replace("Bearer", "Basic")}
        assert_problem(service.get("/info", headers=basic), 401, "unauthorized")
        for path in ("/livez", "/readyz", "/metrics"):
            assert service.get(path).status_code == 200
        assert service.get("/info", headers=key).status_code == 200
        good = service.post("/describe", json=request_of([cloud(0)]), headers=key)
        assert good.status_code == 200


def test_read_only_key_cannot_write(start: Any, file: Path, manifest: Manifest) -> None:
    reads, writes = made(file, "reader"), made(file, "writer", "--write")
    data = encode(map_of(random_codes(3), manifest.model_id))
    with start(keys_file=file) as service:
        assert_problem(
            service.put("/maps/yard", content=data, headers=reads), 403, "forbidden", "may read"
        )
        assert service.put("/maps/yard", content=data, headers=writes).status_code == 201
        assert_problem(service.delete("/maps/yard", headers=reads), 403, "forbidden")
        assert service.get("/maps/yard", headers=reads).content == data
        for headers in (reads, writes):
            assert_problem(service.post("/models/reload", headers=headers), 403, "forbidden")


def test_key_has_no_access_to_other_maps(start: Any, file: Path, manifest: Manifest) -> None:
    everything = made(file, "all", "--write")
    halls = made(file, "halls", "--write", "--map", "hall-*", "--map", "yard")
    data = encode(map_of(random_codes(3), manifest.model_id))
    query = {"model_id": manifest.model_id, "codes": random_codes(1).tolist()}
    with start(keys_file=file) as service:
        for name in ("hall-1", "secret", "yard"):
            assert service.put(f"/maps/{name}", content=data, headers=everything).is_success
        listed = service.get("/maps", headers=halls).json()["maps"]
        assert [each["name"] for each in listed] == ["hall-1", "yard"]
        for response in (
            service.get("/maps/secret", headers=halls),
            service.put("/maps/secret", content=data, headers=halls),
            service.delete("/maps/secret", headers=halls),
            service.post("/match", json=query | {"maps": ["secret"]}, headers=halls),
            # The answer does not reveal which maps exist.
            service.get("/maps/unknown", headers=halls),
        ):
            assert_problem(response, 403, "forbidden")
        found = service.post("/match", json=query, headers=halls).json()
        assert found["searched"] == ["hall-1", "yard"]
        assert found["skipped"] == []


def test_key_of_a_robot_uploads_only_its_segments(
    start: Any, file: Path, manifest: Manifest
) -> None:
    key = made(file, "ann", "--write", "--robot", "ann")
    with start(keys_file=file) as service:
        own = encode(map_of(random_codes(3), manifest.model_id, robot="ann"))
        other = encode(map_of(random_codes(3), manifest.model_id, robot="bob"))
        assert service.put("/maps/a", content=own, headers=key).status_code == 201
        refused = service.put("/maps/b", content=other, headers=key)
        assert_problem(refused, 403, "forbidden", "only segments of the robot 'ann'")
        assert service.get("/maps/b", headers=key).status_code == 404
        # The key cannot replace or remove segments of another robot.
        anyone = made(file, "all", "--write")
        assert service.put("/maps/bobs", content=other, headers=anyone).status_code == 201
        empty = encode(map_of(random_codes(0), manifest.model_id, robot="ann"))
        for data in (own, empty):
            refused = service.put("/maps/bobs", content=data, headers=key)
            assert_problem(refused, 403, "forbidden")
        assert_problem(service.delete("/maps/bobs", headers=key), 403, "forbidden")
        assert service.get("/maps/bobs", headers=anyone).content == other
        assert service.delete("/maps/a", headers=key).status_code == 204


def test_keys_are_added_and_revoked_without_a_restart(start: Any, file: Path) -> None:
    first = made(file, "first")
    with start(keys_file=file) as service:
        second = made(file, "second")
        assert service.get("/info", headers=second).status_code == 200
        file.write_text(file.read_text().split("\n\n")[1])
        os.utime(file, ns=(time.time_ns() + 10**9, time.time_ns() + 10**9))
        assert_problem(service.get("/info", headers=first), 401, "unauthorized")
        # A file that is broken while it is edited changes nothing.
        file.write_text("[second")
        os.utime(file, ns=(time.time_ns() + 2 * 10**9, time.time_ns() + 2 * 10**9))
        assert service.get("/info", headers=second).status_code == 200


def test_key_file_holds_hashes_and_is_private(file: Path) -> None:
    secret = made(file, "ann")["Authorization"].split()[1]
    assert secret not in file.read_text()
    assert hashlib.sha256(secret.encode()).hexdigest() in file.read_text()
    assert file.stat().st_mode & 0o777 == 0o600
    assert read_keys(file)[0].name == "ann"
    again = CliRunner().invoke(app, ["keys", "ann", "--file", str(file)])
    assert again.exit_code == 1
    assert "already" in again.output


def test_every_hash_is_compared_in_constant_time(
    start: Any, file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    headers = [made(file, f"robot-{n}") for n in range(5)]
    compared: list[tuple[str, str]] = []

    def watched(a: str, b: str) -> bool:
        compared.append((a, b))
        return hmac.compare_digest(a, b)

    class Watched:
        compare_digest = staticmethod(watched)

    monkeypatch.setattr(keys_module, "hmac", Watched)
    with start(keys_file=file) as service:
        for sent in (headers[0], headers[4], {"Authorization": "Bearer no"}, {}):
            compared.clear()
            service.get("/info", headers=sent)
            assert len(compared) == 5


def test_log_and_answers_contain_no_secret(
    start: Any, file: Path, manifest: Manifest, caplog: pytest.LogCaptureFixture
) -> None:
    key = made(file, "ann", "--write")
    secret = key["Authorization"].split()[1]
    caplog.set_level(logging.DEBUG)
    data = encode(map_of(random_codes(3), manifest.model_id))
    with start(keys_file=file) as service:
        answers = [
            service.put("/maps/yard", content=data, headers=key),
            service.put("/maps/yard", content=b"rubbish", headers=key),
            service.get("/info", headers={"Authorization": f"Basic {secret}"}),
            service.get("/info", headers={"Authorization": secret}),
        ]
    assert all(secret not in answer.text for answer in answers)
    assert secret not in caplog.text
    # Each write is logged with its key, its map and the number of segments.
    (line,) = [one for one in caplog.records if one.name == "placecell.audit"]
    assert line.getMessage() == "ann put map yard, 3 segments changed, 0 removed"
    assert vars(line)["request_id"] == answers[0].headers["x-request-id"]


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("[", "TOML"),
        ("[a]\nsha256 = 'short'", "a.sha256"),
        ("[a]\nsha256 = '" + "0" * 64 + "'\nrights = 'all'", "a.rights"),
        (None, "cannot be read"),
    ],
)
def test_invalid_key_file_prevents_the_start(
    models_dir: Path, data_dir: Path, file: Path, content: str | None, words: str
) -> None:
    if content is not None:
        file.write_text(content)
    settings = Settings(models_dir=models_dir, data_dir=data_dir, model="tiny", keys_file=file)
    with pytest.raises(StartError, match=words), open_state(settings):
        pass


def test_new_keys_are_long_and_distinct() -> None:
    made_keys = {new_key()[0] for _ in range(100)}
    assert len(made_keys) == 100
    assert min(map(len, made_keys)) > 40


@pytest.mark.parametrize("name", ["robot 😀", 'a "quoted" one', "with.dots", "back\\slash"])
def test_any_key_name_gives_a_readable_file(file: Path, name: str) -> None:
    file.write_text("# ours\n")
    file.chmod(0o640)
    made(file, name)
    made(file, "another")
    assert [principal.name for principal in read_keys(file)] == [name, "another"]
    assert file.read_text().startswith("# ours\n")
    assert file.stat().st_mode & 0o777 == 0o640
    assert [path.name for path in file.parent.iterdir()] == ["keys.toml"]


def test_invalid_key_name_changes_nothing(file: Path) -> None:
    made(file, "ann")
    before = file.read_text()
    done = CliRunner().invoke(app, ["keys", "a\x7fb", "--file", str(file)])
    assert done.exit_code == 1
    assert file.read_text() == before


def test_changed_scope_of_a_key_is_noticed(start: Any, file: Path) -> None:
    key = made(file, "owner", "--admin")
    with start(keys_file=file) as service:
        assert service.post("/models/reload", headers=key).status_code == 200
        times = file.stat()
        file.write_text(file.read_text().replace("admin = true", "admin = false"))
        os.utime(file, ns=(times.st_atime_ns, times.st_mtime_ns))
        assert_problem(service.post("/models/reload", headers=key), 403, "forbidden")


def good(service: Any) -> float:
    """Return the metric of the key file."""
    (line,) = [
        line for line in service.get("/metrics").text.splitlines()
        if line.startswith("placecell_keys_file_good")
    ]  # fmt: skip
    return float(line.split()[1])


@pytest.fixture
def seconds(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Replace the clock of the keys by one that changes only when it is set."""
    now = [100.0]
    made = keys_module.Keys.__init__
    monkeypatch.setattr(
        keys_module.Keys, "__init__", lambda self, file: made(self, file, lambda: now[0])
    )
    return now


def changed(file: Path, content: str | bytes | None) -> None:
    """Write or remove the file; its modification time always changes."""
    if content is None:
        file.unlink()
        return
    file.write_bytes(content.encode() if isinstance(content, str) else content)
    later = time.time_ns() + len(content) * 10**9
    os.utime(file, ns=(later, later))


@pytest.mark.parametrize(
    ("withdraw", "rest_works"),
    [
        (lambda text: text.split("\n\n")[1] + "\n[third\n", True),  # a syntax error elsewhere
        (lambda text: text.split("\n\n")[1] + "\nrights = 'all'\n", True),  # an unknown field
        (lambda text: text.split("\n\n")[1].encode() + b"# \xff\n", True),
        (lambda text: "# " + text.replace("\nsha256", "\n#sha256", 1) + "[x\n", True),
        (lambda text: "[half", False),
        (lambda _: "\0", False),
        (lambda _: None, False),  # deleted
    ],
)
def test_A12_revoked_key_stops_working_despite_an_invalid_file(
    start: Any, file: Path, seconds: list[float], withdraw: Any, rest_works: bool,
    caplog: pytest.LogCaptureFixture,
) -> None:  # fmt: skip
    first, second = made(file, "first"), made(file, "second")
    before = file.read_text()
    with start(keys_file=file) as service:
        assert service.get("/readyz").json() == {"status": "ready"}
        assert good(service) == 1
        changed(file, withdraw(before))
        # /readyz reports the error before any key is used, and robots continue to work.
        told = service.get("/readyz")
        assert told.status_code == 200
        assert "key file" in told.json()["warnings"][0]
        assert str(file) not in told.text
        assert good(service) == 0
        assert any(one.levelname == "ERROR" and str(file) in one.message for one in caplog.records)
        for headers in (first, second):
            assert service.get("/info", headers=headers).status_code == 200
        seconds[0] += 61
        assert_problem(service.get("/info", headers=first), 401, "unauthorized")
        expected = 200 if rest_works else 401
        assert service.get("/info", headers=second).status_code == expected
        if rest_works:
            assert service.get("/readyz").json()["warnings"]
        else:
            assert_problem(service.get("/readyz"), 503, "not-ready", "No key works")
        changed(file, before)
        assert service.get("/readyz").json() == {"status": "ready"}
        assert good(service) == 1
        for headers in (first, second):
            assert service.get("/info", headers=headers).status_code == 200


@pytest.mark.slow
@pytest.mark.parametrize(
    ("method", "path", "status"),
    [("GET", "/maps", 401), ("GET", "/maps/hall", 403), ("DELETE", "/maps/yard", 403)],
)
def test_A21_refused_request_logs_a_warning_with_the_address(
    start: Any, file: Path, method: str, path: str, status: int, caplog: pytest.LogCaptureFixture
) -> None:
    reads = made(file, "reader", "--map", "yard")
    with start(keys_file=file) as service:
        headers = {} if status == 401 else reads
        response = service.request(method, path, headers=headers)
        assert response.status_code == status
        (line,) = [one for one in caplog.records if one.name == "placecell.refusals"]
        assert line.levelno == logging.WARNING
        assert f"{status} " in line.message
        assert "from 'testclient'" in line.message
        assert ("key unknown" if status == 401 else "key reader") in line.message
        assert vars(line)["client"] == "'testclient'"
        assert vars(line)["request_id"] == response.headers["x-request-id"]
        service.get("/info", headers=reads)
        assert len([one for one in caplog.records if one.name == "placecell.refusals"]) == 1


def test_A21_request_log_has_the_client_address(
    service: Any, caplog: pytest.LogCaptureFixture
) -> None:
    caplog.set_level(logging.INFO, "placecell.requests")
    service.get("/info")
    (line,) = [one for one in caplog.records if one.name == "placecell.requests"]
    assert vars(line)["client"] == "'testclient'"
    assert address_of({"client": ("10.0.0.5", 4711)}) == "10.0.0.5"
    assert address_of({"client": ("::1", 4711)}) == "::1"
    assert "\n" not in address_of({"client": ("x\nERROR forged " + "y" * 999, 1)})
    assert len(address_of({"client": ("y" * 999, 1)})) < 60
    assert address_of({"client": None}) == "a local socket"


def test_A21_refusals_cannot_flood_the_log(caplog: pytest.LogCaptureFixture) -> None:
    now = [0.0]
    log = RefusalLog(lambda: now[0])
    for number in range(5_000):
        log.add(401, "GET", "/maps", "10.0.0.5", None, "id")
        log.add(429, "GET", "/maps", f"10.1.{number // 250}.{number % 250}", "ann", "id")
    assert len(caplog.records) == 100
    assert sum("10.0.0.5" in one.message for one in caplog.records) == 10
    now[0] += 61
    log.add(403, "GET", "/maps", "10.0.0.5", "ann", "id")
    assert "9900 further requests" in caplog.records[-2].message
    assert "403 Forbidden: GET /maps from 10.0.0.5, key ann" in caplog.records[-1].message
    assert len(log._lines) == 1
