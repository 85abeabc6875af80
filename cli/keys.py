"""`placecell keys`: creates an API key for a robot or a person."""

import json
import os
import tempfile
import tomllib
from pathlib import Path
from typing import Annotated

import typer

from cli.sources import clear_errors
from cli.tables import JsonFlag, print_json


def keys(
    name: Annotated[str, typer.Argument(help="Name of the principal; the audit log shows it.")],
    file: Annotated[
        Path,
        typer.Option("--file", "-f", help="Keys file of the service; the new key is added to it."),
    ] = Path("keys.toml"),
    write: Annotated[
        bool, typer.Option("--write", help="Scope: allow the key to change maps.")
    ] = False,
    admin: Annotated[
        bool, typer.Option("--admin", help="Scope: allow the key to reload models and to free ids.")
    ] = False,
    maps: Annotated[
        list[str] | None,
        typer.Option(
            "--map",
            help="Scope: name pattern of the maps, with * and ?; repeatable. (default: all maps)",
        ),
    ] = None,
    robot: Annotated[
        str | None, typer.Option(help="Scope: allow uploads only of this robot's segments.")
    ] = None,
    as_json: JsonFlag = False,
) -> None:
    """Create an API key, add its hash to the keys file, and print the key once.

    A running service accepts the key at once. To revoke a key, delete its section from the file.
    """
    from service.core.auth import Key, new_key, read_keys

    with clear_errors():
        known = {each.name for each in read_keys(file)} if file.exists() else set()
        if name in known:
            raise ValueError(f"{file} already has a key for {name!r}. Delete its section first.")
        secret, digest = new_key()
        key = Key(sha256=digest, write=write, admin=admin, maps=tuple(maps or ["*"]), robot=robot)
        section = _section(name, key.model_dump(exclude_none=True))
        before = file.read_text(encoding="utf-8").rstrip() + "\n\n" if file.exists() else ""
        replace(file.resolve(), before + section)
    if as_json:
        print_json({"name": name, "key": secret, "file": str(file)})
        return
    typer.echo(secret)
    typer.echo(f"The key is shown only now; {file} keeps its hash. A client sends:", err=True)
    typer.echo("    Authorization: Bearer KEY", err=True)


def replace(file: Path, content: str) -> None:
    """Replace the keys file atomically; it keeps its mode, and a new file gets mode 600.

    Raises:
        ValueError: the content is not a valid keys file.
    """
    from service.core.auth import KEYS

    try:
        KEYS.validate_python(tomllib.loads(content))
    except ValueError as error:
        raise ValueError(
            f"{file} would become invalid: {error!s:.100}. Choose another name."
        ) from error
    mode = file.stat().st_mode & 0o777 if file.exists() else 0o600
    descriptor, unfinished = tempfile.mkstemp(".unfinished", ".", file.parent)
    with os.fdopen(descriptor, "w", encoding="utf-8") as written:
        written.write(content)
        os.fchmod(written.fileno(), mode)
    Path(unfinished).replace(file)


def _section(name: str, facts: dict[str, object]) -> str:
    """Return a key as a TOML section; JSON strings, booleans and lists are valid TOML."""
    lines = [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in facts.items()]
    return "\n".join([f"[{json.dumps(name, ensure_ascii=False)}]", *lines]) + "\n"
