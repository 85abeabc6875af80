"""Text files, in the encodings that editors and spreadsheets write."""

import codecs
from pathlib import Path

from placecell.core.errors import DriveError


def read_lines(file: Path, what: str) -> list[str]:
    """Read the lines of a UTF-8 text file, with or without byte order mark, LF or CRLF.

    UTF-16 is read if the file begins with its byte order mark.

    Raises:
        DriveError: missing, a folder, unreadable, or no text.
    """
    try:
        content = file.read_bytes()
    except FileNotFoundError as error:
        raise DriveError(f"{file}: missing; it must hold {what}") from error
    except OSError as error:
        raise DriveError(f"{file}: cannot be read ({error.strerror})") from error
    wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    try:
        return content.decode("utf-16" if wide else "utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise DriveError(
            f"{file}: cannot be read as UTF-8 text (byte {error.start}); it must hold {what}"
        ) from error
