"""The ROS 2 node with a real rclpy, where there is one."""

import json
import os
import subprocess
from pathlib import Path

import pytest

PROGRAM = Path(__file__).resolve().parents[2] / "ros/placecell_ros/test/real_rclpy.py"
PYTHON = os.environ.get("PLACECELL_ROS_PYTHON", "")


@pytest.mark.skipif(not PYTHON, reason="PLACECELL_ROS_PYTHON names no Python with rclpy")
def test_node_talks_to_another_node_over_a_real_rclpy() -> None:
    done = subprocess.run(
        [PYTHON, PROGRAM], capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) == {
        "map": "yard",
        "wait": 2.5,
        "x": 102.0,
        "variance": 0.01,
        "frames": ["map", "odom"],
        "level": 0,
        "state": "tracking",
        "service": True,
        "closed": 1,
    }
