"""`placecell serve`: runs the service."""

import gc
import ipaddress
import os
import re
import resource
import signal
import socket
import sys
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.errors import plain

if TYPE_CHECKING:
    from service.core.settings import Settings


def serve(
    host: Annotated[
        str | None, typer.Option(help="Address to listen on. (default: 127.0.0.1)")
    ] = None,
    port: Annotated[
        int | None, typer.Option(help="TCP port to listen on; 0: any free port. (default: 8000)")
    ] = None,
    data_dir: Annotated[
        Path | None, typer.Option(help="Folder for the maps; one service owns it. (default: var)")
    ] = None,
    model: Annotated[
        str | None, typer.Option(help="Name of the default model. (default: context)")
    ] = None,
    models_dir: Annotated[
        Path | None, typer.Option(help="Folder that holds the model folders. (default: models)")
    ] = None,
    keys_file: Annotated[
        Path | None,
        typer.Option(help="TOML file of API keys, from 'placecell keys'. (default: no keys)"),
    ] = None,
    unix_socket: Annotated[
        Path | None,
        typer.Option(help="Unix socket to listen on instead of host and port. (default: none)"),
    ] = None,
    root_path: Annotated[
        str | None,
        typer.Option(help="Path prefix that a proxy adds to all paths. (default: none)"),
    ] = None,
    keep_alive_seconds: Annotated[
        int | None,
        typer.Option(help="Time that an idle connection stays open, seconds. (default: 5)"),
    ] = None,
    forwarded_allow_ip: Annotated[
        list[str] | None,
        typer.Option(
            help="Address or network of a proxy whose X-Forwarded-For is trusted; repeatable. "
            "(default: none)"
        ),
    ] = None,
    cors_origin: Annotated[
        list[str] | None,
        typer.Option(
            help="Origin of web pages that may call the service, such as https://map.example; "
            "repeatable. (default: none)"
        ),
    ] = None,
    allow_remote: Annotated[
        bool,
        typer.Option(
            "--allow-remote",
            help="Listen on a non-loopback address without API keys. Anyone who can reach the "
            "port can change the maps.",
        ),
    ] = False,
) -> None:
    """Run the service.

    Settings that are not given as options come from the environment (PLACECELL_HOST,
    PLACECELL_LIMITS__K, ...), from placecell.toml or the file that PLACECELL_CONFIG names, or are
    defaults. 'placecell config' shows all settings. SIGTERM drains the service: /readyz fails, and
    requests in progress are answered before the service ends.
    """
    # Requests are searched in parallel; threads within one search would compete with them.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    from service.api.state import open_state
    from service.app import create_app
    from service.core import logging as logs
    from service.core import memory
    from service.core.settings import Settings
    from service.core.version import version
    from service.engine import StartError
    from service.server import Server

    given: dict[str, Any] = {
        "host": host,
        "port": port,
        "data_dir": data_dir,
        "model": model,
        "models_dir": models_dir,
        "keys_file": keys_file,
        "unix_socket": unix_socket,
        "root_path": root_path,
        "keep_alive_seconds": keep_alive_seconds,
        "forwarded_allow_ips": forwarded_allow_ip or None,
        "cors_origins": cors_origin or None,
    }
    try:
        settings = Settings(**{name: value for name, value in given.items() if value is not None})
    except ValueError as error:
        raise _refusal(f"Invalid settings: {plain(error)}") from error
    logs.install(settings.log)
    memory.limit()
    open_to_all = allow_remote or settings.keys_file is not None
    _raise_file_limit(settings.limits.connections)
    with _listening_socket(settings, open_to_all) as listening:
        try:
            with open_state(settings) as state:
                typer.echo(
                    f"Placecell {version()} listens on {_shown(listening)} "
                    f"(model {state.model_id}, {len(state.engine.maps)} maps in "
                    f"{settings.data_dir})"
                )
                if settings.page and settings.unix_socket is None:
                    typer.echo(f"Page: {_local(_shown(listening))}/")
                server = Server(create_app(settings, state), state)
                # Loaded objects stay in memory. A garbage collection that visits all of them would
                # stop every request for 0.1 s.
                gc.collect()
                gc.freeze()
                # When uvicorn ends it raises its stop signal again. The process must not end before
                # the store is closed.
                signal.signal(signal.SIGTERM, lambda *_: sys.exit())
                server.run(sockets=[listening])
        except StartError as error:
            raise _refusal(str(error)) from error


@contextmanager
def _listening_socket(settings: "Settings", open_to_all: bool) -> Iterator[socket.socket]:
    """Open a listening socket; clients that connect wait until the service is ready."""
    if settings.unix_socket is not None:
        with _unix_socket(settings.unix_socket) as listening:
            yield listening
        return
    host, port = settings.host, settings.port
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, UnicodeError) as error:
        why = error.strerror if isinstance(error, OSError) else "not a valid host name"
        raise _refusal(f"Invalid host {host!r}: {why}") from error
    parsed = ipaddress.ip_address(address[0])
    if not parsed.is_loopback and not open_to_all:
        raise _refusal(
            f"Host {host!r} can be reached from other machines, and the service has no API keys. "
            "Create keys ('placecell keys'), listen on 127.0.0.1, or use --allow-remote."
        )
    # The unspecified IPv6 address includes IPv4 if the system supports it.
    both = family == socket.AF_INET6 and parsed.is_unspecified and socket.has_dualstack_ipv6()
    try:
        listening = socket.create_server(address[:2], family=family, dualstack_ipv6=both)
    except OSError as error:
        raise _refusal(f"Cannot listen on {host} port {port}: {error.strerror}.") from error
    with listening:
        # Accepted sockets inherit this option. A response has two parts; without the option the
        # second part waits up to 40 ms for the acknowledgment of the first.
        listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        yield listening


@contextmanager
def _unix_socket(path: Path) -> Iterator[socket.socket]:
    """Listen on a Unix socket; replaces a socket file that a stopped service left behind."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as listening:
        try:
            if path.is_socket() and not _is_answered(path):
                path.unlink()
            listening.bind(str(path))
            listening.listen()
        except OSError as error:
            raise _refusal(f"Cannot listen on {path}: {error.strerror or error}.") from error
        try:
            yield listening
        finally:
            path.unlink(missing_ok=True)


def _is_answered(path: Path) -> bool:
    """Return whether a process listens on a Unix socket."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as probe:
        try:
            probe.connect(str(path))
        except ConnectionRefusedError:
            return False
    return True


def _shown(listening: socket.socket) -> str:
    """Return the address at which clients reach the service."""
    name = listening.getsockname()
    if isinstance(name, str):
        return f"unix:{name}"
    address, number = name[:2]
    return f"http://{f'[{address}]' if ':' in address else address}:{number}"


def _local(address: str) -> str:
    """Replace an address that stands for all addresses of the machine by one for a browser."""
    return re.sub(r"//(0\.0\.0\.0|\[::\]):", "//localhost:", address)


def _raise_file_limit(connections: int) -> None:
    """Raise the limit of open files to fit the connections, if the system allows it."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    wanted = 2 * connections + 1_024
    if hard != resource.RLIM_INFINITY:
        wanted = min(wanted, hard)
    if soft != resource.RLIM_INFINITY and soft < wanted:
        with suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_NOFILE, (wanted, hard))


def _refusal(message: str) -> typer.Exit:
    typer.echo(f"placecell serve: {message}", err=True)
    return typer.Exit(1)
