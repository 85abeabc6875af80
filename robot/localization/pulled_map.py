"""Pulled map: a copy of the service's map in the state folder, for the time without a link."""

from pathlib import Path

from placecell_client import MapCopy, MapFileError, decode, encode


def load_copy(name: str, folder: Path | None) -> MapCopy:
    """Return the copy of a map in a folder; an empty one if there is none, or it is damaged."""
    if folder is None:
        return MapCopy(name)
    try:
        file = folder / f"{name}.map"
        etag = (folder / f"{name}.map.etag").read_text(encoding="utf-8").strip()
        return MapCopy(name, decode(file.read_bytes()), etag)
    except (OSError, MapFileError, ValueError):
        return MapCopy(name)


def save_copy(copy: MapCopy, folder: Path) -> bool:
    """Write a copy into a folder; return whether it could be written."""
    if copy.content is None or copy.etag is None:
        return False
    try:
        folder.mkdir(parents=True, exist_ok=True)
        unfinished = folder / f"{copy.name}.map.unfinished"
        unfinished.write_bytes(encode(copy.content))
        tag = folder / f"{copy.name}.map.etag"
        # The version must never describe another file.
        tag.unlink(missing_ok=True)
        unfinished.replace(folder / f"{copy.name}.map")
        tag.write_text(f"{copy.etag}\n", encoding="utf-8")
    except OSError:
        return False
    return True
