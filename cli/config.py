"""`placecell config`: shows each setting of the service, its value, source and meaning."""

import json
import os
from typing import Any

import typer

from cli.sources import clear_errors
from cli.tables import JsonFlag, new_table, print_json, print_tables


def config(as_json: JsonFlag = False) -> None:
    """Show each setting of the service: its value, where the value comes from, and its meaning.

    The first source that has a setting wins: the options of 'placecell serve', the environment,
    the file placecell.toml (or the file that PLACECELL_CONFIG names), the default.
    """
    from pydantic import BaseModel, SecretStr

    from service.core.settings import (
        PREFIX,
        Settings,
        is_service_link,
        read_settings,
        settings_file,
    )

    with clear_errors():
        settings = Settings()
        file = settings_file()
        stated = read_settings(file)
    # Names of environment variables are not case-sensitive.
    environment = {
        name.upper(): value
        for name, value in os.environ.items()
        if not is_service_link(name, value)
    }
    settings_told: list[dict[str, Any]] = []

    def rows(model: BaseModel, inside: str, stated: dict[str, Any]) -> None:
        for name, field in type(model).model_fields.items():
            value = getattr(model, name)
            if isinstance(value, SecretStr):
                value = str(value)  # asterisks, if it is set
            if isinstance(value, BaseModel):
                rows(value, f"{inside}{name}__", stated.get(name, {}))
                continue
            variable = PREFIX + (inside + name).upper()
            source = str(file) if name in stated else "default"
            # A group can also be given as one JSON object.
            group = environment.get(PREFIX + inside.rstrip("_").upper(), "{}") if inside else "{}"
            if variable in environment or name in json.loads(group):
                source = "environment"
            meaning = field.description or ""
            settings_told.append(
                {"setting": variable, "value": value, "from": source, "meaning": meaning}
            )

    rows(settings, "", stated)
    if as_json:
        print_json({"settings": settings_told, "file": str(file), "present": file.is_file()})
        return
    table = new_table("setting", "value", "from", "meaning")
    for one in settings_told:
        value = one["value"]
        shown = ", ".join(value) if isinstance(value, tuple) else str(value)
        table.add_row(one["setting"], shown, one["from"], one["meaning"])
    print_tables(table)
    presence = "exists" if stated else "does not exist"
    typer.echo(f"The settings file {file} {presence}. Example of its content:")
    typer.echo("    port = 9000\n    [limits]\n    k = 50")
