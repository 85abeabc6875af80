"""`placecell bench`: measurements, one file per benchmark."""

import typer

from cli.bench.align import align
from cli.bench.attack import attack
from cli.bench.completion import completion
from cli.bench.crash import crash
from cli.bench.describe import describe
from cli.bench.drift import drift
from cli.bench.fleet import fleet
from cli.bench.fleet_crash import fleet_crash
from cli.bench.floors import floors
from cli.bench.json_requests import json_requests
from cli.bench.ladder import ladder
from cli.bench.live import live
from cli.bench.localize import localize
from cli.bench.long_life import long_life
from cli.bench.maps import maps
from cli.bench.moving import moving
from cli.bench.page import page
from cli.bench.peers import peers
from cli.bench.persistent import persistent
from cli.bench.pose_tables import pose_tables
from cli.bench.power_loss import powerloss
from cli.bench.read import read
from cli.bench.replicas import replicas
from cli.bench.robot import robot
from cli.bench.robot_faults import robot_faults
from cli.bench.search import search
from cli.bench.sensors import sensors
from cli.bench.serve import serve
from cli.bench.shape_bytes import shape_bytes
from cli.bench.soak import soak
from cli.bench.town import town
from cli.bench.views import views
from cli.drive_options import takes_drives

bench = typer.Typer(
    help="Measure speed, durability and localization on this machine.", no_args_is_help=True
)
bench.command()(takes_drives(describe))
bench.command()(takes_drives(serve))
bench.command()(takes_drives(soak))
bench.command()(takes_drives(maps))
bench.command()(takes_drives(ladder))
bench.command()(takes_drives(search))
bench.command()(takes_drives(localize))
bench.command()(takes_drives(floors))
bench.command()(live)
bench.command()(long_life)
bench.command()(drift)
bench.command()(robot_faults)
bench.command()(pose_tables)
bench.command()(sensors)
bench.command()(takes_drives(align))
bench.command()(town)
bench.command()(takes_drives(views))
bench.command()(takes_drives(peers))
bench.command()(crash)
bench.command()(powerloss)
bench.command()(fleet)
bench.command()(fleet_crash)
bench.command()(replicas)
bench.command()(attack)
bench.command("json")(json_requests)
bench.command()(read)
bench.command()(takes_drives(robot))
bench.command()(takes_drives(persistent))
bench.command()(takes_drives(moving))
bench.command()(takes_drives(completion))
bench.command()(shape_bytes)
bench.command()(page)
