"""Fixtures: a running service, and a map for it."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from placecell_client import CompactMap

from benchmarks.synthetic_maps.road_map import road_map
from placecell.descriptors.manifest import Manifest
from placecell.descriptors.shipped_models import DEFAULT_MODEL, MODELS_FOLDER
from service.child_process import running_service


@pytest.fixture(scope="module")
def data_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("data")


@pytest.fixture(scope="module")
def address(data_dir: Path) -> Iterator[str]:
    with running_service(data_dir) as address:
        yield address


@pytest.fixture
def yard() -> CompactMap:
    manifest = Manifest.load(MODELS_FOLDER / DEFAULT_MODEL)
    codes = np.random.default_rng(0).integers(-128, 128, (300, manifest.code_bytes))
    return road_map(codes.astype(np.int8), manifest, "ann")
