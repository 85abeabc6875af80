"""Size of the page, time to its first picture of a large map, pictures a second, memory."""

import gzip
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import numpy as np
from placecell_client import Client

from benchmarks.page.browser import chromium
from benchmarks.synthetic_maps.road_map import road_map
from evaluation.machine import machine
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.api.pages import page as page_files
from service.child_process import running_service

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

MAP = "large"
WAIT_MS = 120_000

TURN = """seconds => new Promise(done => {
  const canvas = document.querySelector(".stage canvas");
  const started = performance.now();
  let pictures = 0;
  const step = () => {
    const spent = performance.now() - started;
    if (spent > 1000 * seconds) return done(1000 * pictures / spent);
    pictures += 1;
    canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "q", bubbles: true }));
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
})"""
"""Turns the view at each picture and returns the pictures a second."""


def gzip_bytes(folder: Path) -> int:
    """Return the bytes of all files of the page, each compressed by gzip at its best."""
    return sum(
        len(gzip.compress(each.read_bytes(), 9))
        for each in sorted(folder.iterdir())
        if each.suffix in {".html", ".js", ".css", ".svg"}
    )


def measure_page(segments: int, seconds: float, seed: int) -> dict[str, Any]:
    """Measure the page with one large map.

    Args:
        segments: segments of the map.
        seconds: duration of the turn, seconds.
        seed: random seed of the map.

    Raises:
        BrowserError: Playwright or Chromium is missing.
    """
    manifest = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
    codes = np.random.default_rng(seed).integers(
        -128, 128, (segments, manifest.code_bytes), np.int8
    )
    with (
        tempfile.TemporaryDirectory(prefix="placecell-page-") as folder,
        running_service(Path(folder)) as address,
        chromium() as browser,
    ):
        with Client(address) as client:
            client.put_map(MAP, road_map(codes, manifest, "robot", seed=seed))
        figures = _measured(browser, address, segments, seconds)
    return {
        "machine": machine(),
        "browser": figures.pop("browser"),
        "segments": segments,
        "seed": seed,
        "gzip_bytes": gzip_bytes(page_files.FOLDER),
        **figures,
    }


def _measured(browser: "Browser", address: str, segments: int, seconds: float) -> dict[str, Any]:
    page = browser.new_page(viewport={"width": 1280, "height": 800})
    page.set_default_timeout(WAIT_MS)
    other_hosts: set[str] = set()
    host = urlsplit(address).netloc

    def note(url: str) -> None:
        parts = urlsplit(url)
        if parts.scheme not in {"data", "blob"} and parts.netloc != host:
            other_hosts.add(parts.netloc)

    page.on("request", lambda request: note(request.url))
    page.goto(address)
    box = page.get_by_role("checkbox", name=f"Show map {MAP}")
    box.wait_for()
    # The page opens the only map by itself. The second time counts: nothing is new but the map.
    page.get_by_text(f"{segments:,} segments", exact=True).wait_for()
    box.uncheck()
    page.get_by_text("Choose a map in the list").wait_for()
    started = time.perf_counter()
    box.check()
    page.get_by_text(f"{segments:,} segments", exact=True).wait_for()
    _shown(page)
    first = time.perf_counter() - started
    rate = page.evaluate(TURN, seconds)
    drawn = page.locator(".scale .count").inner_text()
    _shown(page)
    return {
        "browser": browser.version,
        "first_picture_1m_s": round(first, 2),
        "frames_per_second_1m": round(rate, 1),
        "drawn_while_turning": int(drawn.split(" ")[0].replace(",", "")),
        "tab_mb": _tab_mb(browser),
        "other_hosts": sorted(other_hosts),
    }


def _shown(page: "Page") -> None:
    """Wait until the browser has shown the last picture: it copies the pixels of the canvas."""
    page.wait_for_timeout(50)
    page.evaluate("document.querySelector('.stage canvas').toDataURL().length")


def _tab_mb(browser: "Browser") -> float:
    """Return the memory of the browser's tabs, MB: private pages, and a share of others."""
    session = browser.new_browser_cdp_session()
    processes = session.send("SystemInfo.getProcessInfo")["processInfo"]
    total = 0
    for process in processes:
        if process["type"] == "renderer":
            lines = Path(f"/proc/{process['id']}/smaps_rollup").read_text().splitlines()
            total += next(int(line.split()[1]) for line in lines if line.startswith("Pss:"))
    return round(total * 1024 / 1e6, 1)
