"""Pictures of each view of the page, wide and narrow, for the documentation."""

import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from placecell_client import Client

from benchmarks.page.browser import chromium
from benchmarks.page.two_robots import TwoRobots
from placecell.segmentation.pipeline import Progress
from service.child_process import running_service

if TYPE_CHECKING:
    from playwright.sync_api import Page

WIDTHS = {1280: "", 390: "-narrow"}
"""Width of the window, pixels, and the ending of the file's name."""

SCANS = 120


def take_pictures(folder: Path, seed: int, progress: Progress) -> list[Path]:
    """Let two robots drive through a town, and take a picture of each view.

    Raises:
        BrowserError: Playwright or Chromium is missing.
    """
    folder.mkdir(parents=True, exist_ok=True)
    files = []
    with (
        tempfile.TemporaryDirectory(prefix="placecell-page-") as scratch,
        chromium() as browser,
    ):
        robots = TwoRobots.in_town(Path(scratch) / "town", seed, SCANS, progress, with_classes=True)
        scan = robots.scan_file(Path(scratch))
        with running_service(Path(scratch) / "service") as address:
            robots.store(address)
            for width, ending in WIDTHS.items():
                for name, act in views(scan).items():
                    page = browser.new_page(viewport={"width": width, "height": 800})
                    page.goto(address)
                    page.get_by_text("connected", exact=True).wait_for()
                    report_robots(address, robots)
                    act(page)
                    # Points are refined, and paths drawn, when the view is at rest.
                    page.wait_for_timeout(1500)
                    file = folder / f"{name}{ending}.png"
                    page.screenshot(path=file, full_page=width < 700)
                    page.close()
                    files.append(file)
    return files


def report_robots(address: str, robots: TwoRobots) -> None:
    """Report three robots: one that is sure, one that is less sure, and one that is lost."""
    x, y, z = robots.position
    with Client(address) as client:
        client.report_pose("carol", "yard", (x, y, z), covariance=np.diag([0.02, 0.02, 0.01]))
        client.report_pose("dave", "yard", (x - 25, y, z), covariance=np.diag([4.0, 1.0, 0.01]))
        client.report_pose("erin", "yard", (x - 40, y, z))
        client.report_pose("erin", state="lost", reason="too few segments: drive 10 m")


def views(scan: Path) -> dict[str, Callable[["Page"], None]]:
    """Return what brings the page to each view."""

    def show(page: "Page", *names: str) -> None:
        for name in names:
            page.get_by_role("checkbox", name=f"Show map {name}").check()
            page.get_by_role("heading", name=name, exact=True).wait_for()

    def align(page: "Page") -> None:
        show(page, "hall", "yard")
        page.get_by_role("button", name="Align and merge").click()
        page.get_by_role("button", name="Align", exact=True).click()
        page.get_by_role("button", name="Best").wait_for()

    def segment(page: "Page") -> None:
        show(page, "yard")
        above = page.get_by_role("button", name="From above")
        if not above.is_visible():  # a narrow page folds its tools
            page.get_by_role("button", name="Tools").click()
        above.click()
        page.get_by_placeholder("Segment id").fill("100")
        page.get_by_role("button", name="Find", exact=True).click()
        page.get_by_role("button", name="Find alike segments").click()
        page.locator(".alike").wait_for()
        page.get_by_role("button", name="Show all").click()

    def shapes(page: "Page") -> None:
        show(page, "yard")
        switch = page.get_by_role("button", name="Shapes", exact=True)
        if not switch.is_visible():  # a narrow page folds its tools
            page.get_by_role("button", name="Tools").click()
        switch.click()
        page.get_by_label("Segments of the open maps").focus()
        for _ in range(6):
            page.keyboard.press("+")
        page.get_by_text("Zoom in to see all shapes").wait_for()

    def versions(page: "Page") -> None:
        show(page, "yard")
        page.get_by_role("button", name="Versions").click()
        page.get_by_text("Version 1", exact=True).wait_for()

    def locate(page: "Page") -> None:
        page.get_by_role("button", name="Locate a scan").click()
        page.get_by_label("Search in").select_option("yard")
        page.get_by_label("Choose a scan").set_input_files(scan)
        page.locator(".answer").first.wait_for()

    def watch(page: "Page") -> None:
        show(page, "yard")
        page.get_by_role("button", name="Robots").click()
        page.get_by_role("main").get_by_text("carol").first.wait_for()

    def service(page: "Page") -> None:
        locate(page)
        page.get_by_role("button", name="Service", exact=True).click()
        page.wait_for_timeout(9000)

    return {
        "maps": lambda page: show(page, "yard"),
        "shapes": shapes,
        "segment": segment,
        "align": align,
        "versions": versions,
        "locate": locate,
        "robots": watch,
        "service": service,
    }
