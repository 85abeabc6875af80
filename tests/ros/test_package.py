"""The ROS 2 package: its files, its launch file, and its installation."""

import importlib.util
import shutil
import subprocess
import sys
from collections.abc import Iterator
from importlib.metadata import version
from pathlib import Path
from types import ModuleType
from typing import Any
from xml.etree import ElementTree as ET

import pytest
import yaml

from tests.ros.test_node import PACKAGE, STUBS, forget

XML = ET.parse(PACKAGE / "package.xml").getroot()


@pytest.fixture
def launched(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Any]]:
    """Entities that the launch file describes."""
    forget()
    monkeypatch.syspath_prepend(str(STUBS))
    file = PACKAGE / "launch" / "placecell.launch.py"
    spec = importlib.util.spec_from_file_location("placecell_launch", file)
    assert spec is not None
    assert spec.loader is not None
    module: ModuleType = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    yield module.generate_launch_description().entities
    forget()


def test_launch_file_starts_the_installed_node(launched: list[Any]) -> None:
    arguments = {each.name: each.default_value for each in launched if hasattr(each, "name")}
    nodes = {each.package: each for each in launched if hasattr(each, "package")}
    assert {"map", "service", "points", "odom", "params_file"} <= {*arguments}
    assert arguments["map"] is None  # has to be given
    agent = nodes["placecell_ros"]
    assert agent.executable == "agent"
    assert [topic for topic, _ in agent.options["remappings"]] == ["points", "odom"]
    for share in (agent.options["parameters"][1], nodes["rviz2"].options["arguments"]):
        assert share
    folder, *parts = arguments["params_file"].parts
    assert folder.package == "placecell_ros"
    assert (PACKAGE / Path(*parts)).is_file()
    _, *parts = nodes["rviz2"].options["arguments"][1].parts
    assert (PACKAGE / Path(*parts)).is_file()


def test_package_names_every_package_that_it_imports() -> None:
    listed = {each.text for each in XML.findall("exec_depend")}
    stubs = {each.name for each in STUBS.iterdir() if each.is_dir() and each.name[0] != "_"}
    assert listed == stubs | {"rviz2"}
    assert XML.findtext("export/build_type") == "ament_python"
    assert XML.findtext("license") == "Apache-2.0"


def test_version_is_that_of_placecell() -> None:
    assert XML.findtext("version") == version("placecell")
    assert f'version="{version("placecell")}"' in (PACKAGE / "setup.py").read_text()


def test_picture_of_rviz_is_in_the_frame_of_the_map() -> None:
    content = yaml.safe_load((PACKAGE / "rviz" / "placecell.rviz").read_text())
    manager = content["Visualization Manager"]
    assert manager["Global Options"]["Fixed Frame"] == "map"
    assert "/placecell/pose" in [each.get("Topic", {}).get("Value") for each in manager["Displays"]]


def run(*command: str | Path, cwd: Path) -> str:
    """Run a command and return its output; a failure shows its errors."""
    done = subprocess.run(
        command, cwd=cwd, text=True, timeout=120, capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


@pytest.mark.slow
def test_package_installs_as_colcon_does_it_and_its_node_imports(tmp_path: Path) -> None:
    pytest.importorskip("setuptools", reason="setuptools is not installed")
    venv, source = tmp_path / "venv", tmp_path / "source"
    shutil.copytree(PACKAGE, source, ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    run(sys.executable, "-m", "venv", "--without-pip", venv, cwd=tmp_path)
    install = ("setup.py", "install", "--prefix", venv, "--record", tmp_path / "record")
    run(sys.executable, *install, "--single-version-externally-managed", cwd=source)

    share = venv / "share"
    assert (share / "ament_index/resource_index/packages/placecell_ros").is_file()
    for file in ("package.xml", "launch/placecell.launch.py", "config/params.yaml"):
        assert (share / "placecell_ros" / file).read_bytes() == (PACKAGE / file).read_bytes()
    assert (share / "placecell_ros/rviz/placecell.rviz").is_file()
    assert (venv / "lib/placecell_ros/agent").is_file()  # where ros2 run looks for it
    # The stand-ins and what this Python has take the place of ROS and of placecell.
    paths = [str(STUBS), *(each for each in sys.path if each)]
    code = (
        f"import sys; sys.path += {paths!r}\n"
        "from importlib.metadata import entry_points\n"
        "main, = entry_points(group='console_scripts', name='agent')\n"
        "print(main.load().__module__, sys.modules['placecell_ros'].__file__)"
    )
    module, imported = run(venv / "bin/python", "-c", code, cwd=tmp_path).split()
    assert module == "placecell_ros.agent_node"
    assert Path(imported).is_relative_to(venv)


def test_launch_file_passes_names_as_text(launched: list[Any]) -> None:
    """A map named 2026 would be a number otherwise, which the node refuses."""
    (node,) = (each for each in launched if getattr(each, "executable", "") == "agent")
    _, values = node.options["parameters"]
    assert {name: values[name].value_type for name in ("map", "service")} == {
        "map": str,
        "service": str,
    }
