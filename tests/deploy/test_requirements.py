"""Installed packages match the pins, by version and hash; images match by digest."""

import re
import shutil
import subprocess
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
CLIENT = tomllib.loads((ROOT / "client/pyproject.toml").read_text())["project"]
LOCKED = {
    "build": None,
    "service": ["service"],
    "fleet": ["service", "postgres", "s3", "tracing"],
    "demo": ["service", "town", "plots"],
    "development": [
        *("service", "town", "plots", "training", "odometry", "zenoh", "page"),
        *("postgres", "s3", "tracing", "pose-graph", "development"),
    ],
    "docs": ["docs"],
}
UNHASHED = {"torch", "pytorch-metric-learning"}


def pins(file: Path) -> dict[str, str]:
    """Return versions by name from a file of constraints or requirements."""
    lines = [line for line in file.read_text().splitlines() if re.match(r"[A-Za-z0-9]", line)]
    found = [Requirement(line.rstrip("\\ ")) for line in lines]
    return {canonicalize_name(each.name): str(each.specifier) for each in found}


def closure(extras: list[str]) -> set[str]:
    """Return all packages needed here, according to the installed packages."""
    wanted = [Requirement(each) for each in (*PROJECT["dependencies"], *CLIENT["dependencies"])]
    for extra in extras:
        wanted += [Requirement(each) for each in PROJECT["optional-dependencies"][extra]]
    found: set[str] = set()
    seen: set[tuple[str, str]] = set()
    while wanted:
        each = wanted.pop()
        name = canonicalize_name(each.name)
        if name in UNHASHED or name.startswith("placecell"):
            continue
        for extra in ["", *each.extras]:
            if (name, extra) in seen:
                continue
            seen.add((name, extra))
            found.add(name)
            for line in metadata.requires(name) or []:
                further = Requirement(line)
                if further.marker is None or further.marker.evaluate({"extra": extra}):
                    wanted.append(further)
    return found


@pytest.mark.parametrize("name", LOCKED)
def test_A26_every_package_has_hashes_and_the_pinned_version(name: str) -> None:
    text = (ROOT / "requirements" / f"{name}.txt").read_text()
    entries = re.split(r"\n(?=[A-Za-z0-9])", re.sub(r"^#.*\n", "", text, flags=re.MULTILINE))
    for entry in entries:
        lines = entry.strip().splitlines()
        assert len(lines) > 1, entry
        for line in lines[1:]:
            assert re.fullmatch(r" +--hash=sha256:[0-9a-f]{64}( \\)?", line), line
    # No index, no host: each machine has its own.
    assert "://" not in text
    assert "--index" not in text
    pinned = pins(ROOT / "constraints.txt")
    here = pins(ROOT / "requirements" / f"{name}.txt")
    others = {each for each in here if each not in pinned}
    assert {each: here[each] for each in here if each not in others} == {
        each: pinned[each] for each in here if each not in others
    }
    # Of other systems alone.
    assert others <= {"colorama", "tzdata", "pywin32", "win32-setctime", "appnope"}


@pytest.mark.parametrize(
    # The packages of the docs are in an environment of their own.
    "name",
    [name for name, extras in LOCKED.items() if extras and name != "docs"],
)
def test_A26_all_that_is_needed_is_locked(name: str) -> None:
    extras = LOCKED[name]
    assert extras is not None
    missing = closure(extras) - pins(ROOT / "requirements" / f"{name}.txt").keys()
    assert not missing, "run `make lock`"


def declared() -> list[Requirement]:
    """Return every dependency of both distributions that is not ours."""
    lists = PROJECT["dependencies"], CLIENT["dependencies"]
    extras = PROJECT["optional-dependencies"].values()
    found = [Requirement(text) for each in (*lists, *extras) for text in each]
    return [each for each in found if not canonicalize_name(each.name).startswith("placecell")]


def test_every_dependency_has_a_lower_bound_that_its_pin_satisfies() -> None:
    pinned = pins(ROOT / "constraints.txt")
    for each in declared():
        assert any(bound.operator == ">=" for bound in each.specifier), each
        version = pinned[canonicalize_name(each.name)].removeprefix("==")
        assert each.specifier.contains(version), f"constraints.txt pins {each.name} {version}"


def test_uvicorn_is_bound_to_the_release_whose_protocol_is_subclassed() -> None:
    (uvicorn,) = (each for each in declared() if each.name == "uvicorn")
    first, after = sorted(bound.version for bound in uvicorn.specifier)
    major, minor = map(int, first.split("."))
    assert after == f"{major}.{minor + 1}"
    assert not uvicorn.specifier.contains(after)


def test_A26_every_install_checks_hashes() -> None:
    dockerfile = re.sub(r"\\\n", "", (ROOT / "Dockerfile").read_text())
    makefile = (ROOT / "Makefile").read_text()
    installs = re.findall(r"pip install[^&\n]*", dockerfile)
    assert len(installs) == 3
    for install in installs:
        # What is not checked comes from this build itself.
        assert "--require-hashes" in install or "--no-deps --no-index" in install
    assert "--no-build-isolation --no-index" in dockerfile
    assert "PIP_BUILD_CONSTRAINT" in dockerfile
    assert "PIP_BUILD_CONSTRAINT" in makefile
    assert "HASHED := $(PIP) --require-hashes" in makefile
    for line in re.findall(r"\t\$\(PIP\)(.*)", makefile):
        assert "--no-deps" in line or line.split()[2:] == ["torch", "pytorch-metric-learning"]


def test_A26_images_are_pinned_by_the_digests_that_a_registry_tells(tmp_path: Path) -> None:
    fleet = ("deploy/fleet/compose.yaml", "deploy/fleet/kubernetes.yaml")
    for name in ("Dockerfile", "deploy/compose.yaml", "deploy/kubernetes.yaml", *fleet):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, tmp_path / name)
    shutil.copy(ROOT / "deploy/pin-images.sh", tmp_path / "deploy/pin-images.sh")
    (tmp_path / "bin").mkdir()
    docker = tmp_path / "bin/docker"
    docker.write_text('#!/bin/sh\necho "$DIGEST"\n')
    docker.chmod(0o755)

    def pinned(digest: str) -> int:
        return subprocess.run(
            ["sh", str(tmp_path / "deploy/pin-images.sh")],
            env={"PATH": f"{tmp_path / 'bin'}:/usr/bin:/bin", "DIGEST": digest},
            check=False,
            capture_output=True,
        ).returncode

    for digest in ("sha256:" + "a" * 64, "sha256:" + "b" * 64):  # again: a newer build
        assert pinned(digest) == 0
        dockerfile = (tmp_path / "Dockerfile").read_text()
        compose = (tmp_path / "deploy/compose.yaml").read_text()
        assert len(re.findall(rf"^FROM python:3\S+@{digest}( AS builder)?$", dockerfile, re.M)) == 2
        assert len(re.findall(rf"image: \S+:v?[\d.]+@{digest}$", compose, re.M)) == 2
        assert "image: placecell:0.1.0\n" in compose
        compose = (tmp_path / "deploy/fleet/compose.yaml").read_text()
        assert len(re.findall(rf"image: \S+:[\d.]+@{digest}$", compose, re.M)) == 2
    before = (tmp_path / "Dockerfile").read_text()
    assert pinned("error: not found") == 1
    assert (tmp_path / "Dockerfile").read_text() == before
