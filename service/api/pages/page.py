"""The operator's page at `/`: files of the service, which load nothing from other hosts.

The files are built from the folder `page/` of the repository. They hold no data of the service: the
page gets all data from the HTTP API, with the key that its user types.
"""

from pathlib import Path

from fastapi import FastAPI, Request, Response

from service.api.pages.static_files import file_of
from service.core.problems import Problem

FOLDER = Path(__file__).parents[2] / "page"
"""Folder of the built files."""

INDEX = "index.html"
"""File that `GET /` answers with. Its addresses are relative, so that a path prefix works."""

POLICY = (
    "default-src 'self'; img-src 'self' data: blob:; worker-src 'self' blob:; object-src 'none'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
"""Content-Security-Policy: no script and no style inside the HTML, and no other host."""


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
        return answer(INDEX, request)

    @app.get("/page/{name}", include_in_schema=False)
    async def _(name: str, request: Request) -> Response:
        return answer(name, request)
