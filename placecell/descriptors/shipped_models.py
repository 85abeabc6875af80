"""Where the shipped models lie, and which one is used unless told otherwise."""

from pathlib import Path

MODELS_FOLDER = Path(__file__).resolve().parents[2] / "models"
DEFAULT_MODEL = "context"
BASELINE = "eigenvalue"


def model_folder(name_or_path: str, models: Path = MODELS_FOLDER) -> Path:
    """The folder of a model given by its name in `models/` or by its path."""
    named = models / name_or_path
    return (
        named if Path(name_or_path).name == name_or_path and named.is_dir() else Path(name_or_path)
    )


def shipped_models(models: Path = MODELS_FOLDER) -> list[str]:
    """Names of the folders in `models/` that hold a model."""
    return sorted(file.parent.name for file in models.glob("*/manifest.json"))
