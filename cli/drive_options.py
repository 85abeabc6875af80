"""Options of all commands that read recorded drives: the layout of the drive's files."""

import functools
import inspect
from collections.abc import Callable
from typing import Annotated, Any

import typer

from cli.errors import clear_errors
from placecell.sources.scan_options import (
    DType,
    Order,
    ScanOptions,
    TimeUnit,
    Unit,
    parse_columns,
    use_scan_options,
)

PANEL = "Recorded drives"

OPTIONS: dict[str, tuple[Any, Any]] = {
    "columns": (
        Annotated[
            str | None,
            typer.Option(
                metavar="NAMES",
                help="Columns of a .bin scan: their number, or names such as "
                "x,y,z,intensity,ring. (default: inferred from the values; KITTI has 4)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "dtype": (
        Annotated[
            DType | None,
            typer.Option(
                help="Data type of a scan's values. (default: inferred from the values)",
                rich_help_panel=PANEL,
            ),
        ],
        None,
    ),
    "order": (
        Annotated[
            Order,
            typer.Option(
                help="Memory order of a scan: rows (point by point) or columns (all x first).",
                rich_help_panel=PANEL,
            ),
        ],
        "rows",
    ),
    "unit": (
        Annotated[
            Unit,
            typer.Option(help="Unit of the scans' coordinates.", rich_help_panel=PANEL),
        ],
        "m",
    ),
    "time_unit": (
        Annotated[
            TimeUnit, typer.Option(help="Unit of the times in times.txt.", rich_help_panel=PANEL)
        ],
        "s",
    ),
    "strict": (
        Annotated[
            bool,
            typer.Option(
                "--strict",
                help="Refuse a drive that has unusable scans or NaN points. "
                "(default: skip and count them)",
                rich_help_panel=PANEL,
            ),
        ],
        False,
    ),
}


def tell(message: str) -> None:
    """Print a finding about a drive's files on standard error."""
    typer.echo(f"placecell: {message}", err=True)


def takes_drives(command: Callable[..., None]) -> Callable[..., None]:
    """Add the options of recorded drives to a command; they apply while the command runs."""

    @functools.wraps(command)
    def with_options(**words: Any) -> None:
        given = {name: words.pop(name) for name in OPTIONS}
        with clear_errors():
            names = given.pop("columns")
            options = ScanOptions(
                columns=None if names is None else parse_columns(names), tell=tell, **given
            )
        with use_scan_options(options):
            command(**words)

    signature = inspect.signature(command, eval_str=True)
    extra = [
        inspect.Parameter(
            name, inspect.Parameter.POSITIONAL_OR_KEYWORD, default=default, annotation=kind
        )
        for name, (kind, default) in OPTIONS.items()
    ]
    parameters = [*signature.parameters.values(), *extra]
    with_options.__signature__ = signature.replace(parameters=parameters)  # type: ignore[attr-defined]
    with_options.__annotations__ = {each.name: each.annotation for each in parameters}
    del with_options.__wrapped__
    return with_options
