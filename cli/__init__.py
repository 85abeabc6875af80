"""The command line: `placecell`, one file a subcommand; heavy imports wait until it runs."""

import typer

from cli.ablations import ablations
from cli.benches import bench
from cli.config import config
from cli.demo import demo
from cli.evaluate import evaluate
from cli.evaluate_poses import evaluate_poses
from cli.experiments import experiments
from cli.fit_confidence import fit_confidence
from cli.keys import keys
from cli.maps import maps
from cli.prepare import prepare
from cli.serve import serve
from cli.study import study
from cli.town import town
from cli.train import train

app = typer.Typer(
    name="placecell",
    help="Place recognition for robot teams: learned 3D segment descriptors, served over HTTP.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
app.command()(demo)
app.command()(town)
app.command()(prepare)
app.command()(train)
app.command()(evaluate)
app.command()(evaluate_poses)
app.command()(fit_confidence)
app.command()(experiments)
app.command()(study)
app.command()(ablations)
app.add_typer(bench, name="bench")
app.command()(serve)
app.command()(config)
app.command()(keys)
app.add_typer(maps, name="maps")
