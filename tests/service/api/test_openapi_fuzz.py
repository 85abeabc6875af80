"""Schemathesis on the whole API: all answers match OpenAPI, with and without a key."""

import subprocess
import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from cli import app
from tests.service.api.test_process import running

CHECKS = (
    "not_a_server_error,status_code_conformance,content_type_conformance,"
    "response_schema_conformance,unsupported_method"
)


@pytest.mark.parametrize("key", ["none needed", "given", "missing"])
def test_every_answer_matches_openapi(
    models_dir: Path, data_dir: Path, tmp_path: Path, key: str
) -> None:
    options, headers = [], []
    if key != "none needed":
        file = tmp_path / "keys.toml"
        made = ["keys", "fuzzer", "--file", str(file), "--write", "--admin", "--map", "0*"]
        secret = CliRunner().invoke(app, made).output.splitlines()[0]
        options = ["--keys-file", str(file)]
        headers = ["--header", f"Authorization: Bearer {secret}"] if key == "given" else []
    with running(models_dir, data_dir, *options) as (process, address):
        done = subprocess.run(
            [
                *(sys.executable, "-m", "schemathesis.cli", "run", f"{address}/openapi.json"),
                *("--seed", "1", "--max-examples", "5", "--checks", CHECKS, "--no-color"),
                *("--phases", "examples,coverage,fuzzing", *headers),
                # Its answer has no end, so each request waits; tests/service/live asks for it.
                *("--exclude-path", "/events"),
            ],
            capture_output=True, text=True, timeout=600, cwd=tmp_path, check=False,
        )  # fmt: skip
        assert process.poll() is None
    assert done.returncode == 0, done.stdout[-5000:] + done.stderr[-2000:]
    assert " passed" in done.stdout
