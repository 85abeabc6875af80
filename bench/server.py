"""The real service as a process of its own, on a free port of the loopback interface."""

import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def running_service(
    data_dir: Path, *options: str, environment: Mapping[str, str] | None = None
) -> Iterator[str]:
    """Run `placecell serve` until the block ends; yields its address, such as http://127.0.0.1:8123.

    Args:
        data_dir: where it keeps the maps.
        options: further ones of `placecell serve`.
        environment: further variables.

    Raises:
        RuntimeError: it did not start; the message holds what it said.
    """
    command = [sys.executable, "-m", "cli", "serve", "--port", "0", "--data-dir", str(data_dir)]
    log_file = data_dir / "service.log"
    data_dir.mkdir(parents=True, exist_ok=True)
    with log_file.open("w") as log:
        process = subprocess.Popen(
            [*command, *options],
            stdout=subprocess.PIPE,
            stderr=log,
            text=True,
            # Nobody watches whether it is ready.
            env=os.environ | {"PLACECELL_DRAIN_SECONDS": "0"} | dict(environment or {}),
        )
    try:
        yield _address(process, log_file)
    finally:
        process.terminate()
        try:
            process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stdout is not None:
            process.stdout.close()


def _address(process: "subprocess.Popen[str]", log_file: Path) -> str:
    said = []
    assert process.stdout is not None
    for line in process.stdout:
        said.append(line)
        match = re.search(r"http://[\w.:\[\]-]+", line)
        if match:
            return match[0]
    process.wait()
    raise RuntimeError(f"the service did not start: {''.join(said)}{log_file.read_text()}")
