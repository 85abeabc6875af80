"""The pages of docs/reference that have generated parts."""

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
"""Pages, each with what makes its generated parts."""


def generate(page: Path) -> tuple[str, str]:
    """Return a page as it is, and as it should be.

    Raises:
        ValueError: the page lacks a part that is generated, or marks one that is not known.
    """
    before = page.read_text(encoding="utf-8")
    return before, filled(before, PAGES[page]())
