"""Sensing: the simulated LiDAR and the odometry."""
