"""`placecell bench`: what is measured, one file a bench."""

import typer

from cli.benches.align import align
from cli.benches.attack import attack
from cli.benches.crash import crash
from cli.benches.describe import describe
from cli.benches.fleet import fleet
from cli.benches.floors import floors
from cli.benches.json_requests import json_requests
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
from cli.drive_options import takes_drives

bench = typer.Typer(help="Measure on this machine.", no_args_is_help=True)
bench.command()(takes_drives(describe))
bench.command()(takes_drives(serve))
bench.command()(takes_drives(soak))
bench.command()(takes_drives(maps))
bench.command()(takes_drives(ladder))
bench.command()(takes_drives(localize))
bench.command()(takes_drives(floors))
bench.command()(localisation)
bench.command()(takes_drives(align))
bench.command()(town)
bench.command()(takes_drives(views))
bench.command()(takes_drives(peers))
bench.command()(crash)
bench.command()(powerloss)
bench.command()(fleet)
bench.command()(attack)
bench.command("json")(json_requests)
