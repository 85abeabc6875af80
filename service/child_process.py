"""Service in a child process, on a free port of the loopback interface."""

import os
import re
import subprocess
import sys
import urllib.parse
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Self

STOP_SECONDS = 20.0
"""Seconds after which a service that should stop is killed."""


class Service:
    """Child process that runs `placecell serve`."""

    def __init__(
        self,
        data_dir: Path,
        *options: str,
        environment: Mapping[str, str] | None = None,
        tracer: Sequence[str] = (),
    ) -> None:
        """Start the process; `address` waits until the service listens.

        Args:
            data_dir: data directory of the service; the log is `service.log` in it.
            options: options of `placecell serve`.
            environment: additional environment variables.
            tracer: command that runs the service's command, with its options.
        """
        command = [sys.executable, "-m", "cli", "serve", "--port", "0", "--data-dir", str(data_dir)]
        data_dir.mkdir(parents=True, exist_ok=True)
        self._log_file = data_dir / "service.log"
        self._logged = self._log_file.stat().st_size if self._log_file.exists() else 0
        with self._log_file.open("a") as log:
            self.process = subprocess.Popen(
                [*tracer, *command, *options],
                stdout=subprocess.PIPE,
                stderr=log,
                text=True,
                # No load balancer watches whether the service is ready.
                env=os.environ | {"PLACECELL_DRAIN_SECONDS": "0"} | dict(environment or {}),
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def address(self) -> str:
        """Wait until the service listens and return its address; call it once.

        Raises:
            RuntimeError: the service did not start; the message holds its output.
        """
        said = []
        assert self.process.stdout is not None
        for line in self.process.stdout:
            said.append(line)
            match = re.search(r"http://[\w.:\[\]-]+", line)
            if match:
                return match[0]
        self.process.wait()
        raise RuntimeError(f"the service did not start: {''.join(said)}{self.log()}")

    def peak_mb(self) -> float:
        """Return the peak memory of the process, MB; on Linux only."""
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return round(int(status.split("VmHWM:")[1].split()[0]) * 1024 / 1e6, 1)

    def log(self) -> str:
        """Return the lines of the log since the start."""
        return self._log_file.read_bytes()[self._logged :].decode(errors="replace")

    def kill(self) -> None:
        """Kill the process with SIGKILL, without a shutdown."""
        self.process.kill()
        self._end()

    def stop(self) -> None:
        """Stop the process with SIGTERM; requests in progress are answered."""
        self.process.terminate()
        try:
            self.process.wait(timeout=STOP_SECONDS)
        except subprocess.TimeoutExpired:
            self.process.kill()
        self._end()

    def _end(self) -> None:
        self.process.wait()
        if self.process.stdout is not None:
            self.process.stdout.close()


@contextmanager
def running_service(
    data_dir: Path,
    *options: str,
    environment: Mapping[str, str] | None = None,
    tracer: Sequence[str] = (),
) -> Iterator[str]:
    """Run `placecell serve` for a block and yield its address; arguments as of the class.

    Raises:
        RuntimeError: the service did not start; the message holds its output.
    """
    with Service(data_dir, *options, environment=environment, tracer=tracer) as service:
        yield service.address()


def address_of(url: str) -> tuple[str, int]:
    """Return host and port of an address http://HOST:PORT."""
    parts = urllib.parse.urlsplit(url)
    assert parts.hostname is not None
    assert parts.port is not None
    return parts.hostname, parts.port
