"""The client on the oldest Python that it supports and on the newest one installed here."""

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SMOKE = Path(__file__).with_name("client_smoke.py")
OLDEST = (3, 10)


def version_of(python: str | Path) -> tuple[int, int] | None:
    """Return an interpreter's version; None if it does not run."""
    asked = [str(python), "-c", "import sys; print(*sys.version_info[:2])"]
    try:
        done = subprocess.run(asked, capture_output=True, text=True, timeout=10, check=True)
        major, minor = map(int, done.stdout.split())
    except (OSError, ValueError, subprocess.SubprocessError):
        return None
    return major, minor


def interpreters() -> dict[tuple[int, int], str]:
    """Find interpreters on PATH and in pyenv, by version."""
    pyenv = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv"))
    found: list[str | Path] = [*sorted(pyenv.glob("versions/3.*/bin/python3"))]
    for minor in range(OLDEST[1], 30):
        on_path = shutil.which(f"python3.{minor}")
        if on_path is not None:
            found.append(on_path)
    return {version: str(python) for python in found if (version := version_of(python)) is not None}


def smoke(python: str, folder: Path) -> str:
    """Run the smoke test with the client installed as a robot installs it; return its output."""
    venv: list[str | Path] = [python, "-m", "venv", "--without-pip", folder]
    subprocess.run(venv, check=True, timeout=60, capture_output=True)
    pip: list[str | Path] = [
        sys.executable,
        "-m",
        "pip",
        "--python",
        folder / "bin/python",
        "install",
    ]
    pip += ["-q", "--disable-pip-version-check", "--no-compile"]
    source = folder / "client"
    shutil.copytree(ROOT / "client", source, ignore=shutil.ignore_patterns("__pycache__"))
    installed = subprocess.run(
        [*pip, source], capture_output=True, text=True, timeout=170, check=False
    )
    if installed.returncode:
        assert not re.search("requires a different Python|SyntaxError", installed.stderr)
        pytest.skip(f"no package registry can be reached: {installed.stderr.strip()[-200:]}")
    run: list[str | Path] = [folder / "bin/python", "-W", "error", SMOKE]
    done = subprocess.run(run, capture_output=True, text=True, timeout=60, cwd=folder, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.pythons
def test_B7_client_works_on_the_oldest_python(tmp_path: Path) -> None:
    python = interpreters().get(OLDEST)
    if python is None:
        pytest.skip("no Python 3.10 on PATH or in pyenv")
    assert smoke(python, tmp_path / "venv").startswith("good 3.10")


@pytest.mark.pythons
def test_B7_client_works_on_the_newest_python(tmp_path: Path) -> None:
    version, python = max(interpreters().items(), default=((0, 0), ""))
    if version <= sys.version_info[:2]:
        pytest.skip("no Python newer than the tests' own on PATH or in pyenv")
    assert smoke(python, tmp_path / "venv").startswith(f"good {version[0]}.{version[1]}")


def test_B7_client_declares_the_oldest_python() -> None:
    project = tomllib.loads((ROOT / "client/pyproject.toml").read_text())["project"]
    assert project["requires-python"] == f">={OLDEST[0]}.{OLDEST[1]}"
