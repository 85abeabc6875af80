import ast
import subprocess
import sys
from pathlib import Path

import pytest

import placecell

PACKAGE = Path(placecell.__file__).parent
FOREIGN = {
    "torch",
    "fastapi",
    "pydantic",
    "pydantic_settings",
    "starlette",
    "uvicorn",
    "faiss",
    "httpx",
}
NEIGHBORS = {"service", "training", "town", "cli", "client", "placecell_client", "bench"}
MODULES = sorted(
    ".".join(file.relative_to(PACKAGE.parent).with_suffix("").parts)
    for file in PACKAGE.rglob("*.py")
)

IMPORT_ALL = """
import importlib, sys
for module in sys.argv[1:]:
    importlib.import_module(module)
print("\\n".join({name.partition(".")[0] for name in sys.modules}))
"""


def test_no_web_no_torch_and_no_neighbors_are_loaded() -> None:
    modules = [module.removesuffix(".__init__") for module in MODULES]
    done = subprocess.run(
        [sys.executable, "-c", IMPORT_ALL, *modules],
        cwd=PACKAGE.parent, capture_output=True, text=True, check=True,
    )  # fmt: skip
    loaded = set(done.stdout.split())
    assert "placecell" in loaded
    assert not loaded & (FOREIGN | NEIGHBORS)


@pytest.mark.parametrize("module", MODULES)
def test_no_foreign_import_inside_functions(module: str) -> None:
    """Imports inside functions count, too."""
    tree = ast.parse((PACKAGE.parent / f"{module.replace('.', '/')}.py").read_text())
    imported = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            imported |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0
            imported.add(str(node.module).partition(".")[0])
    assert not imported & (FOREIGN | NEIGHBORS)
