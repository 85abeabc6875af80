"""The layout: size of packages, directions of imports, and names of classes."""

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from itertools import combinations
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
FOLDERS = (
    "placecell",
    "client/placecell_client",
    "service",
    "robot",
    "town",
    "training",
    "evaluation",
    "benchmarks",
    "demo",
    "cli",
)
SMALL = (
    "service",
    "robot",
    "client/placecell_client",
    "training",
    "evaluation",
    "benchmarks",
    "town",
    "demo",
)
MODULES_IN_A_PACKAGE = 12
CLIENT = "placecell_client"

# Lowest first. A package imports from lines above its own only; packages of one line do not
# import each other. A module is ranked by the longest name here that it begins with.
LAYERS = (
    ("placecell.core", "placecell_client"),
    ("placecell.trajectories", "placecell.descriptors"),
    ("placecell.sources",),
    ("placecell.sources.bags.containers",),
    ("placecell.sources.bags", "placecell.sources.clouds"),
    ("placecell.sources.catalog",),
    ("placecell.odometry",),
    ("placecell.datasets",),
    ("placecell.segmentation", "placecell.localization"),
    ("placecell.segmentation.incremental",),
    ("placecell.map_alignment", "placecell.inspection", "placecell.export", "placecell.lasting"),
    ("placecell.pose_graph", "placecell.shapes"),
    ("placecell",),
    ("town.geometry",),
    ("town.streets",),
    ("town.objects",),
    ("town", "town.sensing"),
    ("town.places",),
    ("town.drives",),
    ("service.core",),
    ("service.live",),
    ("service.inference",),
    ("service.clouds",),
    ("service.maps",),
    ("service.maps.sql",),
    ("service.maps.sqlite", "service.maps.postgres", "service.maps.writes"),
    ("service.maps.following",),
    ("service.maps.stores",),
    ("service.annotations", "service.backup"),
    ("service.search",),
    ("service.merging",),
    ("service.warm_up",),
    ("service.engine", "service.child_process"),
    ("service.api.schemas",),
    ("service.api.body",),
    ("service.api.middleware",),
    ("service.api.admission",),
    ("service.api.pages",),
    ("service.api",),
    ("service.api.routes",),
    ("service.app",),
    ("service",),
    ("robot.core",),
    ("robot.outputs", "robot.localization"),
    ("robot.mapping",),
    ("robot",),
    ("robot.node",),
    ("robot.zenoh",),
    ("evaluation",),
    ("training.data",),
    ("evaluation.recognition", "evaluation.poses", "evaluation.segments"),
    ("training.methods",),
    ("training.export", "training.classes"),
    ("training.shapes",),
    ("training.experiments",),
    ("training",),
    ("benchmarks",),
    (
        "benchmarks.load",
        "benchmarks.localization",
        "benchmarks.attack",
        "benchmarks.peers",
        "benchmarks.page",
    ),
    ("benchmarks.storage", "benchmarks.durability"),
    (
        "benchmarks.durability.power_loss",
        "benchmarks.live",
        "benchmarks.replicas",
        "benchmarks.drift",
    ),
    ("demo",),
    ("cli",),
)
RANKS = {name: rank for rank, names in enumerate(LAYERS) for name in names}
OURS = {name.partition(".")[0] for name in RANKS}


@cache
def sources() -> dict[str, Path]:
    """Return the file of each module, by its dotted name; packages are left out."""
    found = {}
    for folder in FOLDERS:
        top = ROOT / folder
        for file in sorted(top.rglob("*.py")):
            if file.name != "__init__.py":
                found[".".join(file.relative_to(top.parent).with_suffix("").parts)] = file
    return found


@cache
def tree_of(file: Path) -> ast.Module:
    return ast.parse(file.read_text(encoding="utf-8"))


def layer_of(module: str) -> str:
    """Return the longest name of `LAYERS` that the module lies in."""
    name = module
    while name not in RANKS:
        name, dot, _ = name.rpartition(".")
        assert dot, f"{module} lies in no layer of this test"
    return name


def imports_of(module: str) -> Iterator[str]:
    """Yield each of our modules that a module imports, inside functions as well."""
    for node in ast.walk(tree_of(sources()[module])):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{alias.name}" for alias in node.names]
            names = [name if name in sources() else str(node.module) for name in names]
        else:
            continue
        yield from (name for name in names if name.partition(".")[0] in OURS)


def test_every_package_has_at_most_twelve_modules() -> None:
    sizes = {
        package.relative_to(ROOT).as_posix(): len(list(package.glob("*.py"))) - 1
        for folder in SMALL
        for package in [ROOT / folder, *(ROOT / folder).rglob("*/")]
        if (package / "__init__.py").exists()
    }
    assert {name: size for name, size in sizes.items() if size > MODULES_IN_A_PACKAGE} == {}


@pytest.mark.parametrize("package", list(RANKS))
def test_no_import_runs_back_up(package: str) -> None:
    upward = []
    for module in sources():
        if layer_of(module) != package:
            continue
        for imported in imports_of(module):
            target = layer_of(imported)
            if target != package and RANKS[target] >= RANKS[package]:
                upward.append(f"{module} imports {imported}")
    assert sorted(set(upward)) == []


def test_every_layer_has_modules() -> None:
    parents = {"placecell", "training"}  # packages without modules of their own
    assert {layer_of(module) for module in sources()} == set(RANKS) - parents


def test_no_two_public_classes_share_a_name() -> None:
    """A class of the client may mirror one class of the service, which it decodes."""
    places = defaultdict(list)
    for module, file in sources().items():
        for node in tree_of(file).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places[node.name].append(module)
    shared = {
        name: (one, other)
        for name, modules in places.items()
        for one, other in combinations(modules, 2)
        if one.startswith(CLIENT) == other.startswith(CLIENT)
    }
    assert shared == {}
