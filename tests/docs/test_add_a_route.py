"""The route that the how-to adds works, and answers errors as the page says."""

import re
import warnings
from pathlib import Path
from typing import Any

from placecell_client import encode

from service.app import create_app
from service.core.settings import Settings
from tests.service.service_builders import map_of, random_codes, write_eigenvalue_model

with warnings.catch_warnings():
    # Starlette 1.x prefers httpx2 under its test client; httpx, our client's, still works.
    warnings.simplefilter("ignore")
    from starlette.testclient import TestClient

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "add-a-route.md"


def test_the_route_of_the_page_lists_the_robots_of_a_map(tmp_path: Path) -> None:
    snippet = re.search(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert snippet is not None
    module: dict[str, Any] = {"__name__": "service.api.routes.robots"}
    exec(compile(snippet[1], str(PAGE), "exec"), module)
    manifest = write_eigenvalue_model(tmp_path / "models")
    settings = Settings(data_dir=tmp_path / "var", models_dir=tmp_path / "models", model="tiny")
    app = create_app(settings)
    app.include_router(module["router"])
    with TestClient(app) as client:
        assert client.put(
            "/maps/yard", content=encode(map_of(random_codes(30), manifest.model_id))
        ).is_success
        assert sum(client.get("/maps/yard/robots").json()["robots"].values()) == 30
        assert client.get("/maps/hall/robots").json()["type"].endswith(":unknown-map")
        assert client.get("/maps/.hall/robots").status_code == 422
        described = client.get("/openapi.json").json()["paths"]["/maps/{map}/robots"]["get"]
    assert described["summary"] == "List the robots of a map"
    assert "404" in described["responses"]
