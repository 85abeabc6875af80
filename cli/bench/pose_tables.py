"""`placecell bench pose-tables`: writes the tables of docs/results/localization.md."""

from pathlib import Path
from typing import Annotated

import typer

from cli.sources import clear_errors
from cli.tables import JsonFile, write_json


def pose_tables(
    folders: Annotated[
        list[Path],
        typer.Argument(
            help="Folder of one case, which becomes a column; it holds MODEL.json from "
            "'placecell evaluate-poses' and peers*.json from 'placecell bench peers'."
        ),
    ],
    system: Annotated[
        str | None,
        typer.Option(
            help="Print all figures of this system only. (default: main figures of all systems)"
        ),
    ] = None,
    json_file: JsonFile = None,
) -> None:
    """Print localization figures of earlier measurements as a Markdown table."""
    from benchmarks.localization.pose_tables import comparison_table, full_table, read_reports

    with clear_errors():
        cases = {folder.name: read_reports(folder) for folder in folders}
        if empty := [name for name, figures in cases.items() if not figures]:
            raise ValueError(f"Folder {empty[0]} holds no figures (*.json).")
        if system is None:
            lines = list(comparison_table(cases))
        else:
            there = dict.fromkeys(name for figures in cases.values() for name in figures)
            if system not in there:
                raise ValueError(f"unknown system {system!r}; expected one of {', '.join(there)}")
            lines = list(
                full_table({name: each[system] for name, each in cases.items() if system in each})
            )
        write_json({"cases": cases}, json_file)
    typer.echo("\n".join(lines))
