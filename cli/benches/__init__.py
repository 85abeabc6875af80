"""`placecell bench`: what is measured, one file a bench."""

import typer

from cli.benches.align import align
from cli.benches.crash import crash
from cli.benches.describe import describe
from cli.benches.fleet import fleet
from cli.benches.floors import floors
from cli.benches.ladder import ladder
from cli.benches.localisation import localisation
from cli.benches.localize import localize
from cli.benches.maps import maps
from cli.benches.peers import peers
from cli.benches.powerloss import powerloss
from cli.benches.serve import serve
from cli.benches.soak import soak
from cli.benches.town import town
from cli.benches.views import views

bench = typer.Typer(help="Measure on this machine.", no_args_is_help=True)
bench.command()(describe)
bench.command()(serve)
bench.command()(soak)
bench.command()(maps)
bench.command()(ladder)
bench.command()(localize)
bench.command()(floors)
bench.command()(localisation)
bench.command()(align)
bench.command()(town)
bench.command()(views)
bench.command()(peers)
bench.command()(crash)
bench.command()(powerloss)
bench.command()(fleet)
