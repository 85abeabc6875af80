"""Folders of the shipped models, and the default model."""

from pathlib import Path

MODELS_FOLDER = Path(__file__).resolve().parents[2] / "models"
DEFAULT_MODEL = "context"
BASELINE = "eigenvalue"


def model_folder(name_or_path: str, models: Path = MODELS_FOLDER) -> Path:
    """Return the folder of a model.

    Args:
        name_or_path: name of a folder in `models`, or a path.
        models: folder of the shipped models.
    """
    named = models / name_or_path
    return (
        named if Path(name_or_path).name == name_or_path and named.is_dir() else Path(name_or_path)
    )


def shipped_models(models: Path = MODELS_FOLDER) -> list[str]:
    """Return the names of the folders in `models` that hold a model."""
    return sorted(file.parent.name for file in models.glob("*/manifest.json"))
