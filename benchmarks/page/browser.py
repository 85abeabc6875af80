"""Chromium of the system, driven by Playwright; Playwright's own browsers are not downloaded."""

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from playwright.sync_api import Browser

NAMES = ("chromium", "chromium-browser", "google-chrome")
"""Names of the program, by preference."""

OPTIONS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
"""Draw without a GPU. In a container, root has no sandbox."""


class BrowserError(ValueError):
    """No browser can be driven on this machine; the message says what to install."""


def find_chromium() -> str | None:
    """Return the path of Chromium; None if there is none."""
    return next(filter(None, map(shutil.which, NAMES)), None)


def program() -> str:
    """Return the path of Chromium.

    Raises:
        BrowserError: Playwright or Chromium is missing.
    """
    try:
        import playwright  # noqa: F401
    except ImportError as error:
        raise BrowserError(
            "Found no Playwright, which drives the browser. Run: pip install 'placecell[page]'"
        ) from error
    found = find_chromium()
    if found is None:
        raise BrowserError(f"Found no {' or '.join(NAMES)}. Run: apt-get install chromium")
    return found


@contextmanager
def chromium() -> Iterator["Browser"]:
    """Run the browser for a block.

    Raises:
        BrowserError: Playwright or Chromium is missing.
    """
    path = program()
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=OPTIONS)
        try:
            yield browser
        finally:
            browser.close()
