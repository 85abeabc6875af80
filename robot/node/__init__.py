"""Node of the agent: pairs scans with odometry, and publishes poses; ROS 2 and Zenoh share it."""
