"""Drift is shown before it is removed, and the removal is undone, in a real browser."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import pytest
from placecell_client import Client

from placecell.descriptors.manifest import Manifest
from service.child_process import running_service
from tests.service.merging.drifting_maps import drifting_map
from tests.service.merging.merged_map_builders import models_that_judge

if TYPE_CHECKING:
    from playwright.sync_api import Page

pytestmark = [pytest.mark.slow, pytest.mark.integration]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of a service that holds the map of a robot whose odometry drifted."""
    pytest.importorskip("gtsam", reason="the extra pose-graph is not installed")
    models = models_that_judge(tmp_path_factory.mktemp("models"))
    given, _ = drifting_map(Manifest.load(models / "tiny").model_id, seed=1)
    environment = {"PLACECELL_MODELS_DIR": str(models), "PLACECELL_MODEL": "tiny"}
    with running_service(tmp_path_factory.mktemp("service"), environment=environment) as running:
        with Client(running) as client:
            client.put_map("block", given)
        yield running


def positions(address: str) -> np.ndarray:
    with Client(address) as client:
        return client.get_map("block").frame_positions


def test_drift_is_shown_removed_and_restored(page: "Page", address: str) -> None:
    before = positions(address)
    page.goto(address)
    page.get_by_role("heading", name="block", exact=True).wait_for()
    page.get_by_role("button", name="Remove drift").click()
    page.get_by_role("button", name="Look for loops").click()
    page.get_by_text("loops are accepted").wait_for()
    page.get_by_role("list", name="Colors of the preview").get_by_text("accepted loop").wait_for()
    assert (positions(address) == before).all()  # a preview writes nothing

    page.get_by_role("button", name="Remove the drift").click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_text("You can undo it").wait_for()
    dialog.get_by_role("button", name="Remove the drift").click()
    page.get_by_text("The drift of block is removed").wait_for()
    moved = positions(address)
    assert np.linalg.norm(moved - before, axis=1).max() > 0.2

    page.get_by_role("button", name="Undo the optimization").click()
    page.get_by_text("The optimization of block is undone").wait_for()
    assert (positions(address) == before).all()
    page.get_by_role("button", name="Undo the optimization").wait_for(state="detached")
