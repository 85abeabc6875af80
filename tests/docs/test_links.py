"""Links between the documents and to files lead somewhere; `make docs` checks those of the site."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCUMENTS = sorted(
    {
        *ROOT.glob("*.md"),
        *(ROOT / "docs").rglob("*.md"),
        *(ROOT / "client").glob("*.md"),
        *(ROOT / "deploy").glob("*.md"),
        *(ROOT / "examples").rglob("*.md"),
        *(ROOT / "ros").rglob("*.md"),
        *(ROOT / "models").rglob("*.md"),
    }
)
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
NAMED = re.compile(r"\bdocs/[\w./-]+\.md\b")
FOLDERS = [
    folder
    for folder in ROOT.iterdir()
    if folder.is_dir() and not folder.name.startswith(".") and folder.name not in {"docs", "site"}
]
SOURCES = [
    file
    for folder in (*FOLDERS, ROOT / ".github")
    for file in folder.rglob("*")
    if file.suffix in {".py", ".md", ".yaml", ".service", ".sh"}
    and not {"site-packages", "node_modules"} & set(file.parts)
]


def prose(file: Path) -> str:
    """Return a document without its code blocks."""
    return re.sub(r"^ *```.*?^ *```", "", file.read_text(encoding="utf-8"), flags=re.M | re.S)


def anchors(file: Path) -> set[str]:
    """Return the anchors of a document's headings, as GitHub and the site make them."""
    headings = re.findall(r"^#+ (.+)$", prose(file), flags=re.MULTILINE)
    plain = (re.sub(r"[^\w\- ]", "", heading.replace("`", "")).strip() for heading in headings)
    return {re.sub(r"[ -]+", "-", text.lower()) for text in plain}


def links(file: Path) -> Iterator[tuple[str, str]]:
    """Yield the path and the anchor of each link to a file of ours."""
    for target in LINK.findall(prose(file)):
        if not re.match(r"[a-z]+:", target):
            path, _, anchor = target.partition("#")
            yield path, anchor


@pytest.mark.parametrize("file", DOCUMENTS, ids=lambda file: file.relative_to(ROOT).as_posix())
def test_links_lead_to_files_and_headings(file: Path) -> None:
    for path, anchor in links(file):
        target = (file.parent / path).resolve() if path else file
        assert target.exists(), f"{file.name}: no file {path}"
        if anchor and target.suffix == ".md":
            assert anchor in anchors(target), f"{file.name}: {path} has no heading #{anchor}"


def test_pages_that_the_code_names_exist() -> None:
    for file in SOURCES:
        for name in NAMED.findall(file.read_text(encoding="utf-8")):
            assert (ROOT / name).exists(), f"{file.relative_to(ROOT)} names {name}"
