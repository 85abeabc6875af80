"""`placecell maps`: the maps of a service, and map files."""

import typer

from cli.maps.copies import pull, push
from cli.maps.differences import diff
from cli.maps.history import age, compact, restore, versions
from cli.maps.listing import show, show_all
from cli.maps.verification import verify

maps = typer.Typer(
    help="Look at, share, take back and check maps, of a service or in files.",
    no_args_is_help=True,
)
maps.command("list")(show_all)
maps.command()(show)
maps.command()(push)
maps.command()(pull)
maps.command()(diff)
maps.command()(versions)
maps.command()(restore)
maps.command()(age)
maps.command()(compact)
maps.command()(verify)
