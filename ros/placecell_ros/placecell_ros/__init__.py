"""ROS 2 node of Placecell: localizes a robot in the maps of a service."""
