"""`placecell keys`: make a key for a robot or a person."""

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
    name: Annotated[str, typer.Argument(help="Whose key it is; in the audit log.")],
    file: Annotated[
        Path, typer.Option("--file", "-f", help="The service's file of keys; is added to.")
    ] = Path("keys.toml"),
    write: Annotated[bool, typer.Option("--write", help="May change maps.")] = False,
    admin: Annotated[
        bool, typer.Option("--admin", help="Let the key reload models and free ids.")
    ] = False,
    maps: Annotated[
        list[str] | None,
        typer.Option("--map", help="Only maps of such names, with * and ?; may be repeated."),
    ] = None,
    robot: Annotated[
        str | None, typer.Option(help="May upload maps of this robot's segments alone.")
    ] = None,
    as_json: JsonFlag = False,
) -> None:
    """Make a key, add its hash to the file, and show the key once.

    A running service takes it up at once. To withdraw a key, delete its section from the file.
    """
    from service.core.auth import Key, new_key, read_keys

    with clear_errors():
        known = {holder.name for holder in read_keys(file)} if file.exists() else set()
        if name in known:
            raise ValueError(f"{file}: has a key for {name!r} already; delete its section first")
        secret, digest = new_key()
        key = Key(sha256=digest, write=write, admin=admin, maps=tuple(maps or ["*"]), robot=robot)
        section = _section(name, key.model_dump(exclude_none=True))
        before = file.read_text(encoding="utf-8").rstrip() + "\n\n" if file.exists() else ""
        replace(file.resolve(), before + section)
    if as_json:
        print_json({"name": name, "key": secret, "file": str(file)})
        return
    typer.echo(secret)
    typer.echo(f"Shown this once; {file} keeps its hash. A robot sends it as", err=True)
    typer.echo("    Authorization: Bearer KEY", err=True)


def replace(file: Path, content: str) -> None:
    """Write the whole file, or nothing; as open as it was, and a new one to its owner alone.

    Raises:
        ValueError: the name cannot stand in it.
    """
    from service.core.auth import KEYS

    try:
        KEYS.validate_python(tomllib.loads(content))
    except ValueError as error:
        raise ValueError(f"{file}: would be no file of keys any more ({error!s:.100})") from error
    mode = file.stat().st_mode & 0o777 if file.exists() else 0o600
    descriptor, unfinished = tempfile.mkstemp(".unfinished", ".", file.parent)
    with os.fdopen(descriptor, "w", encoding="utf-8") as written:
        written.write(content)
        os.fchmod(written.fileno(), mode)
    Path(unfinished).replace(file)


def _section(name: str, facts: dict[str, object]) -> str:
    """TOML of a key; JSON's strings, booleans and lists are TOML's too."""
    lines = [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in facts.items()]
    return "\n".join([f"[{json.dumps(name, ensure_ascii=False)}]", *lines]) + "\n"
