from collections.abc import Iterator

import pytest

from tests.service.service_builders import write_eigenvalue_model


@pytest.fixture(scope="module")
def tiny(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """Let started services use a small model without a network."""
    folder = tmp_path_factory.mktemp("models")
    write_eigenvalue_model(folder)
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("PLACECELL_MODELS_DIR", str(folder))
        patched.setenv("PLACECELL_MODEL", "tiny")
        yield
