"""Imports of the command line before it knows the command."""

import subprocess
import sys


def test_no_heavy_package_is_imported_before_the_command_runs() -> None:
    program = (
        "import sys, cli\n"
        "heavy = {'scipy', 'numba', 'onnxruntime', 'faiss', 'torch', 'matplotlib', 'fastapi',\n"
        "         'pydantic', 'httpx'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
