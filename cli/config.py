"""`placecell config`: every setting of the service, where it comes from, and what it means."""

import json
import os
import tomllib
from typing import Any

import typer

from cli.sources import clear_errors


def config() -> None:
    """Show every setting of the service: its value, where that comes from, and what it means.

    Settings come from the command line of 'placecell serve', then the environment, then
    placecell.toml (or the file that PLACECELL_CONFIG names), then the defaults.
    """
    from pydantic import BaseModel
    from rich.console import Console
    from rich.table import Table

    from service.settings import PREFIX, Settings, settings_file

    with clear_errors():
        settings = Settings()
        file = settings_file()
        stated = tomllib.loads(file.read_text()) if file.is_file() else {}
    # Their names may be written in any case.
    environment = {name.upper(): value for name, value in os.environ.items()}
    table = Table("setting", "value", "from", "meaning")

    def rows(model: BaseModel, inside: str, stated: dict[str, Any]) -> None:
        for name, field in type(model).model_fields.items():
            value = getattr(model, name)
            if isinstance(value, BaseModel):
                rows(value, f"{inside}{name}__", stated.get(name, {}))
                continue
            variable = PREFIX + (inside + name).upper()
            source = str(file) if name in stated else "default"
            # A group can also be given as one JSON object.
            group = environment.get(PREFIX + inside.rstrip("_").upper(), "{}") if inside else "{}"
            if variable in environment or name in json.loads(group):
                source = "environment"
            shown = ", ".join(value) if isinstance(value, tuple) else str(value)
            table.add_row(variable, shown, source, field.description or "")

    rows(settings, "", stated)
    Console(width=max(Console().width, 120)).print(table)
    typer.echo(f"In a file: {file} (here {'present' if stated else 'absent'}), such as")
    typer.echo("    port = 9000\n    [limits]\n    k = 50")
