"""`placecell maps push`, `uploads`, `pull` and `diff`: maps between files and a service."""

from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cli.maps.connection import LOCAL, Name, Url, is_delta, map_from, service
from cli.tables import JsonFlag, print_json

if TYPE_CHECKING:
    from placecell_client import MapSummary, Written

_ETAG = ".etag"


def push(
    file: Annotated[Path, typer.Argument(help="A map file or a delta file.")],
    name: Annotated[str, typer.Argument(help="Of the map; the file's unless said.")] = "",
    replace: Annotated[
        bool, typer.Option("--replace", help="In place of what is there, whoever wrote it.")
    ] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Store a map file, or what a delta file changes; ends when it is safely on the service's disk.

    Other content of that name is replaced only if its last version is the one that 'pull' wrote
    beside the file, or with --replace. So are, by a delta file, other robots' segments. A map
    file larger than the service takes at once is sent in parts; a push that was cut goes on with
    the next part when it is repeated.
    """
    with service(url) as client:
        beside = _etag_of(file)
        seen = beside.read_text(encoding="utf-8").strip() if beside.is_file() else None
        if_match = "*" if replace else seen
        name, data = name or file.stem, file.read_bytes()
        stored: MapSummary | Written
        done: dict[str, Any] = {"map": name}
        if is_delta(data):
            stored = client.edit_map(name, data, if_match=if_match)
            done |= {"changed": stored.changed, "removed": stored.removed}
        else:
            stored = client.put_map(name, data, if_match=if_match)
        if seen is not None:
            beside.write_text(f"{stored.etag}\n", encoding="utf-8")
    done |= {"segments": stored.segments, "version": stored.sequence, "etag": stored.etag}
    if as_json:
        print_json(done)
        return
    if "changed" in done:
        typer.echo(f"{name}: {done['changed']:,} changed, {done['removed']:,} removed")
    typer.echo(f"{name}: {stored.segments:,} segments, version {stored.sequence}")


def uploads(
    name: Name,
    remove: Annotated[
        bool, typer.Option("--remove", help="Remove what was received; the map stays as it is.")
    ] = False,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """List pushes of large map files that were cut, with the bytes that the service has of each.

    A repeated push goes on with them. A day after its last part the service removes an upload.
    """
    with service(url) as client:
        found = client.uploads(name)
        for each in found if remove else ():
            client.delete_upload(name, each.digest)
    if as_json:
        facts = [{"sha256": each.digest, "bytes": each.bytes, "time": each.time} for each in found]
        print_json({"map": name, "uploads": facts, "removed": remove})
        return
    for each in found:
        when = datetime.fromtimestamp(each.time).isoformat(" ", "seconds")
        told = ", removed" if remove else ""
        typer.echo(f"{each.digest}: {each.bytes:,} bytes, last part {when}{told}")
    if not found:
        typer.echo(f"{name}: no upload that is not complete")


def pull(
    name: Name,
    file: Annotated[Path | None, typer.Argument(help="Where to; MAP.map unless said.")] = None,
    version: Annotated[
        int | None,
        typer.Option(
            min=1, help="An earlier one, whole, to MAP@VERSION.map unless said; see 'maps show'."
        ),
    ] = None,
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Bring a map's file up to date; what it has already does not travel again.

    The version is kept beside it (FILE.etag), but for an earlier one: that cannot be pushed over
    what was written since, unless with --replace.
    """
    from placecell_client import MapCopy, decode, encode

    with service(url) as client:
        if version is not None:
            target = file or Path(f"{name}@{version}.map")
            _put(target, client.get_map_file(name, version))
            if as_json:
                print_json({"map": name, "file": str(target), "version": version})
            else:
                typer.echo(f"{target}: version {version}")
            return
        target = file or Path(f"{name}.map")
        beside, copy = _etag_of(target), MapCopy(name)
        if target.is_file() and beside.is_file():
            copy = MapCopy(
                name, decode(target.read_bytes()), beside.read_text(encoding="utf-8").strip()
            )
        before = copy.sequence
        copy = client.pull(copy)
        assert copy.content is not None
        _put(target, encode(copy.content))
        beside.write_text(f"{copy.etag}\n", encoding="utf-8")
        count = len(copy.content)
        if as_json:
            versions = {"before": before, "version": copy.sequence, "etag": copy.etag}
            print_json({"map": name, "file": str(target), "segments": count} | versions)
        else:
            typer.echo(f"{target}: {count:,} segments, version {before} to {copy.sequence}")


def diff(
    old: Annotated[str, typer.Argument(help="A map file, a map, or a version: MAP@VERSION.")],
    new: Annotated[str, typer.Argument(help="The same.")],
    as_json: JsonFlag = False,
    url: Url = LOCAL,
) -> None:
    """Tell what was added, changed and removed from one map to the other."""
    import numpy as np
    from placecell_client.maps.edit import difference

    with service(url) as client:
        before, after = map_from(client, old), map_from(client, new)
        changed, removed = difference(before, after)
        replaced = int(np.isin(changed.ids, before.ids).sum())
    counts = {
        "added": len(changed) - replaced,
        "changed": replaced,
        "removed": len(removed),
        "same": len(before) - replaced - len(removed),
    }
    if as_json:
        print_json(counts)
    else:
        words = {"same": "the same"}
        typer.echo(", ".join(f"{count:,} {words.get(key, key)}" for key, count in counts.items()))


def _put(target: Path, data: bytes) -> None:
    """Replace a file whole, and leave it without a version."""
    unfinished = target.with_name(target.name + ".unfinished")
    unfinished.write_bytes(data)
    # The version first is taken away: it must never be that of another file.
    _etag_of(target).unlink(missing_ok=True)
    unfinished.replace(target)


def _etag_of(file: Path) -> Path:
    return file.with_name(file.name + _ETAG)
