import subprocess
import sys


def test_client_imports_nothing_of_the_service() -> None:
    program = (
        "import sys, placecell_client\n"
        "heavy = {'faiss', 'onnxruntime', 'torch', 'fastapi', 'pydantic', 'segments', 'service'}\n"
        "print(sorted(heavy & set(sys.modules)))"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "[]"
