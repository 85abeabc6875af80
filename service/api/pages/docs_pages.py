"""API documentation pages `/docs` and `/redoc`, served from local files only.

Robots work in networks that reach no CDN. And a page that runs a CDN's scripts trusts the CDN with
the API keys that a user types. The scripts come with the package `fastapi-offline`.
"""

from importlib.resources import files
from pathlib import Path

from fastapi import FastAPI, Request, Response

from service.api.pages.static_files import StaticFile, file_of
from service.core.problems import Problem

FILES = ("swagger-ui-bundle.js", "swagger-ui.css", "redoc.standalone.js", "favicon.png")
"""Files of the package that the pages load."""

# Addresses are relative to the page, so that they hold behind a proxy's path prefix, too.
SWAGGER = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Placecell: API</title>
<link rel="icon" href="docs/favicon.png">
<link rel="stylesheet" href="docs/swagger-ui.css">
</head>
<body>
<div id="swagger-ui"></div>
<script src="docs/swagger-ui-bundle.js"></script>
<script src="docs/start.js"></script>
</body>
</html>
"""

START = """SwaggerUIBundle({
  url: "openapi.json",
  dom_id: "#swagger-ui",
  deepLinking: true,
  validatorUrl: null,
  presets: [SwaggerUIBundle.presets.apis, SwaggerUIBundle.SwaggerUIStandalonePreset],
});
"""
"""Template of /docs; without `validatorUrl` the page would send the description to the Internet."""

REDOC = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Placecell: API</title>
<link rel="icon" href="docs/favicon.png">
</head>
<body>
<redoc spec-url="openapi.json"></redoc>
<script src="docs/redoc.standalone.js"></script>
</body>
</html>
"""

# Both pages make styles as they run, and draw pictures from data; Redoc searches in a worker.
POLICY = (
    "default-src 'none'; script-src 'self'; connect-src 'self'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data:; font-src 'self' data:; worker-src 'self' blob:; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'"
)

CACHED = "public, max-age=3600"


def install(app: FastAPI) -> None:
    """Serve the pages without a key: the description shows no maps or keys."""
    folder = Path(str(files("fastapi_offline"))) / "static"
    swagger, redoc = (StaticFile.of(page.encode(), ".html") for page in (SWAGGER, REDOC))
    start = StaticFile.of(START.encode(), ".js")

    @app.get("/docs", include_in_schema=False)
    async def _(request: Request) -> Response:
        return swagger.respond(request, POLICY)

    @app.get("/redoc", include_in_schema=False)
    async def _(request: Request) -> Response:
        return redoc.respond(request, POLICY)

    @app.get("/docs/{name}", include_in_schema=False)
    async def _(name: str, request: Request) -> Response:
        if name == "start.js":
            return start.respond(request, POLICY, CACHED)
        if name not in FILES:
            raise Problem(404, "not-found", f"Unknown file {name!r:.80}. GET /docs shows the page.")
        return file_of(folder, name).respond(request, POLICY, CACHED)
