import warnings
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import pytest

from placecell.descriptors.manifest import Manifest
from service.app import create_app
from service.core.settings import Settings
from tests.service.postgres_server import ON_POSTGRES
from tests.service.service_builders import write_eigenvalue_model, write_onnx_model

with warnings.catch_warnings():
    # Starlette 1.x prefers httpx2 under its test client; httpx, our client's, still works.
    warnings.simplefilter("ignore")
    from starlette.testclient import TestClient

Start = Callable[..., AbstractContextManager[TestClient]]


@pytest.fixture(autouse=ON_POSTGRES)
def on_postgres(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Keeps the maps of the test in a database of its own."""
    server = request.getfixturevalue("postgres_server")
    url = server.create_database_with_tables()
    monkeypatch.setenv("PLACECELL_DATABASE", url)
    # The server of the tests is not durable, on purpose. Tests of the log expect no such warning.
    monkeypatch.setattr("service.maps.postgres.store.durability_warnings", lambda _: ())
    try:
        yield
    finally:
        server.drop_database(url)


@pytest.fixture(scope="session")
def models_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("models")
    write_eigenvalue_model(folder)
    write_eigenvalue_model(folder, "other", step=0.03)
    write_onnx_model(folder)
    return folder


@pytest.fixture(scope="session")
def manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "tiny")


@pytest.fixture(scope="session")
def other_manifest(models_dir: Path) -> Manifest:
    return Manifest.load(models_dir / "other")


@pytest.fixture
def data_dir(tmp_path: Path) -> Path:
    return tmp_path / "var"


@pytest.fixture
def start(models_dir: Path, data_dir: Path) -> Start:
    """Starts the service on the test's data directory, in this process."""

    def started(**settings: object) -> TestClient:
        values = {"models_dir": models_dir, "data_dir": data_dir, "model": "tiny"} | settings
        app = create_app(Settings.model_validate(values))
        return TestClient(app, raise_server_exceptions=False)

    return started


@pytest.fixture
def service(start: Start) -> Iterator[TestClient]:
    with start() as client:
        yield client
