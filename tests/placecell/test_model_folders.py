from pathlib import Path

import pytest

from placecell.descriptors.shipped_models import model_folder, shipped_models


@pytest.fixture
def models(tmp_path: Path) -> Path:
    for name in ("group", "eigenvalue", "unfinished"):
        (tmp_path / "models" / name).mkdir(parents=True)
    for name in ("group", "eigenvalue"):
        (tmp_path / "models" / name / "manifest.json").write_text("{}")
    return tmp_path / "models"


def test_name_of_a_shipped_model(models: Path) -> None:
    assert model_folder("group", models) == models / "group"


@pytest.mark.parametrize("path", ["elsewhere", "./group", "a/group", "/somewhere/group"])
def test_other_model_names_are_paths(models: Path, path: str) -> None:
    assert model_folder(path, models) == Path(path)


def test_shipped_models_have_a_manifest(models: Path) -> None:
    assert shipped_models(models) == ["eigenvalue", "group"]
    assert shipped_models(models / "none") == []
