"""The built page is that of its source."""

import shutil
import subprocess
from pathlib import Path

import pytest

from benchmarks.page.measure import gzip_bytes
from service.api.pages import page

ROOT = Path(__file__).parents[2]
LARGEST_GZIP_BYTES = 300_000


@pytest.mark.slow
@pytest.mark.integration
def test_built_files_are_those_of_the_source(tmp_path: Path) -> None:
    if shutil.which("npm") is None:
        pytest.skip("needs Node and npm: apt-get install npm")
    shutil.copytree(ROOT / "page", tmp_path / "page", ignore=shutil.ignore_patterns("node_modules"))
    shutil.copytree(page.FOLDER, tmp_path / "service" / "page")
    folder = tmp_path / "page"
    install = ["npm", "ci", "--silent", "--no-audit", "--no-fund"]
    try:
        subprocess.run(install, cwd=folder, check=True, capture_output=True, timeout=180)
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired) as error:
        pytest.skip(f"npm could not install the packages of the page: {error}")
    checked = subprocess.run(
        ["npm", "run", "--silent", "check"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert checked.returncode == 0, checked.stdout
    built = subprocess.run(
        ["node", "build.mjs", "--check"], cwd=folder, capture_output=True, text=True, check=False
    )
    assert built.returncode == 0, built.stderr


def test_page_is_small_and_names_no_other_host() -> None:
    assert gzip_bytes(page.FOLDER) <= LARGEST_GZIP_BYTES
    html = (page.FOLDER / "index.html").read_text()
    style = (page.FOLDER / "page.css").read_text()
    assert "//" not in html + style
