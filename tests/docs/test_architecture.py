"""The architecture page against the code: files of the steps, their number, dependencies."""

import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[2]
PAGE = ROOT / "docs" / "explanation" / "architecture.md"


def section(title: str) -> str:
    """Return the text of one section of the page."""
    text = PAGE.read_text(encoding="utf-8")
    found = re.search(rf"^## {re.escape(title)}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    assert found is not None, f"no section {title!r}"
    return found[1]


def files_of(title: str) -> list[str]:
    """Return the files that the numbered steps of a section name, in order."""
    steps = re.findall(r"^\d+\. (.+?)(?=^\d+\. |^$|\Z)", section(title), re.MULTILINE | re.DOTALL)
    assert steps, f"no numbered steps in {title!r}"
    return [file for step in steps for file in re.findall(r"`([\w/]+\.py)`", step)]


def dependencies() -> set[str]:
    """Return the names of all direct dependencies of both distributions."""
    names = set()
    for file in (ROOT / "pyproject.toml", ROOT / "client" / "pyproject.toml"):
        declared = tomllib.loads(file.read_text(encoding="utf-8"))
        project = declared["project"]
        groups = [project["dependencies"], *project.get("optional-dependencies", {}).values()]
        groups.append(declared["build-system"]["requires"])
        for requirement in (one for group in groups for one in group):
            names.add(re.match(r"[\w.-]+", requirement)[0].lower())  # type: ignore[index]
    return names - {"placecell"}


def test_every_dependency_has_a_reason() -> None:
    rows = re.findall(r"^\| ([\w, .-]+) \| (.+) \|$", section("Dependencies"), re.MULTILINE)
    reasons = {name.strip().lower(): why for names, why in rows for name in names.split(",")}
    assert not dependencies() - set(reasons)
    assert all(len(why.split()) > 1 for name, why in reasons.items() if name != "package")
