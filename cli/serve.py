"""`placecell serve`: run the service."""

import ipaddress
import logging
import socket
from pathlib import Path
from typing import Annotated, Any

import typer


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
        str | None, typer.Option(help="Name of the model to load. (default: group)")
    ] = None,
    models_dir: Annotated[
        Path | None, typer.Option(help="Folder of the models' folders. (default: models)")
    ] = None,
    allow_remote: Annotated[
        bool,
        typer.Option(
            "--allow-remote",
            help="Listen beyond this machine, though whoever reaches the port can change the maps.",
        ),
    ] = False,
) -> None:
    """Run the service.

    What is not given here comes from the environment (PLACECELL_HOST, PLACECELL_LIMITS__K, ...),
    or is the default.
    """
    import uvicorn

    from service.app import create_app, version
    from service.settings import Settings
    from service.state import StartError, open_state

    given: dict[str, Any] = {
        "host": host,
        "port": port,
        "data_dir": data_dir,
        "model": model,
        "models_dir": models_dir,
    }
    try:
        settings = Settings(**{name: value for name, value in given.items() if value is not None})
    except ValueError as error:
        raise _refusal(f"settings: {error}") from error
    logging.basicConfig(format="%(levelname)s %(message)s")
    with _listening_socket(settings.host, settings.port, allow_remote) as listening:
        try:
            with open_state(settings) as state:
                address, number = listening.getsockname()[:2]
                shown = f"[{address}]" if ":" in address else address
                typer.echo(
                    f"Placecell {version()} listens on http://{shown}:{number} "
                    f"(model {state.model_id}, {len(state.maps)} maps in {settings.data_dir})"
                )
                config = uvicorn.Config(
                    create_app(settings, state),
                    access_log=False,
                    log_level="warning",
                    server_header=False,
                )
                uvicorn.Server(config).run(sockets=[listening])
        except StartError as error:
            raise _refusal(str(error)) from error


def _listening_socket(host: str, port: int, allow_remote: bool) -> socket.socket:
    """A socket that listens; what connects now waits until the service is ready."""
    try:
        family, _, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
    except OSError as error:
        raise _refusal(f"host {host!r}: {error.strerror}") from error
    if not ipaddress.ip_address(address[0]).is_loopback and not allow_remote:
        raise _refusal(
            f"host {host!r} can be reached from other machines, and the service has no keys yet: "
            "listen on 127.0.0.1, or say --allow-remote"
        )
    try:
        return socket.create_server(address[:2], family=family)
    except OSError as error:
        raise _refusal(f"cannot listen on {host} port {port}: {error.strerror}") from error


def _refusal(message: str) -> typer.Exit:
    typer.echo(f"placecell serve: {message}", err=True)
    return typer.Exit(1)
