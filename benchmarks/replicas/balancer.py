"""haproxy with the configuration that deploy/fleet has."""

import re
import socket
import subprocess
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path

from benchmarks.replicas.missing_tool import MissingToolError, free_port, haproxy_program

CONFIGURATION = Path(__file__).parents[2] / "deploy" / "fleet" / "haproxy.cfg"
START_SECONDS = 20.0
STOP_SECONDS = 10.0


def configuration(port: int, replicas: Sequence[int]) -> str:
    """Return deploy/fleet/haproxy.cfg with these ports of this machine in place of its names.

    Args:
        port: port of the balancer.
        replicas: port of each replica; the file has three at most.

    Raises:
        MissingToolError: there is no such file, because this is not a checkout.
    """
    if not CONFIGURATION.exists():
        raise MissingToolError(
            f"{CONFIGURATION} was not found. Run the benchmark in a checkout of the repository."
        )
    text = CONFIGURATION.read_text()
    text = re.sub(r"bind :8000", f"bind 127.0.0.1:{port}", text)
    text = re.sub(r"(?m)^resolvers names\n(?: .*\n)+", "", text)
    text = text.replace(" resolvers names init-addr last,libc,none", "")
    for number in (1, 2, 3):
        if number <= len(replicas):
            here = f" 127.0.0.1:{replicas[number - 1]}"
            text = text.replace(f" replica-{number}:8000", here)
        else:
            text = re.sub(rf"(?m)^ +server replica-{number} .*\n", "", text)
    return text


@contextmanager
def running_balancer(folder: Path, replicas: Sequence[int]) -> Iterator[str]:
    """Run haproxy before replicas of this machine for a block; yield its address.

    Args:
        folder: folder of its configuration and its log.
        replicas: port of each replica.

    Raises:
        MissingToolError: haproxy is not installed, or its configuration is missing.
        RuntimeError: it did not start; the message holds its log.
    """
    program, port = haproxy_program(), free_port()
    file, log_file = folder / "haproxy.cfg", folder / "haproxy.log"
    file.write_text(configuration(port, replicas))
    with log_file.open("wb") as log:
        process = subprocess.Popen(
            [program, "-db", "-f", str(file)], stdin=subprocess.DEVNULL, stdout=log, stderr=log
        )
    try:
        until = time.monotonic() + START_SECONDS
        while not _listens(port):
            if process.poll() is not None or time.monotonic() > until:
                raise RuntimeError(f"haproxy did not start: {log_file.read_text()[-2000:]}")
            time.sleep(0.02)
        yield f"http://127.0.0.1:{port}"
    finally:
        process.kill()
        process.wait(STOP_SECONDS)


def _listens(port: int) -> bool:
    with suppress(OSError), socket.create_connection(("127.0.0.1", port), timeout=1.0):
        return True
    return False
