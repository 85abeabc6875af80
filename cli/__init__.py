"""The command line `placecell`: one file per subcommand; heavy imports happen on use."""

from typing import Annotated

import typer

from cli.ablations import ablations
from cli.backup import backup, migrate, restore
from cli.bench import bench
from cli.calibrate import calibrate
from cli.config import config
from cli.demo import demo
from cli.drive_options import takes_drives
from cli.errors import Commands
from cli.evaluate import evaluate
from cli.evaluate_poses import evaluate_poses
from cli.evaluate_segments import evaluate_segments
from cli.events import events
from cli.experiments import experiments
from cli.export import export
from cli.fit_confidence import fit_confidence
from cli.inspect_source import inspect
from cli.keys import keys
from cli.maps import maps
from cli.prepare import prepare
from cli.robot import robot
from cli.robots import robots
from cli.serve import serve
from cli.study import study
from cli.town import town
from cli.train import train
from cli.train_classes import train_classes
from cli.train_shapes import train_shapes

OLD_SPELLINGS = {"metres": "meters", "pair-metres": "pair-meters", "licence": "license"}
"""Former British spellings of options; they are accepted, but not shown."""


def current_spelling(word: str) -> str:
    """Return the present name of an option."""
    return OLD_SPELLINGS.get(word, word)


app = typer.Typer(
    name="placecell",
    context_settings={"token_normalize_func": current_spelling},
    cls=Commands,
    rich_markup_mode="markdown",
    help="Place recognition for robot teams: learned 3D segment descriptors, served over HTTP.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


def show_version(wanted: bool) -> None:
    """Print the version and exit."""
    if wanted:
        from importlib import metadata

        try:
            typer.echo(f"placecell {metadata.version('placecell')}")
        except metadata.PackageNotFoundError:
            typer.echo("placecell, unknown version: the package is not installed")
        raise typer.Exit


@app.callback()
def root(
    version: Annotated[
        bool,
        typer.Option(
            "--version", help="Print the version and exit.", callback=show_version, is_eager=True
        ),
    ] = False,
) -> None:
    """Place recognition for robot teams: learned 3D segment descriptors, served over HTTP."""
    del version


RUN, MAP, EVALUATE, TRAIN, MEASURE = "Run", "Map", "Evaluate", "Train", "Measure"
"""Panels of `placecell --help`."""

app.command(rich_help_panel=RUN)(takes_drives(demo))
app.command(rich_help_panel=RUN)(serve)
app.command(rich_help_panel=RUN)(takes_drives(robot))
app.command(rich_help_panel=RUN)(config)
app.command(rich_help_panel=RUN)(keys)
app.add_typer(maps, name="maps", rich_help_panel=MAP)
app.command(rich_help_panel=MAP)(backup)
app.command(rich_help_panel=MAP)(restore)
app.command(rich_help_panel=MAP)(migrate)
app.command(rich_help_panel=MAP)(robots)
app.command(rich_help_panel=MAP)(events)
app.command(rich_help_panel=MAP)(town)
app.command(rich_help_panel=MAP)(takes_drives(inspect))
app.command(rich_help_panel=MAP)(export)
app.command(rich_help_panel=MAP)(takes_drives(prepare))
app.command(rich_help_panel=EVALUATE)(takes_drives(evaluate))
app.command(rich_help_panel=EVALUATE)(takes_drives(evaluate_poses))
app.command(rich_help_panel=EVALUATE)(takes_drives(evaluate_segments))
app.command(rich_help_panel=EVALUATE)(takes_drives(calibrate))
app.command(rich_help_panel=EVALUATE)(takes_drives(study))
app.command(rich_help_panel=TRAIN)(takes_drives(train))
app.command(rich_help_panel=TRAIN)(takes_drives(train_classes))
app.command(rich_help_panel=TRAIN)(takes_drives(train_shapes))
app.command(rich_help_panel=TRAIN)(fit_confidence)
app.command(rich_help_panel=TRAIN)(takes_drives(experiments))
app.command(rich_help_panel=TRAIN)(takes_drives(ablations))
app.add_typer(bench, name="bench", rich_help_panel=MEASURE)
