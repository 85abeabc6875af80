"""Pages of docs/reference with generated parts."""

from collections.abc import Callable, Mapping
from pathlib import Path

from cli.reference.commands import command_pages
from cli.reference.markdown import filled
from cli.reference.metrics import metric_pages
from cli.reference.paths import ROOT
from cli.reference.routes import route_pages
from cli.reference.settings import setting_pages

FOLDER = ROOT / "docs" / "reference"

PAGES: Mapping[Path, Callable[[], dict[str, str]]] = {
    FOLDER / "cli.md": command_pages,
    FOLDER / "http-api.md": route_pages,
    FOLDER / "metrics.md": metric_pages,
    FOLDER / "settings.md": setting_pages,
}
"""Each page and the function that makes its generated parts."""


def generate(page: Path) -> tuple[str, str]:
    """Return the present and the new text of a page.

    Raises:
        ValueError: the page lacks a generated part or has an unknown one.
    """
    before = page.read_text(encoding="utf-8")
    return before, filled(before, PAGES[page]())
