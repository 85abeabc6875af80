"""A driver, the agent and a receiver in three processes, which only Zenoh connects."""

import json
import subprocess
import sys
import time
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("zenoh", reason="Zenoh is not installed: pip install 'placecell[zenoh]'")

import town
from placecell.datasets import open_drive
from service.child_process import running_service
from tests.robot.zenoh.driver_process import SHIFT
from tests.robot.zenoh.test_bus import free_endpoint

pytestmark = pytest.mark.slow

SCANS = 30
SECONDS = 100.0
"""Time limit of the whole exchange, on a busy machine."""


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A street, seen by 32 beams."""
    built = town.Town.build(seed=1)
    route = town.Route.wander(built.plan, built.terrain, length=SCANS + 10.0)
    lidar = replace(town.sensor("hdl-32e"), columns=720)
    folder = tmp_path_factory.mktemp("town") / "drive"
    return town.write_drive(folder, built, route, traffic_seed=1, scans=SCANS, lidar=lidar)


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory, drive: Path) -> Iterator[str]:
    """A service with a map of the street."""
    with running_service(tmp_path_factory.mktemp("data")) as address:
        run = ["robot", drive, "--map", "street", "--service", address, "--no-localize"]
        command = [sys.executable, "-m", "cli", *map(str, run)]
        done = subprocess.run(command, capture_output=True, text=True, timeout=SECONDS, check=False)
        assert done.returncode == 0, done.stderr
        yield address


def test_robot_localizes_by_topics_in_the_map_of_another_process(
    drive: Path, address: str, tmp_path: Path
) -> None:
    endpoint = free_endpoint()
    source = f"zenoh://?listen={endpoint}&node=placecell"
    own = ["--service", address, "--map", "street", "--no-upload", "--json"]
    agent = [sys.executable, "-m", "cli", "robot", source, *own]
    module = [sys.executable, "-m"]
    receiver = [*module, "tests.robot.zenoh.receiver_process", endpoint, str(SECONDS)]
    driver = [*module, "tests.robot.zenoh.driver_process", endpoint, str(drive)]
    started = time.monotonic()
    with (tmp_path / "log").open("w") as log:
        agent_process = subprocess.Popen(agent, stdout=subprocess.PIPE, stderr=log, text=True)
        driver_process = subprocess.Popen(driver, stdin=subprocess.PIPE, stderr=log)
        try:
            done = subprocess.run(
                receiver, capture_output=True, text=True, timeout=SECONDS + 20, check=False
            )
        finally:
            driver_process.communicate(timeout=20)  # it ends with its input
            agent_process.terminate()
            summary, _ = agent_process.communicate(timeout=40)
    assert done.returncode == 0, done.stderr + (tmp_path / "log").read_text()
    received = json.loads(done.stdout)

    # The driver's odometry frame is shifted against the map: the correction undoes it.
    correction = np.array(received["transform"]) @ SHIFT
    assert np.linalg.norm(correction[:3, 3]) < 0.5
    assert np.degrees(abs(np.arctan2(correction[1, 0], correction[0, 0]))) < 2
    assert received["frames"] == ["map", "odom"]
    assert received["topics"]["/diagnostics"] == "diagnostic_msgs/msg/DiagnosticArray"
    positions = open_drive(drive).poses[:, :2, 3]
    seen = np.array(received["position"])
    assert np.linalg.norm(positions - seen, axis=1).min() < 1.0
    assert received["states"][-1] == "tracking"
    assert json.loads(summary)["fixes"] >= 1
    assert time.monotonic() - started < SECONDS
