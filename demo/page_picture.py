"""Picture of the operator's page, taken with the browser of the system where there is one."""

import subprocess
from pathlib import Path

from benchmarks.page.browser import OPTIONS, find_chromium
from demo.meeting import SITE

SECONDS = 60


def draw_page(file: Path, address: str) -> bool:
    """Take a picture of the page with the merged map; return whether there is one.

    Args:
        file: PNG file to write.
        address: address of the service.
    """
    file.unlink(missing_ok=True)
    browser = find_chromium()
    if browser is None:
        return False
    command = [
        browser,
        "--headless",
        *OPTIONS,
        "--hide-scrollbars",
        "--window-size=1280,800",
        "--virtual-time-budget=10000",
        f"--screenshot={file.resolve()}",
        f"{address}/#map={SITE}",
    ]
    try:
        subprocess.run(command, capture_output=True, timeout=SECONDS, check=False)
    except subprocess.TimeoutExpired:
        return False
    return file.exists()
