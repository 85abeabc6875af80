"""Files: their order by name, and writing one as a whole or not at all."""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path


def natural_key(file: Path) -> tuple[tuple[str | int, ...], str]:
    """Return a key that sorts names by their numbers: 10 after 9.

    The suffix decides only between names that are else equal.
    """
    parts = re.split(r"(\d+)", file.stem)
    parts[::2] = [part.lower() for part in parts[::2]]
    numbered = (int(part) if at % 2 else part for at, part in enumerate(parts))
    return tuple(numbered), file.suffix


@contextmanager
def written_whole(file: Path) -> Iterator[Path]:
    """Yield a path to write to; it becomes the file if the block ends without an error.

    Readers see the old file or the whole new one. The folder of the file is created.
    """
    file.parent.mkdir(parents=True, exist_ok=True)
    unfinished = file.with_name(f"{file.name}.{os.getpid()}.unfinished")
    try:
        yield unfinished
        unfinished.replace(file)
    finally:
        with suppress(OSError):
            unfinished.unlink(missing_ok=True)
