"""`placecell serve`: run the service."""

import gc
import ipaddress
import os
import signal
import socket
import sys
from pathlib import Path
from typing import Annotated, Any

import typer
from pydantic import ValidationError


def serve(
    host: Annotated[
        str | None, typer.Option(help="Address to listen on. (default: 127.0.0.1)")
    ] = None,
    port: Annotated[
        int | None, typer.Option(help="Port to listen on; 0: any free one. (default: 8000)")
    ] = None,
    data_dir: Annotated[
        Path | None, typer.Option(help="Folder of the maps; one service owns it. (default: var)")
    ] = None,
    model: Annotated[
        str | None, typer.Option(help="Name of the default model. (default: context)")
    ] = None,
    models_dir: Annotated[
        Path | None, typer.Option(help="Folder of the models' folders. (default: models)")
    ] = None,
    keys_file: Annotated[
        Path | None, typer.Option(help="TOML file of keys; 'placecell keys' makes them.")
    ] = None,
    allow_remote: Annotated[
        bool,
        typer.Option(
            "--allow-remote",
            help="Without keys, listen beyond this machine, though whoever reaches the port "
            "can change the maps.",
        ),
    ] = False,
) -> None:
    """Run the service.

    What is not given here comes from the environment (PLACECELL_HOST, PLACECELL_LIMITS__K, ...),
    from placecell.toml or the file that PLACECELL_CONFIG names, or is the default: 'placecell
    config' shows all. SIGTERM drains: /readyz fails first, and requests at work are answered.
    """
    # Requests are searched side by side; threads within a search would be in each other's way.
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    from service import logs, memory
    from service.app import create_app, version
    from service.server import Server
    from service.settings import Settings
    from service.state import StartError, open_state

    given: dict[str, Any] = {
        "host": host,
        "port": port,
        "data_dir": data_dir,
        "model": model,
        "models_dir": models_dir,
        "keys_file": keys_file,
    }
    try:
        settings = Settings(**{name: value for name, value in given.items() if value is not None})
    except ValueError as error:
        raise _refusal(f"settings: {_plainly(error)}") from error
    logs.install(settings.log)
    memory.limit()
    open_to_all = allow_remote or settings.keys_file is not None
    with _listening_socket(settings.host, settings.port, open_to_all) as listening:
        try:
            with open_state(settings) as state:
                address, number = listening.getsockname()[:2]
                shown = f"[{address}]" if ":" in address else address
                typer.echo(
                    f"Placecell {version()} listens on http://{shown}:{number} "
                    f"(model {state.model_id}, {len(state.maps)} maps in {settings.data_dir})"
                )
                server = Server(create_app(settings, state), state)
                # What was imported and loaded stays; to look through it all again and again for
                # garbage would stop every request for a tenth of a second.
                gc.collect()
                gc.freeze()
                # At its end uvicorn raises the signal that ended it once more; that must not be
                # the end of us before the store is closed.
                signal.signal(signal.SIGTERM, lambda *_: sys.exit())
                server.run(sockets=[listening])
        except StartError as error:
            raise _refusal(str(error)) from error


def _listening_socket(host: str, port: int, open_to_all: bool) -> socket.socket:
    """A socket that listens; what connects now waits until the service is ready."""
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except (OSError, UnicodeError) as error:
        why = error.strerror if isinstance(error, OSError) else "no name of a host"
        raise _refusal(f"host {host!r}: {why}") from error
    if not ipaddress.ip_address(address[0]).is_loopback and not open_to_all:
        raise _refusal(
            f"host {host!r} can be reached from other machines, and the service has no keys: "
            "make some (placecell keys), listen on 127.0.0.1, or say --allow-remote"
        )
    try:
        listening = socket.create_server(address[:2], family=family)
    except OSError as error:
        raise _refusal(f"cannot listen on {host} port {port}: {error.strerror}") from error
    # Accepted sockets inherit it. An answer is written in two parts, and the second would wait for
    # the client to acknowledge the first, which it does after 40 ms.
    listening.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return listening


def _refusal(message: str) -> typer.Exit:
    typer.echo(f"placecell serve: {message}", err=True)
    return typer.Exit(1)


def _plainly(error: ValueError) -> str:
    """What is wrong with which setting, without the library's address."""
    if not isinstance(error, ValidationError):
        return str(error)
    return "; ".join(f"{'.'.join(map(str, one['loc']))}: {one['msg']}" for one in error.errors())
