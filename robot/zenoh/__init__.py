"""The agent's node over Zenoh, on the wire of `rmw_zenoh`: ROS 2 topics without ROS."""
