"""`placecell maps`: the maps of a running service, and map files."""

import typer

from cli.maps.copies import diff, pull, push
from cli.maps.keep import age, compact, delete, restore
from cli.maps.look import list_maps, show, verify

maps = typer.Typer(
    help="List, show, push, pull and take back maps. PLACECELL_URL and PLACECELL_KEY say where "
    "and as whom.",
    no_args_is_help=True,
)
maps.command("list")(list_maps)
for command in (show, push, pull, diff, restore, verify, compact, age, delete):
    maps.command()(command)
