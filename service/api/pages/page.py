"""The operator's page at `/`: files of the service, which load nothing from other hosts.

The files are built from the folder `page/` of the repository. They hold no data of the service: the
page gets all data from the HTTP API, with the key that its user types.
"""

from functools import lru_cache
from html import escape
from pathlib import Path

from fastapi import FastAPI, Request, Response

from service.api.pages.static_files import StaticFile, file_of
from service.core.problems import Problem

FOLDER = Path(__file__).parents[2] / "page"
"""Folder of the built files."""

INDEX = "index.html"
"""File that `GET /` answers with. Its addresses are relative, so that a path prefix works."""

HEAD = b"<head>"
"""Tag of the document after which the base address is inserted."""

POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; worker-src 'self' blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Content-Security-Policy: no script and no style inside the HTML, and no other host."""

PREFIX_POLICY = POLICY.replace("base-uri 'none'", "base-uri 'self'")
"""Content-Security-Policy of the document behind a path prefix, which has a base address."""


def install(app: FastAPI, is_on: bool) -> None:
    """Serve the page without a key, or say that it is turned off."""

    def answer(name: str, request: Request) -> Response:
        if not is_on:
            raise Problem(
                404,
                "not-found",
                "The page is turned off. Start the service with PLACECELL_PAGE=true to serve it.",
            )
        return file_of(FOLDER, name).respond(request, POLICY)

    @app.get("/", include_in_schema=False)
    async def _(request: Request) -> Response:
        if not is_on or not app.root_path:
            return answer(INDEX, request)
        return _based(file_of(FOLDER, INDEX), app.root_path).respond(request, PREFIX_POLICY)

    @app.get("/page/{name}", include_in_schema=False)
    async def _(name: str, request: Request) -> Response:
        return answer(name, request)


@lru_cache(maxsize=4)
def _based(document: StaticFile, prefix: str) -> StaticFile:
    """Return the document with the prefix as its base address.

    A browser resolves relative addresses against the folder of the document. Without a slash at the
    end, that folder is the one above the prefix. The base address makes both forms work.
    """
    base = f'<base href="{escape(prefix)}/">'.encode()
    return StaticFile.of(document.content.replace(HEAD, HEAD + base, 1), ".html")
