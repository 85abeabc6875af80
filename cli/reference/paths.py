"""Paths of this checkout in the form that the pages show."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def shown(path: Path) -> str:
    """Return a path for a page: relative to the checkout if it lies there."""
    inside = path.is_absolute() and path.is_relative_to(ROOT)
    return (path.relative_to(ROOT) if inside else path).as_posix()
