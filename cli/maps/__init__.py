"""`placecell maps`: the maps of a running service, and map files."""

import typer

from cli.maps.copies import diff, pull, push, uploads
from cli.maps.keep import age, compact, delete, reset_ids, restore
from cli.maps.look import list_maps, show, verify
from cli.maps.together import align, merge

maps = typer.Typer(
    help="List, show, push, pull, take back, align and merge maps. PLACECELL_URL and PLACECELL_KEY "
    "say where and as whom.",
    no_args_is_help=True,
)
maps.command("list")(list_maps)
for command in (
    *(show, push, uploads, pull, diff, align, merge, restore, verify, compact, age, delete),
    reset_ids,
):
    maps.command()(command)
