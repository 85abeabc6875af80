"""`placecell maps`: maps of a running service, and map files."""

import typer

from cli.maps.align import align
from cli.maps.anchor import anchor
from cli.maps.compact import compact
from cli.maps.delete import delete
from cli.maps.diff import diff
from cli.maps.list import list_maps
from cli.maps.merge import merge
from cli.maps.mirror import mirror
from cli.maps.optimize import optimize
from cli.maps.prune import prune
from cli.maps.pull import pull
from cli.maps.push import push
from cli.maps.render import render
from cli.maps.reset_ids import reset_ids
from cli.maps.restore import restore
from cli.maps.show import show
from cli.maps.tag import tag
from cli.maps.uploads import uploads
from cli.maps.verify import verify

maps = typer.Typer(
    help="Store, fetch, compare, align, merge and maintain the maps of a service. The environment "
    "variables PLACECELL_URL and PLACECELL_KEY set the service's address and the API key.",
    no_args_is_help=True,
)

READ, WRITE, COMBINE, MAINTAIN = "Read", "Write", "Combine", "Maintain"
"""Panels of `placecell maps --help`."""

maps.command("list", rich_help_panel=READ)(list_maps)
maps.command(rich_help_panel=READ)(show)
maps.command(rich_help_panel=READ)(pull)
maps.command(rich_help_panel=READ)(render)
maps.command(rich_help_panel=READ)(diff)
maps.command(rich_help_panel=WRITE)(push)
maps.command(rich_help_panel=WRITE)(uploads)
maps.command(rich_help_panel=WRITE)(restore)
maps.command(rich_help_panel=WRITE)(delete)
maps.command(rich_help_panel=WRITE)(tag)
maps.add_typer(anchor, name="anchor", rich_help_panel=WRITE)
maps.command(rich_help_panel=COMBINE)(align)
maps.command(rich_help_panel=COMBINE)(merge)
maps.command(rich_help_panel=COMBINE)(optimize)
maps.command(rich_help_panel=COMBINE)(mirror)
maps.command(rich_help_panel=MAINTAIN)(verify)
maps.command(rich_help_panel=MAINTAIN)(prune)
maps.command(rich_help_panel=MAINTAIN)(compact)
maps.command(rich_help_panel=MAINTAIN)(reset_ids)
maps.command("age", hidden=True)(prune)
