import subprocess
import sys
from pathlib import Path
from textwrap import dedent

import numpy as np
import pytest

import placecell
from tests.placecell.segment_builders import box, plane, pose, write_odometry

EXAMPLE = str(placecell.__doc__).splitlines()
ROOT = Path(placecell.__file__).parents[1]
HEAVY = {"numpy", "numba", "onnxruntime", "scipy", "networkx", "safetensors"}


def test_import_loads_no_heavy_module() -> None:
    code = 'import sys, placecell; print("\\n".join({n.partition(".")[0] for n in sys.modules}))'
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True
    )
    assert not set(done.stdout.split()) & HEAVY


@pytest.mark.parametrize("name", placecell.__all__)
def test_public_name_exists_and_has_a_docstring(name: str) -> None:
    assert getattr(placecell, name).__doc__
    assert name in dir(placecell)


def test_every_public_name_has_one_module() -> None:
    names = [name for some in placecell._MODULES.values() for name in some]
    assert sorted(names) == placecell.__all__


def test_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="'placecell' has no attribute 'nothing'"):
        _ = placecell.nothing


def test_example_of_the_docstring_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cloud = np.concatenate([plane(20.0), box((6, 0, 0), (1, 1, 2)), box((0, 7, 0), (2, 1, 2))])
    folder = write_odometry(tmp_path / "drive", [cloud] * 3, [pose(x) for x in (0.0, 0.1, 0.2)])
    example = dedent("\n".join(line for line in EXAMPLE if line.startswith("    ")))
    exec(example.replace("drives/00", str(folder)), {})
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["0", "1", "2"]
