"""Static files of the pages: with ETag and gzip, and headers that forbid other hosts."""

import gzip
import hashlib
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

from fastapi import Request, Response

from service.core.preconditions import Preconditions
from service.core.problems import Problem

MEDIA_TYPES = {
    ".css": "text/css",
    ".html": "text/html",
    ".ico": "image/x-icon",
    ".js": "text/javascript",
    ".json": "application/json",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".txt": "text/plain",
    ".wasm": "application/wasm",
    ".woff2": "font/woff2",
}
"""Endings of the files that are served, and their media types."""

COMPRESSED = {".png", ".woff2"}
"""Endings of files that gzip does not make smaller."""

SECURITY = {
    "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY",
    "Referrer-Policy": "no-referrer",
}
"""Headers of every page and file, besides its Content-Security-Policy."""


@dataclass(frozen=True, slots=True)
class StaticFile:
    """Content of a page or of its file, as it is and as gzip.

    Attributes:
        content: the bytes.
        packed: the bytes as gzip; None if gzip does not make them smaller.
        media_type: media type.
        tag: ETag without quotes.
    """

    content: bytes
    packed: bytes | None
    media_type: str
    tag: str

    @classmethod
    def of(cls, content: bytes, ending: str) -> "StaticFile":
        """Prepare content; the ending of its file's name gives the media type."""
        packed = None
        if ending not in COMPRESSED:
            packed = gzip.compress(content, mtime=0)
            packed = packed if len(packed) < len(content) else None
        tag = hashlib.sha256(content).hexdigest()[:32]
        return cls(content, packed, MEDIA_TYPES[ending], tag)

    def respond(self, request: Request, policy: str, cache: str = "no-cache") -> Response:
        """Answer a request with the file, or with 304 if the client has it.

        Args:
            request: the HTTP request.
            policy: Content-Security-Policy.
            cache: Cache-Control; by default the client asks each time whether the file changed.
        """
        packed = self.packed if _accepts_gzip(request) else None
        # A strong ETag names the bytes, and the bytes of gzip are others.
        tag = self.tag if packed is None else f"{self.tag}-gzip"
        headers = SECURITY | {
            "Content-Security-Policy": policy,
            "Cache-Control": cache,
            "ETag": f'"{tag}"',
            "Vary": "Accept-Encoding",
        }
        known = Preconditions(None, request.headers.get("if-none-match"))
        if known.is_known(tag):
            return Response(status_code=304, headers=headers)
        if packed is not None:
            headers["Content-Encoding"] = "gzip"
        return Response(
            self.content if packed is None else packed, media_type=self.media_type, headers=headers
        )


def file_of(folder: Path, name: str) -> StaticFile:
    """Return a file of a folder.

    Raises:
        Problem: 404 if the folder holds no such file that may be served.
    """
    file = folder / name
    # The name is compared with those of the folder, so that no part of it is followed as a path.
    listed = folder.is_dir() and any(each.name == name for each in folder.iterdir())
    if not listed or file.suffix not in MEDIA_TYPES or not file.is_file():
        raise Problem(404, "not-found", f"Unknown file {name!r:.80}. Open the page again.")
    status = file.stat()
    return _loaded(file, status.st_mtime_ns, status.st_size)


@lru_cache(maxsize=64)
def _loaded(file: Path, changed: int, size: int) -> StaticFile:
    """Read a file; it is read again when its time or its size has changed."""
    del changed, size
    return StaticFile.of(file.read_bytes(), file.suffix)


def _accepts_gzip(request: Request) -> bool:
    """Return whether a request accepts gzip; `gzip;q=0` refuses it."""
    for part in request.headers.get("accept-encoding", "").lower().split(","):
        coding, _, weight = part.partition(";")
        if coding.strip() == "gzip":
            return weight.replace(" ", "") not in {"q=0", "q=0.0", "q=0.00", "q=0.000"}
    return False
