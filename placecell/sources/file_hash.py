"""Identity of a scan, by the content of its file."""

import hashlib
from pathlib import Path


def file_hash(file: Path, drive: str) -> str:
    """Return a scan's identity: the SHA-256 of its file, shortened to 16 hex digits.

    The identity of a file without content (a sensor dropout) is its drive and name: two drives with
    such scans have not seen the same place.

    Args:
        file: file of the scan.
        drive: name of the drive.
    """
    try:
        content = file.read_bytes()
    except OSError:
        content = b""
    content = content or f"no points: {drive}/{file.name}".encode()
    return hashlib.sha256(content).hexdigest()[:16]
