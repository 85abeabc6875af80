"""The real service as a process of its own, on a free port of the loopback interface."""

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
"""After which a service that was told to stop is killed."""


class Service:
    """A process of `placecell serve`."""

    def __init__(
        self,
        data_dir: Path,
        *options: str,
        environment: Mapping[str, str] | None = None,
        tracer: Sequence[str] = (),
    ) -> None:
        """Start it; `address` waits until it is there.

        Args:
            data_dir: where it keeps the maps, and the log `service.log`.
            options: further ones of `placecell serve`.
            environment: further variables.
            tracer: what stands before the command.
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
                # Nobody watches whether it is ready.
                env=os.environ | {"PLACECELL_DRAIN_SECONDS": "0"} | dict(environment or {}),
            )

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def address(self) -> str:
        """Where it listens, such as http://127.0.0.1:8123, as soon as it does; to be asked once.

        Raises:
            RuntimeError: it did not start; the message holds what it said.
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
        """The most memory that it ever had at once, MB; on Linux."""
        status = Path(f"/proc/{self.process.pid}/status").read_text()
        return round(int(status.split("VmHWM:")[1].split()[0]) * 1024 / 1e6, 1)

    def log(self) -> str:
        """What it wrote to its log since it was started."""
        return self._log_file.read_bytes()[self._logged :].decode(errors="replace")

    def kill(self) -> None:
        """As `kill -9`: it has no time for anything."""
        self.process.kill()
        self._end()

    def stop(self) -> None:
        """As SIGTERM: what is in flight is answered."""
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
    """Run `placecell serve` until the block ends; yields its address. Arguments as of `Service`.

    Raises:
        RuntimeError: it did not start; the message holds what it said.
    """
    with Service(data_dir, *options, environment=environment, tracer=tracer) as service:
        yield service.address()


def address_of(url: str) -> tuple[str, int]:
    """Host and port of http://HOST:PORT."""
    parts = urllib.parse.urlsplit(url)
    assert parts.hostname is not None
    assert parts.port is not None
    return parts.hostname, parts.port
