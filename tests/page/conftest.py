"""A real browser, a real service with the maps of two robots, and a page that must not complain."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING
from urllib.parse import urlsplit

import pytest
from placecell_client import Client

from benchmarks.page.browser import BrowserError, chromium, program
from benchmarks.page.two_robots import TwoRobots
from placecell.segmentation.pipeline import silent
from service.child_process import running_service

if TYPE_CHECKING:
    from playwright.sync_api import Browser, ConsoleMessage, Page, Request

SEED = 7
SCANS = 70


@dataclass
class Watch:
    """Keeps what a page must not do: errors in the console, and requests to other hosts."""

    host: str
    errors: list[str] = field(default_factory=list)
    foreign: list[str] = field(default_factory=list)

    def follow(self, page: "Page") -> None:
        """Listen to a page."""
        page.on("pageerror", lambda error: self.errors.append(str(error)))
        page.on("console", self._said)
        page.on("request", self._asked)

    def _said(self, message: "ConsoleMessage") -> None:
        # The browser writes a line of its own for each answer that is not a success.
        if message.type == "error" and "Failed to load resource" not in message.text:
            self.errors.append(message.text)

    def _asked(self, request: "Request") -> None:
        parts = urlsplit(request.url)
        if parts.scheme not in {"data", "blob"} and parts.netloc != self.host:
            self.foreign.append(request.url)


@pytest.fixture(scope="session")
def two_robots(tmp_path_factory: pytest.TempPathFactory) -> TwoRobots:
    """Two robots in a town, in opposite directions."""
    return TwoRobots.in_town(tmp_path_factory.mktemp("town"), SEED, SCANS, silent)


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory, two_robots: TwoRobots) -> Iterator[str]:
    """The address of a service that holds both maps."""
    with running_service(tmp_path_factory.mktemp("service")) as running:
        two_robots.store(running)
        yield running


@pytest.fixture(scope="module")
def browser() -> Iterator["Browser"]:
    """Chromium of the system."""
    try:
        program()
    except BrowserError as error:
        pytest.skip(str(error))
    with chromium() as running:
        yield running


@pytest.fixture
def page(browser: "Browser", address: str) -> Iterator["Page"]:
    """An empty page; it must end without an error and without a request to another host.

    Maps that a test adds are deleted afterward, so that a test that fails does not fail others.
    """
    with Client(address) as client:
        known = {each.name for each in client.maps()}
    with browser.new_context(viewport={"width": 1280, "height": 800}) as context:
        made = context.new_page()
        made.set_default_timeout(20_000)
        watch = Watch(urlsplit(address).netloc)
        watch.follow(made)
        yield made
        with Client(address) as client:
            for added in {each.name for each in client.maps()} - known:
                client.delete_map(added)
        assert not watch.errors
        assert not watch.foreign
