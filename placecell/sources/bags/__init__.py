"""Bags: ROS 1 bags, ROS 2 bags and MCAP files, without ROS."""

from placecell.sources.bags.bag_poses import BagPoses, Extrinsic, read_poses
from placecell.sources.bags.bag_source import BagSource, Mcap, Ros1Bag, Ros2Bag
from placecell.sources.bags.containers.bag import Bag
from placecell.sources.bags.containers.container import BagTopic

__all__ = [
    "Bag",
    "BagPoses",
    "BagSource",
    "BagTopic",
    "Extrinsic",
    "Mcap",
    "Ros1Bag",
    "Ros2Bag",
    "read_poses",
]
