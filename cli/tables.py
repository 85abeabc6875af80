"""Tables and JSON on standard output: colored on a terminal, plain and complete in a pipe."""

import json
import math
import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.outputs import output_file

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

JsonFlag = Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")]
JsonFile = Annotated[
    Path | None,
    typer.Option("--json", metavar="FILE", callback=output_file, help="JSON file for the figures."),
]

UNBOUNDED = 1_000_000
"""Width of a table in a pipe, characters: large enough that nothing is cut or wrapped."""


def console() -> "Console":
    """Return a console that shows names without markup or emoji; a pipe gets no color."""
    from rich.console import Console

    if sys.stdout.isatty():
        return Console(markup=False, emoji=False, highlight=False)
    return Console(
        markup=False,
        emoji=False,
        highlight=False,
        width=UNBOUNDED,
        no_color=True,
        force_terminal=False,
    )


def progress_console() -> "Console":
    """Return the console of progress bars: standard error, so that a pipe holds results only."""
    from rich.console import Console

    return Console(stderr=True)


def show(items: Iterable[int], total: int, what: str) -> Iterable[int]:
    """Iterate with a progress bar on standard error."""
    from rich.progress import track

    return track(items, description=what, total=total, console=progress_console())


def new_table(*headers: str, title: str | None = None) -> "Table":
    """Return a table that wraps its cells on a narrow terminal and never cuts them."""
    from rich.table import Table

    table = Table(title=title)
    for header in headers:
        table.add_column(header, overflow="fold")
    return table


def print_tables(*tables: "Table") -> None:
    """Print tables, one below the other.

    Raises:
        BrokenPipeError: the reader has closed the pipe.
    """
    to = console()
    with to.capture() as captured:
        to.print(*tables)
    typer.echo(captured.get(), nl=False)


def percent(value: float | None) -> str:
    """Format a share as a percentage; None as a dash."""
    return "-" if value is None else f"{value:.1%}"


def print_json(content: Any) -> None:
    """Print JSON, with arrays as lists and null for numbers that are not finite."""
    typer.echo(_json_of(content))


def write_json(content: Any, file: Path | None) -> None:
    """Write figures as JSON if a file is named."""
    if file:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(_json_of(content) + "\n", encoding="utf-8")


def _json_of(content: Any) -> str:
    return json.dumps(_plain(content), indent=2, allow_nan=False)


def _plain(value: Any) -> Any:
    """Return a value as JSON has it: arrays and sets as lists, NaN and infinity as null."""
    if hasattr(value, "tolist"):
        return _plain(value.tolist())
    if isinstance(value, dict):
        return {key: _plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple | set | frozenset):
        return [_plain(each) for each in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Path):
        return str(value)
    if value is None or isinstance(value, str | int):
        return value
    raise TypeError(f"{type(value).__name__} cannot be written as JSON")
