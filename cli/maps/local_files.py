"""Map and delta files on this machine, with the version that a pulled file has."""

from pathlib import Path

from placecell.core.files import written_whole

ETAG_SUFFIX = ".etag"


def etag_file(file: Path) -> Path:
    """Return the path of the file that holds a map file's version: FILE.etag."""
    return file.with_name(file.name + ETAG_SUFFIX)


def replace_file(target: Path, data: bytes) -> None:
    """Replace a file atomically and remove its FILE.etag."""
    with written_whole(target) as unfinished:
        unfinished.write_bytes(data)
        # Remove the version first: it must never describe another file.
        etag_file(target).unlink(missing_ok=True)


def is_delta(data: bytes) -> bool:
    """Return whether a file claims to be a delta file; it may still be damaged."""
    return b"placecell-delta" in data[:4096]
