"""Attacks on the isolation of keys, and on deployment: A9, A12, A19, A20, A21, A25, A26."""

import os
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from urllib.parse import urljoin

import msgpack  # type: ignore[import-untyped]
import numpy as np
from placecell_client import Delta, encode
from placecell_client.maps.edit import take, with_optional

from benchmarks.attack.stage import NONE, AttackCase, Stage, delta_of, template_of, with_columns
from benchmarks.attack.target import HALL, OWNER, READER, RIGHTS, ROBOT, VICTIM, Target
from benchmarks.attack.wire import (
    ATTACKER,
    JSON,
    MAP,
    MSGPACK,
    AttackRequest,
    AttackResponse,
    edit_request,
    exchange_bytes,
)
from benchmarks.synthetic_maps.random_maps import MapTemplate
from placecell.core.types import UInt32

ROOT = Path(__file__).resolve().parents[2]
"""Root folder of the checkout."""

SECRET = "secret-lab"
"""Name of a map that the key of `hall-*` must not learn."""


def foreign_pages(stage: Stage) -> None:
    """A9: a foreign site's page and a rebound name, against a service without keys."""
    with stage.service(with_keys=False) as target:
        template = template_of(target)
        here = target.address.removeprefix("http://")
        port = here.rpartition(":")[2]
        evil = {"Host": here, "Origin": "http://evil.example"}
        pages = {
            "foreign origin": evil,
            "null origin": {"Host": here, "Origin": "null"},
            "cross-site fetch": {"Host": here, "Sec-Fetch-Site": "cross-site"},
            "same-site fetch": {"Host": here, "Sec-Fetch-Site": "same-site"},
            "origin that begins alike": {"Host": here, "Origin": "http://127.0.0.1.evil.example"},
            "origin of another port": {"Host": here, "Origin": "http://127.0.0.1:1"},
            "rebound name": {
                "Host": f"evil.example:{port}",
                "Origin": f"http://evil.example:{port}",
            },
            "rebound name, no origin": {"Host": f"evil.example:{port}"},
            "name that begins alike": {"Host": f"localhost.evil.example:{port}"},
            "address that begins alike": {"Host": f"127.0.0.1.evil.example:{port}"},
            "loopback as user": {"Host": f"127.0.0.1@evil.example:{port}"},
        }
        writes = [
            ("DELETE", "/maps/precious"),
            ("POST", "/maps/precious/age?unseen_since=4000000000"),
            ("POST", "/maps/precious/compact"),
            ("POST", "/maps/precious/versions/1/restore"),
            ("POST", "/maps/precious/ids?count=1000000"),
            ("POST", "/models/reload"),
        ]
        for name, headers in pages.items():
            _put_precious(stage, target, template)
            rebound = "Host" in headers and headers["Host"] != here
            reads = [("GET", "/maps"), ("GET", "/maps/precious")] if rebound else []
            for method, path in (*reads, *writes):
                status = _status(target, method, path, headers)
                stage.found.statuses[str(status)] += 1
                stage.expect(
                    400 <= status < 500 and status != 404,
                    f"{name}: {method} {path} was answered {status}.",
                )
        good = {
            "address": {"Host": here},
            "name": {"Host": f"localhost:{port}"},
            "IPv6": {"Host": f"[::1]:{port}"},
            "own page": {
                "Host": here, "Origin": target.address, "Sec-Fetch-Site": "same-origin"
            },
            "typed by a user": {"Host": here, "Sec-Fetch-Site": "none"},
        }  # fmt: skip
        _put_precious(stage, target, template)
        for name, headers in good.items():
            for method, path in (("GET", "/maps"), ("POST", "/maps/precious/ids?count=1")):
                status = _status(target, method, path, headers)
                stage.expect(status == 200, f"{name}: {method} {path} was answered {status}.")


def broken_key_file(stage: Stage) -> None:
    """A12: a key is withdrawn from a file that has a typo or is deleted."""
    with stage.service() as target:
        assert target.keys_file is not None
        whole = target.keys_file.read_text()
        withdrawn = re.sub(rf"\[{ROBOT}\].*?(?=\n\n)", "", whole, flags=re.DOTALL)
        before = _key_metrics(stage, target)
        files = {
            "a typo": withdrawn + "\n[broken\n",
            "an unknown field": withdrawn + f'\n[new]\nsha256 = "{"0" * 64}"\nwrites = true\n',
            "no content": "",
            "no file": None,
        }
        for name, content in files.items():
            if content is None:
                target.keys_file.unlink()
            else:
                target.keys_file.write_text(content)
            time.sleep(0.05)
            used = stage.ask(target, AttackRequest("GET", "/maps", key=ROBOT))
            ready = stage.ask(target, AttackRequest("GET", "/readyz"))
            broken = _key_metrics(stage, target)
            stage.note(f"{name}: the withdrawn key", used.status)
            if name == "no content":  # a valid file without keys
                stage.expect(used.status == 401, f"{name}: a withdrawn key is {used.status}.")
                continue
            # The service stays ready as long as a key works, but must report the bad file.
            stage.expect(
                ready.status == 503 or "key" in ready.text.lower(),
                f"{name}: /readyz is {ready.status} and does not report the key file.",
            )
            stage.expect(
                broken != before and bool(broken), f"{name}: no metric reports the key file."
            )
        target.keys_file.write_text(withdrawn)
        time.sleep(0.05)
        used = stage.ask(target, AttackRequest("GET", "/maps", key=ROBOT))
        stage.expect(used.status == 401, f"A withdrawn key is answered {used.status}.")
        ready = stage.ask(target, AttackRequest("GET", "/readyz"))
        stage.expect(ready.status == 200, f"With a good file again /readyz is {ready.status}.")


def foreign_names(stage: Stage) -> None:
    """A19: names of other maps and keys that a key of `hall-*` sees."""
    with stage.service({"PLACECELL_LIMITS__ROBOT_SEGMENTS": "50"}) as target:
        template = template_of(target)
        client = target.client(OWNER)
        owned = template.random_map("shared-robot", _ids(1, 37), stage.random)
        client.put_map(SECRET, owned)
        merged = with_columns(
            with_optional(template.random_map("hall-robot", _ids(1, 4), stage.random), ()),
            source=np.array([0, 1, 1, 2], np.uint16),
            source_ids=np.array([1, 7, 8, 3], np.uint32),
            sources=(SECRET, "hall-b"),
        )
        client.put_map("hall-a", merged)
        client.edit_map(
            "hall-a", Delta(template.random_map("hall-robot", _ids(9, 1), stage.random), NONE)
        )
        codes = merged.codes[:2].tobytes()
        match = {"model_id": template.model_id, "codes": codes, "k": 5}
        packed = {"Content-Type": MSGPACK}
        requests = [
            AttackRequest("GET", "/maps", key=HALL),
            AttackRequest("GET", "/maps/hall-a/versions", key=HALL),
            AttackRequest("GET", "/maps/hall-a", key=HALL),
            AttackRequest("GET", "/maps/hall-a/changes?since=0", key=HALL),
            AttackRequest("POST", "/match", msgpack.packb(match), HALL, packed),
            AttackRequest("GET", "/info", key=HALL),
            AttackRequest("GET", f"/maps/{SECRET}", key=HALL),
            AttackRequest("GET", "/maps/no-such-map", key=HALL),
            AttackRequest(
                "POST",
                "/maps/hall-new/merge",
                f'{{"maps": ["hall-a", "{SECRET}"]}}'.encode(),
                HALL,
                {"Content-Type": JSON},
            ),
        ]
        answers = [stage.ask(target, request) for request in requests]
        forbidden, missing = answers[6], answers[7]
        stage.expect(
            forbidden.status == missing.status,
            f"A map that exists is answered {forbidden.status}, one that does not "
            f"{missing.status}.",
        )
        for request, answer in zip(requests, answers, strict=True):
            text = answer.text
            is_named = SECRET in request.path or SECRET.encode() in request.body
            if not is_named and request.path != "/maps/hall-a" and "changes" not in request.path:
                stage.expect(SECRET not in text, f"{request.path} reveals the name {SECRET!r}.")
            elif not is_named:
                stage.note(f"{request.path} reveals the name", SECRET in text)
            if request.path.endswith("versions"):
                others = [name for name in RIGHTS if name != HALL and f'"{name}"' in text]
                stage.expect(not others, f"{request.path} reveals names of keys: {others}.")
        delta = delta_of(template.random_map("shared-robot", _ids(100, 30), stage.random))
        over = stage.ask(target, edit_request("hall-c", delta, HALL, "create=true"))
        stage.expect(over.status == 507, f"Beyond a quota an edit was answered {over.status}.")
        text = re.sub(r'"request_id": *"[^"]*"', "", over.text)
        stage.expect(
            not re.search(r"\b(37|67)\b", text),
            "A quota's message reveals how many segments a robot has in other maps.",
        )


def docs_pages(stage: Stage) -> None:
    """A20: the page, the documentation pages, and the key requirements in the OpenAPI."""
    with stage.service(own=False) as target:
        for path in ("/", "/docs", "/redoc"):
            page = stage.ask(target, AttackRequest("GET", path))
            if page.status in {401, 404}:
                continue
            links = re.findall(r"""(?:src|href)\s*=\s*["']([^"']+)["']""", page.text)
            foreign = [link for link in links if re.match(r"(https?:)?//", link)]
            stage.expect(not foreign, f"{path} loads {', '.join(foreign)}.")
            for link in links:
                if link not in foreign and not link.startswith(("data:", "#")):
                    part = stage.ask(target, AttackRequest("GET", urljoin(path, link)))
                    stage.expect(part.status == 200, f"{path} needs {link}: {part.status}.")
                    beyond = re.findall(r"@import\s+url\(\s*https?:[^)]*\)", part.text)
                    stage.expect(not beyond, f"{link} loads {beyond[:1]}.")
        openapi = stage.ask(target, AttackRequest("GET", "/openapi.json"))
        if openapi.status == 401:
            openapi = stage.ask(target, AttackRequest("GET", "/openapi.json", key=READER))
        schemes = openapi.json().get("components", {}).get("securitySchemes", {})
        stage.expect(
            any(
                each.get("type") == "http" and each.get("scheme") == "bearer"
                for each in schemes.values()
            ),
            "The OpenAPI has no security scheme for keys.",
        )
        paths = openapi.json()["paths"]
        secured = bool(openapi.json().get("security")) or "security" in paths["/maps"]["get"]
        stage.expect(secured, "The OpenAPI does not say that /maps needs a key.")


def unknown_keys(stage: Stage) -> None:
    """A21: requests without a key and with wrong keys."""
    with stage.service(own=False) as target:
        headers = {
            "no key": {},
            "wrong key": {"Authorization": "Bearer placecell_wrong"},
            "no bearer": {"Authorization": "Basic YTpi"},
            "forged line": {"Authorization": "Bearer x", "X-Request-Id": "a b"},
        }
        for name, each in headers.items():
            before = len(target.service.log())
            answer = stage.ask(target, AttackRequest("GET", "/maps", headers=each))
            stage.expect(answer.status == 401, f"{name}: it was answered {answer.status}.")
            time.sleep(0.1)
            log = target.service.log()[before:]
            stage.expect(ATTACKER in log, f"{name}: the log lacks the client's address.")
            stage.expect("placecell_wrong" not in log, f"{name}: the log reveals the key.")
        before = len(target.service.log())
        stage.ask_all(
            target, [AttackRequest("GET", "/maps") for _ in range(stage.size(20_000, 2_000))], 8
        )
        stage.note("log bytes of a flood", len(target.service.log()) - before)


def many_sessions(stage: Stage) -> None:
    """A25: one key opens so many sessions that another key's session might be dropped."""
    with stage.service({"PLACECELL_LIMITS__SESSIONS": "40"}) as target:
        template = template_of(target)
        codes = stage.random.integers(-127, 128, (60, template.code_bytes)).astype(np.int8)
        places = stage.random.uniform(-40, 40, (60, 3)) * [1, 1, 0.05]
        made = with_columns(
            template.random_map("mapper", _ids(1, 60), stage.random),
            codes=codes,
            centroids=places,
            frame_positions=np.zeros((2, 3)),
        )
        # The map has two similar places: part of the scan is ambiguous without the session.
        shifted = with_columns(made, centroids=places + [150, 0, 0], ids=_ids(101, 60))
        shifted = with_columns(shifted, frame_positions=np.full((2, 3), [150.0, 0, 0]))
        target.client(OWNER).edit_map("hall", Delta(made, NONE), create=True)
        target.client(OWNER).edit_map("hall", Delta(take(shifted, np.arange(60) < 40), NONE))

        def localize(rows: slice, session: str | None, shift: float) -> AttackResponse:
            body = {
                "model_id": template.model_id,
                "codes": codes[rows].tobytes(),
                "centroids": (places[rows] + [shift, 0, 0]).astype("<f8").tobytes(),
                "maps": ["hall"],
                "session": session,
            }
            return stage.ask(
                target,
                AttackRequest(
                    "POST", "/localize", msgpack.packb(body), VICTIM, {"Content-Type": MSGPACK}
                ),
            )

        with_memory = localize(slice(20, 60), "victim-session", 0).json()
        before = localize(slice(0, 40), "victim-session", 0).json()
        alone = localize(slice(0, 40), None, 0).json()
        difference = score_of(before) != score_of(alone)
        stage.note("probability with the session", score_of(before))
        stage.note("probability without", score_of(alone))
        stage.note("first request", score_of(with_memory))
        if not stage.expect(difference, "A session makes no difference: the case shows nothing."):
            return
        localize(slice(20, 60), "second-session", 0)
        body = {
            "model_id": template.model_id,
            "codes": codes[:40].tobytes(),
            "centroids": places[:40].astype("<f8").tobytes(),
            "maps": ["hall"],
        }
        flood = [
            AttackRequest(
                "POST",
                "/localize",
                msgpack.packb(body | {"session": f"s-{number}"}),
                READER,
                {"Content-Type": MSGPACK},
            )
            for number in range(60)
        ]
        stage.count(stage.ask_all(target, flood, 4))
        after = localize(slice(0, 40), "second-session", 0).json()
        stage.note("probability after the flood", score_of(after))
        stage.expect(
            score_of(after) != score_of(alone), "Another key's sessions displaced the victim's."
        )


def pinned_builds(stage: Stage) -> None:
    """A26: the pinned sources of an image build."""
    dockerfile = (ROOT / "Dockerfile").read_text()
    images = re.findall(r"^FROM\s+(\S+)", dockerfile, flags=re.MULTILINE)
    stages = set(re.findall(r"^FROM\s+\S+\s+AS\s+(\S+)", dockerfile, flags=re.MULTILINE | re.I))
    by_tag = [each for each in images if "@sha256:" not in each and each not in stages]
    # Digests are known only with access to a registry, so the script pins images at release.
    stage.note("pinned at release", by_tag)
    unpinned = _unpinned(by_tag)
    stage.expect(
        not unpinned,
        "deploy/pin-images.sh, which writes digests at release, leaves these images by tag: "
        f"{', '.join(unpinned)}.",
    )
    commands = dockerfile.replace("\\\n", " ")
    installs = re.findall(r"pip (?:install|wheel|download)\b[^&;|\n]*", commands)
    stage.note("installs", len(installs))
    # Installs without an index use packages that were built and checked before.
    bare = [each.strip() for each in installs if not re.search("--require-hashes|--no-index", each)]
    stage.expect(bool(installs) and not bare, f"Installed without hashes: {', '.join(bare)}.")
    stage.expect(
        "PIP_BUILD_CONSTRAINT" in dockerfile
        or "--build-constraint" in dockerfile
        or "--no-build-isolation" in dockerfile,
        "The build dependencies of the packages are not pinned.",
    )
    names = re.findall(r"(?:--requirement|-r)[ =](\S+)", dockerfile)
    files = [ROOT / name for name in names]
    stage.note("files with hashes", [file.name for file in files])
    if stage.expect(bool(files), "No requirements file is installed."):
        for file in files:
            lines = file.read_text().replace("\\\n", " ").splitlines()
            bare = [
                line.split()[0]
                for line in lines
                if re.match(r"[A-Za-z0-9]", line) and "--hash=sha256:" not in line
            ]
            stage.expect(not bare, f"{file.name} has no hash for {', '.join(bare[:5])}.")


def _unpinned(images: list[str]) -> list[str]:
    """Run pin-images.sh on a copy with a made-up registry; return the images it leaves by tag."""
    with tempfile.TemporaryDirectory(prefix="placecell-attack-") as name:
        copy = Path(name)
        shutil.copytree(ROOT / "deploy", copy / "deploy")
        shutil.copyfile(ROOT / "Dockerfile", copy / "Dockerfile")
        docker = copy / "docker"
        docker.write_text(f"#!/bin/sh\necho sha256:{'0' * 64}\n")
        docker.chmod(0o755)
        path = f"{copy}{os.pathsep}{os.environ['PATH']}"
        command = ["sh", str(copy / "deploy/pin-images.sh")]
        environment = os.environ | {"PATH": path}
        subprocess.run(command, env=environment, check=True, capture_output=True, timeout=60)
        pinned = (copy / "Dockerfile").read_text()
    return [image for image in images if f"FROM {image}@sha256:" not in pinned]


def score_of(answer: dict[str, object]) -> float:
    """Return the probability of an answer's first localization; -1 if there is none."""
    localizations = answer.get("localizations") or []
    assert isinstance(localizations, list)
    return round(float(localizations[0]["probability"]), 6) if localizations else -1.0


def _put_precious(stage: Stage, target: Target, template: MapTemplate) -> None:
    file = encode(template.random_map(VICTIM, _ids(1, 5), np.random.default_rng(0)))
    headers = {"Content-Type": MAP, "If-Match": "*"}
    if stage.ask(target, AttackRequest("GET", "/maps/precious")).status == 404:
        headers = {"Content-Type": MAP}
    stage.ask(target, AttackRequest("PUT", "/maps/precious", file, headers=headers))


def _status(target: Target, method: str, path: str, headers: dict[str, str]) -> int:
    """Return the status of a request with exactly these headers."""
    lines = [f"{method} {path} HTTP/1.1", *(f"{name}: {value}" for name, value in headers.items())]
    head = "\r\n".join([*lines, "Content-Length: 0", "Connection: close", "", ""])
    line = exchange_bytes(target, head.encode()).split(b"\r\n")[0].split()
    return int(line[1]) if len(line) > 1 else 0


def _key_metrics(stage: Stage, target: Target) -> dict[str, str]:
    """Return the metrics about the key file."""
    lines = stage.ask(target, AttackRequest("GET", "/metrics")).text.splitlines()
    found = [line.rpartition(" ") for line in lines if re.match(r"[a-z_]*keys?[a-z_]*[ {]", line)]
    return {name: value for name, _, value in found}


def _ids(first: int, count: int) -> UInt32:
    return np.arange(first, first + count, dtype=np.uint32)


CASES = (
    AttackCase("A9", foreign_pages, "Without keys, no foreign page reads or changes maps."),
    AttackCase("A12", broken_key_file, "/readyz and a metric report an unreadable key file."),
    AttackCase("A19", foreign_names, "A key learns nothing of maps and keys that are not its own."),
    AttackCase("A20", docs_pages, "The page and the documentation load nothing from other hosts."),
    AttackCase("A21", unknown_keys, "The log records refused requests with the client's address."),
    AttackCase("A25", many_sessions, "One key's sessions displace no other key's."),
    AttackCase("A26", pinned_builds, "Builds install pinned versions only, by hash."),
)
